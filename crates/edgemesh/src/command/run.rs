//! Turns the result of a command into the exit status of its process.

use std::panic::UnwindSafe;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag::register_conditional_shutdown;

use super::failure::{ExitStatus, Failure};
use super::messages::print_error;
use crate::format::whole_file::{before_first_file, remove_unfinished};

/// Runs the body of a command and returns its exit status; errors that end it are
/// printed here only.
///
/// SIGINT ends the process with 130, SIGTERM with 143; neither leaves a temporary file. A panic is
/// printed as an internal error and gives 70.
#[expect(clippy::print_stderr, reason = "the one handler of errors")]
pub fn run(body: impl FnOnce() -> Result<(), Failure> + UnwindSafe) -> ExitCode {
    exit_on_signals();
    std::panic::set_hook(Box::new(|panic| {
        eprintln!("error: internal error; please report it with the command and the file: {panic}");
    }));
    let result = std::panic::catch_unwind(body);
    // Other threads may still write, if the window was closed meanwhile.
    std::mem::forget(remove_unfinished());
    match result {
        Ok(Ok(())) => ExitCode::SUCCESS,
        Ok(Err(failure)) => {
            print_error(&failure);
            failure.status.into()
        }
        Err(_) => ExitStatus::INTERNAL.into(),
    }
}

/// Ends the process at a signal: at once as long as it has made no temporary file, later from a
/// thread that removes these first.
fn exit_on_signals() {
    let at_once = Arc::new(AtomicBool::new(true));
    for signal in [SIGINT, SIGTERM] {
        // If the handler cannot be set, the signal ends the process by default.
        let _ = register_conditional_shutdown(signal, 128 + signal, Arc::clone(&at_once));
    }
    #[cfg(unix)]
    before_first_file(move || {
        // Without a thread that waits, the process still ends at once.
        at_once.store(wait_for_signals().is_err(), Ordering::Relaxed);
    });
}

/// Starts a thread that waits for signals: a handler may not remove files itself.
#[cfg(unix)]
fn wait_for_signals() -> std::io::Result<()> {
    use signal_hook::iterator::Signals;
    use signal_hook::low_level::exit;

    let mut signals = Signals::new([SIGINT, SIGTERM])?;
    let wait = move || {
        if let Some(signal) = signals.forever().next() {
            let _no_files_begin = remove_unfinished();
            exit(128 + signal);
        }
    };
    std::thread::Builder::new().name("signals".into()).spawn(wait)?;
    Ok(())
}
