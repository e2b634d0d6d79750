//! Turns the result of a command into the exit status of its process.

use std::panic::UnwindSafe;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag::register_conditional_shutdown;

use super::failure::{ExitStatus, Failure};

/// Runs the body of a command and returns its exit status; errors are printed here only.
///
/// SIGINT ends the process with 130, SIGTERM with 143. A panic is printed as an internal error and
/// gives 70.
#[expect(clippy::print_stderr, reason = "the one handler of errors")]
pub fn run(body: impl FnOnce() -> Result<(), Failure> + UnwindSafe) -> ExitCode {
    for (signal, status) in [(SIGINT, 130), (SIGTERM, 143)] {
        // If the handler cannot be set, the signal ends the process by default.
        let _ = register_conditional_shutdown(signal, status, Arc::new(AtomicBool::new(true)));
    }
    std::panic::set_hook(Box::new(|panic| {
        eprintln!("error: internal error; please report it with the command and the file: {panic}");
    }));
    match std::panic::catch_unwind(body) {
        Ok(Ok(())) => ExitCode::SUCCESS,
        Ok(Err(failure)) => {
            if !failure.message.is_empty() {
                eprintln!("error: {}", failure.message);
            }
            failure.status.into()
        }
        Err(_) => ExitStatus::INTERNAL.into(),
    }
}
