//! Loads inputs and shows the stages on the terminal.

use std::path::Path;

use super::progress::TerminalProgress;
use crate::arguments::InputArguments;
use crate::load::{LoadError, LoadOptions, LoadedMesh, load};

/// Loads one input of a verb; `with_fill` builds the fill, for verbs that write it, and keeps the
/// rig. `with_instances` keeps meshes that have several places once.
///
/// # Errors
/// As [`load`].
pub(super) fn load_input(
    input: &InputArguments,
    path: &Path,
    with_fill: bool,
    with_instances: bool,
    is_quiet: bool,
) -> Result<LoadedMesh, LoadError> {
    let options =
        LoadOptions { with_fill, with_rig: with_fill, with_instances, ..input.load_options() };
    load(path, &options, &TerminalProgress::new(is_quiet))
}
