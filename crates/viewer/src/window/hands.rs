//! Pointer and keys over the picture.

use egui::{Key, Modifiers, PointerButton, Rect, Response, Ui};
use glam::{DVec2, DVec3};

use super::light_hand;
use super::marking::edge_under;
use super::navigation::{Canvas, between, flown, looked_around, panned, rolled, turned, zoomed};
use super::session::{Request, Session, Work};
use super::viewpoint::{NamedView, Viewpoint};
use crate::arguments::{camera_words, shell_line};

/// Duration of a flight to a viewpoint, in seconds.
const FLIGHT_SECONDS: f64 = 0.25;

/// Flying speed, in distances to the target per second.
const FLY_SPEED: f64 = 0.8;

/// Held while a drag turns the light.
pub const LIGHT_KEY: Key = Key::L;

/// Held while a drag moves the chosen cut. It must not be in [`KEYS`].
pub const CUT_KEY: Key = Key::X;

/// The text for a drag with a key held.
pub(crate) fn drag_with(key: Key) -> String {
    format!("{} + drag", key.name())
}

/// The state of pointer and keys between frames.
#[derive(Debug, Default)]
pub struct Hands {
    flight: Option<Flight>,
}

/// A smooth move from one viewpoint to another.
#[derive(Debug, Clone, Copy)]
struct Flight {
    from: Viewpoint,
    to: Viewpoint,
    /// The window's time at the start, in seconds.
    since: f64,
}

/// A command of a key or menu entry.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Command {
    /// Shows a side.
    Side(NamedView),
    /// Switches between perspective and orthographic.
    Projection,
    /// Fits all models into the picture.
    Fit,
    /// Goes to the default view.
    Home,
    /// Rolls by 15 degrees: to the right if true, else to the left.
    Roll(bool),
    /// Switches marking by hand on and off.
    Mark,
    /// Shows or hides the panels.
    Panels,
    /// Shows or hides the sheet of keys.
    Keys,
    /// Takes the next technique if true, else the previous one.
    Technique(bool),
    /// Chooses files and opens them.
    Open,
    /// Reads the open files again.
    Reload,
    /// Saves a picture.
    SavePicture,
    /// Saves the technique.
    SaveTechnique,
    /// Copies the command line of the picture.
    CopyCommand,
    /// Copies the camera options.
    CopyCamera,
    /// Undoes one change.
    Undo,
    /// Redoes one change.
    Redo,
    /// Closes the window.
    Quit,
}

/// The keys with their modifiers, commands and descriptions.
pub const KEYS: &[(Key, Modifiers, Command, &str)] = &[
    (Key::Num1, Modifiers::NONE, Command::Side(NamedView::Front), "front"),
    (Key::Num1, Modifiers::COMMAND, Command::Side(NamedView::Back), "back"),
    (Key::Num3, Modifiers::NONE, Command::Side(NamedView::Right), "right"),
    (Key::Num3, Modifiers::COMMAND, Command::Side(NamedView::Left), "left"),
    (Key::Num7, Modifiers::NONE, Command::Side(NamedView::Top), "top"),
    (Key::Num7, Modifiers::COMMAND, Command::Side(NamedView::Bottom), "bottom"),
    (Key::Num9, Modifiers::NONE, Command::Side(NamedView::Isometric), "isometric"),
    (Key::Num5, Modifiers::NONE, Command::Projection, "perspective or orthographic"),
    (Key::Num4, Modifiers::NONE, Command::Roll(false), "roll to the left"),
    (Key::Num6, Modifiers::NONE, Command::Roll(true), "roll to the right"),
    (Key::F, Modifiers::NONE, Command::Fit, "fit the model"),
    (Key::Enter, Modifiers::NONE, Command::Home, "go to the default view"),
    (Key::M, Modifiers::NONE, Command::Mark, "mark edges by hand"),
    (Key::N, Modifiers::NONE, Command::Panels, "hide or show panels"),
    (Key::Questionmark, Modifiers::NONE, Command::Keys, "show the keys"),
    (Key::H, Modifiers::NONE, Command::Keys, "show the keys"),
    (Key::OpenBracket, Modifiers::NONE, Command::Technique(false), "previous technique"),
    (Key::CloseBracket, Modifiers::NONE, Command::Technique(true), "next technique"),
    (Key::O, Modifiers::COMMAND, Command::Open, "open files"),
    (Key::F5, Modifiers::NONE, Command::Reload, "reload the files"),
    (Key::F12, Modifiers::NONE, Command::SavePicture, "save a picture"),
    (Key::S, Modifiers::COMMAND, Command::SaveTechnique, "save the technique"),
    (Key::C, Modifiers::NONE, Command::CopyCommand, "copy the viewer render command"),
    (Key::C, Modifiers::SHIFT, Command::CopyCamera, "copy the camera (Ctrl+V pastes it)"),
    (Key::Z, Modifiers { shift: true, ..Modifiers::COMMAND }, Command::Redo, "redo"),
    (Key::Z, Modifiers::COMMAND, Command::Undo, "undo"),
    (Key::Q, Modifiers::COMMAND, Command::Quit, "quit"),
];

/// Keys that lose the graphics device on purpose, before a frame or within one (true), with
/// Ctrl and Shift. Not on the sheet of keys.
const LOSE_DEVICE: [(Key, bool); 2] = [(Key::F9, false), (Key::F10, true)];

impl Command {
    /// Whether it repeats while its key is held.
    const fn goes_on(self) -> bool {
        matches!(self, Self::Roll(_) | Self::Technique(_) | Self::Undo | Self::Redo)
    }
}

impl Hands {
    /// Starts a flight to a viewpoint at `time`, the window's time in seconds.
    pub(crate) fn go_to(&mut self, session: &Session, to: Viewpoint, time: f64) {
        let from = session.recipe.viewpoint;
        self.flight = from.map(|from| Flight { from, to, since: time });
    }

    /// Handles the pointer over the picture.
    pub fn pointer(&mut self, ui: &Ui, response: &Response, session: &mut Session) {
        let Some(view) = session.recipe.viewpoint else { return };
        let canvas = canvas_of(response.rect);
        let mut new = view;
        let delta = response.drag_delta();
        let pixels = DVec2::new(f64::from(delta.x), f64::from(delta.y));
        let (up, mode) = (session.remembered.up, session.remembered.turn_mode);
        let is_shifted = ui.input(|input| input.modifiers.shift);
        let is_held = |key| ui.input(|input| input.key_down(key));
        if response.dragged_by(PointerButton::Primary) && is_held(LIGHT_KEY) {
            drag_light(session, &view, &canvas, pixels);
        } else if response.dragged_by(PointerButton::Primary) && is_held(CUT_KEY) {
            drag_cut(session, &view, &canvas, pixels);
        } else if response.dragged_by(PointerButton::Middle)
            || response.dragged_by(PointerButton::Primary) && is_shifted
        {
            new = panned(&view, canvas, pixels);
        } else if response.dragged_by(PointerButton::Primary) {
            new = turned(&view, mode, up, canvas, pixels);
        } else if response.dragged_by(PointerButton::Secondary) {
            new = looked_around(&view, up, canvas, pixels);
        }
        if let Some(pointer) = response.hover_pos().filter(|_| response.hovered()) {
            let at = position_in(response.rect, pointer);
            let (scroll, pinch) =
                ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
            let factor = (-f64::from(scroll) / 300.0).exp() / f64::from(pinch);
            if (factor - 1.0).abs() > 1e-9 {
                new = zoomed(&new, factor, under(session, &canvas, &new, at));
            }
            if session.marking.is_on {
                mark(ui, response, session, &canvas, at);
            } else if response.double_clicked() {
                let point = under(session, &canvas, &view, at);
                let to = super::navigation::focused(&view, point);
                self.go_to(session, to, ui.input(|input| input.time));
            }
        }
        if new != view {
            // A drag ends a flight.
            self.flight = None;
            session.recipe.viewpoint = Some(new);
        }
    }

    /// Handles held keys and flights; returns whether there is more to come.
    pub(crate) fn go_on(&mut self, ui: &Ui, rect: Rect, session: &mut Session) -> bool {
        let Some(view) = session.recipe.viewpoint else { return false };
        let (time, seconds) = ui.input(|input| (input.time, f64::from(input.stable_dt.min(0.1))));
        let mut is_moving = false;
        if let Some(flight) = self.flight {
            let share = ((time - flight.since) / FLIGHT_SECONDS).clamp(0.0, 1.0);
            // Slow at both ends.
            let eased = share * share * (3.0 - 2.0 * share);
            session.recipe.viewpoint = Some(between(&flight.from, &flight.to, eased));
            is_moving = share < 1.0;
            self.flight = Some(flight).filter(|_| is_moving);
        }
        if ui.ctx().egui_wants_keyboard_input() {
            return is_moving;
        }
        let held = |key: Key| ui.input(|input| input.key_down(key) && input.modifiers.is_none());
        let axis = |plus: Key, minus: Key| {
            f64::from(u8::from(held(plus))) - f64::from(u8::from(held(minus)))
        };
        let steps = DVec3::new(axis(Key::D, Key::A), axis(Key::E, Key::Q), axis(Key::W, Key::S));
        let turns =
            DVec2::new(axis(Key::ArrowLeft, Key::ArrowRight), axis(Key::ArrowUp, Key::ArrowDown));
        let nearer = axis(Key::Plus, Key::Minus) + axis(Key::Equals, Key::Minus).max(0.0);
        if steps == DVec3::ZERO && turns == DVec2::ZERO && nearer == 0.0 {
            return is_moving;
        }
        self.flight = None;
        let canvas = canvas_of(rect);
        let mut new = flown(&view, steps * (FLY_SPEED * seconds));
        // Half a turn in three seconds.
        let pixels = turns * (canvas.size.y * seconds / 3.0);
        new = turned(&new, session.remembered.turn_mode, session.remembered.up, canvas, pixels);
        new = zoomed(&new, (-nearer * seconds).exp(), new.target);
        session.recipe.viewpoint = Some(new);
        true
    }

    /// Handles pressed and pasted keys. `size` is that of the picture in pixels.
    pub fn keys(&mut self, ui: &Ui, session: &mut Session, size: [u32; 2]) {
        let pasted = ui.input(|input| {
            input.events.iter().find_map(|event| match event {
                egui::Event::Paste(text) => Some(text.clone()),
                _ => None,
            })
        });
        if ui.ctx().egui_wants_keyboard_input() {
            return;
        }
        if let (Some(text), Some(view)) = (pasted, session.recipe.viewpoint) {
            match view.pasted(&text) {
                Ok(to) => session.ask(Request::GoTo(to)),
                Err(error) => session.messages.note(format!("nothing was pasted: {error}")),
            }
        }
        let pressed: Vec<Command> = ui.input_mut(|input| {
            let mut commands = Vec::new();
            input.events.retain(|event| {
                let command = command_of(event);
                commands.extend(command);
                command.is_none()
            });
            commands
        });
        for command in pressed {
            run(command, session, size);
        }
        let modifiers = Modifiers { shift: true, ..Modifiers::COMMAND };
        for (key, is_within_frame) in LOSE_DEVICE {
            if ui.input_mut(|input| input.consume_key(modifiers, key)) {
                session.ask(Request::LoseDevice { is_within_frame });
            }
        }
    }
}

/// The command of a key event. Its modifiers are those of the event: in a long frame they may
/// be released already.
fn command_of(event: &egui::Event) -> Option<Command> {
    let egui::Event::Key { key, pressed: true, repeat, modifiers, .. } = event else {
        return None;
    };
    let is_it = |known: &&(Key, Modifiers, Command, &str)| {
        // Some keyboards need Shift to type these, so Shift is ignored.
        let is_typed = matches!(key, Key::Questionmark | Key::OpenBracket | Key::CloseBracket);
        let is_held = match is_typed {
            true => !modifiers.command,
            false => modifiers.matches_exact(known.1),
        };
        known.0 == *key && is_held
    };
    let command = KEYS.iter().find(is_it).map(|(_, _, command, _)| *command);
    command.filter(|command| !repeat || command.goes_on())
}

/// Runs a command. `size` is that of the picture in pixels.
pub(crate) fn run(command: Command, session: &mut Session, size: [u32; 2]) {
    let view = session.recipe.viewpoint;
    match command {
        Command::Side(side) => session.go_to_side(side),
        Command::Projection => {
            if let Some(view) = &mut session.recipe.viewpoint {
                view.is_orthographic = !view.is_orthographic;
            }
        }
        Command::Fit => {
            if let Some(view) = view {
                session.ask(Request::GoTo(session.fitted(&view)));
            }
        }
        Command::Home => session.go_home(),
        Command::Roll(is_right) => {
            let angle = if is_right { -15_f64 } else { 15.0 };
            if let Some(view) = view {
                session.ask(Request::GoTo(rolled(&view, angle.to_radians())));
            }
        }
        Command::Mark => session.marking.is_on = !session.marking.is_on,
        Command::Panels => session.remembered.shows_panels = !session.remembered.shows_panels,
        Command::Keys => session.shows_keys = !session.shows_keys,
        Command::Technique(is_next) => {
            let names: Vec<String> = session.library.technique_names().map(str::to_owned).collect();
            let now = &session.recipe.appearance.technique_name;
            let at = names.iter().position(|name| name == now).unwrap_or(0);
            let step = if is_next { 1 } else { names.len() - 1 };
            let name = names[(at + step) % names.len()].clone();
            session.take_technique(&name);
            session.messages.note(name);
        }
        Command::Open => session.ask(Request::ChooseFiles),
        Command::Reload => session.ask(Request::Reload),
        Command::SavePicture => session.ask(Request::SavePicture(None)),
        Command::SaveTechnique => session.ask(Request::SaveTechnique),
        Command::CopyCommand => match session.command(size) {
            Some(line) => session.ask(Request::Copy(line, "command copied")),
            None => session.messages.error(
                "the changed technique cannot be written as settings; save it as a file and copy again",
            ),
        },
        Command::CopyCamera => {
            if let Some(view) = view {
                let line = shell_line(&camera_words(&view.arguments()));
                session.ask(Request::Copy(line, "camera copied"));
            }
        }
        Command::Undo => session.undo(),
        Command::Redo => session.redo(),
        Command::Quit => session.ask(Request::Quit),
    }
}

fn drag_light(session: &mut Session, view: &Viewpoint, canvas: &Canvas, pixels: DVec2) {
    let Some(scene) = &session.scene else { return };
    let light = &mut session.recipe.appearance.lighting.light;
    *light = light_hand::light_dragged(light, view, scene, canvas, pixels);
}

/// Moves the chosen cut.
fn drag_cut(session: &mut Session, view: &Viewpoint, canvas: &Canvas, pixels: DVec2) {
    let Some(scene) = &session.scene else { return };
    let planes = &mut session.recipe.appearance.lighting.clip_planes;
    let Some(last) = planes.len().checked_sub(1) else {
        return session.messages.note("there are no cuts: add one under Light");
    };
    let plane = &mut planes[session.chosen_cut.min(last)];
    *plane = light_hand::dragged_clip_plane(*plane, view, scene, canvas, pixels);
}

/// Highlights the edge under the pointer, and marks it on a click.
fn mark(ui: &Ui, response: &Response, session: &mut Session, canvas: &Canvas, at: DVec2) {
    let (Some(scene), Some(view)) = (&mut session.scene, session.recipe.viewpoint) else { return };
    // A load replaces the models, and their marks with them.
    if session.work.iter().any(Work::is_loading) {
        return;
    }
    let Some(picked) = edge_under(scene, &view, canvas, at) else { return };
    #[expect(clippy::cast_possible_truncation, reason = "a position on the screen")]
    let place = |at: DVec2| response.rect.min + egui::vec2(at.x as f32, at.y as f32);
    let color = ui.visuals().selection.bg_fill;
    // Above the picture, which is painted later.
    let layer = egui::LayerId::new(egui::Order::Middle, response.id);
    let painter = ui.ctx().layer_painter(layer).with_clip_rect(response.rect);
    painter.line_segment(picked.ends.map(place), egui::Stroke::new(4.0, color));
    let is_path = ui.input(|input| input.modifiers.shift);
    if !response.clicked() {
        return;
    }
    if is_path {
        match session.marking.mark_path(scene, &picked) {
            Some(count) => session.messages.note(format!("{count} edges on the path")),
            None => session.messages.note("click an edge first: the path begins at the last click"),
        }
    } else {
        session.marking.toggle(scene, &picked);
    }
}

/// The point of the models under a position, or else of the plane through the target.
fn under(session: &Session, canvas: &Canvas, view: &Viewpoint, at: DVec2) -> DVec3 {
    let hit = session.scene.as_ref().and_then(|scene| {
        let (start, direction) = canvas.ray(view, at);
        super::picking::hit(scene, start, direction)
    });
    hit.map_or_else(|| canvas.point_on_target_plane(view, at), |hit| hit.point)
}

fn canvas_of(rect: Rect) -> Canvas {
    Canvas { size: DVec2::new(f64::from(rect.width()), f64::from(rect.height()).max(1.0)) }
}

fn position_in(rect: Rect, at: egui::Pos2) -> DVec2 {
    let at = at - rect.min;
    DVec2::new(f64::from(at.x), f64::from(at.y))
}
