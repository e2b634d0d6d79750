//! The triangles of a model over its welded vertices, with seams and T-junctions closed.
//!
//! The edges are found first without closing anything. Only where there is a boundary is it looked
//! at, and only where something closes are the triangles made again.

use std::borrow::Cow;

use rayon::prelude::*;

use super::faces::{FaceSources, keep_items};
use super::rounding::Rounding;
use super::seams::{Boundary, weld_again, with_junctions};
use super::weld::Weld;
use super::{BuildOptions, Welding, duplicates};
use crate::edge_mesh::{EdgeTable, MeshFrame};
use crate::model::Model;
use crate::report::{Place, RepairKind, Report, WarningCode};

/// Two coordinates that were rounded apart differ by up to this many times the rounding.
const ROUNDINGS_APART: f64 = 4.0;

/// A model, its welded vertices, and its triangles and edges over them.
#[derive(Debug)]
pub(crate) struct WeldedModel<'a> {
    /// The model, with a corner more for each T-junction.
    pub(crate) model: Cow<'a, Model>,
    pub(crate) weld: Weld,
    has_closed_seams: bool,
    pub(crate) sources: FaceSources,
    pub(crate) triangles: Vec<[u32; 3]>,
    pub(crate) degenerate_count: usize,
    pub(crate) table: EdgeTable,
}

impl<'a> WeldedModel<'a> {
    /// Welds the triangles of `model` and closes what rounding, or the tolerance of the user, has
    /// left open.
    pub(crate) fn closed(
        model: &'a Model,
        weld: Weld,
        options: &BuildOptions,
        frame: &MeshFrame,
        rounding: &Rounding,
        report: &mut Report,
    ) -> Self {
        let mut first = Report::default();
        let mut welded = Self::of(Cow::Borrowed(model), weld, &[], &mut first);
        let by_rounding = ROUNDINGS_APART * rounding.at(reach(&welded.weld.positions));
        let tolerance = match options.welding {
            Welding::Off => 0.0,
            Welding::Within(tolerance) => by_rounding.max(tolerance * frame.scale),
            Welding::Exact => by_rounding,
        };
        if tolerance > 0.0 && welded.table.iter().any(|(_, sides)| sides.len() == 1) {
            if let Some(becomes) = welded.seams(tolerance) {
                weld_again(&mut welded.weld, &becomes);
                first = Report::default();
                welded = Self::of(welded.model, welded.weld, &[], &mut first);
                welded.has_closed_seams = true;
            }
            let junctions = welded.boundary(tolerance).junctions();
            if !junctions.is_empty() {
                let (cut, polygons) =
                    with_junctions(model, &welded.sources, &welded.weld, &junctions);
                let place = polygons.first().map(|&polygon| model.polygon_place(polygon as usize));
                report.repair(RepairKind::ClosedJunctions, junctions.len(), place);
                first = Report::default();
                welded = Self {
                    has_closed_seams: welded.has_closed_seams,
                    ..Self::of(Cow::Owned(cut), welded.weld, &polygons, &mut first)
                };
            }
        }
        report.absorb(first);
        let place = welded.weld.first_moved.map(|vertex| Place::Vertex(vertex as u64 + 1));
        report.repair(RepairKind::SnappedVertices, welded.weld.moved, place);
        welded
    }

    /// Whether anything was closed.
    pub(crate) const fn is_closed(&self) -> bool {
        self.has_closed_seams || matches!(self.model, Cow::Owned(_))
    }

    /// The triangles of `model`; polygons of `jointed`, ascending, have corners on their sides.
    fn of(model: Cow<'a, Model>, weld: Weld, jointed: &[u32], report: &mut Report) -> Self {
        let mut sources = FaceSources::of(&model, jointed, report);
        let total = sources.len();
        let triangles = weld_triangles(&model, &weld.welded_from_input, &mut sources, report);
        let table = EdgeTable::from_triangles(weld.positions.len(), &triangles);
        let degenerate_count = total - triangles.len();
        Self { model, weld, has_closed_seams: false, sources, triangles, degenerate_count, table }
    }

    /// The vertex that each vertex becomes, if seams are closed and no triangle collapses: what
    /// collapses one was no seam.
    fn seams(&self, tolerance: f64) -> Option<Vec<u32>> {
        let becomes = self.boundary(tolerance).close_seams()?;
        let is_proper = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|vertex| becomes[vertex as usize]);
            a != b && b != c && c != a
        };
        self.triangles.par_iter().all(is_proper).then_some(becomes)
    }

    fn boundary(&self, tolerance: f64) -> Boundary<'_> {
        Boundary::of(&self.weld.positions, &self.triangles, &self.table, tolerance)
    }
}

/// The largest coordinate of a mesh.
fn reach(positions: &[[f32; 3]]) -> f64 {
    let largest = |point: &[f32; 3]| point.iter().fold(0.0, |most: f32, x| most.max(x.abs()));
    f64::from(positions.par_iter().with_min_len(1 << 14).map(largest).reduce(|| 0.0, f32::max))
}

/// Makes welded triangles and drops those with a repeated vertex.
fn weld_triangles(
    model: &Model,
    welded_from_input: &[u32],
    sources: &mut FaceSources,
    report: &mut Report,
) -> Vec<[u32; 3]> {
    let welded = |corner: u32| welded_from_input[model.corner_positions[corner as usize] as usize];
    let mut triangles: Vec<[u32; 3]> = (0..sources.len())
        .into_par_iter()
        .with_min_len(1 << 12)
        .map(|face| sources.corners(face).map(welded))
        .collect();
    let is_proper = |[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
    if triangles.par_iter().with_min_len(1 << 14).all(is_proper) {
        return triangles;
    }
    let is_kept: Vec<bool> = triangles.iter().map(is_proper).collect();
    let first = duplicates::left_out(&is_kept).next();
    let place = first.map(|face| sources.place(model, face));
    report.warn_many(
        WarningCode::Degenerate,
        duplicates::left_out(&is_kept).count(),
        place,
        || "a triangle with two corners in one place was dropped".into(),
    );
    keep_items(&mut triangles, &is_kept);
    sources.keep(&is_kept);
    triangles
}

#[cfg(test)]
mod tests {
    use crate::build::{BuildOptions, Welding, build_edge_mesh};
    use crate::edge_mesh::EdgeMesh;
    use crate::model::{Corner, Model};
    use crate::report::{RepairKind, Report};

    fn build(model: &Model, welding: Welding) -> (EdgeMesh, Report) {
        let mut report = Report::default();
        let options = BuildOptions { welding, ..BuildOptions::default() };
        (build_edge_mesh(model, &options, &mut report), report)
    }

    /// A quad whose right side is `parts` sides of quads beside it, which `gap` keeps apart.
    fn plate(parts: u32, gap: f64) -> Model {
        let mut model = Model::default();
        let height = f64::from(parts);
        model.positions.extend([[-1.5, 0.0, 0.0], [0.0, 0.0, 0.0]]);
        model.positions.extend([[0.0, height, 0.0], [-1.5, height, 0.0]]);
        model.push_polygon(&[0, 1, 2, 3].map(Corner::at), 0);
        for part in 0..=parts {
            let is_end = part == 0 || part == parts;
            let left = if is_end { 0.0 } else { gap };
            model.positions.push([left, f64::from(part), 0.0]);
            model.positions.push([1.234_567_8, f64::from(part), 0.0]);
        }
        for part in 0..parts {
            let corner = 4 + 2 * part;
            model.push_polygon(&[0, 1, 3, 2].map(|k| Corner::at(corner + k)), 0);
        }
        model
    }

    #[test]
    fn a_long_side_against_short_ones_is_closed() {
        for parts in [2, 3, 9] {
            let (mesh, report) = build(&plate(parts, 0.0), Welding::Exact);
            let edges = mesh.counts.edges;
            assert_eq!(edges.boundary, parts as usize + 5);
            assert_eq!(mesh.counts.components, 1);
            assert_eq!(report.repair_count(RepairKind::ClosedJunctions), parts as usize - 1);
            assert_eq!(report.repair_count(RepairKind::ZeroAreaTriangles), 0);
            assert_eq!(mesh.counts.source.edges.boundary, 2 * parts as usize + 6);
        }
    }

    #[test]
    fn a_wider_gap_needs_the_users_tolerance() {
        let model = plate(2, 1e-3);
        assert_eq!(build(&model, Welding::Exact).0.counts.components, 2);
        assert_eq!(build(&model, Welding::Within(1e-4)).0.counts.components, 2);
        assert_eq!(build(&model, Welding::Within(2e-3)).0.counts.components, 1);
        assert_eq!(build(&plate(2, 0.0), Welding::Off).0.counts.components, 2);
    }

    #[test]
    fn a_vertex_that_only_touches_an_edge_joins_nothing() {
        let positions = [
            [0., 0., 0.],
            [2., 0., 0.],
            [1., -1.3, 0.],
            [1., 0., 0.],
            [0.3, 1., 0.],
            [1.7, 1., 0.],
        ];
        let model = Model::from_polygons(&positions, &[&[1, 0, 2], &[3, 5, 4]]);
        let (mesh, report) = build(&model, Welding::Exact);
        assert_eq!((mesh.counts.edges.boundary, mesh.counts.components), (6, 2));
        assert_eq!(report.repair_count(RepairKind::ClosedJunctions), 0);
    }

    /// A fan around the origin whose last vertex is the first one, up to rounding.
    #[test]
    fn a_seam_within_rounding_is_closed() {
        let mut model = Model { positions: vec![[0.0; 3]], ..Model::default() };
        for step in 0..=16_u32 {
            let angle = std::f64::consts::TAU * f64::from(step) / 16.0;
            model.positions.push([0.4 * angle.cos(), 0.4 * angle.sin(), 0.0]);
            if step > 0 {
                model.push_polygon(&[0, step, step + 1].map(Corner::at), 0);
            }
        }
        let (mesh, report) = build(&model, Welding::Exact);
        assert_eq!(mesh.counts.edges.boundary, 16);
        assert_eq!(report.repair_count(RepairKind::SnappedVertices), 1);
        assert_eq!(build(&model, Welding::Off).0.counts.edges.boundary, 18);
    }

    #[test]
    fn new_corners_have_the_attributes_between() {
        let mut model = plate(2, 0.0);
        model.texcoords = model
            .positions
            .iter()
            .map(|p| glam::DVec2::new(p[0], p[1]).as_vec2().to_array())
            .collect();
        model.corner_texcoords = model.corner_positions.clone();
        // Red grows with y to the left of the long side, from 0 to 1, and is 0 to the right.
        let red =
            |(vertex, p): (usize, &[f64; 3])| if vertex < 4 && p[1] > 0.0 { 1.0 } else { 0.0 };
        model.colors =
            model.positions.iter().enumerate().map(|at| [red(at), 0.0, 0.0, 1.0]).collect();
        let (mesh, _) = build(&model, Welding::Exact);
        for vertex in &mesh.fill.vertices {
            assert_eq!(vertex.texcoord, [vertex.position[0], vertex.position[1]]);
        }
        let at = |y: f32| {
            let colors = mesh.fill.vertices.iter().zip(&mesh.fill.colors);
            let mut reds: Vec<u8> = colors
                .filter(|(vertex, _)| vertex.position == [0.0, y, 0.0])
                .map(|(_, color)| color[0])
                .collect();
            reds.sort_unstable();
            reds
        };
        assert_eq!([at(0.0), at(1.0), at(2.0)], [vec![0], vec![0, 128], vec![0, 255]]);
    }
}
