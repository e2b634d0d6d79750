//! The verbs of `edgemesh`, and the exit statuses, messages and output that `viewer` shares.
//!
//! Part of the two programs and hidden from the documentation; not meant for others.
//!
//! Results go to standard output, messages to standard error. A message says what is wrong,
//! where, and what to do. The library's errors become messages and exit statuses in
//! `failure`, and name options only there.

mod build;
mod export;
mod failure;
mod info;
mod loading;
mod manual;
mod messages;
mod output;
mod progress;
mod run;
mod target;
mod validate;

pub use build::BuildCommand;
pub use export::ExportCommand;
pub use failure::{ExitStatus, Failure};
pub use info::InfoCommand;
pub use manual::{CompletionsCommand, ManCommand};
pub use messages::{MessageOptions, print_warnings};
pub use output::{print_to_stdout, to_json};
pub use progress::TerminalProgress;
pub use run::run;
pub use validate::ValidateCommand;
