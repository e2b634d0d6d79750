//! Warnings about techniques, on standard error.

use crate::technique::mistake::Mistakes;

/// Prints mistakes.
#[expect(clippy::print_stderr, reason = "messages of a command")]
pub(super) fn print_mistakes(mistakes: &Mistakes, is_quiet: bool) {
    if !is_quiet && !mistakes.list.is_empty() {
        eprint!("{mistakes}");
    }
}

/// Prints warnings as they arise.
pub(super) fn warn(is_quiet: bool) -> impl FnMut(&Mistakes) {
    move |mistakes| print_mistakes(mistakes, is_quiet)
}
