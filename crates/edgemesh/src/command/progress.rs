//! A line on standard error while work takes long: what is done, and since when.
//!
//! It shows only on a terminal and only after a second, and is gone when the
//! work is done, so that scripts and quick work see nothing of it.

use std::io::{IsTerminal as _, stderr};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::{JoinHandle, spawn};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

use super::Failure;

/// Who is told what is being done.
#[derive(Clone, Copy)]
pub enum Listener<'a> {
    /// Nobody.
    Nobody,
    /// Who sits at the terminal, if standard error is one.
    Terminal,
    /// Called with each stage of the work as it begins; false ends the work.
    Other(&'a (dyn Fn(&str) -> bool + Sync)),
}

impl std::fmt::Debug for Listener<'_> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str(match self {
            Self::Nobody => "Nobody",
            Self::Terminal => "Terminal",
            Self::Other(_) => "Other",
        })
    }
}

impl Listener<'_> {
    /// Whoever is at the terminal, unless the command is to be quiet.
    #[must_use]
    pub const fn terminal(is_quiet: bool) -> Self {
        if is_quiet { Self::Nobody } else { Self::Terminal }
    }

    /// Says that a stage begins, which ends when the result is dropped.
    ///
    /// # Errors
    /// Where the listener wants no more of it.
    pub fn begin(&self, what: &str) -> Result<Progress, Failure> {
        match self {
            Self::Other(tell) if !tell(what) => Err(Failure::fault("it was cancelled")),
            Self::Terminal => Ok(Progress::start(what.to_owned(), false)),
            Self::Other(_) | Self::Nobody => Ok(Progress::start(String::new(), true)),
        }
    }
}

/// How long work may take without a word.
const PATIENCE: Duration = Duration::from_secs(1);

/// Shows the line until it is dropped.
#[derive(Debug)]
pub struct Progress {
    watcher: Option<(Sender<()>, JoinHandle<()>)>,
}

impl Progress {
    /// Says `what` is done, if it takes long and anybody is there to see it.
    #[must_use]
    pub fn start(what: String, is_quiet: bool) -> Self {
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
            // Ends when the sender is dropped.
            let _ = receiver.recv();
            bar.finish_and_clear();
        });
        Self { watcher: Some((sender, thread)) }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some((sender, thread)) = self.watcher.take() {
            drop(sender);
            // A panic there has nothing to say about the work.
            let _ = thread.join();
        }
    }
}
