//! How loading reports its stages, and how it is canceled.

use std::fmt;
use std::ops::ControlFlow;
use std::path::Path;

use super::error::LoadError;

/// A stage of loading. Its text is for messages: `reading bunny.obj`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Stage<'a> {
    /// A file is read.
    Reading(&'a Path),
    /// The edge mesh of the model of a name is built.
    Building(&'a str),
}

impl fmt::Display for Stage<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Reading(path) => write!(formatter, "reading {}", path.display()),
            Self::Building(name) => write!(formatter, "building {name}"),
        }
    }
}

/// Receives the stages of loading. A closure that takes a [`Stage`] is one, too.
pub trait Progress {
    /// A stage begins; [`ControlFlow::Break`] ends the work with [`LoadError::Canceled`].
    fn begin(&self, stage: Stage) -> ControlFlow<()>;

    /// The stage that began last has ended. Default: nothing happens.
    fn end(&self) {}
}

/// Ignores the stages.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoProgress;

impl Progress for NoProgress {
    fn begin(&self, _stage: Stage) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

impl<F: Fn(Stage) -> ControlFlow<()>> Progress for F {
    fn begin(&self, stage: Stage) -> ControlFlow<()> {
        self(stage)
    }
}

/// A stage under way; it ends when this is dropped.
pub(super) struct StageGuard<'a>(&'a dyn Progress);

impl<'a> StageGuard<'a> {
    /// Begins a stage.
    ///
    /// # Errors
    /// [`LoadError::Canceled`] if `progress` ends the work.
    pub(super) fn begin(progress: &'a dyn Progress, stage: Stage) -> Result<Self, LoadError> {
        match progress.begin(stage) {
            ControlFlow::Continue(()) => Ok(Self(progress)),
            ControlFlow::Break(()) => Err(LoadError::Canceled),
        }
    }
}

impl Drop for StageGuard<'_> {
    fn drop(&mut self) {
        self.0.end();
    }
}
