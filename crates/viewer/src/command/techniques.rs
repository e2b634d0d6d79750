//! `viewer techniques`: lists, checks and prints techniques.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use edgemesh::command::{Failure, print_to_stdout};

use super::failure::SHADER;
use super::warnings::print_mistakes;
use crate::arguments::LibraryArguments;
use crate::error::Error;
use crate::technique::library::Library;
use crate::technique::mistake::Mistakes;
use crate::technique::plan::Plan;
use crate::technique::print::technique_text;
use crate::technique::program::ShaderFiles;

const EXAMPLES: &str = "Examples:\n  \
    viewer techniques list\n  \
    viewer techniques print toon\n  \
    viewer techniques check mine.toml";

/// Lists techniques, checks technique files, and prints passes
#[derive(Debug, Clone, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct TechniquesCommand {
    #[command(subcommand)]
    verb: Verb,
    #[command(flatten)]
    library: LibraryArguments,
}

#[derive(Debug, Clone, Subcommand)]
enum Verb {
    /// List all techniques with their descriptions
    List,
    /// Report all mistakes in technique files and their shaders
    Check {
        /// The files
        #[arg(value_name = "FILE", required = true)]
        files: Vec<PathBuf>,
    },
    /// Print the passes of a technique with their variables, and the textures between them
    Print {
        /// Name of a technique, or a technique file
        #[arg(value_name = "NAME|FILE")]
        name: String,
    },
}

impl TechniquesCommand {
    pub(super) fn run(&self, is_quiet: bool) -> Result<(), Failure> {
        let library = self.library.load();
        match &self.verb {
            Verb::List => {
                print_mistakes(library.mistakes(), is_quiet);
                print_to_stdout(list(&library).as_bytes())
            }
            Verb::Check { files } => self.check(&library, files, is_quiet),
            Verb::Print { name } => {
                let (technique, warnings) = library.technique(name).map_err(Error::from)?;
                print_mistakes(&warnings, is_quiet);
                let shaders = ShaderFiles::new(&technique.folders, self.library.shaders.clone());
                let plan = Plan::of(&technique, &shaders).map_err(Error::from)?;
                print_to_stdout(technique_text(&technique, &plan).as_bytes())
            }
        }
    }

    /// Reports every mistake in every file.
    fn check(&self, library: &Library, files: &[PathBuf], is_quiet: bool) -> Result<(), Failure> {
        let mut all = Mistakes::default();
        let mut wrong_files = 0;
        for file in files {
            let mut mistakes = library.check(file, self.library.shaders.as_deref());
            print_mistakes(&mistakes.take_warnings(), is_quiet);
            if mistakes.has_errors() {
                all.append(mistakes);
                wrong_files += 1;
            }
        }
        if wrong_files == 0 {
            return Ok(());
        }
        let count = all.list.len();
        let plural = if count == 1 { "mistake" } else { "mistakes" };
        let text = all.text();
        let message =
            format!("{text}\n\n{count} {plural} in {wrong_files} of {} files", files.len());
        Err(Failure { message, status: SHADER })
    }
}

fn list(library: &Library) -> String {
    let width = library.technique_names().map(str::len).max().unwrap_or_default();
    let line = |name: &str| {
        let about = match library.technique(name) {
            Ok((technique, _)) => technique.about,
            Err(_) => "has mistakes; see viewer techniques print".to_owned(),
        };
        format!("{name:<width$}  {about}\n")
    };
    library.technique_names().map(line).collect()
}
