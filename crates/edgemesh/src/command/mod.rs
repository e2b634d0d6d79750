//! What the two commands share: exit statuses, options, messages, output.
//!
//! Results go to standard output, messages to standard error. A message says
//! what is wrong, where, and what to do. Files are written beside their target
//! and renamed into place.

pub mod build;
pub mod export;
pub mod info;
pub mod input;
pub mod manual;
pub mod marks;
pub mod options;
mod output;
mod progress;
mod target;
pub mod validate;

use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

pub use output::{print_to_stdout, write_file};
pub use progress::{Listener, Progress};
use serde::Serialize;
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag::register_conditional_shutdown;

use crate::format::read::{ReadError, ReadErrorKind};
use crate::report::{Report, Warning, place_in};

/// What a command's exit status means; scripts rely on the numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExitStatus {
    /// The input or the output is at fault.
    Fault = 1,
    /// The command line is wrong.
    Usage = 2,
    /// No suitable adapter.
    NoAdapter = 3,
    /// A shader or technique is wrong.
    Shader = 4,
    /// The picture differs from the reference.
    Differs = 5,
    /// A fault of our own.
    Internal = 70,
}

/// Why a command ends early: a message and an exit status.
#[derive(Debug)]
pub struct Failure {
    /// One message, without "error:" before it.
    pub message: String,
    /// The exit status.
    pub status: ExitStatus,
}

impl Failure {
    /// A fault of the input or the output.
    #[must_use]
    pub fn fault(message: impl Into<String>) -> Self {
        Self { message: message.into(), status: ExitStatus::Fault }
    }

    /// A wrong command line.
    #[must_use]
    pub fn usage(message: impl Into<String>) -> Self {
        Self { message: message.into(), status: ExitStatus::Usage }
    }
}

impl From<ReadError> for Failure {
    fn from(error: ReadError) -> Self {
        let status = match error.kind {
            ReadErrorKind::Internal => ExitStatus::Internal,
            _ => ExitStatus::Fault,
        };
        Self { message: error.to_string(), status }
    }
}

/// Runs a command's body and turns its result into an exit status; the one
/// place where errors are printed.
///
/// Interrupts end the process with 130, terminations with 143. A panic is a
/// fault of ours: it is said so, and the status is 70.
#[expect(clippy::print_stderr, reason = "the one handler of errors")]
pub fn run(body: impl FnOnce() -> Result<(), Failure> + std::panic::UnwindSafe) -> ExitCode {
    for (signal, status) in [(SIGINT, 130), (SIGTERM, 143)] {
        // Without the handler a signal still ends the process, by its default.
        let _ = register_conditional_shutdown(signal, status, Arc::new(AtomicBool::new(true)));
    }
    std::panic::set_hook(Box::new(|panic| {
        eprintln!("error: internal error, please report it with the command and the file: {panic}");
    }));
    match std::panic::catch_unwind(body) {
        Ok(Ok(())) => ExitCode::SUCCESS,
        Ok(Err(failure)) => {
            if !failure.message.is_empty() {
                eprintln!("error: {}", failure.message);
            }
            ExitCode::from(failure.status as u8)
        }
        Err(_) => ExitCode::from(ExitStatus::Internal as u8),
    }
}

/// `value` as JSON with a final line end.
///
/// # Errors
/// Where it cannot be written as JSON, which is a fault of ours.
pub fn to_json(value: &impl Serialize) -> Result<String, Failure> {
    serde_json::to_string_pretty(value).map(|json| json + "\n").map_err(|error| Failure {
        message: format!("internal error: no JSON: {error}"),
        status: ExitStatus::Internal,
    })
}

/// The failure that warnings are with `--strict`: one message a kind.
fn strict_failure(model_name: &str, report: &Report) -> Failure {
    let lines: Vec<String> =
        report.warnings().iter().map(|warning| warning_line(model_name, "", warning)).collect();
    Failure::fault(lines.join("\nerror: "))
}

/// A warning with its first place, the word for its level, how many more there are, and its code.
#[must_use]
pub fn warning_line(model_name: &str, level: &str, warning: &Warning) -> String {
    let Warning { code, count, place, message } = warning;
    let more = match count {
        1 => String::new(),
        count => format!(" (and {} more)", count - 1),
    };
    format!("{}: {level}{message}{more} [{code}]", place_in(model_name, place.as_ref()))
}

/// Prints each kind of warning once, with its first place and how many more
/// there are.
#[expect(clippy::print_stderr, reason = "messages go to standard error")]
pub fn print_warnings(model_name: &str, report: &Report) {
    for warning in report.warnings() {
        eprintln!("{}", warning_line(model_name, "warning: ", warning));
    }
}
