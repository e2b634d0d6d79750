//! Work on threads of its own, while the window goes on: it says what it does, can be
//! cancelled, and cannot take the window with it.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use crate::error::Error;

/// What is told while work is done: each stage as it begins; false ends the work.
pub type Tell<'a> = &'a (dyn Fn(&str) -> bool + Sync);

/// Work under way. What is dropped is cancelled: it ends at its next stage.
#[derive(Debug)]
pub struct Background<T> {
    result: Receiver<Result<T, Error>>,
    stage: Arc<Mutex<String>>,
    is_cancelled: Arc<AtomicBool>,
    /// Since when.
    pub started: Instant,
}

impl<T: Send + 'static> Background<T> {
    /// Begins; `wake` is called whenever there is something new to show.
    #[must_use]
    pub fn start(
        wake: impl Fn() + Send + Sync + 'static,
        body: impl FnOnce(Tell) -> Result<T, Error> + Send + 'static,
    ) -> Self {
        let (sender, result) = channel();
        let stage = Arc::new(Mutex::new(String::new()));
        let is_cancelled = Arc::new(AtomicBool::new(false));
        let (told, cancelled) = (stage.clone(), is_cancelled.clone());
        std::thread::spawn(move || {
            let tell = |what: &str| {
                what.clone_into(&mut told.lock().unwrap_or_else(PoisonError::into_inner));
                wake();
                !cancelled.load(Ordering::Relaxed)
            };
            // A fault of ours must not take the window with it.
            let work = std::panic::AssertUnwindSafe(|| body(&tell));
            let done = std::panic::catch_unwind(work).unwrap_or_else(|_| {
                let stage = told.lock().unwrap_or_else(PoisonError::into_inner).clone();
                Err(Error::Internal(format!("internal error while {stage}; please report it")))
            });
            // Nobody waits for what was cancelled.
            let _ = sender.send(done);
            wake();
        });
        Self { result, stage, is_cancelled, started: Instant::now() }
    }

    /// What is being done.
    #[must_use]
    pub fn stage(&self) -> String {
        self.stage.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// What came out, once it is done.
    #[must_use]
    pub fn take(&self) -> Option<Result<T, Error>> {
        self.result.try_recv().ok()
    }

    /// Ends the work at its next stage.
    pub fn cancel(&self) {
        self.is_cancelled.store(true, Ordering::Relaxed);
    }

    #[cfg(test)]
    pub(super) fn wait(&self) -> Result<T, Error> {
        self.result.recv_timeout(std::time::Duration::from_secs(60)).unwrap()
    }
}

impl<T> Drop for Background<T> {
    fn drop(&mut self) {
        self.is_cancelled.store(true, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_tells_its_stages_and_ends_where_it_is_cancelled() {
        let (sender, receiver) = channel();
        let (go_on, wait) = channel::<()>();
        let work = Background::start(
            || {},
            move |tell| {
                assert!(tell("first"));
                sender.send(()).unwrap();
                wait.recv().unwrap();
                if tell("second") { Ok(7) } else { Err(Error::Canceled) }
            },
        );
        receiver.recv().unwrap();
        assert_eq!(work.stage(), "first");
        assert!(work.take().is_none());
        work.cancel();
        go_on.send(()).unwrap();
        assert!(matches!(work.wait(), Err(Error::Canceled)));
    }

    #[test]
    fn a_panic_is_an_error() {
        let work: Background<()> = Background::start(
            || {},
            |tell| {
                tell("counting");
                panic!("of a test");
            },
        );
        let message = work.wait().unwrap_err().to_string();
        assert_eq!(message, "internal error while counting; please report it");
    }
}
