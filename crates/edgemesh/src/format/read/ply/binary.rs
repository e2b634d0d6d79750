//! Binary rows, without gaps.
//!
//! The rows of an element without lists are equally long, and the offsets of the
//! values are known in advance. Rows with lists are read value by value.
//!
//! ```text
//! | x | y | z | r g b a |    stride 16, columns at 0, 4, 8
//! |3| a | b | c |            1 + 3 * 4 bytes, then the next row
//! ```

use super::super::error::ReadError;
use super::super::source::Source;
use super::header::{Encoding, Header};
use super::rows::{Row, RowPlan, Rows, Step, check_room, list_length, truncated};
use super::scalar::Scalar;
use crate::report::{Place, Report};

/// The rows of a binary file.
#[derive(Debug)]
pub(super) struct BinaryRows<'s, 'a> {
    source: &'s Source<'a>,
    is_big_endian: bool,
    /// The offset of the next byte.
    at: usize,
    /// The number of rows of this element so far.
    row: u64,
    /// The offset of the last row.
    start: usize,
    /// The layout of a row; `None` if it has lists.
    layout: Option<Layout>,
}

/// The offsets of values in rows of fixed length.
#[derive(Debug, Default)]
struct Layout {
    stride: usize,
    columns: Vec<Column>,
}

/// A value in a row, and the slot that it goes to.
#[derive(Debug)]
struct Column {
    offset: usize,
    kind: Scalar,
    slot: usize,
}

impl Layout {
    fn new(plan: &RowPlan) -> Option<Self> {
        let mut layout = Self::default();
        for &step in &plan.steps {
            let Step::Value { kind, slot } = step else { return None };
            let offset = layout.stride;
            layout.columns.extend(slot.map(|slot| Column { offset, kind, slot }));
            layout.stride += kind.size();
        }
        Some(layout)
    }

    /// Reads the row at the start of `bytes`; `None` if they are too few.
    #[inline]
    fn read(&self, bytes: &[u8], is_big_endian: bool, row: &mut Row) -> Option<()> {
        let bytes = bytes.get(..self.stride)?;
        for column in &self.columns {
            row.values[column.slot] =
                column.kind.decode(bytes.get(column.offset..)?, is_big_endian)?;
        }
        Some(())
    }
}

impl<'s, 'a> BinaryRows<'s, 'a> {
    /// The rows after `header`.
    pub(super) const fn new(source: &'s Source<'a>, header: &Header) -> Self {
        let is_big_endian = matches!(header.encoding, Encoding::BigEndian);
        let (at, start) = (header.end, header.end);
        Self { source, is_big_endian, at, row: 0, start, layout: None }
    }

    fn left(&self) -> &'a [u8] {
        self.source.bytes.get(self.at..).unwrap_or_default()
    }

    /// The next value; `None` at the end of the file.
    #[inline]
    fn value(&mut self, kind: Scalar) -> Option<f64> {
        let value = kind.decode(self.left(), self.is_big_endian)?;
        self.at += kind.size();
        Some(value)
    }

    /// Reads a row with lists, value by value.
    fn walk(&mut self, plan: &RowPlan, row: &mut Row) -> Result<(), ReadError> {
        for &step in &plan.steps {
            match step {
                Step::Value { kind, slot } => {
                    let value = self.value(kind).ok_or_else(|| self.truncated_error(plan))?;
                    if let Some(slot) = slot {
                        row.values[slot] = value;
                    }
                }
                Step::List { length, kind, is_kept } => {
                    let length = self.value(length).ok_or_else(|| self.truncated_error(plan))?;
                    let length = list_length(self.source, self.place(), length)?;
                    let list = is_kept.then_some(&mut row.list);
                    self.list(kind, length, list).ok_or_else(|| self.truncated_error(plan))?;
                }
            }
        }
        Ok(())
    }

    /// Reads the values of a list into `list`, or skips them; `None` at the end of the
    /// file.
    fn list(&mut self, kind: Scalar, length: usize, list: Option<&mut Vec<f64>>) -> Option<()> {
        let size = kind.size();
        // At most 8 * MAX_INDEX, which cannot overflow.
        let bytes = self.left().get(..length * size)?;
        self.at += bytes.len();
        if let Some(list) = list {
            let is_big_endian = self.is_big_endian;
            list.clear();
            list.extend(bytes.chunks_exact(size).filter_map(|one| kind.decode(one, is_big_endian)));
        }
        Some(())
    }

    #[cold]
    fn truncated_error(&self, plan: &RowPlan) -> ReadError {
        truncated(self.source, self.place(), plan.element, self.row)
    }
}

impl Rows for BinaryRows<'_, '_> {
    fn begin(&mut self, plan: &RowPlan) -> Result<(), ReadError> {
        (self.row, self.start) = (0, self.at);
        self.layout = Layout::new(plan);
        let size = |step: &Step| match step {
            Step::Value { kind, .. } => kind.size() as u64,
            Step::List { length, .. } => length.size() as u64,
        };
        let needed = plan.element.count.saturating_mul(plan.steps.iter().map(size).sum());
        check_room(self.source, self.place(), plan.element, needed, self.left().len())
    }

    fn read(
        &mut self,
        plan: &RowPlan,
        row: &mut Row,
        _report: &mut Report,
    ) -> Result<(), ReadError> {
        self.row += 1;
        self.start = self.at;
        let left = self.left();
        let Some(layout) = &self.layout else { return self.walk(plan, row) };
        layout.read(left, self.is_big_endian, row).ok_or_else(|| self.truncated_error(plan))?;
        self.at += layout.stride;
        Ok(())
    }

    fn place(&self) -> Place {
        Place::Byte(self.start as u64)
    }

    fn line(&self) -> u32 {
        0
    }

    fn first_unread(&mut self) -> Option<Place> {
        let is_blank = |byte: &u8| *byte == 0 || byte.is_ascii_whitespace();
        let offset = self.left().iter().position(|byte| !is_blank(byte))?;
        Some(Place::Byte((self.at + offset) as u64))
    }
}
