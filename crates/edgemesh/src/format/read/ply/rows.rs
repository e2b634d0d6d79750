//! Rows of values, in text or binary.
//!
//! A [`RowPlan`] maps each property to its place in a [`Row`]. Both encodings follow
//! it, so that neither knows what the values mean.
//!
//! ```text
//! properties  x  y  confidence  z    and    red  vertex_indices
//! steps       0  1  -           2           -    list
//! values      [x, y, z, ...]                     list [..]
//! ```

use std::ops::Range;

use super::super::error::{ReadError, ReadErrorKind};
use super::super::source::Source;
use super::super::words::quoted;
use super::header::Element;
use super::scalar::Scalar;
use crate::index::MAX_INDEX;
use crate::report::{Place, Report};

/// The most values that are read of a row: those of a vertex.
pub(super) const SLOTS: usize = 12;

/// Where the properties of an element go.
#[derive(Debug)]
pub(super) struct RowPlan<'e> {
    /// The element.
    pub(super) element: &'e Element<'e>,
    /// One step for each property.
    pub(super) steps: Vec<Step>,
    /// The type of the value in each slot; `None` if the element has none.
    pub(super) slots: [Option<Scalar>; SLOTS],
    /// Whether the element has a list that is kept.
    pub(super) has_list: bool,
}

/// How one property is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Step {
    /// A value, stored in a slot or skipped.
    Value { kind: Scalar, slot: Option<usize> },
    /// A list, kept or skipped.
    List { length: Scalar, kind: Scalar, is_kept: bool },
}

/// The values of a row.
#[derive(Debug, Default)]
pub(super) struct Row {
    /// The values by slot; undefined for slots without a property.
    pub(super) values: [f64; SLOTS],
    /// The values of the kept list.
    pub(super) list: Vec<f64>,
}

impl<'e> RowPlan<'e> {
    /// Gives each property the slot that lists its name in `slot_names`, and keeps the
    /// list whose name is in `list_names`. Of several such properties the first counts.
    pub(super) fn new(
        element: &'e Element<'e>,
        slot_names: &[&[&str]],
        list_names: &[&str],
    ) -> Self {
        let mut plan = Self { element, steps: Vec::new(), slots: [None; SLOTS], has_list: false };
        let holds = |names: &[&str], name: &[u8]| names.iter().any(|one| one.as_bytes() == name);
        for property in &element.properties {
            let kind = property.kind;
            plan.steps.push(match property.length {
                Some(length) => {
                    let is_kept = !plan.has_list && holds(list_names, property.name);
                    plan.has_list |= is_kept;
                    Step::List { length, kind, is_kept }
                }
                None => {
                    let named = slot_names.iter().position(|names| holds(names, property.name));
                    let slot = named.filter(|&slot| plan.slots[slot].is_none());
                    if let Some(slot) = slot {
                        plan.slots[slot] = Some(kind);
                    }
                    Step::Value { kind, slot }
                }
            });
        }
        plan
    }

    /// Whether the element has values for all of `slots`.
    pub(super) fn has(&self, slots: Range<usize>) -> bool {
        self.slots[slots].iter().all(Option::is_some)
    }
}

/// The rows of a file, in their order.
pub(super) trait Rows {
    /// Prepares for the rows of `plan`.
    ///
    /// # Errors
    /// Truncated: the remaining bytes cannot hold all rows. After this check, memory
    /// may be reserved for them.
    fn begin(&mut self, plan: &RowPlan) -> Result<(), ReadError>;

    /// Reads the next row.
    ///
    /// # Errors
    /// Truncated: the file ends. Syntax, Number: the text is not a row of the element.
    fn read(&mut self, plan: &RowPlan, row: &mut Row, report: &mut Report)
    -> Result<(), ReadError>;

    /// The place of the last row that was read.
    fn place(&self) -> Place;

    /// The line of that row; 0 in binary files.
    fn line(&self) -> u32;

    /// The place of the first content after the last row, if there is any.
    fn first_unread(&mut self) -> Option<Place>;
}

/// Checks that the rows of `element`, at least `needed` bytes, fit into `left` bytes.
pub(super) fn check_room(
    source: &Source,
    place: Place,
    element: &Element,
    needed: u64,
    left: usize,
) -> Result<(), ReadError> {
    if needed <= left as u64 {
        return Ok(());
    }
    let what = format!(
        "{} rows of {} need at least {needed} bytes, but {left} are left; \
         the file is truncated, or its header is wrong",
        element.count,
        quoted(element.name)
    );
    Err(source.error(ReadErrorKind::Truncated, Some(place), what))
}

/// The error of a file that ends in row `row` of `element`.
pub(super) fn truncated(source: &Source, place: Place, element: &Element, row: u64) -> ReadError {
    let name = quoted(element.name);
    let what =
        format!("the file is truncated: it ends in row {row} of {} of {name}", element.count);
    source.error(ReadErrorKind::Truncated, Some(place), what)
}

/// The length of a list as a count.
///
/// # Errors
/// Syntax: `length` is not a whole number from 0 to [`MAX_INDEX`].
pub(super) fn list_length(source: &Source, place: Place, length: f64) -> Result<usize, ReadError> {
    let is_count = length.fract() == 0.0 && (0.0..=MAX_INDEX as f64).contains(&length);
    if !is_count {
        let what = format!("a list has {length} values; lists have from 0 to {MAX_INDEX}");
        return Err(source.error(ReadErrorKind::Syntax, Some(place), what));
    }
    #[expect(clippy::cast_possible_truncation, reason = "at most MAX_INDEX")]
    Ok(length as usize)
}
