//! The `edgemesh` command.

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use edgemesh::command::info::InfoCommand;
use edgemesh::command::{run, start_logging};

/// Turns triangle meshes into edge meshes and says what is in them
#[derive(Debug, Parser)]
#[command(version, propagate_version = true)]
struct Edgemesh {
    #[command(subcommand)]
    command: Command,
    /// No warnings
    #[arg(short, long, global = true)]
    quiet: bool,
    /// More messages; twice for still more
    #[arg(short, long, global = true, action = clap::ArgAction::Count)]
    verbose: u8,
}

#[derive(Debug, Subcommand)]
enum Command {
    Info(InfoCommand),
}

fn main() -> ExitCode {
    let arguments = Edgemesh::parse();
    start_logging(arguments.verbose, arguments.quiet);
    run(move || match arguments.command {
        Command::Info(command) => command.run(arguments.quiet),
    })
}
