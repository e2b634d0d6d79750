//! `edgemesh export`: edges for other programs.

use std::fs::File;
use std::io::{self, Read as _};
use std::path::{Path, PathBuf};

use clap::builder::PossibleValue;
use clap::{Args, ValueEnum};

use super::failure::Failure;
use super::loading::load_input;
use super::messages::print_warnings;
use super::progress::TerminalLine;
use super::target::{Targets, library_beside, write_target};
use crate::arguments::InputArguments;
use crate::edge_mesh::EdgeMesh;
use crate::format::export::{
    ExportFormat, LIBRARY_HEAD, Parts, material_library, obj_with_library, to_bytes_with,
};
use crate::load::LoadedMesh;
use crate::report::Report;

/// Writes the mesh and its feature edges for other programs
///
/// glTF stores edges in an extension for edge visibility, PLY as edges,
/// OBJ as lines in groups by class, JSON as lists. Read again, all but JSON,
/// which is not read, have the same classes. glTF keeps materials with their
/// textures, skins and morph targets; materials of an OBJ file are written
/// to an .mtl file beside it, PLY has their colors.
#[derive(Debug, Clone, Args)]
#[command(after_help = "Examples:\n  \
    edgemesh export bunny.obj -o bunny.glb\n  \
    edgemesh export part.stl -o part-lines.obj --crease 20\n  \
    edgemesh export bunny.edgemesh -o - --to json")]
pub struct ExportCommand {
    /// Models or edge meshes to export; - is standard input
    #[arg(value_name = "IN", required = true)]
    pub inputs: Vec<PathBuf>,
    /// File to write; - is standard output. Several inputs need a folder
    #[arg(short, long, value_name = "OUT")]
    pub output: PathBuf,
    /// Format to write [default: detected from the extension of OUT]
    #[arg(long, value_name = "FORMAT")]
    pub to: Option<ExportFormat>,
    /// Arguments for reading the input
    #[command(flatten)]
    pub input: InputArguments,
}

impl ValueEnum for ExportFormat {
    fn value_variants<'a>() -> &'a [Self] {
        &Self::ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.as_str()))
    }
}

impl ExportCommand {
    fn format(&self) -> Result<ExportFormat, Failure> {
        if let Some(format) = self.to {
            return Ok(format);
        }
        ExportFormat::of_name(&self.output).ok_or_else(|| {
            Failure::usage(format!(
                "{}: unknown extension; use .glb, .gltf, .ply, .obj or .json, or give --to",
                self.output.display()
            ))
        })
    }

    /// Reads, builds where needed, and writes each input.
    ///
    /// # Errors
    /// Fails if an input cannot be read or a file cannot be written; the files of the inputs
    /// before it stay.
    pub fn run(&self, is_quiet: bool) -> Result<(), Failure> {
        let format = self.format()?;
        let targets = Targets::new(&self.inputs, &self.output, format.as_str())?;
        for (input, target) in targets.pairs() {
            // Only glTF places a mesh several times.
            let with_instances = matches!(format, ExportFormat::Glb | ExportFormat::Gltf);
            let loaded = load_input(&self.input, input, true, with_instances, is_quiet)?;
            if !is_quiet {
                print_warnings(&loaded.name, &loaded.report);
            }
            let is_empty = loaded.mesh.triangles.is_empty()
                && loaded.mesh.records.is_empty()
                && loaded.instanced.is_empty();
            if is_empty && format != ExportFormat::Json {
                // No reader takes a file without faces and lines, ours neither.
                return Err(Failure::fault(format!(
                    "{}: no face and no line is left to export; mend the model first",
                    loaded.name
                )));
            }
            let _progress = TerminalLine::start(format!("writing {}", target.display()), is_quiet);
            let name = input.file_stem().unwrap_or_else(|| Path::new("mesh").as_os_str());
            let name = name.to_string_lossy();
            let library = match format {
                ExportFormat::Obj => write_library(&loaded.mesh, target, is_quiet)?,
                _ => None,
            };
            let bytes = bytes_of(&loaded, &name, format, library.as_deref())
                .map_err(|error| Failure::fault(format!("{}: {error}", target.display())))?;
            write_target(target, &bytes)?;
        }
        Ok(())
    }
}

/// The bytes of an export; `library` is the material library of an OBJ file.
fn bytes_of(
    loaded: &LoadedMesh,
    name: &str,
    format: ExportFormat,
    library: Option<&str>,
) -> io::Result<Vec<u8>> {
    match library {
        Some(library) => obj_with_library(&loaded.mesh, name, library),
        None => {
            let parts = Parts { rig: loaded.rig.as_ref(), instanced: &loaded.instanced };
            to_bytes_with(&loaded.mesh, parts, name, format)
        }
    }
}

/// Writes the material library beside the OBJ file `target` and returns its name. There is none for
/// a stream, or for a mesh without materials.
fn write_library(
    mesh: &EdgeMesh,
    target: &Path,
    is_quiet: bool,
) -> Result<Option<String>, Failure> {
    let Some((path, name)) = library_beside(target) else { return Ok(None) };
    let mut report = Report::default();
    let folder = path.parent().unwrap_or(Path::new(""));
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let Some(text) = material_library(mesh, folder, &mut report) else { return Ok(None) };
    if is_of_others(&path) {
        return Err(Failure::fault(format!(
            "{}: is not from Edgemesh and would be overwritten by the material library; give \
             another name with -o",
            path.display()
        )));
    }
    if !is_quiet {
        print_warnings(&path.display().to_string(), &report);
    }
    write_target(&path, text.as_bytes())?;
    Ok(Some(name))
}

/// Whether a file stands at `path` that is no material library of this program.
fn is_of_others(path: &Path) -> bool {
    let mut head = [0; LIBRARY_HEAD.len()];
    File::open(path)
        .is_ok_and(|mut file| file.read_exact(&mut head).is_err() || head != *LIBRARY_HEAD)
}
