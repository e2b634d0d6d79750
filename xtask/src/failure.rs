//! The error of a task and its exit status.

use std::fmt::Display;
use std::path::Path;

/// There is no suitable adapter: the same exit status as that of `viewer`.
pub(crate) const NO_ADAPTER: u8 = 3;

/// A message for the terminal and an exit status.
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

    /// An operation on a file or folder failed.
    pub(crate) fn file(doing: &str, path: &Path, reason: impl Display) -> Self {
        Self::new(format!("cannot {doing} {}: {reason}", path.display()))
    }
}
