//! Saving pictures and copying commands.

use egui::{DragValue, Ui};

use crate::window::hands::{Command, run};
use crate::window::session::{Request, Session};

/// `size` is that of the picture in the window, in pixels.
pub(super) fn output_panel(ui: &mut Ui, session: &mut Session, size: [u32; 2]) {
    ui.heading("Picture");
    let mut is_own = session.remembered.picture_size.is_some();
    if ui.checkbox(&mut is_own, "Custom size").changed() {
        session.remembered.picture_size = is_own.then_some([2048, 2048]);
    }
    if let Some([width, height]) = &mut session.remembered.picture_size {
        ui.horizontal(|ui| {
            for (name, side) in [("Width", width), ("Height", height)] {
                let label = ui.label(name);
                ui.add(DragValue::new(side).range(1..=65_536).suffix(" px")).labelled_by(label.id);
            }
        });
    } else {
        ui.weak(format!("{} × {} pixels, as in the window", size[0], size[1]));
    }
    ui.checkbox(&mut session.recipe.appearance.is_transparent, "Transparent background");
    ui.horizontal(|ui| {
        if ui.button("Save picture…").on_hover_text("F12").clicked() {
            run(Command::SavePicture, session, size);
        }
        let window = ui.button("Save window…");
        if window.on_hover_text("with its panels, as on the screen").clicked() {
            session.ask(Request::SaveWindow);
        }
    });
    ui.add_space(8.0);
    ui.heading("Turntable");
    ui.horizontal(|ui| {
        let label = ui.label("Pictures");
        let steps = &mut session.remembered.turntable_steps;
        ui.add(DragValue::new(steps).range(2..=10_000)).labelled_by(label.id);
        if ui.button("Save turntable…").clicked() {
            let steps = session.remembered.turntable_steps;
            session.ask(Request::SavePicture(Some(steps)));
        }
    });
    ui.weak("an animated .apng or .gif, or numbered .png files");
    ui.add_space(8.0);
    ui.heading("Command");
    let size = session.remembered.picture_size.unwrap_or(size);
    match session.command(size) {
        Some(command) => {
            ui.label(egui::RichText::new(command).monospace());
            if ui.button("Copy command").clicked() {
                run(Command::CopyCommand, session, size);
            }
        }
        None => {
            ui.label("The changed technique cannot be written as settings; save it as a file.");
        }
    }
}
