//! Text rows: one vertex or face a line. A `#` begins a comment; lines without a value
//! are skipped.

use super::super::error::{ReadError, ReadErrorKind};
use super::super::source::Source;
use super::super::words::{Words, quoted};
use super::elements::{Counts, Elements};
use super::header::{Header, VertexLayout};
use crate::index::MAX_INDEX;
use crate::model::Model;
use crate::report::{Place, Report, WarningCode};

/// The numbers of values that a color of a face may have: none, an index of a table,
/// three or four channels.
const FACE_COLORS: [usize; 4] = [0, 1, 3, 4];

/// Reads the rows behind the keyword.
///
/// # Errors
/// Syntax, Number: a row breaks the rules. Index: a vertex does not exist. Truncated: rows
/// are missing. Size: too many elements.
pub(super) fn read_text(
    source: &Source,
    header: Header,
    report: &mut Report,
) -> Result<Model, ReadError> {
    let Header { layout, rest, .. } = header;
    let mut rows = Rows { source, line: rest.line(), words: rest };
    let counts = rows.counts()?;
    let mut elements = Elements::new(source, layout, counts);
    let (mut values, mut color) = (Vec::new(), Vec::new());
    for at in 1..=counts.vertices {
        let row = rows.next("vertex", at, counts.vertices)?;
        rows.vertex(row, layout, &mut values, report)?;
        elements.vertex(&values);
    }
    for at in 1..=counts.faces {
        let row = rows.next("face", at, counts.faces)?;
        rows.face(row, &mut values, &mut color, report)?;
        elements.face(&values, &color, rows.place(), rows.line, report)?;
    }
    if rows.next_row().is_some() {
        report.warn(WarningCode::Syntax, Some(rows.place()), || {
            "the content after the last face was left out".into()
        });
    }
    Ok(elements.finish())
}

/// Lines with values.
struct Rows<'s, 'a> {
    source: &'s Source<'a>,
    words: Words<'a>,
    /// The line of the last row.
    line: u32,
}

impl<'a> Rows<'_, 'a> {
    /// The next line with values, without its comment; `None` at the end of the file.
    fn next_row(&mut self) -> Option<Words<'a>> {
        while !self.words.left().is_empty() {
            self.line = self.words.line();
            let text = self.words.take_rest_of_line();
            let text = text.split(|&byte| byte == b'#').next().unwrap_or_default();
            if !text.trim_ascii().is_empty() {
                return Some(Words::new(text, 0, self.line));
            }
        }
        self.line = self.words.line();
        None
    }

    fn next(&mut self, what: &str, at: usize, count: usize) -> Result<Words<'a>, ReadError> {
        self.next_row().ok_or_else(|| {
            let what = format!("the file is truncated: it ends before {what} {at} of {count}");
            self.error(ReadErrorKind::Truncated, what)
        })
    }

    /// The counts of vertices and faces; that of edges is ignored and may be missing.
    fn counts(&mut self) -> Result<Counts, ReadError> {
        let Some(mut row) = self.next_row() else {
            return Err(self.error(ReadErrorKind::Truncated, "the file ends before its counts"));
        };
        let [vertices, faces] = [self.count(&mut row)?, self.count(&mut row)?];
        // A row takes a digit and a line end, which the last may lack.
        let needed = vertices.saturating_add(faces).saturating_mul(2).saturating_sub(1);
        let left = self.words.left().len();
        let counts = Counts { vertices, faces };
        counts.check(needed, left).map_err(|(kind, what)| self.error(kind, what))?;
        Ok(counts)
    }

    fn count(&self, row: &mut Words) -> Result<usize, ReadError> {
        let word = row.word().unwrap_or_default();
        std::str::from_utf8(word).ok().and_then(|word| word.parse().ok()).ok_or_else(|| {
            let what = format!(
                "needs the counts of vertices and faces here, and {} is not one",
                quoted(word)
            );
            self.error(ReadErrorKind::Syntax, what)
        })
    }

    /// Reads the values of a vertex: as many as its layout needs.
    fn vertex(
        &self,
        mut row: Words,
        layout: VertexLayout,
        values: &mut Vec<f64>,
        report: &mut Report,
    ) -> Result<(), ReadError> {
        let (least, most) = (layout.values(3), layout.values(4));
        values.clear();
        while values.len() < most
            && let Some(value) = self.number(&mut row)?
        {
            values.push(value);
        }
        let found = values.len();
        if found < least {
            let what = format!("a vertex needs {least} values here, this one has {found}");
            return Err(self.error(ReadErrorKind::Syntax, what));
        }
        let surplus = row.take_rest_of_line();
        if !surplus.is_empty() {
            report.warn(WarningCode::Syntax, Some(self.place()), || {
                format!("{} after the last value of a vertex was left out", quoted(surplus))
            });
        }
        Ok(())
    }

    /// Reads the vertices of a face, and its color, which is empty without one.
    fn face(
        &self,
        mut row: Words,
        values: &mut Vec<f64>,
        color: &mut Vec<f64>,
        report: &mut Report,
    ) -> Result<(), ReadError> {
        values.clear();
        let count = self.number(&mut row)?.unwrap_or_default();
        if count.fract() != 0.0 || !(0.0..=MAX_INDEX as f64).contains(&count) {
            let what = format!("a face has {count} corners; faces have from 0 to {MAX_INDEX}");
            return Err(self.error(ReadErrorKind::Syntax, what));
        }
        while (values.len() as f64) < count {
            let Some(value) = self.number(&mut row)? else {
                let what = format!("a face of {count} corners has {} vertices", values.len());
                return Err(self.error(ReadErrorKind::Syntax, what));
            };
            values.push(value);
        }
        let rest = row.left();
        if !self.read_color(row, color) {
            color.clear();
            report.warn(WarningCode::Syntax, Some(self.place()), || {
                format!("{} behind a face is not a color; it was left out", quoted(rest))
            });
        }
        Ok(())
    }

    /// Reads the rest of a row as the color of a face; returns whether it can be one.
    fn read_color(&self, mut row: Words, color: &mut Vec<f64>) -> bool {
        color.clear();
        loop {
            match self.number(&mut row) {
                Ok(Some(value)) => color.push(value),
                Ok(None) => return FACE_COLORS.contains(&color.len()),
                Err(_) => return false,
            }
        }
    }

    /// The next value of a row; `None` at its end.
    fn number(&self, row: &mut Words) -> Result<Option<f64>, ReadError> {
        row.number().transpose().map_err(|word| {
            self.error(ReadErrorKind::Number, format!("{} is not a number", quoted(word)))
        })
    }

    const fn place(&self) -> Place {
        Place::Line(self.line)
    }

    fn error(&self, kind: ReadErrorKind, what: impl Into<String>) -> ReadError {
        self.source.error(kind, Some(self.place()), what)
    }
}
