//! The camera.

use egui::{DragValue, Grid, Slider, Ui};
use glam::DVec3;

use crate::window::hands::{Command, run};
use crate::window::navigation::TurnMode;
use crate::window::session::Session;
use crate::window::viewpoint::{NamedView, UpAxis};

pub(super) fn view_panel(ui: &mut Ui, session: &mut Session) {
    ui.heading("Sides");
    ui.horizontal_wrapped(|ui| {
        for view in NamedView::ALL {
            if ui.button(view.name()).clicked() {
                session.go_to_side(view);
            }
        }
    });
    ui.horizontal(|ui| {
        for (name, command) in [("Default view", Command::Home), ("Fit", Command::Fit)] {
            if ui.button(name).clicked() {
                run(command, session, [0; 2]);
            }
        }
    });
    ui.add_space(8.0);
    ui.heading("Camera");
    if let Some(view) = &mut session.recipe.viewpoint {
        ui.checkbox(&mut view.is_orthographic, "Orthographic");
        let before = *view;
        Grid::new("camera").num_columns(2).spacing([12.0, 4.0]).show(ui, |ui| {
            let label = ui.label("Field of view");
            let slider = Slider::new(&mut view.fov_y_deg, 5.0..=120.0).suffix("°");
            ui.add(slider).labelled_by(label.id);
            ui.end_row();
            let speed = (view.distance() / 200.0).max(1e-9);
            for (name, vector) in [("Eye", &mut view.eye), ("Target", &mut view.target)] {
                vector_row(ui, name, vector, speed);
            }
            vector_row(ui, "Up", &mut view.up, 0.01);
        });
        // A camera that sees nothing is not taken.
        let is_nowhere = (view.target - view.eye).cross(view.up).length() <= 0.0;
        if is_nowhere {
            *view = before;
        }
    }
    ui.horizontal(|ui| {
        if ui.button("Copy camera").clicked() {
            run(Command::CopyCamera, session, [0; 2]);
        }
        ui.weak("Ctrl+V pastes it");
    });
    ui.add_space(8.0);
    ui.heading("Rotation");
    let remembered = &mut session.remembered;
    ui.horizontal(|ui| {
        for (mode, name) in [(TurnMode::Turntable, "Turntable"), (TurnMode::Trackball, "Trackball")]
        {
            ui.radio_value(&mut remembered.turn_mode, mode, name);
        }
    });
    ui.horizontal(|ui| {
        for (axis, name) in [(UpAxis::Y, "Y is up"), (UpAxis::Z, "Z is up")] {
            ui.radio_value(&mut remembered.up, axis, name);
        }
    });
}

fn vector_row(ui: &mut Ui, name: &str, vector: &mut DVec3, speed: f64) {
    let label = ui.label(name);
    ui.horizontal(|ui| {
        for number in [&mut vector.x, &mut vector.y, &mut vector.z] {
            ui.add(DragValue::new(number).speed(speed).max_decimals(5)).labelled_by(label.id);
        }
    });
    ui.end_row();
}
