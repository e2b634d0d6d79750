//! `edgemesh info`: counts of a model and of its feature edges in a view.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;
use serde::Serialize;

use super::options::{CameraOptions, CreaseOptions};
use super::{Failure, print_to_stdout, print_warnings};
use crate::build::build_edge_mesh;
use crate::edge_mesh::EdgeMesh;
use crate::oracle::{FeatureCounts, count_features};
use crate::read::read_model;
use crate::report::Report;

/// Prints counts of a model: vertices, edges, what is broken, feature edges
#[derive(Debug, Clone, Args)]
#[command(after_help = "Examples:\n  \
    edgemesh info bunny.obj\n  \
    edgemesh info bunny.obj --json --eye 0,0,5 --target 0,0,0\n  \
    edgemesh info part.obj --ridge 20 --valley 60")]
pub struct InfoCommand {
    /// The model file (OBJ)
    #[arg(value_name = "MODEL")]
    pub model: PathBuf,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// Crease thresholds
    #[command(flatten)]
    pub creases: CreaseOptions,
    /// The view that contours are counted in
    #[command(flatten)]
    pub camera: CameraOptions,
}

impl InfoCommand {
    /// Reads, builds, counts and prints.
    ///
    /// # Errors
    /// Where the model cannot be read, the camera is wrong, or standard output
    /// cannot be written.
    pub fn run(&self, is_quiet: bool) -> Result<(), Failure> {
        let (model, mut report) = read_model(&self.model)?;
        let mesh = build_edge_mesh(&model, &self.creases.build_options(), &mut report);
        // The aspect does not matter for the eye.
        let eye = self.camera.camera(&mesh.bounds)?.view(&mesh.bounds, 1.0).eye;
        let info = Info::of(&model.name, &mesh, &report, count_features(&mesh, eye));
        if !is_quiet {
            print_warnings(&model.name, &report);
        }
        let text = if self.json {
            let json = serde_json::to_string_pretty(&info);
            json.map_err(|error| Failure::fault(error.to_string()))? + "\n"
        } else {
            info.to_text()
        };
        print_to_stdout(text.as_bytes())
    }
}

/// What `info --json` prints; scripts rely on the keys.
#[derive(Debug, Clone, Serialize)]
pub struct Info {
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
    bytes: BytesInfo,
    records: usize,
    source: SourceInfo,
    repairs: RepairsInfo,
    warnings: Vec<WarningInfo>,
    features: FeatureCounts,
}

#[derive(Debug, Clone, Serialize)]
struct BoundsInfo {
    min: [f32; 3],
    max: [f32; 3],
}

#[derive(Debug, Clone, Serialize)]
struct BytesInfo {
    indexed: usize,
    replicated_f32: usize,
    replicated_i16: usize,
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
    ear_clipped_polygons: usize,
    zero_area_triangles: usize,
}

/// A warning as `--json` prints it.
#[derive(Debug, Clone, Serialize)]
pub struct WarningInfo {
    code: &'static str,
    count: usize,
    place: String,
    message: String,
}

impl Info {
    /// Gathers what there is to say of `mesh`.
    #[must_use]
    pub fn of(file: &str, mesh: &EdgeMesh, report: &Report, features: FeatureCounts) -> Self {
        let counts = &mesh.counts;
        let bytes = mesh.layout_bytes();
        Self {
            file: file.into(),
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
            bounds: BoundsInfo { min: mesh.bounds.min, max: mesh.bounds.max },
            bytes: BytesInfo {
                indexed: bytes.indexed,
                replicated_f32: bytes.replicated_f32,
                replicated_i16: bytes.replicated_i16,
            },
            records: mesh.records.len(),
            source: SourceInfo {
                vertices: counts.source.vertices,
                polygons: counts.source.polygons,
                triangles: counts.source.triangles,
                edges: counts.source.edges.edges,
                boundary_edges: counts.source.edges.boundary,
                non_manifold_edges: counts.source.edges.non_manifold,
                inconsistent_edges: counts.source.edges.inconsistent,
            },
            repairs: RepairsInfo {
                flipped_faces: report.flipped_faces,
                ear_clipped_polygons: report.ear_clipped_polygons,
                zero_area_triangles: report.zero_area_triangles,
            },
            warnings: warnings_of(file, report),
            features,
        }
    }

    fn to_text(&self) -> String {
        let mut text = String::new();
        let rows: [(&str, usize, &str); 18] = [
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
            ("contour", self.features.contour as usize, "in this view"),
            ("ridge", self.features.ridge as usize, ""),
            ("valley", self.features.valley as usize, ""),
            ("boundary", self.features.boundary as usize, ""),
            ("marked", self.features.marked as usize, ""),
            ("material", self.features.material as usize, "between two materials"),
        ];
        let _ = writeln!(text, "{}", self.file);
        for (name, count, note) in rows {
            let _ = writeln!(text, "{}", format!("{name:<16}{count:>10}  {note}").trim_end());
        }
        let _ = writeln!(
            text,
            "bytes           {:>10}  indexed\n                {:>10}  replicated, 32-bit floats\n                {:>10}  replicated, 16-bit",
            self.bytes.indexed, self.bytes.replicated_f32, self.bytes.replicated_i16
        );
        let BoundsInfo { min, max } = &self.bounds;
        let _ = writeln!(text, "bounds          {min:?} to {max:?}");
        text
    }
}

/// The warnings of `report` for JSON, each with its first place, `file:line`.
#[must_use]
pub fn warnings_of(file: &str, report: &Report) -> Vec<WarningInfo> {
    report
        .warnings()
        .iter()
        .map(|warning| WarningInfo {
            code: warning.code.as_str(),
            count: warning.count,
            place: warning.line.map_or_else(|| file.to_owned(), |line| format!("{file}:{line}")),
            message: warning.message.clone(),
        })
        .collect()
}
