//! The verbs of `edgemesh`, and what they share with `viewer`: exit statuses, messages,
//! output.
//!
//! Results go to standard output, messages to standard error. A message says what is wrong,
//! where, and what to do. The library's errors become messages and exit statuses in
//! `failure`, and name options only there.

pub mod build;
pub mod export;
mod failure;
pub mod info;
mod loading;
pub mod manual;
mod messages;
mod output;
mod progress;
mod run;
mod target;
pub mod validate;

pub use failure::{ExitStatus, Failure};
pub use messages::{MessageOptions, print_warnings};
pub use output::{print_to_stdout, to_json};
pub use progress::TerminalProgress;
pub use run::run;
