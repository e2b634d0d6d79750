//! What commands read: models and edge meshes, from files or standard input.

use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use clap::builder::PossibleValue;
use clap::{Args, ValueEnum};
use glam::DVec3;

use super::marks::{SideMarks, read_marks, side_file};
use super::options::CreaseOptions;
use super::progress::Listener;
use super::{Failure, strict_failure};
use crate::build::{BuildOptions, Welding, box_of, build_with_file_vertices, reclassify};
use crate::edge_mesh::{EdgeMesh, MeshFrame};
use crate::format::edge_mesh_file::{FileError, HEADER_BYTES, is_edge_mesh, parse, stated_length};
use crate::format::read::{Format, read_model_as, read_model_stream};
use crate::model::Model;
use crate::report::Report;

/// What is named instead of a file for the project's own model, a torus knot.
pub const DEMO: &str = "demo:";

const DEMO_MODEL: &[u8] = include_bytes!("../../../../models/torus_knot.obj");

/// How the input is read and what is made of it.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Input")]
pub struct InputOptions {
    /// The format of the input [default: told by its first bytes]; needed for
    /// standard input (-)
    #[arg(long, value_name = "FORMAT")]
    pub format: Option<InputFormat>,
    /// Weld vertices that are at most this far apart, in units of the model
    /// [default: only those in exactly the same place]
    #[arg(long, value_name = "TOLERANCE", value_parser = parse_tolerance)]
    pub weld: Option<f64>,
    /// Weld no vertices
    #[arg(long, conflicts_with = "weld")]
    pub no_weld: bool,
    /// A file with pairs of vertices, one a line, counted from 1, whose edges
    /// are marked [default: MODEL.marks, where it is there]
    #[arg(long, value_name = "FILE")]
    pub marks: Option<PathBuf>,
    /// Warnings are errors
    #[arg(long)]
    pub strict: bool,
    /// Crease thresholds
    #[command(flatten)]
    pub creases: CreaseOptions,
}

/// The formats that `--format` names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InputFormat {
    /// A model's.
    Model(Format),
    /// An edge mesh's own.
    EdgeMesh,
}

/// Those of all models, then the edge mesh's.
static INPUT_FORMATS: LazyLock<Vec<InputFormat>> = LazyLock::new(|| {
    let models = Format::ALL.map(InputFormat::Model);
    models.into_iter().chain([InputFormat::EdgeMesh]).collect()
});

impl ValueEnum for InputFormat {
    fn value_variants<'a>() -> &'a [Self] {
        &INPUT_FORMATS
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(match self {
            Self::Model(format) => PossibleValue::new(format.as_str()).help(format.name()),
            Self::EdgeMesh => PossibleValue::new("edgemesh").help("An edge mesh"),
        })
    }
}

impl InputFormat {
    /// The model format; `None` for an edge mesh.
    const fn of_model(self) -> Option<Format> {
        match self {
            Self::Model(format) => Some(format),
            Self::EdgeMesh => None,
        }
    }
}

/// An edge mesh with what there is to say of it.
#[derive(Debug, Clone)]
pub struct Loaded {
    /// How its file is called in messages.
    pub name: String,
    /// The edge mesh.
    pub mesh: EdgeMesh,
    /// What was repaired or dropped.
    pub report: Report,
    /// Where it is from; none for standard input, and for edge meshes.
    pub source: Option<ModelSource>,
}

/// The model file of an edge mesh.
#[derive(Debug, Clone)]
pub struct ModelSource {
    /// The file.
    pub path: PathBuf,
    /// A vertex of the file, counted from 0, for each vertex of the mesh.
    pub file_vertices: Vec<u32>,
}

impl Loaded {
    /// An edge mesh that is from no file.
    #[must_use]
    pub const fn new(name: String, mesh: EdgeMesh, report: Report) -> Self {
        Self { name, mesh, report, source: None }
    }
}

/// An input before it is built.
enum Input {
    /// With the file that it is from, where it is one.
    Model(Box<Model>, Report, Option<PathBuf>),
    Stored(Box<EdgeMesh>, String, Report),
}

impl InputOptions {
    /// The builder's options; `with_fill` is for who shades.
    fn build_options(&self, with_fill: bool) -> Result<BuildOptions, Failure> {
        let SideMarks { marked, unmarked } =
            self.marks.as_deref().map(read_marks).transpose()?.unwrap_or_default();
        let welding = match (self.weld, self.no_weld) {
            (Some(tolerance), _) => Welding::Within(tolerance),
            (None, true) => Welding::Off,
            (None, false) => Welding::Exact,
        };
        Ok(BuildOptions {
            welding,
            marks: marked,
            unmarked,
            with_fill,
            ..self.creases.build_options()
        })
    }

    /// Reads one input and builds its edge mesh.
    ///
    /// # Errors
    /// Where it cannot be read, and, with `--strict`, where there is a warning.
    pub fn load(&self, path: &Path, with_fill: bool, is_quiet: bool) -> Result<Loaded, Failure> {
        let options = self.build_options(with_fill)?;
        let listener = Listener::terminal(is_quiet);
        let input = self.read(path, listener)?;
        self.finish(input, &options, listener)
    }

    /// Reads several inputs that lie in one scene, in one frame: that of all of
    /// them, unless `keeps_coordinates` asks for the files' own numbers.
    ///
    /// # Errors
    /// As [`Self::load`], for the first one that fails, and where the listener wants no
    /// more.
    pub fn load_scene(
        &self,
        paths: &[PathBuf],
        keeps_coordinates: bool,
        listener: Listener,
    ) -> Result<Vec<Loaded>, Failure> {
        let inputs: Vec<Input> =
            paths.iter().map(|path| self.read(path, listener)).collect::<Result<_, _>>()?;
        let frame = match keeps_coordinates {
            true => Some(MeshFrame::default()),
            false => Some(frame_of(&inputs)).filter(|_| inputs.len() > 1),
        };
        let options = BuildOptions { frame, ..self.build_options(true)? };
        inputs.into_iter().map(|input| self.finish(input, &options, listener)).collect()
    }

    fn read(&self, path: &Path, listener: Listener) -> Result<Input, Failure> {
        let _progress = listener.begin(&format!("reading {}", path.display()))?;
        let format = self.format.map(InputFormat::of_model);
        if path == Path::new("-") {
            return self.read_standard_input();
        }
        if path == Path::new(DEMO) {
            let (model, report) = read_model_stream(DEMO_MODEL, path, Some(Format::Obj))?;
            return Ok(Input::Model(Box::new(model), report, None));
        }
        if format == Some(None) || format.is_none() && is_edge_mesh_file(path) {
            let stream = File::open(path).map_err(|error| unreadable(path, &error))?;
            return self.stored(path, stream);
        }
        let (model, report) = read_model_as(path, format.flatten())?;
        Ok(Input::Model(Box::new(model), report, Some(path.to_owned())))
    }

    fn read_standard_input(&self) -> Result<Input, Failure> {
        let Some(format) = self.format else {
            return Err(Failure::usage("standard input (-) needs --format, as --format obj"));
        };
        let stream = std::io::stdin().lock();
        let name = Path::new("(standard input)");
        if let Some(format) = format.of_model() {
            let (model, report) = read_model_stream(stream, name, Some(format))?;
            return Ok(Input::Model(Box::new(model), report, None));
        }
        self.stored(name, stream)
    }

    fn stored(&self, path: &Path, stream: impl Read) -> Result<Input, Failure> {
        if self.weld.is_some() || self.no_weld || self.marks.is_some() {
            return Err(Failure::usage(format!(
                "{}: --weld, --no-weld and --marks are for models; an edge mesh is welded already",
                path.display()
            )));
        }
        let name = path.display().to_string();
        let failed = |error: FileError| Failure::fault(format!("{name}: {error}"));
        let bytes = read_edge_mesh(stream).map_err(|error| unreadable(path, &error))?;
        let stored = parse(&bytes).map_err(failed)?;
        Ok(Input::Stored(Box::new(stored.to_mesh()), name.clone(), stored.report().clone()))
    }

    fn finish(
        &self,
        input: Input,
        options: &BuildOptions,
        listener: Listener,
    ) -> Result<Loaded, Failure> {
        let loaded = match input {
            Input::Model(model, mut report, path) => {
                let _progress = listener.begin(&format!("building {}", model.name))?;
                let mut options = options.clone();
                let side = path.as_deref().map(side_file).filter(|side| side.is_file());
                if let Some(side) = side.filter(|_| self.marks.is_none()) {
                    let SideMarks { marked, unmarked } = read_marks(&side)?;
                    (options.marks, options.unmarked) = (marked, unmarked);
                }
                let (mesh, file_vertices) = build_with_file_vertices(&model, &options, &mut report);
                let source = path.map(|path| ModelSource { path, file_vertices });
                Loaded { source, ..Loaded::new(model.name, mesh, report) }
            }
            Input::Stored(mut mesh, name, report) => {
                if let Some(frame) = options.frame {
                    mesh.set_frame(frame);
                }
                if self.creases.is_given() {
                    reclassify(&mut mesh, options);
                }
                Loaded::new(name, *mesh, report)
            }
        };
        if self.strict && !loaded.report.warnings().is_empty() {
            return Err(strict_failure(&loaded.name, &loaded.report));
        }
        Ok(loaded)
    }
}

fn unreadable(path: &Path, error: &io::Error) -> Failure {
    Failure::fault(format!("{}: cannot be read: {error}", path.display()))
}

/// The bytes of an edge mesh: those of its stated length and one more, by which
/// one that goes on is known; only the header of what is none.
///
/// The memory grows with what is there, not with what is stated.
fn read_edge_mesh(mut stream: impl Read) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    stream.by_ref().take(HEADER_BYTES).read_to_end(&mut bytes)?;
    if let Some(length) = stated_length(&bytes) {
        let rest = length.saturating_sub(bytes.len() as u64).saturating_add(1);
        stream.take(rest).read_to_end(&mut bytes)?;
    }
    Ok(bytes)
}

/// The frame that all inputs share.
fn frame_of(inputs: &[Input]) -> MeshFrame {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for input in inputs {
        let own = match input {
            Input::Model(model, ..) => box_of(model),
            Input::Stored(mesh, ..) => mesh.box_in_file(),
        };
        (low, high) = (low.min(own.0), high.max(own.1));
    }
    MeshFrame::of_box(low, high)
}

/// Whether the file at `path` begins as an edge mesh does. Pipes are not asked,
/// as what is read from them is gone.
fn is_edge_mesh_file(path: &Path) -> bool {
    let is_file = path.metadata().is_ok_and(|metadata| metadata.is_file());
    let mut head = [0; 8];
    is_file
        && File::open(path).and_then(|mut file| file.read_exact(&mut head)).is_ok()
        && is_edge_mesh(&head)
}

fn parse_tolerance(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(tolerance) if tolerance.is_finite() && tolerance >= 0.0 => Ok(tolerance),
        _ => Err("needs a distance of 0 or more".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tolerances_are_distances() {
        assert_eq!(parse_tolerance("1e-6"), Ok(1e-6));
        for text in ["-1", "nan", "inf", "", "x"] {
            assert!(parse_tolerance(text).is_err(), "{text}");
        }
    }
}
