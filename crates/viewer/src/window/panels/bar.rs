//! The bars above and below the picture.

use egui::{Align, Layout, Ui, Vec2};

use crate::window::hands::{Command, run};
use crate::window::remembered::{Theme, name_of};
use crate::window::session::{Request, Session};
use crate::window::viewpoint::NamedView;

/// The bar above the picture: menus and the list of techniques. `size` is that of the picture
/// in pixels.
pub fn top_bar(ui: &mut Ui, session: &mut Session, size: [u32; 2]) {
    ui.horizontal(|ui| {
        ui.menu_button("File", |ui| file_menu(ui, session, size));
        ui.menu_button("Edit", |ui| edit_menu(ui, session, size));
        ui.menu_button("View", |ui| view_menu(ui, session, size));
        ui.separator();
        technique_box(ui, session);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let panels = &mut session.remembered.shows_panels;
            ui.toggle_value(panels, "Panels").on_hover_text("N");
            ui.toggle_value(&mut session.shows_keys, "?").on_hover_text("keys");
        });
    });
}

/// Size of thumbnails, in points.
const THUMBNAIL: Vec2 = Vec2::new(72.0, 54.0);

/// Columns of the list of techniques, and their width in points.
const COLUMNS: usize = 3;
const CELL_WIDTH: f32 = 196.0;

fn technique_box(ui: &mut Ui, session: &mut Session) {
    let names: Vec<String> = session.library.technique_names().map(str::to_owned).collect();
    let appearance = &session.recipe.appearance;
    let (mut chosen, mut is_open) = (None, false);
    let changed = if appearance.is_changed() { " *" } else { "" };
    let label = ui.label("Technique");
    egui::ComboBox::from_id_salt("technique")
        .selected_text(format!("{}{changed}", appearance.technique_name))
        .height(660.0)
        .width(170.0)
        .show_ui(ui, |ui| {
            is_open = true;
            // As high without thumbnails: egui keeps the first size of a list.
            let cell = Vec2::new(CELL_WIDTH, THUMBNAIL.y + 2.0 * ui.spacing().button_padding.y);
            egui::Grid::new("techniques").num_columns(COLUMNS).show(ui, |ui| {
                for (at, name) in names.iter().enumerate() {
                    let is_it = *name == appearance.technique_name;
                    let button = match session.thumbnails.textures.get(name) {
                        Some(texture) => {
                            let image = egui::Image::new((texture.id(), THUMBNAIL));
                            egui::Button::image_and_text(image, name.as_str())
                        }
                        None => egui::Button::new(name.as_str()),
                    };
                    let button = button.min_size(cell).selected(is_it);
                    if ui.add(button.frame_when_inactive(is_it)).clicked() {
                        chosen = Some(name.clone());
                    }
                    if at % COLUMNS == COLUMNS - 1 {
                        ui.end_row();
                    }
                }
            });
        })
        .response
        .labelled_by(label.id);
    if is_open && !session.thumbnails.are_wanted {
        session.thumbnails.are_wanted = true;
        session.ask(Request::DrawThumbnails);
    }
    if let Some(name) = chosen {
        session.take_technique(&name);
    }
}

fn file_menu(ui: &mut Ui, session: &mut Session, size: [u32; 2]) {
    item(ui, session, size, "Open…", Command::Open);
    let recent = session.remembered.recent.clone();
    ui.add_enabled_ui(!recent.is_empty(), |ui| {
        ui.menu_button("Open recent", |ui| {
            for models in recent {
                let paths: Vec<String> =
                    models.iter().map(|path| path.display().to_string()).collect();
                if ui.button(name_of(&models)).on_hover_text(paths.join("\n")).clicked() {
                    session.ask(Request::Open(models));
                }
            }
        });
    });
    item(ui, session, size, "Reload", Command::Reload);
    ui.separator();
    item(ui, session, size, "Save picture…", Command::SavePicture);
    if ui.button("Save window…").clicked() {
        session.ask(Request::SaveWindow);
        ui.close();
    }
    item(ui, session, size, "Save technique…", Command::SaveTechnique);
    ui.separator();
    item(ui, session, size, "Quit", Command::Quit);
}

fn edit_menu(ui: &mut Ui, session: &mut Session, size: [u32; 2]) {
    let (has_undo, has_redo) = (session.has_undo(), session.has_redo());
    ui.add_enabled_ui(has_undo, |ui| item(ui, session, size, "Undo", Command::Undo));
    ui.add_enabled_ui(has_redo, |ui| item(ui, session, size, "Redo", Command::Redo));
    ui.separator();
    item(ui, session, size, "Copy command", Command::CopyCommand);
    item(ui, session, size, "Copy camera", Command::CopyCamera);
}

fn view_menu(ui: &mut Ui, session: &mut Session, size: [u32; 2]) {
    for view in NamedView::ALL {
        item(ui, session, size, view.name(), Command::Side(view));
    }
    ui.separator();
    item(ui, session, size, "Default view", Command::Home);
    item(ui, session, size, "Fit", Command::Fit);
    item(ui, session, size, "Perspective or orthographic", Command::Projection);
    ui.separator();
    for (theme, name) in [
        (Theme::System, "System theme"),
        (Theme::Light, "Light theme"),
        (Theme::Dark, "Dark theme"),
    ] {
        ui.radio_value(&mut session.remembered.theme, theme, name);
    }
}

/// A menu entry with its key.
fn item(ui: &mut Ui, session: &mut Session, size: [u32; 2], name: &str, command: Command) {
    let key = super::keys::key_of(ui, command).unwrap_or_default();
    let button = egui::Button::new(name).shortcut_text(key);
    if ui.add(button).clicked() {
        run(command, session, size);
        ui.close();
    }
}

/// The bar below the picture: the models, what was drawn, and the GPU time.
pub fn status_bar(ui: &mut Ui, session: &Session) {
    ui.horizontal(|ui| {
        if let Some(scene) = &session.scene {
            let counts = |count: fn(&edgemesh::edge_mesh::MeshCounts) -> usize| {
                let objects = scene.objects.iter();
                objects.map(|at| count(&scene.models[at.model].mesh.counts)).sum::<usize>()
            };
            ui.label(session.recipe.title());
            ui.separator();
            let triangles = counts(|counts| counts.triangles);
            ui.label(format!("{} triangles", grouped(triangles)));
            ui.label(format!("{} edges", grouped(counts(|counts| counts.edges.edges))));
        }
        if let Some(last) = session.statistics.last() {
            if let Some(tally) = last.tally {
                ui.label(format!("{} strokes", grouped(tally.stroke_count as usize)));
            }
            let times: Vec<f64> = last.passes.iter().filter_map(|pass| pass.1).collect();
            if !times.is_empty() {
                ui.separator();
                ui.label(format!("{:.1} ms", times.iter().sum::<f64>()))
                    .on_hover_text("GPU time of the last picture");
            }
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.weak(&session.adapter);
        });
    });
}

/// A number with narrow spaces between its thousands.
pub(super) fn grouped(number: usize) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (at, digit) in digits.chars().enumerate() {
        if at > 0 && (digits.len() - at).is_multiple_of(3) {
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::grouped;

    #[test]
    fn thousands_are_apart() {
        let texts = [7, 1234, 1_234_567].map(|number| grouped(number).replace('\u{202f}', " "));
        assert_eq!(texts, ["7", "1 234", "1 234 567"]);
    }
}
