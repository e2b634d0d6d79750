//! Progress of loading, and its cancellation.

use std::fmt;
use std::ops::ControlFlow;
use std::path::Path;

use super::error::LoadError;

/// A stage of loading, displayed as `reading bunny.obj`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Stage<'a> {
    /// Reads the file at a path.
    Reading(&'a Path),
    /// Builds the edge mesh of the model with a name.
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

/// Receives the stages of loading; implemented for closures that take a [`Stage`].
pub trait Progress {
    /// Called when a stage begins; [`ControlFlow::Break`] cancels with [`LoadError::Canceled`].
    fn begin(&self, stage: Stage) -> ControlFlow<()>;

    /// Called when the last stage ends. Default: does nothing.
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

/// A running stage, which ends on drop.
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
