//! What the window has to say: what is wrong with a technique, as long as it is wrong;
//! what happened, for a while.

use std::time::{Duration, Instant};

/// How long a note stays.
const NOTE_STAYS: Duration = Duration::from_secs(6);

/// What the window has to say.
#[derive(Debug, Default)]
pub struct Messages {
    /// What is wrong with what should be drawn; the picture is the last good one.
    pub technique: Option<String>,
    /// What went wrong and waits to be read.
    pub errors: Vec<String>,
    notes: Vec<(Instant, String)>,
}

impl Messages {
    /// Tells what happened; it goes away by itself.
    pub fn note(&mut self, text: impl Into<String>) {
        self.notes.push((Instant::now(), text.into()));
    }

    /// Tells what went wrong; it stays until it is dismissed. The same is told once.
    pub fn error(&mut self, text: impl Into<String>) {
        let text = text.into();
        if !self.errors.contains(&text) {
            self.errors.push(text);
        }
    }

    /// The notes that are not old, and when the next one will be.
    pub fn notes(&mut self) -> (Vec<&str>, Option<Duration>) {
        self.notes.retain(|(since, _)| since.elapsed() < NOTE_STAYS);
        let next = self.notes.iter().map(|(since, _)| NOTE_STAYS.saturating_sub(since.elapsed()));
        let next = next.min();
        (self.notes.iter().map(|(_, text)| text.as_str()).collect(), next)
    }
}
