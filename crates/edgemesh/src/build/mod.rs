//! From a [`Model`] to an [`EdgeMesh`], stage by stage:
//!
//! ```text
//! polygons --triangulate--> triangles --weld--> drop degenerate --> count
//!     --> drop duplicates --> edge table --orient--> records, normals, planes, fill
//! ```
//!
//! Every stage takes linear time, and nothing depends on hash order or threads:
//! the same model gives the same bytes.

mod corners;
mod normals;
mod orient;
mod records;
mod triangulate;
mod weld;

use rustc_hash::FxHashSet;

use self::corners::{CornerInput, UnionFind, build_fill};
use self::orient::orient;
use self::records::{RecordInput, build_records, is_diagonal_edge, mark_solids};
use self::triangulate::{PolygonTriangle, triangulate};
use self::weld::weld;
use crate::edge_mesh::{Bounds, EdgeMesh, MeshCounts, SourceCounts};
use crate::model::Model;
use crate::report::{Report, WarningCode};
use crate::topology::{EdgeCounts, EdgeTable, triangle_side};

/// The angle between face normals above which an edge is a crease: 30 degrees,
/// that is, an internal angle of 150 degrees in the paper's terms. Enough to
/// leave out the facets of a cylinder with 12 sides or more.
pub const DEFAULT_CREASE_ANGLE_RAD: f64 = std::f64::consts::FRAC_PI_6;

/// How the edge mesh is made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BuildOptions {
    /// A convex edge is a ridge where its face normals differ by more than
    /// this. Default: [`DEFAULT_CREASE_ANGLE_RAD`].
    pub ridge_angle_rad: f64,
    /// A concave edge is a valley where its face normals differ by more than
    /// this. Default: [`DEFAULT_CREASE_ANGLE_RAD`].
    pub valley_angle_rad: f64,
    /// The fill is smooth across edges up to this angle, where the file has
    /// neither normals nor smoothing groups. Default:
    /// [`DEFAULT_CREASE_ANGLE_RAD`].
    pub smoothing_angle_rad: f64,
}

impl Default for BuildOptions {
    fn default() -> Self {
        Self {
            ridge_angle_rad: DEFAULT_CREASE_ANGLE_RAD,
            valley_angle_rad: DEFAULT_CREASE_ANGLE_RAD,
            smoothing_angle_rad: DEFAULT_CREASE_ANGLE_RAD,
        }
    }
}

/// Builds the edge mesh of `model`; what is repaired or dropped goes to `report`.
///
/// A model whose faces are all degenerate gives an edge mesh without triangles
/// and a warning, not an error.
#[must_use]
pub fn build_edge_mesh(model: &Model, options: &BuildOptions, report: &mut Report) -> EdgeMesh {
    let source = count_source(model);
    let welded = weld(&model.positions, model.corners.iter().map(|corner| corner.position));
    let mut sources = triangulate(model, report);
    let triangle_total = sources.len();
    let mut triangles = drop_degenerate(model, &welded.welded_from_input, &mut sources, report);

    let mut table = EdgeTable::from_triangles(welded.positions.len(), &triangles);
    let mut counts = count_mesh(&triangles, &table, &sources);
    counts.vertices = model.vertex_count_in_file;
    counts.welded_vertices = welded.positions.len();
    counts.degenerate_triangles = triangle_total - triangles.len();
    counts.source = source;
    warn_non_manifold(model, &sources, &table, report);

    counts.duplicate_triangles = drop_duplicates(model, &mut triangles, &mut sources, report);
    if counts.duplicate_triangles > 0 {
        table = EdgeTable::from_triangles(welded.positions.len(), &triangles);
    }
    let clashes = repair_winding(model, &mut triangles, &mut sources, &table, report);
    if report.flipped_faces > 0 {
        // Flipped triangles number their sides anew.
        table = EdgeTable::from_triangles(welded.positions.len(), &triangles);
    }
    finish(
        model,
        options,
        report,
        Parts { positions: welded.positions, triangles, sources, table, clashes, counts },
    )
}

/// What the first stages leave for the last ones.
struct Parts {
    positions: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
    sources: Vec<PolygonTriangle>,
    table: EdgeTable,
    clashes: Vec<u32>,
    counts: MeshCounts,
}

fn finish(model: &Model, options: &BuildOptions, report: &mut Report, parts: Parts) -> EdgeMesh {
    let Parts { positions, triangles, sources, table, clashes, counts } = parts;
    let face_normals = normals::face_normals(&positions, &triangles);
    report.zero_area_triangles = face_normals.iter().filter(|normal| normal.is_none()).count();
    let materials: Vec<u32> =
        sources.iter().map(|source| model.polygons[source.polygon as usize].material).collect();
    let is_diagonal = diagonal_sides(&sources);
    let input = RecordInput {
        positions: &positions,
        triangles: &triangles,
        normals: &face_normals,
        materials: &materials,
        is_diagonal: &is_diagonal,
        clashes: &clashes,
    };
    let mut records = build_records(&input, &table, options);
    mark_solids(&positions, &triangles, &mut records);
    let fill = build_fill(&CornerInput {
        model,
        positions: &positions,
        triangles: &triangles,
        sources: &sources,
        normals: &face_normals,
        records: &records,
        smoothing_angle_rad: options.smoothing_angle_rad,
    });
    EdgeMesh {
        vertex_normals: normals::vertex_normals(&positions, &triangles, &face_normals),
        face_planes: normals::face_planes(&positions, &triangles, &face_normals, &table),
        bounds: Bounds::of(&positions),
        positions,
        triangles,
        records,
        fill,
        counts,
    }
}

/// Counts the file's own polygons, by the file's own vertices.
fn count_source(model: &Model) -> SourceCounts {
    let sides: Vec<[u32; 2]> = model
        .polygons
        .iter()
        .flat_map(|polygon| {
            let corners = &model.corners[polygon.corner_range()];
            (0..corners.len())
                .map(|k| [corners[k].position, corners[(k + 1) % corners.len()].position])
        })
        .collect();
    let table = EdgeTable::from_sides(model.positions.len(), &sides);
    SourceCounts {
        vertices: model.vertex_count_in_file,
        polygons: model.polygons.len(),
        triangles: model.polygons.iter().map(|polygon| polygon.corner_count as usize - 2).sum(),
        edges: EdgeCounts::of(&table, |side| sides[side as usize]),
    }
}

fn line_of(model: &Model, source: &PolygonTriangle) -> Option<u32> {
    Some(model.polygons[source.polygon as usize].line).filter(|&line| line > 0)
}

/// Makes welded triangles and drops those that name a vertex twice.
fn drop_degenerate(
    model: &Model,
    welded_from_input: &[u32],
    sources: &mut Vec<PolygonTriangle>,
    report: &mut Report,
) -> Vec<[u32; 3]> {
    let mut triangles = Vec::with_capacity(sources.len());
    sources.retain(|source| {
        let [a, b, c] = source
            .corners
            .map(|corner| welded_from_input[model.corners[corner as usize].position as usize]);
        let is_sound = a != b && b != c && c != a;
        if is_sound {
            triangles.push([a, b, c]);
        } else {
            report.warn(WarningCode::Degenerate, line_of(model, source), || {
                "a triangle with two corners in one place was dropped".into()
            });
        }
        is_sound
    });
    triangles
}

fn count_mesh(
    triangles: &[[u32; 3]],
    table: &EdgeTable,
    sources: &[PolygonTriangle],
) -> MeshCounts {
    let is_diagonal = diagonal_sides(sources);
    let mut sets = UnionFind::new(triangles.len());
    let mut diagonal_edges = 0;
    for (_, sides) in table.iter() {
        diagonal_edges += usize::from(is_diagonal_edge(sides, &is_diagonal));
        for pair in sides.windows(2) {
            sets.join(pair[0] as usize / 3, pair[1] as usize / 3);
        }
    }
    MeshCounts {
        triangles: triangles.len(),
        edges: EdgeCounts::of(table, |side| triangle_side(triangles, side)),
        diagonal_edges,
        components: (0..triangles.len()).filter(|&face| sets.root(face) == face).count(),
        ..MeshCounts::default()
    }
}

/// Whether each side (3 f + k) is a diagonal of its polygon.
fn diagonal_sides(sources: &[PolygonTriangle]) -> Vec<bool> {
    sources
        .iter()
        .flat_map(|source| [0, 1, 2].map(|side| source.diagonals & (1 << side) != 0))
        .collect()
}

fn warn_non_manifold(
    model: &Model,
    sources: &[PolygonTriangle],
    table: &EdgeTable,
    report: &mut Report,
) {
    for (_, sides) in table.iter().filter(|(_, sides)| sides.len() > 2) {
        let line = line_of(model, &sources[sides[2] as usize / 3]);
        report.warn(WarningCode::NonManifold, line, || {
            format!("an edge is shared by {} faces; they are drawn in pairs", sides.len())
        });
    }
}

/// Drops triangles that name the same vertices in the same cyclic order as an
/// earlier one; a reversed twin stays, as the back of a two-sided sheet.
fn drop_duplicates(
    model: &Model,
    triangles: &mut Vec<[u32; 3]>,
    sources: &mut Vec<PolygonTriangle>,
    report: &mut Report,
) -> usize {
    let mut seen = FxHashSet::with_capacity_and_hasher(triangles.len(), rustc_hash::FxBuildHasher);
    let is_first: Vec<bool> = triangles
        .iter()
        .map(|&[a, b, c]| {
            seen.insert(match a.min(b).min(c) {
                smallest if smallest == a => [a, b, c],
                smallest if smallest == b => [b, c, a],
                _ => [c, a, b],
            })
        })
        .collect();
    let total = triangles.len();
    for (source, _) in sources.iter().zip(&is_first).filter(|(_, is_first)| !**is_first) {
        report.warn(WarningCode::Duplicate, line_of(model, source), || {
            "a face that repeats another was dropped".into()
        });
    }
    keep(triangles, &is_first);
    keep(sources, &is_first);
    total - triangles.len()
}

fn keep<T>(items: &mut Vec<T>, mask: &[bool]) {
    let mut kept = mask.iter();
    items.retain(|_| kept.next() == Some(&true));
}

/// Flips the minority of every component that winds two ways; returns the
/// edges that clash nevertheless.
fn repair_winding(
    model: &Model,
    triangles: &mut [[u32; 3]],
    sources: &mut [PolygonTriangle],
    table: &EdgeTable,
    report: &mut Report,
) -> Vec<u32> {
    let orientation = orient(triangles, table, |face| sources[face].flip());
    report.flipped_faces = orientation.flipped;
    if let Some(&edge) = orientation.clashes.first() {
        let sides = table.iter().nth(edge as usize).map_or(&[][..], |(_, sides)| sides);
        let line = sides.last().and_then(|side| line_of(model, &sources[*side as usize / 3]));
        report.warn_many(WarningCode::Orientation, orientation.clashes.len(), line, || {
            "the surface has no two sides; it is cut along edges where its faces clash".into()
        });
    }
    orientation.clashes
}
