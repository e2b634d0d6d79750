//! Turns the values of vertices and faces into a model, for both encodings.

use super::super::error::{ReadError, ReadErrorKind};
use super::super::source::Source;
use super::header::VertexLayout;
use crate::index::{MAX_INDEX, NONE};
use crate::model::{Corner, Model};
use crate::report::{Place, Report, WarningCode};

/// Colors with a channel of this value or more are bytes, others fractions. The whole
/// file counts, because black and nearly black are written alike in both.
const LEAST_BYTE: f32 = 2.0;

/// The stated numbers of vertices and faces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Counts {
    pub(super) vertices: usize,
    pub(super) faces: usize,
}

impl Counts {
    /// Checks that a file with `left` bytes can have so many elements, which need at least
    /// `needed`.
    pub(super) fn check(self, needed: usize, left: usize) -> Result<(), (ReadErrorKind, String)> {
        let Self { vertices, faces } = self;
        if needed > left {
            let what = format!(
                "{vertices} vertices and {faces} faces need at least {needed} bytes, but {left} \
                 are left; the file is truncated, or its counts are wrong"
            );
            return Err((ReadErrorKind::Truncated, what));
        }
        if vertices > MAX_INDEX || faces > MAX_INDEX {
            let what = format!("too large: more than {MAX_INDEX} vertices or faces");
            return Err((ReadErrorKind::Size, what));
        }
        Ok(())
    }
}

/// A model, to which vertices and faces are added.
#[derive(Debug)]
pub(super) struct Elements<'s, 'a> {
    source: &'s Source<'a>,
    layout: VertexLayout,
    vertex_count: usize,
    model: Model,
}

impl VertexLayout {
    /// The values of a vertex whose color has `channels` values.
    pub(super) const fn values(self, channels: usize) -> usize {
        let normal = if self.has_normal { 3 } else { 0 };
        let color = if self.has_color { channels } else { 0 };
        let texcoord = if self.has_texcoord { 2 } else { 0 };
        3 + normal + color + texcoord
    }
}

impl<'s, 'a> Elements<'s, 'a> {
    /// A model without vertices; `counts` states how many will come.
    pub(super) fn new(source: &'s Source<'a>, layout: VertexLayout, counts: Counts) -> Self {
        Self { source, layout, vertex_count: counts.vertices, model: Model::default() }
    }

    /// Adds a vertex: its position, normal, color and texture coordinates, as far as the
    /// layout has them. The color may have a fourth value, its opacity, which is ignored.
    pub(super) fn vertex(&mut self, values: &[f64]) {
        let (position, mut rest) = first::<3>(values);
        self.model.positions.push(position);
        if self.layout.has_normal {
            let (normal, behind) = first::<3>(rest);
            self.model.normals.push(normal.map(narrow));
            rest = behind;
        }
        if self.layout.has_color {
            self.model.colors.push(first::<3>(rest).0.map(narrow));
        }
        if self.layout.has_texcoord {
            let texcoord = rest.get(rest.len().saturating_sub(2)..).unwrap_or_default();
            self.model.texcoords.push(first::<2>(texcoord).0.map(narrow));
        }
    }

    /// Adds a face; one with fewer than three corners is dropped with a warning. `line`
    /// is 0 in binary files.
    ///
    /// # Errors
    /// Index: a vertex does not exist. Size: too many corners.
    pub(super) fn face(
        &mut self,
        vertices: &[f64],
        place: Place,
        line: u32,
        report: &mut Report,
    ) -> Result<(), ReadError> {
        if vertices.len() < 3 {
            report.warn(WarningCode::Degenerate, Some(place), || {
                let count = vertices.len();
                format!("a face needs three corners, this one has {count}; it was dropped")
            });
            return Ok(());
        }
        if self.model.corner_positions.len() + vertices.len() > MAX_INDEX {
            let what = format!("too large: more than {MAX_INDEX} corners");
            return Err(self.source.error(ReadErrorKind::Size, Some(place), what));
        }
        let corners = vertices.iter().map(|&vertex| self.corner(vertex, &place));
        let corners = corners.collect::<Result<Vec<Corner>, ReadError>>()?;
        self.model.push_polygon(&corners, line);
        Ok(())
    }

    /// The corner at a vertex, with the attributes of the vertex.
    fn corner(&self, vertex: f64, place: &Place) -> Result<Corner, ReadError> {
        let count = self.vertex_count;
        if vertex.fract() != 0.0 || !(0.0..count as f64).contains(&vertex) {
            let what = format!("index {vertex} is not one of {count} vertices, counted from 0");
            return Err(self.source.error(ReadErrorKind::Index, Some(place.clone()), what));
        }
        #[expect(clippy::cast_possible_truncation, reason = "below MAX_INDEX")]
        let position = vertex as u32;
        let index_if = |has: bool| if has { position } else { NONE };
        let texcoord = index_if(self.layout.has_texcoord);
        Ok(Corner { position, texcoord, normal: index_if(self.layout.has_normal) })
    }

    /// The model, with colors from 0 to 1.
    pub(super) fn finish(mut self) -> Model {
        let colors = &mut self.model.colors;
        if colors.as_flattened().iter().any(|&channel| channel >= LEAST_BYTE) {
            for channel in colors.as_flattened_mut() {
                *channel /= 255.0;
            }
        }
        self.model
    }
}

/// The first `N` values and those behind them; missing values are 0.
fn first<const N: usize>(values: &[f64]) -> ([f64; N], &[f64]) {
    values.split_first_chunk::<N>().map_or(([0.0; N], &[]), |(first, rest)| (*first, rest))
}

#[expect(clippy::cast_possible_truncation, reason = "attributes have 32 bits")]
const fn narrow(value: f64) -> f32 {
    value as f32
}
