//! The line classes: on and off, with their counts and main settings.

use edgemesh::line::LineClass;
use egui::{Grid, Ui};

use super::bar::grouped;
use crate::technique::core::CoreComponent;
use crate::technique::core_view::{LineSelection, Visibility, classes_text};
use crate::technique::mistake::Mistakes;
use crate::technique::pass::Pass;
use crate::technique::value::Value;
use crate::technique::word::Word as _;
use crate::window::error_text::error_text;
use crate::window::session::Session;

pub(super) fn lines_panel(ui: &mut Ui, session: &mut Session) {
    marks(ui, session);
    let counts = session.statistics.last().and_then(|last| last.tally);
    let features = counts.map(|tally| tally.features());
    let technique = &mut session.recipe.appearance.technique;
    if !technique.passes.iter().any(is_strokes) {
        ui.label("This technique draws no strokes: its lines are detected in the image.");
        return;
    }
    ui.heading("Visible");
    Grid::new("classes").num_columns(3).spacing([12.0, 4.0]).show(ui, |ui| {
        for class in LineClass::ALL {
            let mut is_drawn = draws(&technique.passes, class, Visibility::Visible);
            let name = capitalized(class.name());
            if ui.checkbox(&mut is_drawn, name).changed() {
                set_drawn(&mut technique.passes, class, is_drawn);
            }
            let count = features.map(|features| features[class]);
            ui.label(count.map_or_else(String::new, |count| grouped(count as usize)));
            ui.end_row();
        }
    });
    ui.add_space(8.0);
    for pass in technique.passes.iter_mut().filter(|pass| is_strokes(pass)) {
        stroke(ui, pass);
    }
}

/// Edges marked by hand.
fn marks(ui: &mut Ui, session: &mut Session) {
    ui.horizontal(|ui| {
        ui.toggle_value(&mut session.marking.is_on, "Mark edges").on_hover_text("M");
        let has_changes = session.marking.has_changes();
        if ui.add_enabled(has_changes, egui::Button::new("Undo mark")).clicked()
            && let Some(scene) = &mut session.scene
        {
            session.marking.undo(scene);
        }
        if ui.add_enabled(has_changes, egui::Button::new("Save marks")).clicked()
            && let Some(scene) = &session.scene
        {
            let file = session.recipe.marks_file();
            match session.marking.save(scene, file) {
                Ok(files) => {
                    let names: Vec<String> =
                        files.iter().map(|path| path.display().to_string()).collect();
                    session.messages.note(format!("saved as {}", names.join(", ")));
                }
                Err(error) => session.messages.error(error_text(&error)),
            }
        }
    });
    if session.marking.is_on {
        ui.weak("Click marks an edge; Shift + click marks the shortest path from the last click.");
    }
    ui.add_space(8.0);
}

/// The main settings of a stroke pass.
fn stroke(ui: &mut Ui, pass: &mut Pass) {
    ui.push_id(pass.name.clone(), |ui| {
        ui.horizontal(|ui| {
            let mut is_on = pass.is_rendered();
            let name = egui::RichText::new(&pass.name).heading();
            if ui.checkbox(&mut is_on, name).changed() {
                set(pass, "render", Value::Bool(is_on));
            }
            ui.weak(LineSelection::of(pass).map_or("", |lines| lines.visibility.word()));
        });
        Grid::new("stroke").num_columns(2).spacing([12.0, 4.0]).show(ui, |ui| {
            for name in ["width", "color", "brush", "parameterization", "linked"] {
                let Some((index, variable)) = pass.component.variable(name) else { continue };
                let label = ui.label(name).on_hover_text(&variable.about).id;
                let value = &pass.values()[index];
                let variable = variable.clone();
                let new = super::variable::variable_widget(ui, &variable, value, label, &[]);
                if let Some(new) = new {
                    pass.set_value(index, new, None, &mut Mistakes::default());
                }
                ui.end_row();
            }
        });
    });
}

fn is_strokes(pass: &Pass) -> bool {
    pass.component.core == CoreComponent::Strokes
}

/// Whether any pass draws a class.
fn draws(passes: &[Pass], class: LineClass, visibility: Visibility) -> bool {
    let has_class =
        |pass: &Pass| LineSelection::of(pass).is_some_and(|lines| lines.draws(class, visibility));
    passes.iter().any(|pass| pass.is_rendered() && has_class(pass))
}

/// Adds a class to the first pass of visible strokes, or removes it from all.
fn set_drawn(passes: &mut [Pass], class: LineClass, is_drawn: bool) {
    for pass in passes {
        let lines = LineSelection::of(pass);
        let Some(lines) = lines.filter(|lines| lines.visibility == Visibility::Visible) else {
            continue;
        };
        let mut classes = lines.classes;
        if is_drawn {
            if !classes.contains(&class) {
                classes.push(class);
            }
            // In the order that the files use.
            classes = LineClass::ALL.into_iter().filter(|known| classes.contains(known)).collect();
        } else {
            classes.retain(|known| *known != class);
        }
        set(pass, LineSelection::CLASSES, Value::String(classes_text(&classes)));
        set(pass, "render", Value::Bool(pass.is_rendered() || is_drawn));
        if is_drawn {
            return;
        }
    }
}

fn set(pass: &mut Pass, name: &str, value: Value) {
    if let Some((index, _)) = pass.component.variable(name) {
        pass.set_value(index, value, None, &mut Mistakes::default());
    }
}

fn capitalized(name: &str) -> String {
    let mut letters = name.chars();
    letters.next().map_or_else(String::new, |first| {
        first.to_uppercase().collect::<String>() + letters.as_str()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::technique::library::Library;

    #[test]
    fn classes_go_off_and_come_back() {
        let before = Library::shipped().technique("ink").unwrap().0;
        let mut passes = before.passes.clone();
        set_drawn(&mut passes, LineClass::Ridge, false);
        assert!(!draws(&passes, LineClass::Ridge, Visibility::Visible));
        assert!(draws(&passes, LineClass::Contour, Visibility::Visible));
        set_drawn(&mut passes, LineClass::Ridge, true);
        assert_eq!(passes, before.passes);
    }
}
