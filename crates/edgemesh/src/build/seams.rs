//! Closes seams that rounding has left open, and T-junctions, where the side of one polygon runs
//! along the shorter sides of others.
//!
//! Idea: only boundary edges are looked at. Two that run along each other, with ends within a
//! tolerance, become one edge by welding their ends. A vertex within the tolerance of a longer
//! boundary edge becomes a corner of its polygon, if a piece of the edge then has a partner. So
//! nothing moves where nothing closes, and a sound mesh costs nothing. By default the tolerance is
//! the rounding of the coordinates; with `--weld` it is the user's.
//!
//! Rejected: welding all vertices within the rounding, which moves vertices of sound surfaces;
//! records of parts of an edge, which every later stage would have to know.

use glam::{DVec3, Vec3};
use rustc_hash::{FxHashMap, FxHashSet};

use super::components::Sets;
use super::faces::FaceSources;
use super::weld::Weld;
use crate::edge_mesh::{EdgeTable, triangle_side};
use crate::index::{NONE, to_u32};
use crate::model::Model;

/// The boundary of welded triangles.
#[derive(Debug)]
pub(crate) struct Boundary<'a> {
    positions: &'a [[f32; 3]],
    triangles: &'a [[u32; 3]],
    /// The sides, as numbered by the edge table.
    sides: Vec<u32>,
    /// The largest distance that is closed, in units of the mesh.
    tolerance: f64,
}

/// A vertex that becomes a corner of a polygon, between two successive corners.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Junction {
    side: u32,
    /// The place on the side, from 0 at its start to 1 at its end.
    along: f64,
    vertex: u32,
}

impl<'a> Boundary<'a> {
    pub(crate) fn of(
        positions: &'a [[f32; 3]],
        triangles: &'a [[u32; 3]],
        table: &EdgeTable,
        tolerance: f64,
    ) -> Self {
        let alone = table.iter().filter_map(|(_, sides)| match *sides {
            [side] => Some(side),
            _ => None,
        });
        Self { positions, triangles, sides: alone.collect(), tolerance }
    }

    fn ends(&self) -> impl Iterator<Item = [u32; 2]> {
        self.sides.iter().map(|&side| self.ends_of(side))
    }

    fn ends_of(&self, side: u32) -> [u32; 2] {
        triangle_side(self.triangles, side)
    }

    fn position(&self, vertex: u32) -> DVec3 {
        Vec3::from(self.positions[vertex as usize]).as_dvec3()
    }

    fn vertices(&self) -> Vec<u32> {
        let mut vertices: Vec<u32> = self.ends().flatten().collect();
        vertices.sort_unstable();
        vertices.dedup();
        vertices
    }

    /// The vertex that each vertex becomes, if any seam is closed.
    pub(crate) fn close_seams(&self) -> Option<Vec<u32>> {
        let vertices = self.vertices();
        let grid = Grid::of(self, &vertices, 2.0 * self.tolerance);
        let near: FxHashMap<u32, Vec<u32>> = vertices
            .iter()
            .filter_map(|&vertex| {
                let others = grid.around(self.position(vertex), self.tolerance);
                let is_near = |&other: &u32| {
                    let distance = self.position(other).distance(self.position(vertex));
                    other != vertex && distance <= self.tolerance
                };
                let others: Vec<u32> = others.filter(is_near).take(MOST_NEAR + 1).collect();
                (1..=MOST_NEAR).contains(&others.len()).then_some((vertex, others))
            })
            .collect();
        if near.is_empty() {
            return None;
        }
        let edges: FxHashSet<[u32; 2]> = self.ends().map(sorted).collect();
        let sets = Sets::new(self.positions.len());
        let mut is_closed = false;
        let is_near = |ends: &[u32; 2]| ends.iter().any(|end| near.contains_key(end));
        for [a, b] in self.ends().filter(is_near) {
            for &x in near.get(&a).into_iter().flatten().chain([&a]) {
                for &y in near.get(&b).into_iter().flatten().chain([&b]) {
                    let is_other = sorted([x, y]) != sorted([a, b]) && x != y && x != b && y != a;
                    if is_other && edges.contains(&sorted([x, y])) {
                        sets.join(a, x);
                        sets.join(b, y);
                        is_closed = true;
                    }
                }
            }
        }
        is_closed
            .then(|| (0..to_u32(self.positions.len())).map(|vertex| sets.root(vertex)).collect())
    }

    /// The vertices that lie on boundary edges of others, by side and place.
    ///
    /// Two rows of boundary edges that begin in one vertex and run the same way are walked along
    /// together, the nearer next vertex first; it lies on the edge of the other row.
    pub(crate) fn junctions(&self) -> Vec<Junction> {
        let mut arms: Vec<Arm> = self
            .sides
            .iter()
            .flat_map(|&side| {
                let [a, b] = self.ends_of(side);
                [Arm { from: a, to: b, side }, Arm { from: b, to: a, side }]
            })
            .collect();
        arms.sort_unstable();
        let mut walks =
            Walks { boundary: self, arms: &arms, steps_left: 64 * arms.len(), found: Vec::new() };
        for here in arms.chunk_by(|a, b| a.from == b.from) {
            if here.len() > MOST_ARMS {
                continue;
            }
            for (at, &long) in here.iter().enumerate() {
                for (other, &short) in here.iter().enumerate() {
                    if at != other {
                        walks.walk(long, short);
                    }
                }
            }
        }
        let mut junctions = walks.found;
        if junctions.is_empty() {
            return junctions;
        }
        junctions.sort_by(|a, b| {
            a.side.cmp(&b.side).then(a.along.total_cmp(&b.along)).then(a.vertex.cmp(&b.vertex))
        });
        junctions.dedup_by_key(|junction| (junction.side, junction.vertex));
        self.retain_closing(&mut junctions);
        junctions
    }

    /// Whether a vertex lies on the inside of an edge.
    fn is_on(&self, vertex: u32, arm: Arm) -> bool {
        let (start, end) = (self.position(arm.from), self.position(arm.to));
        let length = start.distance(end);
        let offset = self.position(vertex) - start;
        let along = offset.dot(end - start) / length;
        let across = (offset - (end - start) * (along / length)).length();
        across <= self.tolerance && along > self.tolerance && along < length - self.tolerance
    }

    fn junction(&self, vertex: u32, arm: Arm) -> Junction {
        // Along the side, which may run the other way.
        let [a, b] = self.ends_of(arm.side);
        let (start, end) = (self.position(a), self.position(b));
        let along =
            (self.position(vertex) - start).dot(end - start) / (end - start).length_squared();
        Junction { side: arm.side, along, vertex }
    }

    /// Keeps the junctions beside a piece of an edge that is also a piece of another.
    fn retain_closing(&self, junctions: &mut Vec<Junction>) {
        let mut pieces: FxHashMap<[u32; 2], u32> = FxHashMap::default();
        for &side in &self.sides {
            let [a, b] = self.ends_of(side);
            let from = junctions.partition_point(|junction| junction.side < side);
            let on_side = junctions[from..].iter().take_while(|junction| junction.side == side);
            let mut before = a;
            for vertex in on_side.map(|junction| junction.vertex).chain([b]) {
                *pieces.entry(sorted([before, vertex])).or_default() += 1;
                before = vertex;
            }
        }
        let closes: Vec<bool> = (0..junctions.len())
            .map(|at| {
                let Junction { side, vertex, .. } = junctions[at];
                let neighbor = |index: Option<usize>| {
                    index.and_then(|index| junctions.get(index)).filter(|other| other.side == side)
                };
                let [a, b] = self.ends_of(side);
                let before = neighbor(at.checked_sub(1)).map_or(a, |other| other.vertex);
                let behind = neighbor(Some(at + 1)).map_or(b, |other| other.vertex);
                [before, behind].into_iter().any(|other| pieces[&sorted([vertex, other])] > 1)
            })
            .collect();
        super::faces::keep_items(junctions, &closes);
    }
}

/// Vertices with more boundary edges are not looked at.
const MOST_ARMS: usize = 64;

/// Vertices with more others within the tolerance are no seam.
const MOST_NEAR: usize = 16;

/// A boundary edge at one of its ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Arm {
    from: u32,
    to: u32,
    side: u32,
}

/// Walks along rows of boundary edges.
struct Walks<'a> {
    boundary: &'a Boundary<'a>,
    /// Sorted by the vertex that they start from.
    arms: &'a [Arm],
    /// A bound for the work on files made to take long.
    steps_left: usize,
    found: Vec<Junction>,
}

impl Walks<'_> {
    /// Walks along a long edge and the row that begins with a shorter one, from one vertex.
    fn walk(&mut self, mut long: Arm, mut short: Arm) {
        while short.to != long.to && self.boundary.is_on(short.to, long) && self.steps_left > 0 {
            self.steps_left -= 1;
            self.found.push(self.boundary.junction(short.to, long));
            let first = self.arms.partition_point(|arm| arm.from < short.to);
            let onward = self.arms[first..].iter().take_while(|arm| arm.from == short.to);
            let candidates = onward.take(MOST_ARMS).filter(|arm| arm.side != short.side);
            let rest = Arm { from: short.to, ..long };
            let next =
                candidates.copied().find(|&arm| arm.to == long.to || self.goes_along(rest, arm));
            match next {
                Some(arm) if self.boundary.is_on(long.to, arm) => (long, short) = (arm, long),
                Some(arm) => short = arm,
                None => return,
            }
        }
    }

    /// Whether an edge goes on along the rest of another, to a place on it or beyond its end.
    fn goes_along(&self, rest: Arm, arm: Arm) -> bool {
        self.boundary.is_on(arm.to, rest) || self.boundary.is_on(rest.to, arm)
    }
}

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// Vertices by cell.
struct Grid {
    cell: f64,
    vertices: FxHashMap<[i64; 3], Vec<u32>>,
}

impl Grid {
    fn of(boundary: &Boundary, vertices: &[u32], cell: f64) -> Self {
        let mut grid = Self { cell, vertices: FxHashMap::default() };
        for &vertex in vertices {
            let key = grid.key(boundary.position(vertex));
            grid.vertices.entry(key).or_default().push(vertex);
        }
        grid
    }

    #[expect(clippy::cast_possible_truncation, reason = "saturates, which only joins cells")]
    fn key(&self, point: DVec3) -> [i64; 3] {
        (point / self.cell).floor().to_array().map(|cell| cell as i64)
    }

    /// The vertices of all cells within `reach` of a point along each axis.
    fn around(&self, point: DVec3, reach: f64) -> impl Iterator<Item = u32> {
        let (low, high) = (self.key(point - reach), self.key(point + reach));
        let cells = (low[0]..=high[0]).flat_map(move |x| {
            (low[1]..=high[1]).flat_map(move |y| (low[2]..=high[2]).map(move |z| [x, y, z]))
        });
        cells
            .filter_map(|cell| self.vertices.get(&cell))
            .flat_map(|all| all.iter().take(4 * MOST_NEAR))
            .copied()
    }
}

/// Applies `becomes`, the vertex that each welded vertex becomes, to a weld.
pub(crate) fn weld_again(weld: &mut Weld, becomes: &[u32]) {
    let mut numbers = vec![NONE; weld.positions.len()];
    let mut positions = Vec::with_capacity(weld.positions.len());
    for (vertex, &target) in becomes.iter().enumerate() {
        if target as usize == vertex {
            numbers[vertex] = to_u32(positions.len());
            positions.push(weld.positions[vertex]);
        }
    }
    for (input, vertex) in weld.welded_from_input.iter_mut().enumerate() {
        if *vertex != NONE {
            let target = becomes[*vertex as usize];
            if target != *vertex {
                weld.moved += 1;
                weld.first_moved = weld.first_moved.or(Some(input));
            }
            *vertex = numbers[target as usize];
        }
    }
    weld.positions = positions;
}

/// The model with a corner for each of `junctions`, which are sorted by side and place, and the
/// polygons that have them, ascending.
pub(crate) fn with_junctions(
    model: &Model,
    sources: &FaceSources,
    weld: &Weld,
    junctions: &[Junction],
) -> (Model, Vec<u32>) {
    let inputs = weld.first_inputs(weld.positions.len());
    // The corner behind which each new corner comes.
    let mut added: Vec<(u32, Junction)> = junctions
        .iter()
        .map(|&junction| {
            let corners = sources.corners(junction.side as usize / 3);
            (corners[junction.side as usize % 3], junction)
        })
        .collect();
    added.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.along.total_cmp(&b.1.along)));
    let mut cut = Model {
        corner_positions: Vec::new(),
        corner_texcoords: Vec::new(),
        corner_normals: Vec::new(),
        corner_colors: Vec::new(),
        polygon_ends: Vec::new(),
        ..model.clone()
    };
    let mut polygons = Vec::new();
    let mut next = 0;
    for polygon in 0..model.polygon_count() {
        let range = model.corner_range(polygon);
        let before = next;
        for corner in range.clone() {
            push_corner(&mut cut, model, corner);
            let behind = if corner + 1 == range.end { range.start } else { corner + 1 };
            while let Some((_, junction)) = added.get(next).filter(|add| add.0 as usize == corner) {
                cut.corner_positions.push(inputs[junction.vertex as usize]);
                push_between(&mut cut, model, [corner, behind], junction.along);
                next += 1;
            }
        }
        if next > before {
            polygons.push(to_u32(polygon));
        }
        cut.polygon_ends.push(to_u32(cut.corner_positions.len()));
    }
    (cut, polygons)
}

fn push_corner(cut: &mut Model, model: &Model, corner: usize) {
    cut.corner_positions.push(model.corner_positions[corner]);
    cut.corner_texcoords.extend(model.corner_texcoords.get(corner));
    cut.corner_normals.extend(model.corner_normals.get(corner));
    if !model.colors.is_empty() {
        // Colors of positions too: a new corner has another color than its position.
        cut.corner_colors.push(model.color_index(corner));
    }
}

/// Adds the attributes of a corner between two others, which it has if both of them have them.
#[expect(clippy::cast_possible_truncation, reason = "attributes are in 32 bits")]
fn push_between(cut: &mut Model, model: &Model, corners: [usize; 2], along: f64) {
    let along = along as f32;
    if !model.corner_texcoords.is_empty() {
        let [a, b] = corners.map(|corner| model.corner_texcoords[corner]);
        cut.corner_texcoords.push(if a == NONE || b == NONE {
            NONE
        } else {
            let [a, b] = [a, b].map(|index| glam::Vec2::from(model.texcoords[index as usize]));
            cut.texcoords.push(a.lerp(b, along).to_array());
            to_u32(cut.texcoords.len() - 1)
        });
    }
    if !model.corner_normals.is_empty() {
        let [a, b] = corners.map(|corner| model.corner_normals[corner]);
        cut.corner_normals.push(if a == NONE || b == NONE {
            NONE
        } else {
            let [a, b] = [a, b].map(|index| Vec3::from(model.normals[index as usize]));
            cut.normals.push(a.lerp(b, along).to_array());
            to_u32(cut.normals.len() - 1)
        });
    }
    if !model.colors.is_empty() {
        let [a, b] = corners.map(|corner| glam::Vec4::from(model.corner_color(corner)));
        cut.colors.push(a.lerp(b, along).to_array());
        cut.corner_colors.push(to_u32(cut.colors.len() - 1));
    }
}
