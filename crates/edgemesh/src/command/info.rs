//! `edgemesh info`: counts of a model and of its feature edges in a view.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;
use glam::{Vec3, Vec4};
use serde::Serialize;

use super::failure::{ExitStatus, Failure};
use super::loading::load_input;
use super::messages::{print_error, print_warnings};
use super::output::{print_to_stdout, to_json};
use crate::arguments::{CameraArguments, InputArguments};
use crate::edge_mesh::{
    Bounds, Chain, EdgeMesh, EdgeVertex, EdgeVertex16, InstancedMesh, MeshCounts, MeshFrame,
};
use crate::line::LineClass;
use crate::load::LoadedMesh;
use crate::report::{RepairKind, Report, place_in};
use crate::view::{FeatureCounts, count_features};

/// Prints counts of a model: vertices, edges, defects, feature edges
#[derive(Debug, Clone, Args)]
#[command(after_help = "Examples:\n  \
    edgemesh info bunny.obj\n  \
    edgemesh info bunny.obj --json --eye 0,0,5 --target 0,0,0\n  \
    edgemesh info part.stl --ridge 20 --valley 60\n  \
    edgemesh info part.edgemesh other.glb --json")]
pub struct InfoCommand {
    /// Models (OBJ, PLY, STL, glTF, VRML, OFF, 3MF) or edge meshes; - is standard input
    #[arg(value_name = "MODEL", required = true)]
    pub models: Vec<PathBuf>,
    /// Print JSON: an object, or an array of objects for several models
    #[arg(long)]
    pub json: bool,
    /// Arguments for reading the input
    #[command(flatten)]
    pub input: InputArguments,
    /// View in which contours are counted
    #[command(flatten)]
    pub camera: CameraArguments,
}

impl InfoCommand {
    /// Reads, builds, counts and prints. A model that cannot be read is reported, and the others
    /// are printed.
    ///
    /// # Errors
    /// Fails without a message if a model could not be read, and at once if the command line is
    /// wrong or standard output cannot be written.
    pub fn run(&self, is_quiet: bool) -> Result<(), Failure> {
        let mut infos = Vec::new();
        let mut status = None;
        for model in &self.models {
            match self.info_of(model, is_quiet) {
                Ok(info) => infos.push(info),
                Err(failure) if failure.status == ExitStatus::USAGE => return Err(failure),
                Err(failure) => {
                    print_error(&failure);
                    status = status.or(Some(failure.status));
                }
            }
        }
        if !infos.is_empty() {
            let text = match &infos[..] {
                [only] if self.json && self.models.len() == 1 => to_json(only)?,
                all if self.json => to_json(&all)?,
                all => all.iter().map(Info::to_text).collect::<Vec<_>>().join("\n"),
            };
            print_to_stdout(text.as_bytes())?;
        }
        match status {
            Some(status) => Err(Failure { message: String::new(), status }),
            None => Ok(()),
        }
    }

    fn info_of(&self, model: &Path, is_quiet: bool) -> Result<Info, Failure> {
        let loaded = load_input(&self.input, model, false, true, is_quiet)?;
        if !is_quiet {
            print_warnings(&loaded.name, &loaded.report);
        }
        let bounds = loaded.bounds();
        // The eye does not depend on the aspect ratio.
        let eye = self.camera.camera(&bounds, &loaded.mesh.frame)?.view(&bounds, 1.0).eye;
        Ok(Info::of(&loaded, &bounds, &features(&loaded, eye)))
    }
}

/// Counts the feature edges of a mesh and of all instances, each seen from its place.
fn features(loaded: &LoadedMesh, eye: Vec4) -> FeatureCounts {
    let mut sum = count_features(&loaded.mesh, eye);
    for InstancedMesh { mesh, placements } in &loaded.instanced {
        for place in placements {
            let own = count_features(mesh, (place.inverse() * eye.as_dvec4()).as_vec4());
            sum.0.iter_mut().zip(own.0).for_each(|(sum, own)| *sum = sum.saturating_add(own));
        }
    }
    sum
}

/// The output of `info --json`; scripts rely on the keys.
#[derive(Debug, Clone, Serialize)]
struct Info {
    file: String,
    vertices: usize,
    welded_vertices: usize,
    triangles: usize,
    degenerate_triangles: usize,
    duplicate_triangles: usize,
    edges: usize,
    diagonal_edges: usize,
    boundary_edges: usize,
    non_manifold_edges: usize,
    inconsistent_edges: usize,
    components: usize,
    bounds: BoundsInfo,
    frame: FrameInfo,
    bytes: BytesInfo,
    records: usize,
    chains: ChainsInfo,
    source: SourceInfo,
    repairs: RepairsInfo,
    repair_places: Vec<RepairInfo>,
    warnings: Vec<WarningInfo>,
    features: FeatureCounts,
}

/// The bounds in the units of the file.
#[derive(Debug, Clone, Serialize)]
struct BoundsInfo {
    min: [f64; 3],
    max: [f64; 3],
}

impl BoundsInfo {
    fn of(bounds: &Bounds, frame: &MeshFrame) -> Self {
        let [min, max] = [bounds.min, bounds.max].map(|corner| {
            if frame.is_identity() {
                // Prints the shortest digits of the 32-bit number, not those of its 64-bit value.
                corner.map(|x| x.to_string().parse().unwrap_or(f64::from(x)))
            } else {
                frame.to_file(Vec3::from(corner).as_dvec3()).to_array()
            }
        });
        Self { min, max }
    }
}

/// The frame of the mesh: `in_mesh = (in_file - origin) * scale`.
#[derive(Debug, Clone, Serialize)]
struct FrameInfo {
    origin: [f64; 3],
    scale: f64,
}

/// Bytes of the input mesh, and of the edge mesh in each layout; a mesh in several places counts
/// once.
#[derive(Debug, Clone, Serialize)]
struct BytesInfo {
    /// 24 bytes a vertex (position and normal), 12 a triangle.
    input: usize,
    /// Positions, normals, triangles, and 20 bytes an edge record.
    indexed: usize,
    /// Four edge vertices of 80 bytes an edge.
    replicated_f32: usize,
    /// Four edge vertices of 40 bytes an edge: 37 bytes, padded.
    replicated_i16: usize,
}

impl BytesInfo {
    fn of(loaded: &LoadedMesh) -> Self {
        let sum = |bytes: fn(&EdgeMesh) -> usize| meshes(loaded).map(|(mesh, _)| bytes(mesh)).sum();
        Self {
            input: sum(|mesh| mesh.positions.len() * 24 + size_of_val(&*mesh.triangles)),
            indexed: sum(|mesh| {
                size_of_val(&*mesh.positions)
                    + size_of_val(&*mesh.vertex_normals)
                    + size_of_val(&*mesh.triangles)
                    + size_of_val(&*mesh.records)
            }),
            replicated_f32: sum(|mesh| mesh.records.len() * 4 * size_of::<EdgeVertex>()),
            replicated_i16: sum(|mesh| mesh.records.len() * 4 * size_of::<EdgeVertex16>()),
        }
    }
}

/// Chains of edges that no view changes.
#[derive(Debug, Clone, Serialize)]
struct ChainsInfo {
    count: usize,
    loops: usize,
    edges: usize,
    /// Edges of the longest chain.
    longest: u32,
}

#[derive(Debug, Clone, Serialize)]
struct SourceInfo {
    vertices: usize,
    polygons: usize,
    triangles: usize,
    edges: usize,
    boundary_edges: usize,
    non_manifold_edges: usize,
    inconsistent_edges: usize,
}

#[derive(Debug, Clone, Serialize)]
struct RepairsInfo {
    flipped_faces: usize,
    inside_out_faces: usize,
    two_sided_faces: usize,
    ear_clipped_polygons: usize,
    zero_area_triangles: usize,
    split_edges: usize,
    split_vertices: usize,
    snapped_vertices: usize,
    closed_junctions: usize,
    recentred: usize,
}

/// A repair in the output of `--json`.
#[derive(Debug, Clone, Serialize)]
pub(super) struct RepairInfo {
    pub(super) kind: &'static str,
    /// Repaired elements.
    pub(super) count: usize,
    /// The first repaired element, behind the name of its file.
    pub(super) place: String,
}

/// A warning in the output of `--json`.
#[derive(Debug, Clone, Serialize)]
pub(super) struct WarningInfo {
    pub(super) code: &'static str,
    /// Affected elements.
    pub(super) count: usize,
    /// The first affected element, behind the name of its file.
    pub(super) place: String,
    /// The defect at `place`, and how it was handled.
    pub(super) message: String,
}

impl Info {
    fn of(loaded: &LoadedMesh, bounds: &Bounds, features: &FeatureCounts) -> Self {
        let counts = &loaded.counts();
        let (file, report, frame) = (&loaded.name, &loaded.report, &loaded.mesh.frame);
        Self {
            file: file.clone(),
            vertices: counts.vertices,
            welded_vertices: counts.welded_vertices,
            triangles: counts.triangles,
            degenerate_triangles: counts.degenerate_triangles,
            duplicate_triangles: counts.duplicate_triangles,
            edges: counts.edges.edges,
            diagonal_edges: counts.diagonal_edges,
            boundary_edges: counts.edges.boundary,
            non_manifold_edges: counts.edges.non_manifold,
            inconsistent_edges: counts.edges.inconsistent,
            components: counts.components,
            bounds: BoundsInfo::of(bounds, frame),
            frame: FrameInfo { origin: frame.origin.into(), scale: frame.scale },
            bytes: BytesInfo::of(loaded),
            records: drawn(loaded, |mesh| mesh.records.len()),
            chains: ChainsInfo::of(loaded),
            source: SourceInfo::of(counts),
            repairs: RepairsInfo::of(report),
            repair_places: repairs_of(file, report),
            warnings: warnings_of(file, report),
            features: *features,
        }
    }

    fn to_text(&self) -> String {
        let mut text = String::new();
        let rows: [(&str, usize, &str); 19] = [
            ("vertices", self.vertices, "in the file"),
            ("welded", self.welded_vertices, "different positions that faces use"),
            ("polygons", self.source.polygons, ""),
            ("triangles", self.triangles, ""),
            ("  degenerate", self.degenerate_triangles, "dropped"),
            ("  duplicate", self.duplicate_triangles, "dropped"),
            ("edges", self.edges, "undirected, welded"),
            ("  diagonals", self.diagonal_edges, "of polygons"),
            ("  non-manifold", self.non_manifold_edges, "more than two faces"),
            ("  inconsistent", self.inconsistent_edges, "two faces that wind two ways"),
            ("components", self.components, ""),
            ("records", self.records, "edge records"),
            ("contour", self.features[LineClass::Contour] as usize, "in this view"),
            ("ridge", self.features[LineClass::Ridge] as usize, ""),
            ("valley", self.features[LineClass::Valley] as usize, ""),
            ("boundary", self.features[LineClass::Boundary] as usize, ""),
            ("marked", self.features[LineClass::Marked] as usize, ""),
            ("material", self.features[LineClass::Material] as usize, "between two materials"),
            (
                "smoothing",
                self.features[LineClass::Smoothing] as usize,
                "between two smoothing groups",
            ),
        ];
        let _ = writeln!(text, "{}", self.file);
        for (name, count, note) in rows {
            let _ = writeln!(text, "{}", format!("{name:<16}{count:>10}  {note}").trim_end());
        }
        let ChainsInfo { count, loops, edges, .. } = self.chains;
        let _ = writeln!(text, "chains          {count:>10}  of {edges} edges, {loops} closed");
        self.write_bytes(&mut text);
        let BoundsInfo { min, max } = &self.bounds;
        let _ = writeln!(text, "bounds          {min:?} to {max:?}");
        for RepairInfo { kind, count, place } in &self.repair_places {
            let kind = kind.replace('_', " ");
            let _ = writeln!(text, "repaired        {count:>10}  {kind}, first at {place}");
        }
        text
    }

    /// Writes the size of each layout, and its ratio to that of the input.
    fn write_bytes(&self, text: &mut String) {
        #[expect(clippy::cast_precision_loss, reason = "two digits are shown")]
        let ratio = |bytes: usize| bytes as f64 / self.bytes.input.max(1) as f64;
        let rows = [
            ("bytes", self.bytes.input, "input: positions, normals, indices"),
            ("", self.bytes.indexed, "indexed"),
            ("", self.bytes.replicated_f32, "replicated, 32-bit floats"),
            ("", self.bytes.replicated_i16, "replicated, 16-bit"),
        ];
        for (name, bytes, note) in rows {
            let times = ratio(bytes);
            let _ = writeln!(text, "{name:<16}{bytes:>10}  {note}, {times:.1} times the input");
        }
    }
}

impl ChainsInfo {
    fn of(loaded: &LoadedMesh) -> Self {
        let chains = meshes(loaded).flat_map(|(mesh, _)| &mesh.chains.chains);
        let is_loop = |chain: &&Chain| chain.is_loop != 0;
        Self {
            count: drawn(loaded, |mesh| mesh.chains.chains.len()),
            loops: drawn(loaded, |mesh| mesh.chains.chains.iter().filter(is_loop).count()),
            edges: drawn(loaded, |mesh| mesh.chains.links.len()),
            longest: chains.map(|chain| chain.link_count).max().unwrap_or_default(),
        }
    }
}

impl SourceInfo {
    const fn of(counts: &MeshCounts) -> Self {
        let source = &counts.source;
        Self {
            vertices: source.vertices,
            polygons: source.polygons,
            triangles: source.triangles,
            edges: source.edges.edges,
            boundary_edges: source.edges.boundary,
            non_manifold_edges: source.edges.non_manifold,
            inconsistent_edges: source.edges.inconsistent,
        }
    }
}

/// All meshes, each with the number of its places.
fn meshes(loaded: &LoadedMesh) -> impl Iterator<Item = (&EdgeMesh, usize)> {
    let instanced = loaded.instanced.iter().map(|own| (&own.mesh, own.placements.len()));
    std::iter::once((&loaded.mesh, 1)).chain(instanced)
}

/// The sum of a count over all places.
fn drawn(loaded: &LoadedMesh, count: impl Fn(&EdgeMesh) -> usize) -> usize {
    meshes(loaded).map(|(mesh, places)| count(mesh).saturating_mul(places)).sum()
}

impl RepairsInfo {
    fn of(report: &Report) -> Self {
        let count = |kind| report.repair_count(kind);
        Self {
            flipped_faces: count(RepairKind::FlippedFaces),
            inside_out_faces: count(RepairKind::InsideOutFaces),
            two_sided_faces: count(RepairKind::TwoSidedFaces),
            ear_clipped_polygons: count(RepairKind::EarClippedPolygons),
            zero_area_triangles: count(RepairKind::ZeroAreaTriangles),
            split_edges: count(RepairKind::SplitEdges),
            split_vertices: count(RepairKind::SplitVertices),
            snapped_vertices: count(RepairKind::SnappedVertices),
            closed_junctions: count(RepairKind::ClosedJunctions),
            recentred: count(RepairKind::Recentered),
        }
    }
}

/// The warnings of `report` for JSON, with places such as `file:line`.
pub(super) fn warnings_of(file: &str, report: &Report) -> Vec<WarningInfo> {
    report
        .warnings()
        .iter()
        .map(|warning| WarningInfo {
            code: warning.code.as_str(),
            count: warning.count,
            place: place_in(file, warning.place.as_ref()),
            message: warning.message.clone(),
        })
        .collect()
}

/// The repairs of `report` for JSON.
pub(super) fn repairs_of(file: &str, report: &Report) -> Vec<RepairInfo> {
    report
        .repairs()
        .iter()
        .map(|repair| RepairInfo {
            kind: repair.kind.as_str(),
            count: repair.count,
            place: place_in(file, repair.place.as_ref()),
        })
        .collect()
}
