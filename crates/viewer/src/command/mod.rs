//! The `viewer` command line.

mod adapters;
mod render;

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use edgemesh::command::{run, start_logging};

/// Draws 3D models as line art
#[derive(Debug, Parser)]
#[command(version, propagate_version = true)]
struct Viewer {
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
    // Boxed: it has far more options than the others.
    Render(Box<render::RenderCommand>),
    Adapters(adapters::AdaptersCommand),
}

/// Reads the command line, does what it says, and returns the exit status.
#[must_use]
pub fn main() -> ExitCode {
    let arguments = Viewer::parse();
    start_logging(arguments.verbose, arguments.quiet);
    run(move || match arguments.command {
        Command::Render(command) => command.run(arguments.quiet),
        Command::Adapters(command) => command.run(),
    })
}
