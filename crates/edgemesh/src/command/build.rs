//! `edgemesh build`: models to edge mesh files.

use std::path::PathBuf;

use clap::builder::PossibleValue;
use clap::{Args, ValueEnum};

use super::failure::Failure;
use super::loading::load_input;
use super::messages::print_warnings;
use super::progress::TerminalLine;
use super::target::{Targets, write_target};
use crate::arguments::InputArguments;
use crate::format::edge_mesh_file::{Layout, to_bytes_with_instances};
use crate::load::LoadedMesh;

/// Builds the edge mesh of a model and writes it to a file
#[derive(Debug, Clone, Args)]
#[command(after_help = "Examples:\n  \
    edgemesh build bunny.obj -o bunny.edgemesh\n  \
    edgemesh build bunny.obj -o bunny.edgemesh --layout replicated-i16\n  \
    edgemesh build *.stl -o meshes/\n  \
    zcat part.ply.gz | edgemesh build - --format ply -o part.edgemesh")]
pub struct BuildCommand {
    /// Models to build; - is standard input
    #[arg(value_name = "MODEL", required = true)]
    pub models: Vec<PathBuf>,
    /// File to write; - is standard output. Several models need a folder
    #[arg(short, long, value_name = "OUT")]
    pub output: PathBuf,
    /// Layout to add to the indexed one, which every file has; can be repeated
    #[arg(long = "layout", value_name = "LAYOUT")]
    pub layouts: Vec<Layout>,
    /// Arguments for reading the input
    #[command(flatten)]
    pub input: InputArguments,
}

impl ValueEnum for Layout {
    fn value_variants<'a>() -> &'a [Self] {
        &Self::ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let help = match self {
            Self::Indexed => "20 bytes an edge, over shared positions and faces",
            Self::ReplicatedF32 => "Four edge vertices of 80 bytes an edge",
            Self::ReplicatedI16 => "Four edge vertices of 40 bytes an edge",
        };
        Some(PossibleValue::new(self.as_str()).help(help))
    }
}

impl BuildCommand {
    /// Reads, builds and writes each model.
    ///
    /// # Errors
    /// Fails if a model cannot be read or a file cannot be written; the files of the models
    /// before it stay.
    pub fn run(&self, is_quiet: bool) -> Result<(), Failure> {
        let targets = Targets::new(&self.models, &self.output, "edgemesh")?;
        for (model, target) in targets.pairs() {
            let LoadedMesh { name, mesh, instanced, report, .. } =
                load_input(&self.input, model, true, true, is_quiet)?;
            if !is_quiet {
                print_warnings(&name, &report);
            }
            let _progress = TerminalLine::start(format!("writing {}", target.display()), is_quiet);
            let bytes =
                to_bytes_with_instances(&mesh, &instanced, &name, &report, &self.layouts)
                    .map_err(|error| Failure::fault(format!("{}: {error}", target.display())))?;
            write_target(target, &bytes)?;
        }
        Ok(())
    }
}
