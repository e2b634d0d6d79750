//! The variable `run`, which every pass has.

use crate::technique::word::Word;

/// When a pass runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum RunMode {
    /// In every frame.
    Always,
    /// In the first frame only.
    Once,
    /// In the first frame, and again when a variable or the fragment program has changed.
    Changed,
}

impl RunMode {
    /// The name of the variable.
    pub(crate) const VARIABLE: &str = "run";
}

impl Word for RunMode {
    const WORDS: &'static [(&'static str, Self)] =
        &[("always", Self::Always), ("once", Self::Once), ("changed", Self::Changed)];
}
