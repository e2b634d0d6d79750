//! A lost graphics device: how the window notices, and what it hands over to the next one.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use super::loading::LoadOrder;
use super::session::Session;

/// What one window hands over to the next.
#[derive(Debug)]
pub(super) struct WindowHandover {
    pub(super) session: Session,
    /// Models that are not loaded yet.
    pub(super) to_load: Option<LoadOrder>,
    /// Whether this is the first window.
    pub(super) is_new: bool,
}

/// Whether the device of a window is lost.
#[derive(Debug, Default)]
pub(super) struct DeviceLoss {
    pub(super) is_lost: AtomicBool,
    device: Mutex<Option<wgpu::Device>>,
    /// Whether the window has drawn a frame.
    pub(super) is_shown: AtomicBool,
}

impl DeviceLoss {
    /// Destroys the device. The loss is noted here, since the callback for a destroyed device
    /// comes late.
    pub(super) fn lose(&self) {
        self.is_lost.store(true, Ordering::Relaxed);
        if let Some(device) = &*self.device.lock().unwrap_or_else(PoisonError::into_inner) {
            device.destroy();
        }
    }

    /// Whether the device is lost. Polls it, since the callback runs only then.
    pub(super) fn is_lost(&self) -> bool {
        if let Some(device) = &*self.device.lock().unwrap_or_else(PoisonError::into_inner) {
            let _ = device.poll(wgpu::PollType::Poll);
        }
        self.is_lost.load(Ordering::Relaxed)
    }
}

/// Records a lost device and uncaptured errors, which would otherwise end the program.
pub(super) fn watch_device(
    device: &wgpu::Device,
    context: &egui::Context,
    loss: &Arc<DeviceLoss>,
    faults: &Arc<Mutex<Vec<String>>>,
) {
    *loss.device.lock().unwrap_or_else(PoisonError::into_inner) = Some(device.clone());
    let (noted, repaint) = (loss.clone(), context.clone());
    device.set_device_lost_callback(move |reason, what| {
        log::error!("the graphics adapter was lost ({reason:?}): {what}");
        noted.is_lost.store(true, Ordering::Relaxed);
        repaint.request_repaint();
    });
    let (loss, faults) = (loss.clone(), faults.clone());
    device.on_uncaptured_error(Arc::new(move |error| {
        // A lost device causes many more errors, which say nothing new.
        if loss.is_lost.load(Ordering::Relaxed) {
            return;
        }
        let text = format!("internal graphics error, please report it: {error}");
        log::error!("{text}");
        let mut faults = faults.lock().unwrap_or_else(PoisonError::into_inner);
        if !faults.contains(&text) {
            faults.push(text);
        }
    }));
}
