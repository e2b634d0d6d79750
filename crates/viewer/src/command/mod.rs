//! The `viewer` command line.

mod adapters;
mod compare_strokes;
mod components;
mod options;
mod picture_arguments;
mod render;
mod techniques;

use std::process::ExitCode;

use clap::{CommandFactory as _, Parser, Subcommand};
use edgemesh::command::manual::{CompletionsCommand, ManCommand};
use edgemesh::command::options::MessageOptions;
use edgemesh::command::run;

/// Draws 3D models as line art
#[derive(Debug, Parser)]
#[command(version, propagate_version = true)]
struct Viewer {
    #[command(subcommand)]
    command: Command,
    #[command(flatten)]
    messages: MessageOptions,
}

#[derive(Debug, Subcommand)]
enum Command {
    // Boxed: these have far more options than the others.
    Render(Box<render::RenderCommand>),
    CompareStrokes(Box<compare_strokes::CompareStrokesCommand>),
    Components(components::ComponentsCommand),
    Techniques(techniques::TechniquesCommand),
    Adapters(adapters::AdaptersCommand),
    #[command(hide = true)]
    Completions(CompletionsCommand),
    #[command(hide = true)]
    Man(ManCommand),
}

/// Reads the command line, does what it says, and returns the exit status.
#[must_use]
pub fn main() -> ExitCode {
    let arguments = Viewer::parse();
    arguments.messages.start_logging();
    run(move || match arguments.command {
        Command::Render(command) => command.run(arguments.messages.quiet),
        Command::CompareStrokes(command) => command.run(arguments.messages.quiet),
        Command::Components(command) => command.run(arguments.messages.quiet),
        Command::Techniques(command) => command.run(arguments.messages.quiet),
        Command::Adapters(command) => command.run(),
        Command::Completions(command) => command.run(Viewer::command()),
        Command::Man(command) => command.run(Viewer::command()),
    })
}
