//! The technique: its passes, on and off, and their variables.

use egui::collapsing_header::CollapsingState;
use egui::{Button, Grid, Ui};

use super::variable::{Edit, variable_widget};
use crate::technique::mistake::Mistakes;
use crate::technique::value::Value;
use crate::window::hands::{Command, run};
use crate::window::session::Session;

pub(super) fn look_panel(ui: &mut Ui, session: &mut Session) {
    let appearance = &session.recipe.appearance;
    ui.heading(&appearance.technique_name);
    ui.weak(&appearance.technique.about);
    ui.add_space(4.0);
    let is_changed = appearance.is_changed();
    ui.horizontal(|ui| {
        if ui.add_enabled(is_changed, egui::Button::new("Reset all")).clicked() {
            let appearance = &mut session.recipe.appearance;
            appearance.technique = appearance.original.clone();
        }
        if ui.button("Save as…").clicked() {
            run(Command::SaveTechnique, session, [0; 2]);
        }
        if ui.add_enabled(session.has_undo(), egui::Button::new("Undo")).clicked() {
            session.undo();
        }
        if ui.add_enabled(session.has_redo(), egui::Button::new("Redo")).clicked() {
            session.redo();
        }
    });
    comparison(ui, session);
    ui.add_space(8.0);
    let mut edit = None;
    for at in 0..session.recipe.appearance.technique.passes.len() {
        edit = edit.or(pass(ui, session, at));
    }
    let appearance = &mut session.recipe.appearance;
    if let Some(Edit { pass, variable, value }) = edit
        && let Some(pass) = appearance.technique.passes.get_mut(pass)
    {
        // A value out of range is clamped; the widget shows the result.
        pass.set_value(variable, value, None, &mut Mistakes::default());
    }
    ui.checkbox(&mut appearance.is_transparent, "Transparent background");
}

/// Chooses the technique to compare with.
fn comparison(ui: &mut Ui, session: &mut Session) {
    let names: Vec<String> = session.library.technique_names().map(str::to_owned).collect();
    let now = session.comparison.as_ref();
    let now = now.map(|comparison| comparison.appearance.technique_name.clone());
    let mut chosen = now.clone();
    ui.horizontal(|ui| {
        let label = ui.label("Compare with");
        egui::ComboBox::from_id_salt("comparison")
            .selected_text(now.as_deref().unwrap_or("nothing"))
            .height(400.0)
            .show_ui(ui, |ui| {
                ui.selectable_value(&mut chosen, None, "nothing");
                for name in names {
                    ui.selectable_value(&mut chosen, Some(name.clone()), name);
                }
            })
            .response
            .labelled_by(label.id);
        if now.is_some() && ui.button("Swap").clicked() {
            session.swap_sides();
        }
    });
    if chosen != now {
        session.compare_with(chosen.as_deref());
    }
}

/// Shows a pass; returns the change of a variable, if any.
fn pass(ui: &mut Ui, session: &Session, at: usize) -> Option<Edit> {
    let appearance = &session.recipe.appearance;
    let pass = &appearance.technique.passes[at];
    let original = appearance.original.pass(&pass.name);
    // Only the first two rendered passes are open by default; more would not fit.
    let before = &appearance.original.passes[..at.min(appearance.original.passes.len())];
    let is_open = pass.is_rendered() && before.iter().filter(|p| p.is_rendered()).count() < 2;
    let mut edit = None;
    ui.push_id(&pass.name, |ui| {
        let id = ui.make_persistent_id("pass");
        let state = CollapsingState::load_with_default_open(ui.ctx(), id, is_open);
        let header = state.show_header(ui, |ui| {
            let mut is_on = pass.is_rendered();
            let (index, _) = pass.component.variable("render").unzip();
            let name = egui::RichText::new(&pass.name).strong();
            if ui.checkbox(&mut is_on, name).on_hover_text(&pass.component.about).changed() {
                let value = Value::Bool(is_on);
                edit = index.map(|variable| Edit { pass: at, variable, value });
            }
            ui.weak(&pass.component.name);
        });
        header.body(|ui| {
            Grid::new("variables").num_columns(3).spacing([8.0, 4.0]).show(ui, |ui| {
                for (variable, descriptor) in pass.component.variables.iter().enumerate() {
                    if descriptor.internal || descriptor.name == "render" {
                        continue;
                    }
                    let value = &pass.values()[variable];
                    let before = original.map_or(descriptor.default.as_ref(), |original| {
                        original.values().get(variable)
                    });
                    let label = ui.label(descriptor.name.replace('_', " "));
                    let label = label.on_hover_text(&descriptor.about).id;
                    let folders = &appearance.technique.folders;
                    let changed = variable_widget(ui, descriptor, value, label, folders);
                    // The button keeps its place, so that nothing moves when it appears.
                    let other = before.filter(|before| *before != value);
                    let reset = ui.add_visible(other.is_some(), Button::new("×").small());
                    let reset = other.and_then(|before| {
                        let reset = reset.on_hover_text(format!("reset to {before}"));
                        reset.clicked().then(|| before.clone())
                    });
                    if let Some(value) = reset.or(changed) {
                        edit = Some(Edit { pass: at, variable, value });
                    }
                    ui.end_row();
                }
            });
        });
    });
    edit
}
