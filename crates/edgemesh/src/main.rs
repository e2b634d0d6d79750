//! The `edgemesh` command.

use std::process::ExitCode;

use clap::{CommandFactory as _, Parser, Subcommand};
use edgemesh::command::{
    BuildCommand, CompletionsCommand, ExportCommand, InfoCommand, ManCommand, MessageOptions,
    ValidateCommand, run,
};

/// Turns triangle meshes into edge meshes and says what is in them
#[derive(Debug, Parser)]
#[command(version, propagate_version = true)]
struct Edgemesh {
    #[command(subcommand)]
    command: Command,
    #[command(flatten)]
    messages: MessageOptions,
}

#[derive(Debug, Subcommand)]
enum Command {
    Info(InfoCommand),
    Build(BuildCommand),
    Export(ExportCommand),
    Validate(ValidateCommand),
    #[command(hide = true)]
    Completions(CompletionsCommand),
    #[command(hide = true)]
    Man(ManCommand),
}

fn main() -> ExitCode {
    let arguments = Edgemesh::parse();
    arguments.messages.start_logging();
    let is_quiet = arguments.messages.quiet;
    run(move || match arguments.command {
        Command::Info(command) => command.run(is_quiet),
        Command::Build(command) => command.run(is_quiet),
        Command::Export(command) => command.run(is_quiet),
        Command::Validate(command) => command.run(is_quiet),
        Command::Completions(command) => command.run(Edgemesh::command()),
        Command::Man(command) => command.run(Edgemesh::command()),
    })
}
