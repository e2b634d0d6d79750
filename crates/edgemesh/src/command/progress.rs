//! Shows the stage and its elapsed time on one line of standard error.
//!
//! The line appears on a terminal only, after a second, and is cleared at the end, so that scripts
//! and short runs never see it.

use std::cell::RefCell;
use std::io::{IsTerminal as _, stderr};
use std::ops::ControlFlow;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::{JoinHandle, spawn};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

use crate::load::{Progress, Stage};

/// Shows the stages of loading on the terminal.
#[derive(Debug)]
pub struct TerminalProgress {
    is_quiet: bool,
    line: RefCell<Option<TerminalLine>>,
}

impl TerminalProgress {
    /// A progress display, without output if `is_quiet`.
    #[must_use]
    pub const fn new(is_quiet: bool) -> Self {
        Self { is_quiet, line: RefCell::new(None) }
    }
}

impl Progress for TerminalProgress {
    fn begin(&self, stage: Stage) -> ControlFlow<()> {
        self.line.replace(Some(TerminalLine::start(stage.to_string(), self.is_quiet)));
        ControlFlow::Continue(())
    }

    fn end(&self) {
        self.line.take();
    }
}

/// The delay before the line appears.
const PATIENCE: Duration = Duration::from_secs(1);

/// A line on the terminal, cleared on drop.
#[derive(Debug)]
pub(super) struct TerminalLine {
    watcher: Option<(Sender<()>, JoinHandle<()>)>,
}

impl TerminalLine {
    /// Shows `what` after [`PATIENCE`] if standard error is a terminal.
    pub(super) fn start(what: String, is_quiet: bool) -> Self {
        if is_quiet || !stderr().is_terminal() {
            return Self { watcher: None };
        }
        let (sender, receiver) = channel();
        let thread = spawn(move || {
            if receiver.recv_timeout(PATIENCE) != Err(RecvTimeoutError::Timeout) {
                return;
            }
            let bar = ProgressBar::new_spinner().with_message(what).with_elapsed(PATIENCE);
            if let Ok(style) = ProgressStyle::with_template("{spinner} {msg} ({elapsed})") {
                bar.set_style(style);
            }
            bar.enable_steady_tick(Duration::from_millis(120));
            // Returns when the sender is dropped.
            let _ = receiver.recv();
            bar.finish_and_clear();
        });
        Self { watcher: Some((sender, thread)) }
    }
}

impl Drop for TerminalLine {
    fn drop(&mut self) {
        if let Some((sender, thread)) = self.watcher.take() {
            drop(sender);
            // A panic of this thread does not concern the work.
            let _ = thread.join();
        }
    }
}
