//! Loads files, or standard input, as edge meshes.

use std::io::{self, Read};
use std::path::{Path, PathBuf};

use edgemesh_models::TORUS_KNOT;
use glam::DVec3;

use super::error::LoadError;
use super::loaded_mesh::{LoadedMesh, ModelSource};
use super::marks::{SideMarks, marks_beside, read_marks};
use super::options::{InputFormat, LoadOptions};
use super::progress::{Progress, Stage, StageGuard};
use crate::build::{
    BuildOptions, BuiltScene, TooManyCopies, box_of, build_scene, flattened, reclassify,
    with_placed_boxes,
};
use crate::edge_mesh::{EdgeMesh, InstancedMesh, MeshFrame};
use crate::format::edge_mesh_file::{HEADER_BYTES, is_edge_mesh, parse, stated_length};
use crate::format::read::{Format, read_model_as, read_model_stream};
use crate::format::regular_file::open_regular;
use crate::model::{MeshRig, Model};
use crate::report::{Report, WarningCode};

/// The path of the embedded model, a torus knot.
pub const DEMO: &str = "demo:";

/// The path of standard input.
pub const STANDARD_INPUT: &str = "-";

/// An input before it is built.
enum Input {
    /// With its path, if it comes from a file.
    Model(Box<Model>, Report, Option<PathBuf>),
    Stored(Box<EdgeMesh>, Vec<InstancedMesh>, String, Report),
}

/// Reads one input and builds its edge mesh. `path` is a file, [`DEMO`] or
/// [`STANDARD_INPUT`].
///
/// # Errors
/// Fails if the input or its marks cannot be read, if an option does not apply to it, if strict
/// options meet a warning, or if `progress` cancels.
pub fn load(
    path: &Path,
    options: &LoadOptions,
    progress: &dyn Progress,
) -> Result<LoadedMesh, LoadError> {
    // Malformed marks are reported before a long read.
    let build = options.build_options(given_marks(options)?);
    let input = read(path, options, progress)?;
    finish(input, options, &build, progress)
}

/// Loads the inputs of one scene with a common frame. It fits all of them, or is the identity if
/// `keeps_coordinates`, so that the meshes have the numbers of their files.
///
/// # Errors
/// As [`load`], for the first input that fails.
pub fn load_scene(
    paths: &[PathBuf],
    options: &LoadOptions,
    keeps_coordinates: bool,
    progress: &dyn Progress,
) -> Result<Vec<LoadedMesh>, LoadError> {
    let inputs: Vec<Input> =
        paths.iter().map(|path| read(path, options, progress)).collect::<Result<_, _>>()?;
    let frame = match keeps_coordinates {
        true => Some(MeshFrame::default()),
        false => Some(frame_of(&inputs)).filter(|_| inputs.len() > 1),
    };
    let build = BuildOptions { frame, ..options.build_options(given_marks(options)?) };
    inputs.into_iter().map(|input| finish(input, options, &build, progress)).collect()
}

fn given_marks(options: &LoadOptions) -> Result<SideMarks, LoadError> {
    Ok(options.marks.as_deref().map(read_marks).transpose()?.unwrap_or_default())
}

fn read(path: &Path, options: &LoadOptions, progress: &dyn Progress) -> Result<Input, LoadError> {
    let _running = StageGuard::begin(progress, Stage::Reading(path))?;
    if path == Path::new(STANDARD_INPUT) {
        return read_standard_input(options);
    }
    if path == Path::new(DEMO) {
        let (model, report) = read_model_stream(TORUS_KNOT, path, Some(Format::Obj))?;
        return Ok(Input::Model(Box::new(model), report, None));
    }
    let format = match options.format {
        Some(InputFormat::Model(format)) => Some(format),
        None if !is_edge_mesh_file(path) => None,
        Some(InputFormat::EdgeMesh) | None => {
            let stream = open_regular(path).map_err(|error| unreadable(path, error))?;
            return stored(path, stream, options);
        }
    };
    let (model, report) = read_model_as(path, format)?;
    Ok(Input::Model(Box::new(model), report, Some(path.to_owned())))
}

fn read_standard_input(options: &LoadOptions) -> Result<Input, LoadError> {
    let stream = io::stdin().lock();
    let name = Path::new("(standard input)");
    match options.format {
        None => Err(LoadError::FormatNeeded),
        Some(InputFormat::EdgeMesh) => stored(name, stream, options),
        Some(InputFormat::Model(format)) => {
            let (model, report) = read_model_stream(stream, name, Some(format))?;
            Ok(Input::Model(Box::new(model), report, None))
        }
    }
}

/// Reads an edge mesh file.
fn stored(path: &Path, stream: impl Read, options: &LoadOptions) -> Result<Input, LoadError> {
    let file = path.display().to_string();
    if options.welding.is_some() || options.marks.is_some() {
        return Err(LoadError::ModelsOnly { file });
    }
    let bytes = read_edge_mesh(stream).map_err(|error| unreadable(path, error))?;
    match parse(&bytes) {
        Ok(stored) => Ok(Input::Stored(
            Box::new(stored.to_mesh()),
            stored.instanced.clone(),
            file,
            stored.report().clone(),
        )),
        Err(reason) => Err(LoadError::EdgeMeshFile { file, reason }),
    }
}

fn finish(
    input: Input,
    options: &LoadOptions,
    build: &BuildOptions,
    progress: &dyn Progress,
) -> Result<LoadedMesh, LoadError> {
    let mut loaded = match input {
        Input::Model(model, mut report, path) => {
            let _running = StageGuard::begin(progress, Stage::Building(&model.name))?;
            let mut build = build.clone();
            if let Some(path) = path.as_deref().filter(|_| options.marks.is_none()) {
                let SideMarks { marked, unmarked } = marks_of(path, &mut report)?;
                (build.marks, build.unmarked) = (marked, unmarked);
            }
            built(*model, path, options, &build, report)
        }
        Input::Stored(mut mesh, mut instanced, name, report) => {
            if let Some(frame) = build.frame {
                mesh.set_frame(frame);
                instanced.iter_mut().for_each(|instanced| instanced.set_frame(frame));
            }
            if options.has_crease_angles() {
                reclassify(&mut mesh, build);
                instanced.iter_mut().for_each(|own| reclassify(&mut own.mesh, build));
            }
            LoadedMesh { instanced, ..LoadedMesh::new(name, *mesh, report) }
        }
    };
    if !options.with_instances {
        copy_instances(&mut loaded)?;
    }
    if options.is_strict && !loaded.report.warnings().is_empty() {
        return Err(LoadError::Warnings { file: loaded.name, report: loaded.report });
    }
    Ok(loaded)
}

/// The edge meshes of a model.
fn built(
    model: Model,
    path: Option<PathBuf>,
    options: &LoadOptions,
    build: &BuildOptions,
    mut report: Report,
) -> LoadedMesh {
    let BuiltScene { mut main, instanced: built } = build_scene(&model, build, &mut report);
    let has_angles = options.has_crease_angles();
    if has_angles && model.stated_edges.is_some() {
        reclassify(&mut main.mesh, build);
    }
    let (mut instanced, mut instanced_vertices) = (Vec::new(), Vec::new());
    for ((mut built, placements), source) in built.into_iter().zip(&model.instanced) {
        if has_angles && source.model.stated_edges.is_some() {
            reclassify(&mut built.mesh, build);
        }
        instanced.push(InstancedMesh { mesh: built.mesh, placements });
        instanced_vertices.push(built.file_vertices);
    }
    let file_vertices = main.file_vertices;
    let source = path.map(|path| ModelSource { path, file_vertices, instanced_vertices });
    let rig = model.rig.filter(|_| options.with_rig);
    let rig = rig.map(|rig| MeshRig { rig, corners: main.corner_vertices });
    LoadedMesh { source, rig, instanced, ..LoadedMesh::new(model.name, main.mesh, report) }
}

/// Copies all instances into the mesh, which then has no rig.
fn copy_instances(loaded: &mut LoadedMesh) -> Result<(), LoadError> {
    if loaded.instanced.is_empty() {
        return Ok(());
    }
    let mut vertices = Vec::new();
    if let Some(source) = &mut loaded.source {
        vertices.push(std::mem::take(&mut source.file_vertices));
        vertices.append(&mut source.instanced_vertices);
    }
    let (mesh, file_vertices) = flattened(&loaded.mesh, &loaded.instanced, &vertices).map_err(
        |TooManyCopies { elements, limit }| LoadError::TooManyCopies {
            file: loaded.name.clone(),
            elements,
            limit,
        },
    )?;
    if let Some(source) = &mut loaded.source {
        source.file_vertices = file_vertices;
    }
    (loaded.mesh, loaded.instanced, loaded.rig) = (mesh, Vec::new(), None);
    Ok(())
}

/// The marks in the side file of a model; none without a side file. Warns of one outside of the
/// model's folder.
fn marks_of(model: &Path, report: &mut Report) -> Result<SideMarks, LoadError> {
    match marks_beside(model) {
        Ok(None) => Ok(SideMarks::default()),
        Ok(Some(side)) => Ok(read_marks(&side)?),
        Err(side) => {
            report.warn(WarningCode::Uri, None, || {
                format!(
                    "the marks {} are a link out of the model's folder and were not read; put the \
                     file there itself, or name it as the file of marks",
                    side.display()
                )
            });
            Ok(SideMarks::default())
        }
    }
}

fn unreadable(path: &Path, reason: io::Error) -> LoadError {
    LoadError::Io { path: path.to_owned(), reason }
}

/// Reads an edge mesh up to its stated length and one byte more, which reveals excess bytes; reads
/// only the header of anything else.
///
/// Memory grows with the bytes read, not with the stated length.
fn read_edge_mesh(mut stream: impl Read) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    stream.by_ref().take(HEADER_BYTES).read_to_end(&mut bytes)?;
    if let Some(length) = stated_length(&bytes) {
        let rest = length.saturating_sub(bytes.len() as u64).saturating_add(1);
        stream.take(rest).read_to_end(&mut bytes)?;
    }
    Ok(bytes)
}

/// The common frame of all inputs.
fn frame_of(inputs: &[Input]) -> MeshFrame {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for input in inputs {
        let own = match input {
            Input::Model(model, ..) => box_of(model),
            Input::Stored(mesh, instanced, ..) => box_in_file(mesh, instanced),
        };
        (low, high) = (low.min(own.0), high.max(own.1));
    }
    MeshFrame::of_box(low, high)
}

/// The corners of a box around a mesh and its instances, in units of the file.
fn box_in_file(mesh: &EdgeMesh, instanced: &[InstancedMesh]) -> (DVec3, DVec3) {
    let mut all = mesh.box_in_file();
    let has_vertices = |own: &&InstancedMesh| !own.mesh.positions.is_empty();
    for InstancedMesh { mesh, placements } in instanced.iter().filter(has_vertices) {
        let places: Vec<_> = placements.iter().map(|place| mesh.frame.in_file(place)).collect();
        all = with_placed_boxes(all, mesh.box_in_file(), &places);
    }
    all
}

/// Whether the file at `path` begins like an edge mesh.
fn is_edge_mesh_file(path: &Path) -> bool {
    let mut head = [0; 8];
    let read = open_regular(path).and_then(|mut file| file.read_exact(&mut head));
    read.is_ok() && is_edge_mesh(&head)
}

#[cfg(test)]
mod tests {
    use std::cell::RefCell;
    use std::ops::ControlFlow;

    use super::*;
    use crate::build::Welding;
    use crate::format::edge_mesh_file::to_bytes;
    use crate::load::NoProgress;
    use crate::load::marks::MarksError;

    fn error(path: &Path, options: &LoadOptions) -> LoadError {
        load(path, options, &NoProgress).unwrap_err()
    }

    #[test]
    fn errors_are_typed_and_name_no_option_of_a_command() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, bytes: &[u8]| {
            let path = folder.path().join(name);
            std::fs::write(&path, bytes).unwrap();
            path
        };
        let demo = load(DEMO.as_ref(), &LoadOptions::default(), &NoProgress).unwrap();
        let bytes = to_bytes(&demo.mesh, DEMO, &demo.report, &[]).unwrap();
        let (stored, cut) = (write("a.edgemesh", &bytes), write("b.edgemesh", &bytes[..99]));
        let twice = write("twice.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 3\n");
        let wrong_marks = write("wrong.marks", b"1 2\n3\n");
        let default = LoadOptions::default;
        let off = LoadOptions { welding: Some(Welding::Off), ..default() };
        let marked = LoadOptions { marks: Some(wrong_marks), ..default() };
        let strict = LoadOptions { is_strict: true, ..default() };
        let errors = [
            error(Path::new(STANDARD_INPUT), &default()),
            error(&stored, &off),
            error(&cut, &default()),
            error(&twice, &marked),
            error(&twice, &strict),
            error(&folder.path().join("none.obj"), &default()),
        ];
        assert!(matches!(errors[0], LoadError::FormatNeeded), "{:?}", errors[0]);
        assert!(matches!(errors[1], LoadError::ModelsOnly { .. }), "{:?}", errors[1]);
        assert!(matches!(errors[2], LoadError::EdgeMeshFile { .. }), "{:?}", errors[2]);
        let LoadError::Marks(MarksError::Line { line: 2, .. }) = errors[3] else {
            panic!("{:?}", errors[3]);
        };
        assert!(matches!(errors[4], LoadError::Warnings { .. }), "{:?}", errors[4]);
        assert!(matches!(errors[5], LoadError::Read(_)), "{:?}", errors[5]);
        for error in errors {
            assert!(!error.to_string().contains("--"), "{error}");
        }
        assert!(load(&twice, &default(), &NoProgress).is_ok());
    }

    #[test]
    fn stages_come_in_order_and_can_cancel() {
        let stages = RefCell::new(Vec::new());
        let note = |stage: Stage| {
            stages.borrow_mut().push(stage.to_string());
            ControlFlow::Continue(())
        };
        assert!(load(DEMO.as_ref(), &LoadOptions::default(), &note).is_ok());
        assert_eq!(stages.into_inner(), ["reading demo:", "building demo:"]);
        let cancel = |stage: Stage| match stage {
            Stage::Building(_) => ControlFlow::Break(()),
            Stage::Reading(_) => ControlFlow::Continue(()),
        };
        let canceled = load(DEMO.as_ref(), &LoadOptions::default(), &cancel).unwrap_err();
        assert!(matches!(canceled, LoadError::Canceled), "{canceled:?}");
    }
}
