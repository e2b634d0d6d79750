//! `edgemesh export`: edges for other programs.

use std::path::{Path, PathBuf};

use clap::builder::PossibleValue;
use clap::{Args, ValueEnum};

use super::failure::Failure;
use super::loading::load_input;
use super::messages::print_warnings;
use super::progress::TerminalLine;
use super::target::{Targets, write_target};
use crate::arguments::InputArguments;
use crate::format::export::{ExportFormat, to_bytes};

/// Writes the mesh and its feature edges for other programs
///
/// glTF stores edges in an extension for edge visibility, PLY as edges,
/// OBJ as lines in a group for each class, JSON as lists.
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
            let loaded = load_input(&self.input, input, false, is_quiet)?;
            if !is_quiet {
                print_warnings(&loaded.name, &loaded.report);
            }
            let is_empty = loaded.mesh.triangles.is_empty() && loaded.mesh.records.is_empty();
            if is_empty && format != ExportFormat::Json {
                // No reader takes a file without faces and lines, ours neither.
                return Err(Failure::fault(format!(
                    "{}: no face and no line is left to export; mend the model first",
                    loaded.name
                )));
            }
            let _progress = TerminalLine::start(format!("writing {}", target.display()), is_quiet);
            let name = input.file_stem().unwrap_or_else(|| Path::new("mesh").as_os_str());
            let bytes = to_bytes(&loaded.mesh, &name.to_string_lossy(), format)
                .map_err(|error| Failure::fault(format!("{}: {error}", target.display())))?;
            write_target(target, &bytes)?;
        }
        Ok(())
    }
}
