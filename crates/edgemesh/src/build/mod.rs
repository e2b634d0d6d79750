//! Builds the [`EdgeMesh`] of a [`Model`], in stages:
//!
//! ```text
//! positions --frame--> 32 bits --weld--.
//! polygons  --triangulate-------------> triangles --> edge table --> counts
//!                                           |
//!        copies and backs dropped, winding repaired (only where there are any)
//!                                           |
//!     planes, crease normals --> records --> components --> fans (split, normals) --> chains --> fill
//! ```
//!
//! Every stage takes linear time. Stages that visit every face or edge run in parallel, and their
//! results do not depend on the threads: the same model gives the same bytes.

mod attributes;
mod chains;
mod components;
mod concave;
mod corners;
mod creases;
mod duplicates;
mod faces;
mod fans;
mod flatten;
mod marks;
mod orient;
mod outside;
mod planes;
mod records;
mod repair;
mod rounding;
mod runs;
mod seams;
mod surface;
mod triangulate;
mod two_sided;
mod weld;
mod welded;

use std::collections::BTreeSet;
use std::sync::atomic::{AtomicBool, Ordering};

use glam::{DMat4, DVec3};
use rayon::prelude::*;

pub(crate) use self::attributes::FaceAttributes;
pub use self::chains::DEFAULT_CHAIN_TURN_RAD;
use self::corners::{CornerInput, build_fill};
use self::faces::FaceSources;
use self::fans::{FanInput, Split, apply_splits, walk_fans};
pub(crate) use self::flatten::{TooManyCopies, flattened};
use self::marks::Marks;
use self::planes::Planes;
use self::repair::Faces;
use self::rounding::Rounding;
use self::surface::{Surface, SurfaceInput};
pub use self::weld::Welding;
use self::weld::{Weld, weld};
use self::welded::WeldedModel;
use crate::edge_mesh::{
    Bounds, EdgeCounts, EdgeFlags, EdgeMesh, EdgePart, EdgeTable, InstancedMesh, MeshCounts,
    MeshFrame, SourceCounts, threshold_steps, triangle_side,
};
use crate::index::{NONE, to_u32};
use crate::model::{InstancedModel, Model};
use crate::report::{RepairKind, Report, WarningCode};

/// The default for the angle between face normals above which an edge is a crease: 30 degrees, an
/// internal angle of 150 degrees in the paper. The facets of a cylinder with 12 or more sides are
/// not creases.
pub const DEFAULT_CREASE_ANGLE_RAD: f64 = std::f64::consts::FRAC_PI_6;

/// Options of the builder.
#[derive(Debug, Clone, PartialEq)]
pub struct BuildOptions {
    /// The angle between the face normals of a convex edge above which it is a ridge, in radians.
    /// Default: [`DEFAULT_CREASE_ANGLE_RAD`].
    pub ridge_angle_rad: f64,
    /// The angle between the face normals of a concave edge above which it is a valley, in radians.
    /// Default: [`DEFAULT_CREASE_ANGLE_RAD`].
    pub valley_angle_rad: f64,
    /// The angle between face normals up to which the fill is smooth, in radians, if the file has
    /// neither normals nor smoothing groups. Default: [`DEFAULT_CREASE_ANGLE_RAD`].
    pub smoothing_angle_rad: f64,
    /// The largest turn within a chain, in radians. Default: [`DEFAULT_CHAIN_TURN_RAD`].
    pub chain_turn_rad: f64,
    /// The vertices that become one. Default: [`Welding::Exact`].
    pub welding: Welding,
    /// Pairs of vertices of the file, counted from 0, whose edges are marked.
    pub marks: Vec<[u32; 2]>,
    /// Pairs of vertices whose edges are not marked, even if the file or `marks` marks them.
    pub unmarked: Vec<[u32; 2]>,
    /// The frame of the mesh. Default: the identity, unless 32 bits would lose detail.
    pub frame: Option<MeshFrame>,
    /// Whether the fill is built, which only shading needs. Default: true.
    pub with_fill: bool,
}

impl Default for BuildOptions {
    fn default() -> Self {
        Self {
            ridge_angle_rad: DEFAULT_CREASE_ANGLE_RAD,
            valley_angle_rad: DEFAULT_CREASE_ANGLE_RAD,
            smoothing_angle_rad: DEFAULT_CREASE_ANGLE_RAD,
            chain_turn_rad: DEFAULT_CHAIN_TURN_RAD,
            welding: Welding::Exact,
            marks: Vec::new(),
            unmarked: Vec::new(),
            frame: None,
            with_fill: true,
        }
    }
}

impl BuildOptions {
    /// The least steps of ridges and valleys.
    fn crease_steps(&self) -> [u32; 2] {
        [self.ridge_angle_rad, self.valley_angle_rad].map(threshold_steps)
    }

    /// Takes the marks between vertices in `range`; returns these options with them alone, counted
    /// from the start of the range.
    fn take_marks(&mut self, range: std::ops::Range<u32>) -> Self {
        let mut own = Self { marks: Vec::new(), unmarked: Vec::new(), ..self.clone() };
        let lists = [(&mut self.marks, &mut own.marks), (&mut self.unmarked, &mut own.unmarked)];
        for (all, own) in lists {
            let is_own = |pair: &mut [u32; 2]| pair.iter().all(|vertex| range.contains(vertex));
            let taken = all.extract_if(.., is_own);
            own.extend(taken.map(|pair| pair.map(|vertex| vertex - range.start)));
        }
        own
    }
}

/// Builds the edge mesh of `model`, and adds its warnings and repairs to `report`.
///
/// [`Model::instanced`] is left out; [`build_instanced`] builds it, too.
///
/// A model of degenerate faces gives an edge mesh without triangles and a warning.
///
/// # Panics
/// Panics if an index of `model` is out of range. Models from a reader have none.
#[must_use]
pub fn build_edge_mesh(model: &Model, options: &BuildOptions, report: &mut Report) -> EdgeMesh {
    build_main(model, options, report).mesh
}

/// As [`build_edge_mesh`], with the meshes that the model has in several places, each built once in
/// its first place and in the frame of all.
///
/// # Panics
/// As [`build_edge_mesh`].
#[must_use]
pub fn build_instanced(
    model: &Model,
    options: &BuildOptions,
    report: &mut Report,
) -> (EdgeMesh, Vec<InstancedMesh>) {
    let BuiltScene { main, instanced } = build_scene(model, options, report);
    let instanced = instanced
        .into_iter()
        .map(|(built, placements)| InstancedMesh { mesh: built.mesh, placements });
    (main.mesh, instanced.collect())
}

/// An edge mesh, and the vertices of the model at its vertices.
#[derive(Debug)]
pub(crate) struct BuiltMesh {
    pub(crate) mesh: EdgeMesh,
    /// The first vertex of the file, counted from 0, at the position of each vertex of the mesh.
    pub(crate) file_vertices: Vec<u32>,
    /// The vertices of the model at the corners of each triangle; empty without a rig.
    pub(crate) corner_vertices: Vec<[u32; 3]>,
}

/// The edge mesh of a model, and those of its instanced models with their placements, in units of
/// the mesh.
#[derive(Debug)]
pub(crate) struct BuiltScene {
    pub(crate) main: BuiltMesh,
    pub(crate) instanced: Vec<(BuiltMesh, Vec<DMat4>)>,
}

/// As [`build_instanced`], with the vertices of the models.
#[must_use]
pub(crate) fn build_scene(
    model: &Model,
    options: &BuildOptions,
    report: &mut Report,
) -> BuiltScene {
    if model.instanced.is_empty() {
        return BuiltScene { main: build_main(model, options, report), instanced: Vec::new() };
    }
    let (low, high) = box_of(model);
    let frame = options.frame.unwrap_or_else(|| MeshFrame::of_box(low, high));
    let mut options = BuildOptions { frame: Some(frame), ..options.clone() };
    let mut first = to_u32(model.positions.len());
    let mut instanced = Vec::new();
    for InstancedModel { model, placements } in &model.instanced {
        let end = first + to_u32(model.positions.len());
        let mut built = build_one(model, &options.take_marks(first..end), report);
        built.file_vertices.iter_mut().for_each(|vertex| *vertex += first);
        let placements = placements.iter().map(|place| frame.of_file(place)).collect();
        instanced.push((built, placements));
        first = end;
    }
    BuiltScene { main: build_main(model, &options, report), instanced }
}

/// Builds a model without its instances, and reports its frame.
fn build_main(model: &Model, options: &BuildOptions, report: &mut Report) -> BuiltMesh {
    let built = build_one(model, options, report);
    report.repair(RepairKind::Recentered, usize::from(!built.mesh.frame.is_identity()), None);
    built
}

/// Builds a model without its instances.
fn build_one(model: &Model, options: &BuildOptions, report: &mut Report) -> BuiltMesh {
    let is_used = used_vertices(model);
    let used_box = used_box(model, &is_used);
    let (frame, weld) = weld_model(model, &is_used, used_box, options);
    let rounding = Rounding::of(model, &frame, used_box);
    let source = model;
    let welded = WeldedModel::closed(model, weld, options, &frame, &rounding, report);
    let is_closed = welded.is_closed();
    let WeldedModel {
        model, weld: mut welded, sources, triangles, degenerate_count, table, ..
    } = welded;
    let model = &*model;
    let mut counts = MeshCounts {
        vertices: model.positions.len(),
        welded_vertices: count_face_vertices(model, &welded),
        degenerate_triangles: degenerate_count,
        triangles: triangles.len(),
        ..MeshCounts::default()
    };
    count_edges(&mut counts, &triangles, &table, &sources);
    counts.source = count_source(source, &welded, &counts, is_closed);
    warn_non_manifold(model, &sources, &table, &counts, report);
    let positions = std::mem::take(&mut welded.positions);
    let mut faces = Faces {
        model,
        welded_from_input: &welded.welded_from_input,
        vertex_count: positions.len(),
        triangles,
        sources,
        table,
        clashes: Vec::new(),
    };
    faces.repair(&mut counts, report);
    let marks = Marks::find(model, options, &welded.welded_from_input, &faces.table, report);
    let (mesh, corner_vertices) =
        finish(positions, faces, &marks, options, counts, rounding, report);
    let mesh = EdgeMesh { frame, ..mesh };
    let mut file_vertices = welded.first_inputs(mesh.positions.len() - mesh.split_from.len());
    let of_split = |&vertex: &u32| file_vertices[vertex as usize];
    let split: Vec<u32> = mesh.split_from.iter().map(of_split).collect();
    file_vertices.extend(split);
    BuiltMesh { mesh, file_vertices, corner_vertices }
}

/// Marks or unmarks the edges between pairs of vertices of `mesh`, and chains its edges again with
/// the largest turn of `options`.
///
/// # Panics
/// Panics if a vertex is out of range.
pub fn set_marks(mesh: &mut EdgeMesh, pairs: &[[u32; 2]], is_marked: bool, options: &BuildOptions) {
    let welded_count = mesh.positions.len() - mesh.split_from.len();
    let split_from = &mesh.split_from;
    let welded = |vertex: u32| match (vertex as usize).checked_sub(welded_count) {
        Some(split) => split_from[split],
        None => vertex,
    };
    let edge = |a: u32, b: u32| [welded(a).min(welded(b)), welded(a).max(welded(b))];
    let wanted: BTreeSet<[u32; 2]> = pairs.iter().map(|&[a, b]| edge(a, b)).collect();
    for record in &mut mesh.records {
        if wanted.contains(&edge(record.v0, record.v1)) {
            record.word.set(EdgeFlags::MARKED, is_marked);
        }
    }
    mesh.chains = chains::chain(&mesh.positions, &mesh.records, options.chain_turn_rad);
}

/// Finds the creases of a mesh with the thresholds of `options`, and chains its edges again.
pub(crate) fn reclassify(mesh: &mut EdgeMesh, options: &BuildOptions) {
    let [ridge_steps, valley_steps] = options.crease_steps();
    let never = EdgeFlags::NON_MANIFOLD | EdgeFlags::DIAGONAL | EdgeFlags::BOUNDARY;
    for record in mesh.records.iter_mut().filter(|record| !record.flags().intersects(never)) {
        record.word.set(EdgeFlags::RIDGE | EdgeFlags::VALLEY, false);
        record.word.insert(record.word.creases(ridge_steps, valley_steps));
    }
    mesh.chains = chains::chain(&mesh.positions, &mesh.records, options.chain_turn_rad);
}

/// Converts used vertices to the mesh frame and welds them.
fn weld_model(
    model: &Model,
    is_used: &[bool],
    (low, high): (DVec3, DVec3),
    options: &BuildOptions,
) -> (MeshFrame, Weld) {
    let frame = options.frame.unwrap_or_else(|| MeshFrame::of_box(low, high));
    let to_mesh = |&point: &[f64; 3]| frame.to_mesh(point.into()).as_vec3().to_array();
    let positions: Vec<[f32; 3]> = if frame.is_identity() {
        #[expect(clippy::cast_possible_truncation, reason = "a mesh is in 32 bits")]
        let rounded = |point: &[f64; 3]| point.map(|coordinate| coordinate as f32);
        model.positions.par_iter().with_min_len(1 << 14).map(rounded).collect()
    } else {
        model.positions.par_iter().with_min_len(1 << 14).map(to_mesh).collect()
    };
    let welding = match options.welding {
        Welding::Within(tolerance) => Welding::Within(tolerance * frame.scale),
        other => other,
    };
    (frame, weld(&positions, is_used, welding))
}

/// Whether a face or line uses each vertex.
fn used_vertices(model: &Model) -> Vec<bool> {
    let is_used: Vec<AtomicBool> = model.positions.iter().map(|_| AtomicBool::new(false)).collect();
    let mark = |&vertex: &u32| is_used[vertex as usize].store(true, Ordering::Relaxed);
    model.corner_positions.par_iter().with_min_len(1 << 14).for_each(mark);
    model.segments.iter().flat_map(|segment| &segment.ends).for_each(mark);
    is_used.into_iter().map(AtomicBool::into_inner).collect()
}

/// The corners of a box around the used vertices of a model and its instances, in its units;
/// without any, infinite with the lower corner above the upper one.
#[must_use]
pub(crate) fn box_of(model: &Model) -> (DVec3, DVec3) {
    let (mut low, mut high) = used_box(model, &used_vertices(model));
    for InstancedModel { model, placements } in &model.instanced {
        let own = used_box(model, &used_vertices(model));
        if own.0.cmple(own.1).all() {
            (low, high) = with_placed_boxes((low, high), own, placements);
        }
    }
    (low, high)
}

/// The box around `all` and the boxes around `own` in all its places.
pub(crate) fn with_placed_boxes(
    all: (DVec3, DVec3),
    own: (DVec3, DVec3),
    placements: &[DMat4],
) -> (DVec3, DVec3) {
    let corners = placements.iter().flat_map(|place| {
        (0..8_u32).map(move |corner| {
            let pick =
                |axis: usize| if corner >> axis & 1 == 0 { own.0[axis] } else { own.1[axis] };
            place.transform_point3(DVec3::new(pick(0), pick(1), pick(2)))
        })
    });
    corners.fold(all, |(low, high), corner| (low.min(corner), high.max(corner)))
}

fn used_box(model: &Model, is_used: &[bool]) -> (DVec3, DVec3) {
    let nothing = || (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let used = model.positions.par_iter().with_min_len(1 << 14).zip(is_used);
    used.filter(|(_, used)| **used)
        .fold(nothing, |(low, high), (&point, _)| (low.min(point.into()), high.max(point.into())))
        .reduce(nothing, |a, b| (a.0.min(b.0), a.1.max(b.1)))
}

/// Counts the different positions that faces use.
fn count_face_vertices(model: &Model, welded: &Weld) -> usize {
    if model.segments.is_empty() {
        return welded.positions.len();
    }
    let mut is_used = vec![false; welded.positions.len()];
    for &corner in &model.corner_positions {
        is_used[welded.welded_from_input[corner as usize] as usize] = true;
    }
    is_used.iter().filter(|&&used| used).count()
}

fn count_edges(
    counts: &mut MeshCounts,
    triangles: &[[u32; 3]],
    table: &EdgeTable,
    sources: &FaceSources,
) {
    counts.edges = EdgeCounts::of(table, |side| triangle_side(triangles, side));
    if !sources.has_no_diagonals() {
        let of_part = |(_, part): (usize, &EdgePart)| {
            part.iter().filter(|(_, sides)| sources.is_diagonal_edge(sides)).count()
        };
        counts.diagonal_edges = table.parts().map(of_part).sum();
    }
}

/// Counts the polygons of the file, by the vertices of the file; `is_closed` if seams were closed.
fn count_source(
    model: &Model,
    welded: &Weld,
    counts: &MeshCounts,
    is_closed: bool,
) -> SourceCounts {
    let mut source = SourceCounts {
        vertices: model.positions.len(),
        polygons: model.polygon_count(),
        triangles: model.corner_positions.len() - 2 * model.polygon_count(),
        edges: counts.edges,
    };
    let used = welded.welded_from_input.iter().filter(|&&vertex| vertex != NONE).count();
    let is_welded = used != welded.positions.len();
    // If nothing was welded, cut or dropped, the edges of the mesh are those of the file.
    if is_closed || is_welded || !model.is_triangles() || counts.degenerate_triangles > 0 {
        let mut sides = Vec::with_capacity(model.corner_positions.len());
        for polygon in 0..model.polygon_count() {
            let corners = &model.corner_positions[model.corner_range(polygon)];
            sides
                .extend((0..corners.len()).map(|k| [corners[k], corners[(k + 1) % corners.len()]]));
        }
        let table = EdgeTable::from_sides(model.positions.len(), &sides);
        source.edges = EdgeCounts::of(&table, |side| sides[side as usize]);
    }
    source
}

fn warn_non_manifold(
    model: &Model,
    sources: &FaceSources,
    table: &EdgeTable,
    counts: &MeshCounts,
    report: &mut Report,
) {
    if counts.edges.non_manifold == 0 {
        return;
    }
    let first = table.iter().map(|(_, sides)| sides).find(|sides| sides.len() > 2);
    let sides = first.unwrap_or_default();
    let place = sides.get(2).map(|&side| sources.place(model, side as usize / 3));
    report.warn_many(WarningCode::NonManifold, counts.edges.non_manifold, place, || {
        format!("{} faces share an edge; they are drawn in pairs", sides.len())
    });
}

fn finish(
    mut positions: Vec<[f32; 3]>,
    mut faces: Faces,
    marks: &Marks,
    options: &BuildOptions,
    mut counts: MeshCounts,
    rounding: Rounding,
    report: &mut Report,
) -> (EdgeMesh, Vec<[u32; 3]>) {
    let attributes = FaceAttributes::of(faces.model, &faces.sources);
    let input = SurfaceInput {
        positions: &positions,
        rounding,
        attributes: &attributes,
        marks,
        options,
        has_split_edges: counts.edges.non_manifold > 0,
    };
    let Surface { planes, built, components, .. } = input.outward_surface(&mut faces, report);
    let Faces { model, mut triangles, sources, table, clashes, .. } = faces;
    report_slivers(model, &sources, &planes, report);
    report_split_edges(model, &sources, &table, built.split_edges, report);
    counts.components = components.count_joined_by_edges(&table);
    let fans = walk_fans(&FanInput {
        positions: &positions,
        triangles: &triangles,
        planes: &planes.planes,
        twins: &built.twins,
        clashing: &clashing_vertices(&triangles, &table, &clashes),
    });
    drop(built.twins);
    drop(table);
    let (mut records, mut vertex_normals) = (built.records, fans.normals);
    let fill = build_fill(&CornerInput {
        model,
        positions: &positions,
        triangles: &triangles,
        sources: &sources,
        planes: &planes.planes,
        records: &records,
        attributes: &attributes,
        smoothing_angle_rad: options.smoothing_angle_rad,
        is_wanted: options.with_fill,
    });
    report_splits(model, &sources, &fans.splits, report);
    let vertices = (&mut positions, &mut vertex_normals);
    let split_from = apply_splits(&fans.splits, vertices, &mut triangles, &mut records);
    records.extend(marks.loose_records());
    let mesh = EdgeMesh {
        chains: chains::chain(&positions, &records, options.chain_turn_rad),
        bounds: Bounds::of(&positions),
        frame: MeshFrame::default(),
        positions,
        split_from,
        vertex_normals,
        triangles,
        face_planes: planes.planes,
        records,
        fill,
        counts,
    };
    (mesh, corner_vertices(model, &sources))
}

/// The vertices of the model at the corners of each triangle; empty without a rig.
fn corner_vertices(model: &Model, sources: &FaceSources) -> Vec<[u32; 3]> {
    let count = if model.rig.is_some() { sources.len() } else { 0 };
    let vertex = |corner: u32| model.corner_positions[corner as usize];
    (0..count).map(|face| sources.corners(face).map(vertex)).collect()
}

fn report_split_edges(
    model: &Model,
    sources: &FaceSources,
    table: &EdgeTable,
    count: usize,
    report: &mut Report,
) {
    if count > 0 {
        let sides = table.iter().map(|(_, sides)| sides).find(|sides| sides.len() > 2);
        let third = sides.and_then(|sides| sides.get(2));
        let place = third.map(|&side| sources.place(model, side as usize / 3));
        report.repair(RepairKind::SplitEdges, count, place);
    }
}

fn report_splits(model: &Model, sources: &FaceSources, splits: &[Split], report: &mut Report) {
    let corner = splits.first().and_then(|split| split.corners.first());
    let place = corner.map(|&corner| sources.place(model, corner as usize / 3));
    report.repair(RepairKind::SplitVertices, splits.len(), place);
}

/// The vertices of edges whose winding clashes, ascending.
fn clashing_vertices(triangles: &[[u32; 3]], table: &EdgeTable, clashes: &[u32]) -> Vec<u32> {
    let sides = clashes.iter().filter_map(|&edge| table.sides(edge as usize).first());
    let mut vertices: Vec<u32> = sides.flat_map(|&side| triangle_side(triangles, side)).collect();
    vertices.sort_unstable();
    vertices.dedup();
    vertices
}

/// Counts the faces that took the planes of their neighbors.
fn report_slivers(model: &Model, sources: &FaceSources, planes: &Planes, report: &mut Report) {
    let place = planes.slivers.first().map(|&face| sources.place(model, face as usize));
    report.repair(RepairKind::ZeroAreaTriangles, planes.slivers.len(), place);
}
