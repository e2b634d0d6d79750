//! Text rows: one row a line, with blanks between the values.
//!
//! A row that is too short is an error, because the values after a missing one
//! would shift. Text after the last value is left out with a warning. Empty lines
//! are skipped.
//!
//! Rejected: rows that continue in the next line, as the original C library reads
//! them. A row without its last value would then take one from the next row.

use super::super::error::{ReadError, ReadErrorKind};
use super::super::source::Source;
use super::super::words::{Words, quoted};
use super::header::Header;
use super::rows::{Row, RowPlan, Rows, Step, check_room, list_length, truncated};
use crate::report::{Place, Report, WarningCode};

/// The rows of a text file.
#[derive(Debug)]
pub(super) struct TextRows<'s, 'a> {
    source: &'s Source<'a>,
    words: Words<'a>,
    /// The number of rows of this element so far.
    row: u64,
    /// The line of the last row.
    line: u32,
}

impl<'s, 'a> TextRows<'s, 'a> {
    /// The rows after `header`.
    pub(super) const fn new(source: &'s Source<'a>, header: &Header) -> Self {
        let words = Words::new(source.bytes, header.end, header.end_line);
        Self { source, words, row: 0, line: header.end_line }
    }

    /// The next value of the row.
    #[inline]
    fn number(&mut self, plan: &RowPlan) -> Result<f64, ReadError> {
        match self.words.number() {
            Some(Ok(number)) => Ok(number),
            Some(Err(word)) => {
                let what = format!("{} is not a number", quoted(word));
                Err(self.source.error(ReadErrorKind::Number, Some(self.place()), what))
            }
            None => Err(self.too_short(plan)),
        }
    }

    /// Reads a list into `list`, or skips it.
    fn list(&mut self, plan: &RowPlan, list: Option<&mut Vec<f64>>) -> Result<(), ReadError> {
        let length = self.number(plan)?;
        let length = list_length(self.source, self.place(), length)?;
        let Some(list) = list else {
            return (0..length).try_for_each(|_| self.skip_value(plan));
        };
        list.clear();
        for _ in 0..length {
            list.push(self.number(plan)?);
        }
        Ok(())
    }

    /// Skips the next value of the row, which need not be a number.
    fn skip_value(&mut self, plan: &RowPlan) -> Result<(), ReadError> {
        self.words.word().map(|_| ()).ok_or_else(|| self.too_short(plan))
    }

    #[cold]
    fn too_short(&self, plan: &RowPlan) -> ReadError {
        if self.words.left().is_empty() {
            return truncated(self.source, self.place(), plan.element, self.row);
        }
        let name = quoted(plan.element.name);
        let what = format!("row {} of {name} has too few values", self.row);
        self.source.error(ReadErrorKind::Syntax, Some(self.place()), what)
    }
}

impl Rows for TextRows<'_, '_> {
    fn begin(&mut self, plan: &RowPlan) -> Result<(), ReadError> {
        self.row = 0;
        self.line = self.words.line();
        // A digit and a blank or line end, which the last value may lack.
        let row_bytes = 2 * plan.steps.len() as u64;
        let needed = plan.element.count.saturating_mul(row_bytes).saturating_sub(1);
        check_room(self.source, self.place(), plan.element, needed, self.words.left().len())
    }

    fn read(
        &mut self,
        plan: &RowPlan,
        row: &mut Row,
        report: &mut Report,
    ) -> Result<(), ReadError> {
        self.words.skip_space();
        self.row += 1;
        self.line = self.words.line();
        for &step in &plan.steps {
            match step {
                Step::Value { slot: Some(slot), .. } => row.values[slot] = self.number(plan)?,
                Step::Value { slot: None, .. } => self.skip_value(plan)?,
                Step::List { is_kept, .. } => {
                    self.list(plan, is_kept.then_some(&mut row.list))?;
                }
            }
        }
        let rest = self.words.take_rest_of_line();
        if !rest.is_empty() {
            report.warn(WarningCode::Syntax, Some(self.place()), || {
                let name = quoted(plan.element.name);
                format!("{} after the last value of {name} was left out", quoted(rest))
            });
        }
        Ok(())
    }

    fn place(&self) -> Place {
        Place::Line(self.line)
    }

    fn line(&self) -> u32 {
        self.line
    }

    fn first_unread(&mut self) -> Option<Place> {
        self.words.skip_space();
        (!self.words.left().is_empty()).then_some(Place::Line(self.words.line()))
    }
}
