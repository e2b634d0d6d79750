//! Results on standard output.

use std::io::{self, Write as _};

use serde::Serialize;

use super::failure::{ExitStatus, Failure};

/// Writes `bytes` to standard output; a closed pipe is not an error.
///
/// # Errors
/// Fails if standard output cannot be written for another reason, such as a full disk.
pub fn print_to_stdout(bytes: &[u8]) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(bytes).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::fault(format!("standard output: cannot be written: {error}")))
        }
        _ => Ok(()),
    }
}

/// `value` as JSON with a final line end.
///
/// # Errors
/// Fails if `value` cannot be written as JSON, which is an internal error.
pub fn to_json(value: &impl Serialize) -> Result<String, Failure> {
    serde_json::to_string_pretty(value).map(|json| json + "\n").map_err(|error| Failure {
        message: format!("internal error: cannot write JSON: {error}"),
        status: ExitStatus::INTERNAL,
    })
}
