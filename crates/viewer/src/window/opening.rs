//! Opens the window, and opens another one where the graphics device was lost: the device
//! is the window's too, so it cannot be replaced beneath it.

use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use strokes::Gpu;

use super::app::Window;
use super::device_loss::{Kept, Lost};
use super::loading::ToLoad;
use super::recipe::Recipe;
use super::remembered::Remembered;
use super::session::Session;
use crate::error::Error;
use crate::technique::library::Library;

/// What the window is called, and where it remembers.
const APP_ID: &str = "edgemesh";

/// How often a lost device is replaced, within [`RECOVERY_TIME`].
const MOST_RECOVERIES: usize = 3;

/// How long recoveries count.
const RECOVERY_TIME: Duration = Duration::from_secs(10);

/// Opens the window and returns when it is closed.
///
/// A device that is lost takes its window with it: another window takes its place, with
/// the same session.
///
/// # Errors
/// If there is no adapter or no display; [`Error::AdapterLost`], if the device was lost again
/// and again.
pub(crate) fn run(library: Library, recipe: Recipe) -> Result<(), Error> {
    let adapter = recipe.adapter().map(str::to_owned);
    let to_load = Some(ToLoad { models: recipe.models.clone(), recipe: None });
    let session = Session::new(library, recipe, Remembered::default());
    let kept = Arc::new(Mutex::new(Some(Kept { session, to_load, is_new: true })));
    let mut losses: Vec<Instant> = Vec::new();
    let mut is_after_panic = false;
    let latest = Arc::new(Mutex::new(Arc::new(Lost::default())));
    hush_panics_of_lost_devices(&latest);
    loop {
        let lost = Arc::new(Lost::default());
        latest.lock().unwrap_or_else(PoisonError::into_inner).clone_from(&lost);
        // The window system's side of the window panics where it draws with a device that
        // is lost in that very frame.
        let open = || open(&kept, &lost, adapter.as_deref());
        let opened = std::panic::catch_unwind(std::panic::AssertUnwindSafe(open));
        let has_kept = kept.lock().unwrap_or_else(PoisonError::into_inner).is_some();
        let is_unseen = !lost.is_shown.load(Ordering::Relaxed);
        if is_after_panic && is_unseen && has_kept && matches!(opened, Ok(Ok(()))) {
            // The event loop that a panic has left ends once more before it begins.
            is_after_panic = false;
            continue;
        }
        is_after_panic = opened.is_err();
        if !lost.is_lost() || !has_kept {
            return opened.unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        }
        losses.push(Instant::now());
        losses.retain(|loss| loss.elapsed() < RECOVERY_TIME);
        if losses.len() > MOST_RECOVERIES {
            let (times, seconds) = (losses.len(), RECOVERY_TIME.as_secs());
            return Err(Error::AdapterLost { times, seconds });
        }
        log::warn!("the graphics adapter was lost; the window opens again");
    }
}

/// Has panics told as before, but for those that another window follows.
fn hush_panics_of_lost_devices(latest: &Arc<Mutex<Arc<Lost>>>) {
    let (latest, before) = (latest.clone(), std::panic::take_hook());
    std::panic::set_hook(Box::new(move |panic| {
        let lost = latest.lock().unwrap_or_else(PoisonError::into_inner).clone();
        match lost.is_lost.load(Ordering::Relaxed) {
            true => log::info!("as the graphics adapter was lost: {panic}"),
            false => before(panic),
        }
    }));
}

/// Opens one window, until it is closed or its device is lost.
fn open(
    kept: &Arc<Mutex<Option<Kept>>>,
    lost: &Arc<Lost>,
    adapter: Option<&str>,
) -> Result<(), Error> {
    let options = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("Edgemesh")
            .with_app_id(APP_ID)
            .with_inner_size([1280.0, 800.0])
            .with_min_inner_size([320.0, 240.0]),
        wgpu_options: egui_wgpu::WgpuConfiguration {
            wgpu_setup: window_setup(adapter).into(),
            ..egui_wgpu::WgpuConfiguration::default()
        },
        // What is drawn is drawn with the colours that files have.
        dithering: false,
        ..eframe::NativeOptions::default()
    };
    let (creator_kept, creator_lost) = (kept.clone(), lost.clone());
    let made = eframe::run_native(
        APP_ID,
        options,
        Box::new(move |context| Ok(Box::new(Window::new(context, creator_kept, creator_lost)?))),
    );
    made.map_err(window_error)
}

/// The adapter and the device, asked for as `viewer render` does.
fn window_setup(adapter: Option<&str>) -> egui_wgpu::WgpuSetupCreateNew {
    let mut setup = egui_wgpu::WgpuSetupCreateNew::without_display_handle();
    setup.instance_descriptor.backends = Gpu::backends();
    let wanted = adapter.map(str::to_owned);
    setup.native_adapter_selector = Some(Arc::new(move |adapters, surface| {
        Gpu::choose_adapter(adapters, wanted.as_deref(), surface).map_err(|error| error.to_string())
    }));
    setup.device_descriptor = Arc::new(Gpu::device_descriptor);
    setup
}

fn window_error(error: eframe::Error) -> Error {
    match error {
        eframe::Error::Wgpu(egui_wgpu::WgpuError::CreateSurfaceError(error)) => {
            // Without any adapter there is nothing to make a surface for.
            let none = Gpu::choose_adapter(&[], None, None).err();
            none.map_or_else(|| Error::WindowAdapter(error.to_string()), Error::Adapter)
        }
        eframe::Error::Wgpu(error) => {
            let text = error.to_string();
            let what = text.strip_prefix("Adapter selection failed: ").unwrap_or(&text);
            Error::WindowAdapter(what.to_owned())
        }
        eframe::Error::AppCreation(error) => match error.downcast::<Error>() {
            Ok(error) => *error,
            Err(error) => Error::Window(error.to_string()),
        },
        _ if has_no_display() => Error::NoDisplay,
        error => Error::NoWindow { reason: error.to_string() },
    }
}

/// Whether no display is named where displays have names.
fn has_no_display() -> bool {
    let is_named = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    let has_names = cfg!(all(unix, not(target_os = "macos")));
    has_names && !["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"].iter().any(|name| is_named(name))
}
