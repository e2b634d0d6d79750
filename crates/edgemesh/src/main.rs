//! The `edgemesh` command.

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use edgemesh::command::info::InfoCommand;
use edgemesh::command::options::MessageOptions;
use edgemesh::command::run;

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
}

fn main() -> ExitCode {
    let arguments = Edgemesh::parse();
    arguments.messages.start_logging();
    run(move || match arguments.command {
        Command::Info(command) => command.run(arguments.messages.quiet),
    })
}
