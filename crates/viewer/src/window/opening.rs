//! Opens the window, and another one after its graphics device was lost: the device belongs
//! to the window too, so it cannot be replaced in it.

use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use strokes::Gpu;

use super::app::Window;
use super::device_loss::{DeviceLoss, WindowHandover};
use super::loading::LoadOrder;
use super::recipe::Recipe;
use super::remembered::Remembered;
use super::session::Session;
use crate::error::Error;
use crate::technique::library::Library;

/// Name of the application, also for its storage.
const APP_ID: &str = "edgemesh";

/// The most recoveries from a lost device within [`RECOVERY_TIME`].
const MOST_RECOVERIES: usize = 3;

/// How long a recovery counts.
const RECOVERY_TIME: Duration = Duration::from_secs(10);

/// Opens the window and returns when it is closed.
///
/// After a lost device another window opens with the same session.
///
/// # Errors
/// If there is no adapter or no display; [`Error::AdapterLost`], if the device was lost too
/// often.
pub(crate) fn run(library: Library, recipe: Recipe) -> Result<(), Error> {
    let adapter = recipe.adapter().map(str::to_owned);
    let to_load = Some(LoadOrder { models: recipe.models.clone(), recipe: None });
    let session = Session::new(library, recipe, Remembered::default());
    let handover = Arc::new(Mutex::new(Some(WindowHandover { session, to_load, is_new: true })));
    let mut losses: Vec<Instant> = Vec::new();
    let mut is_after_panic = false;
    let latest = Arc::new(Mutex::new(Arc::new(DeviceLoss::default())));
    hush_panics_of_lost_devices(&latest);
    loop {
        let loss = Arc::new(DeviceLoss::default());
        latest.lock().unwrap_or_else(PoisonError::into_inner).clone_from(&loss);
        // eframe panics if the device is lost within a frame that it draws.
        let open = || open(&handover, &loss, adapter.as_deref());
        let opened = std::panic::catch_unwind(std::panic::AssertUnwindSafe(open));
        let has_handover = handover.lock().unwrap_or_else(PoisonError::into_inner).is_some();
        let is_unseen = !loss.is_shown.load(Ordering::Relaxed);
        if is_after_panic && is_unseen && has_handover && matches!(opened, Ok(Ok(()))) {
            // The event loop after a panic ends once before it starts again.
            is_after_panic = false;
            continue;
        }
        is_after_panic = opened.is_err();
        if !loss.is_lost() || !has_handover {
            return opened.unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        }
        losses.push(Instant::now());
        losses.retain(|time| time.elapsed() < RECOVERY_TIME);
        if losses.len() > MOST_RECOVERIES {
            let (times, seconds) = (losses.len(), RECOVERY_TIME.as_secs());
            return Err(Error::AdapterLost { times, seconds });
        }
        log::warn!("the graphics adapter was lost; the window opens again");
    }
}

/// Logs panics that another window follows; others are reported as before.
fn hush_panics_of_lost_devices(latest: &Arc<Mutex<Arc<DeviceLoss>>>) {
    let (latest, before) = (latest.clone(), std::panic::take_hook());
    std::panic::set_hook(Box::new(move |panic| {
        let loss = latest.lock().unwrap_or_else(PoisonError::into_inner).clone();
        match loss.is_lost.load(Ordering::Relaxed) {
            true => log::info!("as the graphics adapter was lost: {panic}"),
            false => before(panic),
        }
    }));
}

/// Opens one window, until it is closed or its device is lost.
fn open(
    handover: &Arc<Mutex<Option<WindowHandover>>>,
    loss: &Arc<DeviceLoss>,
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
        // Dithering would change the colors of the picture.
        dithering: false,
        ..eframe::NativeOptions::default()
    };
    let (creator_handover, creator_loss) = (handover.clone(), loss.clone());
    let made = eframe::run_native(
        APP_ID,
        options,
        Box::new(move |context| {
            Ok(Box::new(Window::new(context, creator_handover, creator_loss)?))
        }),
    );
    made.map_err(window_error)
}

/// The adapter and the device, chosen as by `viewer render`.
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
            // Without an adapter no surface can be created; the error about adapters says
            // more.
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

/// Whether the system has display variables and none is set.
fn has_no_display() -> bool {
    let is_named = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    let has_names = cfg!(all(unix, not(target_os = "macos")));
    has_names && !["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"].iter().any(|name| is_named(name))
}
