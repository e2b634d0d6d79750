//! Rows of values, whichever way they are written.
//!
//! A [`Plan`] says what becomes of each property; the two encodings follow it
//! and fill a [`Row`]. So what the values mean is written once, and neither
//! encoding knows it.
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

/// The most values of a row that anyone asks for: those of a vertex.
pub(super) const SLOTS: usize = 11;

/// What becomes of the properties of an element.
#[derive(Debug)]
pub(super) struct Plan<'e> {
    /// The element.
    pub(super) element: &'e Element<'e>,
    /// One step a property.
    pub(super) steps: Vec<Step>,
    /// The type of the value in each slot; `None` where there is none.
    pub(super) slots: [Option<Scalar>; SLOTS],
    /// Whether one of the lists is kept.
    pub(super) has_list: bool,
}

/// What becomes of one property.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Step {
    /// A value, which goes to a slot or nowhere.
    Value { kind: Scalar, slot: Option<usize> },
    /// A list, which is kept or not.
    List { length: Scalar, kind: Scalar, is_kept: bool },
}

/// What a row said.
#[derive(Debug, Default)]
pub(super) struct Row {
    /// The values by slot; meaningless where the element has none for it.
    pub(super) values: [f64; SLOTS],
    /// The values of the list that is kept.
    pub(super) list: Vec<f64>,
}

impl<'e> Plan<'e> {
    /// Gives each value the slot whose names hold its own, and keeps the list
    /// that `list_names` hold; where two would do, the first one counts.
    pub(super) fn new(
        element: &'e Element<'e>,
        slot_names: &[&[&str]],
        list_names: &[&str],
    ) -> Self {
        let mut plan = Self { element, steps: Vec::new(), slots: [None; SLOTS], has_list: false };
        let holds = |names: &[&str], name: &[u8]| names.iter().any(|own| own.as_bytes() == name);
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

    /// Whether the element has values for all these slots.
    pub(super) fn has(&self, slots: Range<usize>) -> bool {
        self.slots[slots].iter().all(Option::is_some)
    }
}

/// The rows of a file, in turn.
pub(super) trait Rows {
    /// Gets ready for the rows of `plan`.
    ///
    /// # Errors
    /// Truncated, where the bytes that are left cannot hold as many rows as are
    /// announced; behind this, memory may be reserved for them.
    fn begin(&mut self, plan: &Plan) -> Result<(), ReadError>;

    /// Reads the next row.
    ///
    /// # Errors
    /// Truncated at the end of the file; Syntax and Number, where text is no
    /// row of the element.
    fn read(&mut self, plan: &Plan, row: &mut Row, report: &mut Report) -> Result<(), ReadError>;

    /// Where the row stands that was read last.
    fn place(&self) -> Place;

    /// Its line; 0 where rows are no lines.
    fn line(&self) -> u32;

    /// Where something stands behind the last row; `None` where nothing does.
    fn first_unread(&mut self) -> Option<Place>;
}

/// Checks that rows that take `needed` bytes at least fit into those `left`.
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
         the file was cut off, or its header is wrong",
        element.count,
        quoted(element.name)
    );
    Err(source.error(ReadErrorKind::Truncated, Some(place), what))
}

/// The error for a file that ends in row `row` of `element`.
pub(super) fn cut_off(source: &Source, place: Place, element: &Element, row: u64) -> ReadError {
    let name = quoted(element.name);
    let what = format!("the file ends in row {row} of {} of {name}; it was cut off", element.count);
    source.error(ReadErrorKind::Truncated, Some(place), what)
}

/// The length of a list.
///
/// # Errors
/// Syntax, where `length` is no count, or one too large to be named.
pub(super) fn list_length(source: &Source, place: Place, length: f64) -> Result<usize, ReadError> {
    let is_count = length.fract() == 0.0 && (0.0..=MAX_INDEX as f64).contains(&length);
    if !is_count {
        let what = format!("a list of {length} values; lists have from 0 to {MAX_INDEX}");
        return Err(source.error(ReadErrorKind::Syntax, Some(place), what));
    }
    #[expect(clippy::cast_possible_truncation, reason = "at most MAX_INDEX")]
    Ok(length as usize)
}
