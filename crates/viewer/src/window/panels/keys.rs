//! The sheet of keys.

use egui::{Align2, Key, Modifiers, Ui};

use crate::window::hands::{CUT_KEY, Command, KEYS, LIGHT_KEY, drag_with};
use crate::window::session::Session;

/// Actions of the pointer.
const POINTER: [(&str, &str); 6] = [
    ("drag", "turn around the model"),
    ("Shift + drag, middle drag", "pan"),
    ("right drag", "look around"),
    ("wheel", "zoom toward the pointer"),
    ("double click", "turn around the point under the pointer"),
    ("drop a file", "open it"),
];

/// Actions of held keys.
const HELD: [(&str, &str); 3] =
    [("W A S D, Q E", "fly"), ("arrows", "turn around the model"), ("+ −", "zoom in and out")];

/// The sheet of keys, above the picture.
pub fn keys_sheet(ui: &Ui, session: &mut Session) {
    let mut is_open = session.shows_keys;
    egui::Window::new("Keys")
        .open(&mut is_open)
        .anchor(Align2::CENTER_CENTER, [0.0, 0.0])
        .collapsible(false)
        .resizable(false)
        .show(ui.ctx(), |ui| {
            egui::Grid::new("keys").num_columns(4).spacing([16.0, 4.0]).show(ui, |ui| {
                let keys = KEYS
                    .iter()
                    .map(|(key, modifiers, _, what)| (text_of(ui, *key, *modifiers), *what));
                let keys: Vec<(String, &str)> = keys.collect();
                let own = |(key, what): (&str, &'static str)| (key.to_owned(), what);
                let drags = [
                    (drag_with(LIGHT_KEY), "turn the light"),
                    (drag_with(CUT_KEY), "move the chosen cut"),
                ];
                let hands = POINTER.into_iter().map(own).chain(drags);
                let hands: Vec<(String, &str)> = hands.chain(HELD.map(own)).collect();
                let rows = keys.len().div_ceil(2);
                let (left, right) = keys.split_at(rows);
                for at in 0..rows.max(hands.len()) {
                    for column in [left, right, &hands[..]] {
                        let (key, what) = column.get(at).map_or(("", ""), |(k, w)| (k, *w));
                        ui.strong(key);
                        ui.label(what);
                    }
                    ui.end_row();
                }
            });
        });
    session.shows_keys = is_open;
}

/// The first key of a command, as text.
pub(super) fn key_of(ui: &Ui, command: Command) -> Option<String> {
    let found = KEYS.iter().find(|(.., known, _)| *known == command)?;
    Some(text_of(ui, found.0, found.1))
}

fn text_of(ui: &Ui, key: Key, modifiers: Modifiers) -> String {
    if modifiers.is_none() {
        return key.symbol_or_name().to_owned();
    }
    ui.ctx().format_shortcut(&egui::KeyboardShortcut::new(modifiers, key))
}
