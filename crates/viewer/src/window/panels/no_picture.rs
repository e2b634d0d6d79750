//! Shown before the first picture.

use std::path::PathBuf;

use edgemesh::load::DEMO;
use egui::{Rect, Ui, UiBuilder, vec2};

use super::keys::key_of;
use crate::window::hands::Command;
use crate::window::session::{Request, Session};

/// Empty paper at `rect`, and how to open a model unless one `is_waiting`.
pub fn no_picture(ui: &mut Ui, session: &mut Session, rect: Rect, is_waiting: bool) {
    ui.painter().rect_filled(rect, 0.0, ui.visuals().extreme_bg_color);
    if is_waiting || session.scene.is_some() {
        return;
    }
    let place = Rect::from_center_size(rect.center(), vec2(320.0, 110.0)).intersect(rect);
    ui.scope_builder(UiBuilder::new().max_rect(place), |ui| {
        ui.vertical_centered(|ui| {
            ui.heading("No model is open");
            ui.weak("Drop a file here, or");
            ui.add_space(6.0);
            let key = key_of(ui, Command::Open).unwrap_or_default();
            if ui.add(egui::Button::new("Open…").shortcut_text(key)).clicked() {
                session.ask(Request::ChooseFiles);
            }
            if ui.button("Open the demo").clicked() {
                session.ask(Request::Open(vec![PathBuf::from(DEMO)]));
            }
        });
    });
}
