//! Shell completions and manual pages, generated from the definitions of the arguments.

use std::path::PathBuf;

use clap::{Args, Command};
use clap_complete::Shell;

use super::failure::Failure;
use super::output::print_to_stdout;
use crate::format::whole_file::write_file;

/// Prints the completion script of a shell
#[derive(Debug, Clone, Args)]
pub struct CompletionsCommand {
    /// Shell that reads the script
    pub shell: Shell,
}

/// Prints the manual page, or writes the pages of all commands to a folder
#[derive(Debug, Clone, Args)]
pub struct ManCommand {
    /// Folder for the pages, one for each command
    #[arg(short, long, value_name = "FOLDER")]
    pub output: Option<PathBuf>,
}

impl CompletionsCommand {
    /// Prints the completions of `program`.
    ///
    /// # Errors
    /// Fails if standard output cannot be written.
    pub fn run(&self, mut program: Command) -> Result<(), Failure> {
        let name = program.get_name().to_owned();
        let mut text = Vec::new();
        clap_complete::generate(self.shell, &mut program, name, &mut text);
        print_to_stdout(&text)
    }
}

impl ManCommand {
    /// Prints or writes the pages of `program`.
    ///
    /// # Errors
    /// Fails if standard output or a page cannot be written.
    pub fn run(&self, program: Command) -> Result<(), Failure> {
        let Some(folder) = &self.output else {
            return print_to_stdout(&page(&program)?);
        };
        let name = program.get_name().to_owned();
        write_file(&folder.join(format!("{name}.1")), &page(&program)?)?;
        for command in program.get_subcommands().filter(|command| !command.is_hide_set()) {
            let full_name = format!("{name}-{}", command.get_name());
            let command = command.clone().display_name(full_name.clone());
            write_file(&folder.join(format!("{full_name}.1")), &page(&command)?)?;
        }
        Ok(())
    }
}

fn page(command: &Command) -> Result<Vec<u8>, Failure> {
    let mut text = Vec::new();
    clap_mangen::Man::new(command.clone())
        .render(&mut text)
        .map_err(|error| Failure::fault(format!("cannot make the manual page: {error}")))?;
    Ok(text)
}
