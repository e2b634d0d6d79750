//! One frame of the window: results of other threads are taken, the pointer and keys act, the
//! canvas draws, panels are shown, and their requests are carried out.

use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use edgemesh::format::whole_file::write_file;
use egui::{CentralPanel, Panel, Sense, Ui};

use super::background::{Background, Tell};
use super::canvas::Canvas;
use super::device_loss::{DeviceLoss, WindowHandover, watch_device};
use super::error_text::{error_text, saving_text};
use super::hands::Hands;
use super::loading::{self, BuildKey, LoadOrder, LoadedScene, Loading};
use super::saving::{self, Order};
use super::session::{Request, Session, Work};
use super::thumbnails::{self, Thumbnail};
use super::watching::{Change, Watching};
use super::{desktop, panels, style};
use crate::error::Error;
use crate::technique::write::file_text;

/// The storage key of [`Remembered`](super::remembered::Remembered).
const REMEMBERED: &str = "remembered";

/// How soon statistics are asked for again if the GPU does not have them yet.
const ASK_AGAIN: Duration = Duration::from_millis(15);

/// The program's window.
pub(super) struct Window {
    session: Session,
    canvas: Canvas,
    hands: Hands,
    /// Models to load once the size of the picture is known.
    to_load: Option<LoadOrder>,
    loading: Option<Loading>,
    saving: Vec<Background<String>>,
    watching: Option<Watching>,
    thumbnails: Option<(Background<()>, Receiver<Thumbnail>)>,
    /// What was refused because unsaved marks would be lost; asking for it again does it.
    warned_of: Option<&'static str>,
    /// Results of dialogs on other threads.
    arrived: Receiver<Arrival>,
    sender: Sender<Arrival>,
    /// Size of the picture in pixels.
    size: [u32; 2],
    title: String,
    handover: Arc<Mutex<Option<WindowHandover>>>,
    loss: Arc<DeviceLoss>,
    /// Whether to lose the device on purpose: false before a frame, true within one.
    is_to_be_lost: Option<bool>,
    faults: Arc<Mutex<Vec<String>>>,
}

/// A result of another thread.
enum Arrival {
    Files(Vec<PathBuf>),
    TechniqueFile(PathBuf),
    PictureFile(PathBuf, Option<u32>),
    WindowFile(PathBuf),
    Fault(&'static str),
    WindowPixels(PathBuf, Arc<egui::ColorImage>),
}

impl Window {
    pub(super) fn new(
        context: &eframe::CreationContext,
        handover: Arc<Mutex<Option<WindowHandover>>>,
        loss: Arc<DeviceLoss>,
    ) -> Result<Self, Error> {
        let missing = |what: &str| Error::Window(what.to_owned());
        let before = handover.lock().unwrap_or_else(PoisonError::into_inner).take();
        let WindowHandover { mut session, to_load, is_new } =
            before.ok_or_else(|| missing("there is no session to show"))?;
        let window = context.wgpu_render_state.clone();
        let window = window.ok_or_else(|| missing("the window has no device"))?;
        let faults = Arc::new(Mutex::new(Vec::new()));
        watch_device(&window.device, &context.egui_ctx, &loss, &faults);
        if is_new {
            let stored = context.storage.and_then(|storage| eframe::get_value(storage, REMEMBERED));
            session.remembered = stored.unwrap_or_default();
        } else {
            session.move_on();
        }
        style::apply(&context.egui_ctx);
        desktop::follow_theme(&context.egui_ctx);
        let mut canvas = Canvas::new(&window)?;
        session.adapter.clone_from(&canvas.gpu().info.name);
        if let Some(scene) = &session.scene {
            canvas.take_scene(scene.clone(), None);
        }
        let (sender, arrived) = channel();
        Ok(Self {
            session,
            canvas,
            hands: Hands::default(),
            to_load,
            loading: None,
            saving: Vec::new(),
            watching: None,
            thumbnails: None,
            warned_of: None,
            arrived,
            sender,
            size: [1, 1],
            title: String::new(),
            handover,
            loss,
            is_to_be_lost: None,
            faults,
        })
    }

    fn take_loaded(&mut self, what: LoadOrder, loaded: LoadedScene) {
        let LoadedScene { models, scene, objects, renderer } = loaded;
        if let Some(recipe) = what.recipe {
            self.session.recipe = recipe;
        }
        if let Err(error) = self.session.take_scene(models, scene.clone(), objects) {
            self.session.messages.error(error_text(&error));
        }
        self.canvas.take_scene(scene, renderer);
    }

    /// Starts loading models, and cancels the load before.
    fn load(&mut self, what: LoadOrder, context: &egui::Context) {
        let recipe = what.recipe.as_ref().unwrap_or(&self.session.recipe);
        let request = loading::Request {
            models: what.models.clone(),
            load: recipe.load_options(),
            gpu: Some(self.canvas.gpu().clone()),
            library: self.session.library.clone(),
            build_key: BuildKey {
                technique: recipe.appearance.technique.clone(),
                is_transparent: recipe.appearance.is_transparent,
            },
            options: recipe.picture_options(self.size),
        };
        let context = context.clone();
        let wake = move || context.request_repaint();
        let work = Background::start(wake, |tell| loading::load(request, tell));
        self.loading = Some(Loading { what, work });
    }

    /// Loads models in place of the open ones, unless unsaved marks would be lost.
    fn replace(&mut self, what: LoadOrder, context: &egui::Context) {
        if !self.would_lose_marks("open") {
            self.load(what, context);
        }
    }

    /// Whether unsaved marks forbid an action. The first time it is reported; the second time
    /// the action is allowed.
    fn would_lose_marks(&mut self, what: &'static str) -> bool {
        let is_told = self.warned_of == Some(what);
        if !self.session.marking.has_changes() || is_told {
            return false;
        }
        self.warned_of = Some(what);
        self.session
            .messages
            .error(format!("Some marks are not saved: save them under Lines, or {what} again"));
        true
    }

    /// Takes the results of other threads.
    fn take_arrivals(&mut self, context: &egui::Context) {
        if let Some(loaded) = self.loading.as_ref().and_then(|loading| loading.work.take())
            && let Some(Loading { what, .. }) = self.loading.take()
        {
            match loaded {
                Ok(loaded) => self.take_loaded(what, loaded),
                Err(error) => self.session.messages.error(error_text(&error)),
            }
        }
        let mut done = Vec::new();
        self.saving.retain(|saving| {
            let result = saving.take();
            let goes_on = result.is_none();
            done.extend(result);
            goes_on
        });
        for result in done {
            match result {
                Ok(note) => self.session.messages.note(note),
                Err(error) => self.session.messages.error(saving_text(&error)),
            }
        }
        self.session.work.clear();
        if let Some(Loading { work: loading, .. }) = &self.loading {
            let work = Work { what: loading.stage(), since: loading.started, saving: None };
            self.session.work.push(work);
        }
        for (at, saving) in self.saving.iter().enumerate() {
            let work = Work { what: saving.stage(), since: saving.started, saving: Some(at) };
            self.session.work.push(work);
        }
        if !self.session.work.is_empty() {
            context.request_repaint_after(Duration::from_millis(100));
        }
        while let Ok(arrival) = self.arrived.try_recv() {
            match arrival {
                Arrival::Files(files) => self.open_files(files, context),
                Arrival::TechniqueFile(path) => self.save_technique(&path),
                Arrival::PictureFile(path, turntable) => {
                    self.save_picture(path, turntable, context);
                }
                Arrival::Fault(what) => self.session.messages.error(what),
                Arrival::WindowFile(path) => self.take_window_pixels(path, context),
                Arrival::WindowPixels(path, pixels) => {
                    let body = move |tell: Tell| saving::save_window(&path, &pixels, tell);
                    self.save_aside(body, context);
                }
            }
        }
        for fault in self.faults.lock().unwrap_or_else(PoisonError::into_inner).drain(..) {
            self.session.messages.error(fault);
        }
    }

    /// Watches the files of the technique and reads them again when they change.
    fn follow_files(&mut self, context: &egui::Context) {
        let folders = self.session.watched_folders();
        if self.watching.as_ref().is_none_or(|watching| !watching.is_of(&folders)) {
            let context = context.clone();
            let started = Watching::start(&folders, move || context.request_repaint());
            // Without a watcher, files are read only when they are opened.
            self.watching = started.inspect_err(|what| log::warn!("{what}")).ok();
        }
        let Some(change) = self.watching.as_ref().and_then(Watching::take) else { return };
        match self.session.read_again() {
            Ok(()) => self.canvas.forget(change),
            Err(error) if change == Change::Settled => {
                self.session.messages.technique = Some(error_text(&error));
            }
            Err(_) => {}
        }
    }

    /// Carries out the requests of panels and keys.
    fn answer(&mut self, context: &egui::Context, time: f64) {
        for request in std::mem::take(&mut self.session.requests) {
            match request {
                Request::ChooseFiles => self.ask(context, |dialog| {
                    let dialog = dialog.set_title("Open models");
                    dialog.pick_files().map(Arrival::Files)
                }),
                Request::Open(files) => self.open_files(files, context),
                Request::Reload => {
                    let models = self.session.recipe.models.clone();
                    self.replace(LoadOrder { models, recipe: None }, context);
                }
                Request::Cancel(None) => self.loading = None,
                Request::Cancel(Some(saving)) => {
                    if let Some(saving) = self.saving.get(saving) {
                        saving.cancel();
                    }
                }
                Request::SaveTechnique => {
                    let name = format!("{}.toml", self.session.recipe.appearance.technique.name);
                    self.ask(context, move |dialog| {
                        let dialog = dialog.set_title("Save technique").set_file_name(name);
                        let dialog = dialog.add_filter("Technique", &["toml"]);
                        dialog.save_file().map(Arrival::TechniqueFile)
                    });
                }
                Request::SavePicture(turntable) => self.ask(context, move |dialog| {
                    let dialog = match turntable {
                        None => dialog.set_title("Save picture").set_file_name("picture.png"),
                        Some(_) => dialog.set_title("Save turntable").set_file_name("turn.apng"),
                    };
                    let ends =
                        if turntable.is_some() { &["apng", "gif", "png"][..] } else { &["png"] };
                    let path = dialog.add_filter("Pictures", ends).save_file()?;
                    Some(Arrival::PictureFile(path, turntable))
                }),
                Request::SaveWindow => self.ask(context, |dialog| {
                    let dialog = dialog.set_title("Save window").set_file_name("window.png");
                    let path = dialog.add_filter("Pictures", &["png"]).save_file()?;
                    Some(Arrival::WindowFile(with_ending(path, false)))
                }),
                Request::DrawThumbnails => self.draw_thumbnails(context),
                Request::Copy(text, note) => {
                    context.copy_text(text);
                    self.session.messages.note(note);
                }
                Request::GoTo(view) => {
                    self.hands.go_to(&self.session, view, time);
                    context.request_repaint();
                }
                Request::LoseDevice { is_within_frame } => {
                    self.is_to_be_lost = Some(is_within_frame);
                    context.request_repaint();
                }
                Request::Quit => context.send_viewport_cmd(egui::ViewportCommand::Close),
            }
        }
    }

    fn lose_where_wanted(&mut self, is_within_frame: bool) {
        if self.is_to_be_lost == Some(is_within_frame) {
            self.is_to_be_lost = None;
            self.loss.lose();
        }
    }

    fn draw_thumbnails(&mut self, context: &egui::Context) {
        let (sender, arrived) = channel();
        let (gpu, library) = (self.canvas.gpu().clone(), self.session.library.clone());
        let context = context.clone();
        let wake = move || context.request_repaint();
        let work =
            Background::start(wake, move |tell| thumbnails::draw(&gpu, &library, &sender, tell));
        self.thumbnails = Some((work, arrived));
    }

    fn take_thumbnails(&mut self, context: &egui::Context) {
        let Some((work, arrived)) = &self.thumbnails else { return };
        let is_over = work.take().is_some();
        for (name, picture) in arrived.try_iter() {
            let size = [picture.width() as usize, picture.height() as usize];
            let picture = egui::ColorImage::from_rgba_unmultiplied(size, &picture);
            let texture = context.load_texture(&name, picture, egui::TextureOptions::LINEAR);
            self.session.thumbnails.textures.insert(name, texture);
        }
        if is_over {
            self.thumbnails = None;
        }
    }

    /// Cancels the first attempt to close the window if unsaved marks would be lost.
    fn hold_close(&mut self, context: &egui::Context) {
        let is_closing = context.input(|input| input.viewport().close_requested());
        if is_closing && self.would_lose_marks("close") {
            context.send_viewport_cmd(egui::ViewportCommand::CancelClose);
        }
    }

    /// Opens a file dialog on another thread.
    fn ask(
        &self,
        context: &egui::Context,
        dialog: impl FnOnce(rfd::FileDialog) -> Option<Arrival> + Send + 'static,
    ) {
        let (sender, context) = (self.sender.clone(), context.clone());
        std::thread::spawn(move || {
            let arrival = match desktop::missing_for_dialogs() {
                Some(what) => Some(Arrival::Fault(what)),
                None => dialog(rfd::FileDialog::new()),
            };
            if let Some(arrival) = arrival {
                // The window may be closed.
                let _ = sender.send(arrival);
                context.request_repaint();
            }
        });
    }

    fn save_technique(&mut self, path: &std::path::Path) {
        let appearance = &self.session.recipe.appearance;
        let about = appearance.technique.about.clone();
        let saved = file_text(&appearance.technique, &about)
            .map_err(Error::from)
            .and_then(|text| Ok(write_file(path, text.as_bytes())?));
        match saved {
            Err(error) => self.session.messages.error(error_text(&error)),
            Ok(()) => {
                let name = path.display().to_string();
                self.session.messages.note(format!("saved as {name}"));
                self.session.take_technique(&name);
            }
        }
    }

    /// Draws and saves a picture or a turntable, in the size chosen under Output.
    fn save_picture(&mut self, path: PathBuf, turntable: Option<u32>, context: &egui::Context) {
        let Some(scene) = self.session.scene.clone() else { return };
        let overrides = match self.session.object_overrides() {
            Ok(overrides) => overrides,
            Err(error) => return self.session.messages.error(error_text(&error)),
        };
        let order = Order {
            recipe: self.session.recipe.clone(),
            scene,
            overrides,
            size: self.session.remembered.picture_size.unwrap_or(self.size),
            path: with_ending(path, turntable.is_some()),
            turntable,
            gpu: self.canvas.gpu().clone(),
        };
        self.save_aside(move |tell| saving::save(&order, tell), context);
    }

    /// Saves something on another thread.
    fn save_aside(
        &mut self,
        body: impl FnOnce(Tell) -> Result<String, Error> + Send + 'static,
        context: &egui::Context,
    ) {
        let context = context.clone();
        let wake = move || context.request_repaint();
        self.saving.push(Background::start(wake, body));
    }

    /// Requests the pixels of the next frame, including panels, and sends them to be saved.
    fn take_window_pixels(&self, path: PathBuf, context: &egui::Context) {
        let (sender, waker) = (self.sender.clone(), context.clone());
        context.request_screenshot(move |pixels| {
            // The window may be closed.
            let _ = sender.send(Arrival::WindowPixels(path, pixels));
            waker.request_repaint();
        });
    }

    /// Opens files: models, a technique, or a picture that contains its recipe.
    fn open_files(&mut self, files: Vec<PathBuf>, context: &egui::Context) {
        let has_ending = |path: &PathBuf, wanted: &str| {
            path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case(wanted))
        };
        let [file] = &files[..] else {
            return self.replace(LoadOrder { models: files, recipe: None }, context);
        };
        if has_ending(file, "png") {
            let Some(words) = saving::words_in(file) else {
                let name = file.display();
                let what = format!("{name}: this picture contains no recipe; open a model instead");
                return self.session.messages.error(what);
            };
            match self.session.take_words(&words) {
                Err(error) => self.session.messages.error(error_text(&error)),
                Ok(None) => {}
                Ok(Some(recipe)) => {
                    let models = recipe.models.clone();
                    self.replace(LoadOrder { models, recipe: Some(recipe) }, context);
                }
            }
        } else if has_ending(file, "toml") && is_technique_file(file) {
            let name = file.display().to_string();
            self.session.take_technique(&name);
        } else {
            self.replace(LoadOrder { models: files, recipe: None }, context);
        }
    }

    /// Paints the picture, or two with a line between them.
    fn paint(&mut self, ui: &mut Ui, rect: egui::Rect) {
        let Some(picture) = self.canvas.picture() else {
            let is_waiting = self.loading.is_some() || self.to_load.is_some();
            return panels::no_picture(ui, &mut self.session, rect, is_waiting);
        };
        let other = self.canvas.compared_picture();
        let (Some(other), Some(comparison)) = (other, &mut self.session.comparison) else {
            return picture.paint(ui.painter(), rect);
        };
        let line = egui::lerp(rect.left()..=rect.right(), comparison.share);
        let [mut left, mut right] = [rect; 2];
        (left.max.x, right.min.x) = (line, line);
        picture.paint(&ui.painter().with_clip_rect(left), rect);
        other.paint(&ui.painter().with_clip_rect(right), rect);
        let names = [&self.session.recipe.appearance, &comparison.appearance]
            .map(|appearance| appearance.technique_name.clone());
        comparison.share = panels::comparison_line(ui, rect, comparison.share, names);
    }

    /// Shows the picture and handles the pointer over it.
    fn picture(&mut self, ui: &mut Ui) {
        let rect = ui.available_rect_before_wrap();
        let response = ui.allocate_rect(rect, Sense::click_and_drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "The picture"));
        self.hands.pointer(ui, &response, &mut self.session);
        if self.hands.go_on(ui, rect, &mut self.session) {
            ui.ctx().request_repaint();
        }
        let scale = ui.ctx().pixels_per_point();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "positive")]
        let pixels = |points: f32| (points * scale).round().max(1.0) as u32;
        self.size = [pixels(rect.width()), pixels(rect.height())];
        self.canvas.follow(&self.session);
        self.canvas.draw(&mut self.session, self.size);
        self.paint(ui, rect);
        let (known, waits) = self.canvas.statistics();
        if let Some(statistics) = known {
            self.session.keep(statistics);
            ui.ctx().request_repaint();
        }
        if waits {
            ui.ctx().request_repaint_after(ASK_AGAIN);
        }
        panels::notes(ui, &mut self.session, rect);
    }
}

/// Appends the ending of a picture file if `path` has none.
fn with_ending(path: PathBuf, is_turntable: bool) -> PathBuf {
    let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
    let known = if is_turntable { &["apng", "gif", "png"][..] } else { &["png"] };
    let is_known = ending.is_some_and(|ending| known.iter().any(|known| ending == *known));
    if is_known {
        return path;
    }
    let mut name = path.into_os_string();
    name.push(if is_turntable { ".apng" } else { ".png" });
    name.into()
}

/// Whether a TOML file is a technique, not a scene.
fn is_technique_file(path: &std::path::Path) -> bool {
    let text = std::fs::read_to_string(path).unwrap_or_default();
    text.lines().any(|line| line.trim_start().starts_with("[[pass]]"))
}

/// Leaves the session for the next window, even if a lost device ends this one in the middle
/// of a frame.
impl Drop for Window {
    fn drop(&mut self) {
        let Session { library, recipe, remembered, .. } = &self.session;
        let nothing = Session::new(library.clone(), recipe.clone(), remembered.clone());
        let mut session = std::mem::replace(&mut self.session, nothing);
        if !self.saving.is_empty() {
            session.messages.error("a picture was not saved: the graphics adapter was lost");
        }
        let loading = self.loading.take().map(|loading| loading.what);
        let to_load = loading.or_else(|| self.to_load.take());
        *self.handover.lock().unwrap_or_else(PoisonError::into_inner) =
            Some(WindowHandover { session, to_load, is_new: false });
    }
}

impl eframe::App for Window {
    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        let context = ui.ctx().clone();
        self.lose_where_wanted(false);
        self.loss.is_shown.store(true, Ordering::Relaxed);
        if self.loss.is_lost() {
            // Nothing can be drawn on the lost device.
            context.send_viewport_cmd(egui::ViewportCommand::Close);
            return;
        }
        if !self.session.marking.has_changes() {
            self.warned_of = None;
        }
        self.take_arrivals(&context);
        self.follow_files(&context);
        self.take_thumbnails(&context);
        let dropped: Vec<PathBuf> = context.input(|input| {
            let files = input.raw.dropped_files.iter();
            files.map(|file| file.path().to_owned()).collect()
        });
        if !dropped.is_empty() {
            self.open_files(dropped, &context);
        }
        let time = context.input(|input| input.time);
        self.session.watch_changes(time);
        self.hands.keys(ui, &mut self.session, self.size);
        context.set_theme(self.session.remembered.theme);
        if self.session.remembered.shows_panels {
            Panel::top("top").show(ui, |ui| {
                panels::top_bar(ui, &mut self.session, self.size);
            });
            Panel::bottom("status").show(ui, |ui| panels::status_bar(ui, &self.session));
            Panel::right("side").default_size(356.0).size_range(260.0..=560.0).show(ui, |ui| {
                panels::side_panel(ui, &mut self.session, self.size);
            });
        }
        CentralPanel::no_frame().show(ui, |ui| self.picture(ui));
        if self.session.shows_keys {
            panels::keys_sheet(ui, &mut self.session);
        }
        if let Some(what) = self.to_load.take() {
            self.load(what, &context);
        }
        self.answer(&context, time);
        self.hold_close(&context);
        // Within a frame: painting after this fails for want of a device.
        self.lose_where_wanted(true);
        let title = format!("{} – Edgemesh", self.session.recipe.title());
        if title != self.title {
            context.send_viewport_cmd(egui::ViewportCommand::Title(title.clone()));
            self.title = title;
        }
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        eframe::set_value(storage, REMEMBERED, &self.session.remembered);
    }
}
