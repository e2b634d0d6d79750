//! From a command's result to the end of its process.

use std::panic::UnwindSafe;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag::register_conditional_shutdown;

use super::failure::{ExitStatus, Failure};

/// Runs a command's body and turns its result into an exit status; the one place where
/// errors are printed.
///
/// Interrupts end the process with 130, terminations with 143. A panic is an internal error:
/// it is printed as one, and the status is 70.
#[expect(clippy::print_stderr, reason = "the one handler of errors")]
pub fn run(body: impl FnOnce() -> Result<(), Failure> + UnwindSafe) -> ExitCode {
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
            failure.status.into()
        }
        Err(_) => ExitStatus::INTERNAL.into(),
    }
}
