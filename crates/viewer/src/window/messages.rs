//! Messages of the window: mistakes in a technique stay until they are mended, errors until
//! they are dismissed, notes for some seconds.

use std::time::{Duration, Instant};

/// How long a note is shown.
const NOTE_STAYS: Duration = Duration::from_secs(6);

/// Messages of the window.
#[derive(Debug, Default)]
pub struct Messages {
    /// The mistakes of the technique that cannot be drawn.
    pub(crate) technique: Option<String>,
    /// Errors that are not dismissed yet.
    pub(crate) errors: Vec<String>,
    notes: Vec<(Instant, String)>,
}

impl Messages {
    /// Shows a note for some seconds.
    pub fn note(&mut self, text: impl Into<String>) {
        self.notes.push((Instant::now(), text.into()));
    }

    /// Shows an error until it is dismissed; an equal one that is already shown is not
    /// repeated.
    pub fn error(&mut self, text: impl Into<String>) {
        let text = text.into();
        if !self.errors.contains(&text) {
            self.errors.push(text);
        }
    }

    /// The notes to show, and when the next of them ends.
    pub(crate) fn notes(&mut self) -> (Vec<&str>, Option<Duration>) {
        self.notes.retain(|(since, _)| since.elapsed() < NOTE_STAYS);
        let next = self.notes.iter().map(|(since, _)| NOTE_STAYS.saturating_sub(since.elapsed()));
        let next = next.min();
        (self.notes.iter().map(|(_, text)| text.as_str()).collect(), next)
    }
}
