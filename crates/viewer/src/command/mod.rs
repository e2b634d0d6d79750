//! The `viewer` command line.

mod adapters;
mod compare_strokes;
mod components;
mod failure;
mod render;
mod techniques;
mod warnings;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::error::ErrorKind;
use clap::parser::ValueSource;
use clap::{ArgMatches, Args, CommandFactory as _, FromArgMatches as _, Parser, Subcommand};
use edgemesh::command::{CompletionsCommand, Failure, ManCommand, MessageOptions, run};

use crate::arguments::PictureArguments;
#[cfg(feature = "window")]
use crate::window::recipe::Recipe;

/// Draws 3D models as line art; opens a window if no command is given
#[derive(Debug, Parser)]
#[command(version, propagate_version = true)]
#[command(after_help = EXAMPLES)]
struct Viewer {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    window: Box<WindowCommand>,
    #[command(flatten)]
    messages: MessageOptions,
}

const EXAMPLES: &str = "Examples:\n  \
    viewer\n  \
    viewer bunny.obj --technique pen\n  \
    viewer render bunny.obj -o bunny.png";

/// Opens the window.
#[derive(Debug, Args)]
struct WindowCommand {
    /// Models (OBJ, PLY, STL, glTF, VRML, OFF, 3MF), edge meshes, or scene files (.toml)
    /// [default: a demo model]
    #[arg(value_name = "MODEL")]
    models: Vec<PathBuf>,
    #[command(flatten)]
    picture: PictureArguments,
}

impl WindowCommand {
    #[cfg(feature = "window")]
    fn run(self) -> Result<(), Failure> {
        let library = self.picture.library.load();
        let recipe = Recipe::new(&self.models, self.picture, &library)?;
        Ok(crate::window::run(library, recipe)?)
    }

    #[cfg(not(feature = "window"))]
    fn run(self) -> Result<(), Failure> {
        Err(Failure::usage(
            "this viewer was built without the feature `window`; viewer render draws without one",
        ))
    }
}

#[derive(Debug, Subcommand)]
enum Command {
    // Boxed, since these have far more options than the others.
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

/// An argument of the window that was given, for a message.
fn window_option(matches: &ArgMatches) -> Option<String> {
    let command = Viewer::command();
    let is_given = |id: &str| {
        let is_known = matches.try_contains_id(id).unwrap_or(false);
        is_known && matches.value_source(id) == Some(ValueSource::CommandLine)
    };
    let own = command.get_arguments().filter(|argument| !argument.is_global_set());
    let given = own.into_iter().find(|argument| is_given(argument.get_id().as_str()))?;
    Some(given.get_long().map_or_else(|| "a model".to_owned(), |name| format!("--{name}")))
}

/// Parses and runs the command line; returns the exit status.
#[must_use]
pub fn main() -> ExitCode {
    let matches = Viewer::command().get_matches();
    let arguments = Viewer::from_arg_matches(&matches).unwrap_or_else(|error| error.exit());
    if let (Some(verb), Some(option)) = (matches.subcommand_name(), window_option(&matches)) {
        let what = format!("{option} stands before '{verb}'; put it after the command");
        Viewer::command().error(ErrorKind::ArgumentConflict, what).exit();
    }
    arguments.messages.start_logging();
    let Some(command) = arguments.command else {
        return run(std::panic::AssertUnwindSafe(move || arguments.window.run()));
    };
    run(move || match command {
        Command::Render(command) => command.run(arguments.messages.quiet),
        Command::CompareStrokes(command) => command.run(arguments.messages.quiet),
        Command::Components(command) => command.run(arguments.messages.quiet),
        Command::Techniques(command) => command.run(arguments.messages.quiet),
        Command::Adapters(command) => command.run(),
        Command::Completions(command) => command.run(Viewer::command()),
        Command::Man(command) => command.run(Viewer::command()),
    })
}
