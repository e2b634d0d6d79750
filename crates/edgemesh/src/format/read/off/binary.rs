//! Binary rows: integers and floats (positions, colors and so on) of 32 bits, the most significant byte first.
//!
//! ```text
//! OFF BINARY\n
//! | vertices | faces | edges |
//! | x | y | z | nx ny nz | r g b a | s t |           as far as the keyword says
//! | corners | vertex, vertex, ... | channels | r, g, b, a |
//! ```

use super::super::error::{ReadError, ReadErrorKind};
use super::super::source::Source;
use super::elements::{Counts, Elements};
use super::header::Header;
use crate::model::Model;
use crate::report::{Place, Report, WarningCode};

/// The bytes of a value.
const VALUE: usize = 4;

/// The most values of a face's color.
const MOST_CHANNELS: i32 = 4;

/// Reads the rows behind the keyword.
///
/// # Errors
/// Syntax: a count is impossible. Index: a vertex does not exist. Truncated: rows are
/// missing. Size: too many elements.
pub(super) fn read_binary(
    source: &Source,
    header: &Header,
    report: &mut Report,
) -> Result<Model, ReadError> {
    let at = header.rest.at();
    let mut rows = Rows { source, at, start: at };
    let counts = rows.counts(header.layout.values(4))?;
    let mut elements = Elements::new(source, header.layout, counts);
    let (mut values, mut color) = (Vec::new(), Vec::new());
    for _ in 0..counts.vertices {
        rows.start = rows.at;
        rows.take(header.layout.values(4), f32::from_be_bytes, &mut values)?;
        elements.vertex(&values);
    }
    for _ in 0..counts.faces {
        rows.face(&mut values, &mut color)?;
        elements.face(&values, &color, rows.place(), 0, report)?;
    }
    let rest = source.bytes.get(rows.at..).unwrap_or_default();
    if rest.iter().any(|byte| *byte != 0 && !byte.is_ascii_whitespace()) {
        report.warn(WarningCode::Syntax, Some(Place::Byte(rows.at as u64)), || {
            "the content after the last face was left out".into()
        });
    }
    Ok(elements.finish())
}

struct Rows<'s, 'a> {
    source: &'s Source<'a>,
    /// The offset of the next byte.
    at: usize,
    /// The offset of the last row.
    start: usize,
}

impl Rows<'_, '_> {
    /// The counts of vertices, of `vertex_values` values each, and of faces; that of edges
    /// is ignored.
    fn counts(&mut self, vertex_values: usize) -> Result<Counts, ReadError> {
        let [vertices, faces, _] = [self.integer()?, self.integer()?, self.integer()?];
        let [Ok(vertices), Ok(faces)] = [vertices, faces].map(usize::try_from) else {
            let what = format!("states {vertices} vertices and {faces} faces");
            return Err(self.error(ReadErrorKind::Syntax, what));
        };
        // A face has at least its counts of corners and channels.
        let needed = (vertices * vertex_values).saturating_add(2 * faces).saturating_mul(VALUE);
        let left = self.source.bytes.len() - self.at.min(self.source.bytes.len());
        let counts = Counts { vertices, faces };
        counts.check(needed, left).map_err(|(kind, what)| self.error(kind, what))?;
        Ok(counts)
    }

    /// Reads the vertices of a face, and its color in floats.
    fn face(&mut self, values: &mut Vec<f64>, color: &mut Vec<f64>) -> Result<(), ReadError> {
        self.start = self.at;
        let corners = self.integer()?;
        let Ok(count) = usize::try_from(corners) else {
            let what = format!("a face has {corners} corners");
            return Err(self.error(ReadErrorKind::Syntax, what));
        };
        self.take(count, i32::from_be_bytes, values)?;
        let channels = self.integer()?;
        if !(0..=MOST_CHANNELS).contains(&channels) {
            let what =
                format!("the color of a face has {channels} values; colors have from 0 to 4");
            return Err(self.error(ReadErrorKind::Syntax, what));
        }
        self.take(usize::try_from(channels).unwrap_or_default(), f32::from_be_bytes, color)
    }

    fn integer(&mut self) -> Result<i32, ReadError> {
        let chunk = self.source.bytes.get(self.at..).and_then(<[u8]>::first_chunk::<VALUE>);
        let Some(&chunk) = chunk else { return Err(self.truncated()) };
        self.at += VALUE;
        Ok(i32::from_be_bytes(chunk))
    }

    /// Reads `count` values into `values`.
    fn take<T: Into<f64>>(
        &mut self,
        count: usize,
        convert: impl Fn([u8; VALUE]) -> T,
        values: &mut Vec<f64>,
    ) -> Result<(), ReadError> {
        values.clear();
        let end = count.checked_mul(VALUE).and_then(|bytes| bytes.checked_add(self.at));
        let bytes = end.and_then(|end| self.source.bytes.get(self.at..end));
        let Some(bytes) = bytes else { return Err(self.truncated()) };
        self.at += bytes.len();
        values.extend(bytes.as_chunks::<VALUE>().0.iter().map(|&chunk| convert(chunk).into()));
        Ok(())
    }

    const fn place(&self) -> Place {
        Place::Byte(self.start as u64)
    }

    fn truncated(&self) -> ReadError {
        self.error(ReadErrorKind::Truncated, "the file is truncated: it ends within this row")
    }

    fn error(&self, kind: ReadErrorKind, what: impl Into<String>) -> ReadError {
        self.source.error(kind, Some(self.place()), what)
    }
}
