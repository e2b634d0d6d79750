//! Turns the rows of elements into vertices, faces, strips and edges.
//!
//! Elements may come in any order, even faces before vertices. So the attributes
//! and the number of vertices are taken from the header; the number is verified
//! when the vertices are read.
//!
//! ```text
//! strip 0 1 2 3 4 -1        1---3       0 1 2, 2 1 3, 2 3 4: every other
//!                          / \ / \      triangle has its first two corners
//!                         0---2---4     swapped, so that all wind one way
//! ```

use std::ops::Range;

use super::super::error::{ReadError, ReadErrorKind};
use super::super::source::Source;
use super::super::stated::add_stated_edge;
use super::super::words::quoted;
use super::header::{Element, Header};
use super::rows::{Row, RowPlan, Rows, SLOTS};
use super::scalar::Scalar;
use crate::edge_mesh::EdgeFlags;
use crate::index::{MAX_INDEX, NONE};
use crate::model::{Corner, Model, Segment};
use crate::report::{Place, Report, WarningCode};

/// The names of vertex properties, by slot.
const VERTEX_SLOTS: [&[&str]; SLOTS] = [
    &["x"],
    &["y"],
    &["z"],
    &["nx"],
    &["ny"],
    &["nz"],
    &["red", "diffuse_red"],
    &["green", "diffuse_green"],
    &["blue", "diffuse_blue"],
    &["u", "s", "texture_u"],
    &["v", "t", "texture_v"],
    &["alpha", "diffuse_alpha"],
];

// Slots of `VERTEX_SLOTS`.
const POSITION: Range<usize> = 0..3;
const NORMAL: Range<usize> = 3..6;
const COLOR: Range<usize> = 6..9;
const TEXCOORD: Range<usize> = 9..11;
const ALPHA: usize = 11;

/// The names of the properties of a face, by slot.
const FACE_SLOTS: [&[&str]; 4] = [
    &["red", "diffuse_red"],
    &["green", "diffuse_green"],
    &["blue", "diffuse_blue"],
    &["alpha", "diffuse_alpha"],
];

// Slots of `FACE_SLOTS`.
const FACE_COLOR: Range<usize> = 0..3;
const FACE_ALPHA: usize = 3;

/// The names of the properties of an edge, by slot.
const EDGE_SLOTS: [&[&str]; 3] = [&["vertex1"], &["vertex2"], &["flags"]];

// Slots of `EDGE_SLOTS`.
const ENDS: Range<usize> = 0..2;
const FLAGS: Range<usize> = 2..3;

/// The names of the list of corners of a face or strip.
const CORNER_LISTS: [&str; 2] = ["vertex_indices", "vertex_index"];

/// Why an element without such a list is skipped.
const NO_LIST: &str = "has no list vertex_indices or vertex_index";

/// Reads all rows into a model.
pub(super) fn read_elements(
    source: &Source,
    header: &Header,
    rows: &mut impl Rows,
    report: &mut Report,
) -> Result<Model, ReadError> {
    let vertex = header.elements.iter().find(|element| element.name == b"vertex");
    let plan = vertex.map(|vertex| RowPlan::new(vertex, &VERTEX_SLOTS, &[]));
    let has = |slots| plan.as_ref().is_some_and(|plan| plan.has(slots));
    let mut reader = ElementReader {
        source,
        rows,
        report,
        row: Row::default(),
        model: Model::default(),
        vertex_count: vertex.map_or(0, |vertex| vertex.count),
        has_normals: has(NORMAL),
        has_texcoords: has(TEXCOORD),
        has_colors: has(COLOR),
        states_classes: header.states_classes,
    };
    if header.states_classes {
        reader.model.stated_edges = Some(Vec::new());
    }
    for element in &header.elements {
        match element.name {
            b"vertex" => reader.vertices(&RowPlan::new(element, &VERTEX_SLOTS, &[]))?,
            b"face" => reader.faces(&RowPlan::new(element, &FACE_SLOTS, &CORNER_LISTS))?,
            b"tristrips" => reader.strips(&RowPlan::new(element, &[], &CORNER_LISTS))?,
            b"edge" => reader.edges(&RowPlan::new(element, &EDGE_SLOTS, &[]))?,
            _ => reader.skip(element, "is unknown")?,
        }
    }
    reader.warn_of_rest();
    Ok(reader.model)
}

struct ElementReader<'s, 'a, R> {
    source: &'s Source<'a>,
    rows: &'s mut R,
    report: &'s mut Report,
    row: Row,
    model: Model,
    /// The number of vertices by the header.
    vertex_count: u64,
    /// Whether each vertex has a normal.
    has_normals: bool,
    /// Whether each vertex has texture coordinates.
    has_texcoords: bool,
    /// Whether each vertex has a color, so that those of faces are left out.
    has_colors: bool,
    /// Whether edges have the classes of an export of this program.
    states_classes: bool,
}

impl<R: Rows> ElementReader<'_, '_, R> {
    fn vertices(&mut self, plan: &RowPlan) -> Result<(), ReadError> {
        if !plan.has(POSITION) {
            let place = Some(Place::Line(plan.element.line));
            let what = "the vertices lack one of the properties x, y, z";
            return Err(self.source.error(ReadErrorKind::Syntax, place, what));
        }
        self.rows.begin(plan)?;
        let count = usize::try_from(plan.element.count).unwrap_or(usize::MAX);
        if count > MAX_INDEX || self.model.positions.try_reserve_exact(count).is_err() {
            return Err(self.too_large());
        }
        let channels = Channels::of(plan, COLOR, ALPHA);
        for _ in 0..count {
            self.rows.read(plan, &mut self.row, self.report)?;
            let [x, y, z, nx, ny, nz, _, _, _, u, v, _] = self.row.values;
            self.model.positions.push([x, y, z]);
            if self.has_normals {
                self.model.normals.push([nx, ny, nz].map(narrow));
            }
            if let Some(channels) = &channels {
                self.model.colors.push(channels.color(&self.row));
            }
            if self.has_texcoords {
                self.model.texcoords.push([u, v].map(narrow));
            }
        }
        Ok(())
    }

    fn faces(&mut self, plan: &RowPlan) -> Result<(), ReadError> {
        if !plan.has_list {
            return self.skip(plan.element, NO_LIST);
        }
        self.rows.begin(plan)?;
        let channels = Channels::of(plan, FACE_COLOR, FACE_ALPHA).filter(|_| !self.has_colors);
        let mut corners = Vec::new();
        for _ in 0..plan.element.count {
            self.rows.read(plan, &mut self.row, self.report)?;
            corners.clear();
            let color = channels.as_ref().map(|channels| channels.color(&self.row));
            let color = color.map_or(NONE, |color| self.model.color_of_face(color));
            for &value in &self.row.list {
                corners.push(Corner { color, ..self.corner(value)? });
            }
            self.push(&corners)?;
        }
        Ok(())
    }

    fn strips(&mut self, plan: &RowPlan) -> Result<(), ReadError> {
        if !plan.has_list {
            return self.skip(plan.element, NO_LIST);
        }
        self.rows.begin(plan)?;
        for _ in 0..plan.element.count {
            self.rows.read(plan, &mut self.row, self.report)?;
            let list = std::mem::take(&mut self.row.list);
            for strip in list.split(|&value| value == -1.0).filter(|strip| !strip.is_empty()) {
                self.strip(strip)?;
            }
            self.row.list = list;
        }
        Ok(())
    }

    fn strip(&mut self, strip: &[f64]) -> Result<(), ReadError> {
        let corners = strip.iter().map(|&value| self.corner(value));
        let corners = corners.collect::<Result<Vec<Corner>, ReadError>>()?;
        if corners.len() < 3 {
            return self.push(&corners);
        }
        for (at, triangle) in corners.windows(3).enumerate() {
            match (triangle, at % 2) {
                (&[a, b, c], 1) => self.push(&[b, a, c])?,
                _ => self.push(triangle)?,
            }
        }
        Ok(())
    }

    fn edges(&mut self, plan: &RowPlan) -> Result<(), ReadError> {
        if !plan.has(ENDS) {
            return self.skip(plan.element, "lacks vertex1 or vertex2");
        }
        self.rows.begin(plan)?;
        let states_classes = self.states_classes && plan.has(FLAGS);
        for _ in 0..plan.element.count {
            self.rows.read(plan, &mut self.row, self.report)?;
            let [a, b, flags, ..] = self.row.values;
            let (ends, line) = ([self.index(a)?, self.index(b)?], self.rows.line());
            if states_classes {
                #[expect(clippy::cast_possible_truncation, reason = "saturates")]
                #[expect(clippy::cast_sign_loss, reason = "saturates")]
                let classes = EdgeFlags::from_bits_truncate(flags as u32);
                add_stated_edge(&mut self.model, ends, classes, line);
            } else {
                self.model.segments.push(Segment { ends, line });
            }
        }
        Ok(())
    }

    /// Skips the rows of an element with a warning; `why` follows its name.
    fn skip(&mut self, element: &Element, why: &str) -> Result<(), ReadError> {
        let plan = RowPlan::new(element, &[], &[]);
        // Rows without values take no bytes, whatever their number.
        if plan.steps.is_empty() || element.count == 0 {
            return Ok(());
        }
        let place = Some(Place::Line(element.line));
        self.report.warn(WarningCode::Unsupported, place, || {
            let name = quoted(element.name);
            format!("the element {name} {why}; its {} rows were left out", element.count)
        });
        self.rows.begin(&plan)?;
        for _ in 0..element.count {
            self.rows.read(&plan, &mut self.row, self.report)?;
        }
        Ok(())
    }

    /// The corner at a vertex, with the attributes of the vertex.
    fn corner(&self, value: f64) -> Result<Corner, ReadError> {
        let position = self.index(value)?;
        let index_if = |has: bool| if has { position } else { NONE };
        let (texcoord, normal) = (index_if(self.has_texcoords), index_if(self.has_normals));
        Ok(Corner { texcoord, normal, ..Corner::at(position) })
    }

    fn index(&self, value: f64) -> Result<u32, ReadError> {
        let count = self.vertex_count.min(MAX_INDEX as u64);
        if value.fract() == 0.0 && (0.0..count as f64).contains(&value) {
            #[expect(clippy::cast_possible_truncation, reason = "below MAX_INDEX")]
            return Ok(value as u32);
        }
        let what =
            format!("index {value} is not one of {} vertices, counted from 0", self.vertex_count);
        Err(self.source.error(ReadErrorKind::Index, Some(self.rows.place()), what))
    }

    /// Adds a polygon; one with fewer than three corners is dropped with a warning.
    fn push(&mut self, corners: &[Corner]) -> Result<(), ReadError> {
        if corners.len() < 3 {
            self.report.warn(WarningCode::Degenerate, Some(self.rows.place()), || {
                format!(
                    "a face needs three corners, this one has {}; it was dropped",
                    corners.len()
                )
            });
            return Ok(());
        }
        if self.model.corner_positions.len() + corners.len() > MAX_INDEX {
            return Err(self.too_large());
        }
        self.model.push_polygon(corners, self.rows.line());
        Ok(())
    }

    fn too_large(&self) -> ReadError {
        let what = format!("too large: more than {MAX_INDEX} vertices or corners, or no memory");
        self.source.error(ReadErrorKind::Size, Some(self.rows.place()), what)
    }

    fn warn_of_rest(&mut self) {
        if let Some(place) = self.rows.first_unread() {
            self.report.warn(WarningCode::Syntax, Some(place), || {
                "the content after the last row was left out".into()
            });
        }
    }
}

/// The slots of a color, with the values of full channels.
struct Channels {
    slots: [usize; 3],
    maxima: [f64; 3],
    /// The slot and the full value of the opacity, if it is stated.
    alpha: Option<(usize, f64)>,
}

impl Channels {
    /// The slots of `plan`, if it has all of `color`.
    fn of(plan: &RowPlan, color: Range<usize>, alpha: usize) -> Option<Self> {
        let maximum = |slot: usize| plan.slots[slot].map(Scalar::color_maximum);
        let slots = [0, 1, 2].map(|channel| color.start + channel);
        let alpha = maximum(alpha).map(|maximum| (alpha, maximum));
        let maxima = slots.map(|slot| maximum(slot).unwrap_or(1.0));
        plan.has(color).then_some(Self { slots, maxima, alpha })
    }

    /// The color of a row.
    fn color(&self, row: &Row) -> [f32; 4] {
        let [red, green, blue] = [0, 1, 2].map(|k| row.values[self.slots[k]] / self.maxima[k]);
        let alpha = self.alpha.map_or(1.0, |(slot, maximum)| row.values[slot] / maximum);
        [red, green, blue, alpha].map(narrow)
    }
}

#[expect(clippy::cast_possible_truncation, reason = "attributes have 32 bits")]
const fn narrow(value: f64) -> f32 {
    value as f32
}
