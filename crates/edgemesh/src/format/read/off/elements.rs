//! Turns the values of vertices and faces into a model, for both encodings.

use super::super::error::{ReadError, ReadErrorKind};
use super::super::source::Source;
use super::header::VertexLayout;
use crate::index::{MAX_INDEX, NONE, to_u32};
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
    /// The colors of vertices, or of faces, as the file has them.
    colors: Vec<Color>,
}

/// A color as the file has it: bytes or fractions.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Color {
    channels: [f32; 3],
    /// The opacity, if it is stated.
    alpha: Option<f32>,
}

impl Color {
    /// The color of three or four values; missing ones are 0.
    fn of(values: &[f64]) -> Self {
        let (channels, rest) = first::<3>(values);
        Self { channels: channels.map(narrow), alpha: rest.first().copied().map(narrow) }
    }

    /// Whether it can only be bytes.
    fn is_bytes(&self) -> bool {
        self.channels.iter().chain(&self.alpha).any(|&channel| channel >= LEAST_BYTE)
    }

    /// Red, green, blue and opacity from 0 to 1; `full` is the value of a full channel.
    fn fractions(&self, full: f32) -> [f32; 4] {
        let [red, green, blue] = self.channels.map(|channel| channel / full);
        [red, green, blue, self.alpha.map_or(1.0, |alpha| alpha / full)]
    }
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
        let (vertex_count, model) = (counts.vertices, Model::default());
        Self { source, layout, vertex_count, model, colors: Vec::new() }
    }

    /// Adds a vertex: its position, normal, color and texture coordinates, as far as the
    /// layout has them. The color may have a fourth value, its opacity.
    pub(super) fn vertex(&mut self, values: &[f64]) {
        let (position, mut rest) = first::<3>(values);
        self.model.positions.push(position);
        if self.layout.has_normal {
            let (normal, behind) = first::<3>(rest);
            self.model.normals.push(normal.map(narrow));
            rest = behind;
        }
        if self.layout.has_color {
            let texcoord = if self.layout.has_texcoord { 2 } else { 0 };
            let end = rest.len().saturating_sub(texcoord);
            self.colors.push(Color::of(rest.get(..end).unwrap_or_default()));
        }
        if self.layout.has_texcoord {
            let texcoord = rest.get(rest.len().saturating_sub(2)..).unwrap_or_default();
            self.model.texcoords.push(first::<2>(texcoord).0.map(narrow));
        }
    }

    /// Adds a face; one with fewer than three corners is dropped with a warning. Its color has
    /// three or four values, others are no color; it is left out if vertices have colors. `line`
    /// is 0 in binary files.
    ///
    /// # Errors
    /// Index: a vertex does not exist. Size: too many corners.
    pub(super) fn face(
        &mut self,
        vertices: &[f64],
        color: &[f64],
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
        let color = self.color_of_face(color);
        let corners = vertices
            .iter()
            .map(|&vertex| self.corner(vertex, &place).map(|corner| Corner { color, ..corner }));
        let corners = corners.collect::<Result<Vec<Corner>, ReadError>>()?;
        self.model.push_polygon(&corners, line);
        Ok(())
    }

    /// The index of the color of a face, or [`NONE`].
    fn color_of_face(&mut self, values: &[f64]) -> u32 {
        if self.layout.has_color || values.len() < 3 {
            return NONE;
        }
        let color = Color::of(values);
        if self.colors.last() != Some(&color) {
            self.colors.push(color);
        }
        to_u32(self.colors.len() - 1)
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
        let normal = index_if(self.layout.has_normal);
        Ok(Corner { texcoord, normal, ..Corner::at(position) })
    }

    /// The model, with colors from 0 to 1.
    pub(super) fn finish(mut self) -> Model {
        let full = if self.colors.iter().any(Color::is_bytes) { 255.0 } else { 1.0 };
        self.model.colors = self.colors.iter().map(|color| color.fractions(full)).collect();
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
