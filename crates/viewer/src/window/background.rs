//! Work on other threads. It reports its stage, can be canceled, and a panic in it does not
//! end the window.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use crate::error::Error;

/// Reports the stage that begins; returns false if the work is canceled.
pub(crate) type Tell<'a> = &'a (dyn Fn(&str) -> bool + Sync);

/// Work on another thread. Dropping it cancels it: it ends at its next stage.
#[derive(Debug)]
pub(crate) struct Background<T> {
    result: Receiver<Result<T, Error>>,
    stage: Arc<Mutex<String>>,
    is_canceled: Arc<AtomicBool>,
    /// When the work started.
    pub(crate) started: Instant,
}

impl<T: Send + 'static> Background<T> {
    /// Starts `body` on a thread. `wake` is called whenever the stage changes and at the end.
    #[must_use]
    pub(crate) fn start(
        wake: impl Fn() + Send + Sync + 'static,
        body: impl FnOnce(Tell) -> Result<T, Error> + Send + 'static,
    ) -> Self {
        let (sender, result) = channel();
        let stage = Arc::new(Mutex::new(String::new()));
        let is_canceled = Arc::new(AtomicBool::new(false));
        let (told, canceled) = (stage.clone(), is_canceled.clone());
        std::thread::spawn(move || {
            let tell = |what: &str| {
                what.clone_into(&mut told.lock().unwrap_or_else(PoisonError::into_inner));
                wake();
                !canceled.load(Ordering::Relaxed)
            };
            // A panic in the work must not end the window.
            let work = std::panic::AssertUnwindSafe(|| body(&tell));
            let done = std::panic::catch_unwind(work).unwrap_or_else(|_| {
                let stage = told.lock().unwrap_or_else(PoisonError::into_inner).clone();
                Err(Error::Internal(format!("internal error while {stage}; please report it")))
            });
            // The receiver is gone if the work was canceled.
            let _ = sender.send(done);
            wake();
        });
        Self { result, stage, is_canceled, started: Instant::now() }
    }

    /// The current stage.
    #[must_use]
    pub(crate) fn stage(&self) -> String {
        self.stage.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// The result, once the work is done; `None` before, and after it was taken.
    #[must_use]
    pub(crate) fn take(&self) -> Option<Result<T, Error>> {
        self.result.try_recv().ok()
    }

    /// Ends the work at its next stage.
    pub(crate) fn cancel(&self) {
        self.is_canceled.store(true, Ordering::Relaxed);
    }

    #[cfg(test)]
    pub(super) fn wait(&self) -> Result<T, Error> {
        self.result.recv_timeout(std::time::Duration::from_secs(60)).unwrap()
    }
}

impl<T> Drop for Background<T> {
    fn drop(&mut self) {
        self.is_canceled.store(true, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_tells_its_stages_and_ends_where_it_is_canceled() {
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
