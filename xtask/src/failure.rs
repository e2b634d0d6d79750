//! Why a task did not end well, and with which exit status it ends.

use std::fmt::Display;
use std::path::Path;

/// No suitable adapter: the same number as the `viewer` command's.
pub(crate) const NO_ADAPTER: u8 = 3;

/// A message for the person at the terminal and the exit status that goes with it.
#[derive(Debug)]
pub(crate) struct Failure {
    pub(crate) message: String,
    pub(crate) status: u8,
}

impl Failure {
    pub(crate) fn new(message: impl Into<String>) -> Self {
        Self { message: message.into(), status: 1 }
    }

    /// The command line is wrong.
    pub(crate) fn usage(message: &str) -> Self {
        Self { message: message.into(), status: 2 }
    }

    /// Something could not be done with a file or folder.
    pub(crate) fn file(doing: &str, path: &Path, reason: impl Display) -> Self {
        Self::new(format!("cannot {doing} {}: {reason}", path.display()))
    }
}
