//! Debug views, textures between passes, edge counts, GPU times, and repairs.

use std::collections::BTreeMap;

use egui::{Grid, Slider, SliderClamping, Ui};
use egui_plot::{Legend, Line, Plot, PlotPoints};

use super::bar::grouped;
use crate::window::inspection::Inspection;
use crate::window::session::{DEBUG_VIEWS, KEPT_FRAMES, Session};

pub(super) fn inspect_panel(ui: &mut Ui, session: &mut Session) {
    ui.heading("Debug views");
    ui.horizontal_wrapped(|ui| {
        if ui.selectable_label(!session.is_debug_view(), "The picture").clicked() {
            session.leave_debug_view();
        }
        for (technique, name) in DEBUG_VIEWS {
            let is_it = session.recipe.appearance.technique_name == technique;
            if ui.selectable_label(is_it, name).clicked() && !is_it {
                session.show_debug_view(technique);
            }
        }
    });
    ui.add_space(8.0);
    textures(ui, session);
    ui.add_space(8.0);
    counts(ui, session);
    ui.add_space(8.0);
    times(ui, session);
    ui.add_space(8.0);
    repairs(ui, session);
}

/// The textures that passes write for each other.
fn textures(ui: &mut Ui, session: &mut Session) {
    ui.heading("Textures between passes");
    if session.generated.is_empty() {
        ui.weak("This technique draws no textures between passes.");
        return;
    }
    ui.horizontal_wrapped(|ui| {
        if ui.selectable_label(session.inspection.is_none(), "None").clicked() {
            session.inspection = None;
        }
        for texture in session.generated.clone() {
            let known = session.inspection.as_ref();
            let is_it = known.is_some_and(|inspection| inspection.texture == texture);
            let label = ui.selectable_label(is_it, &texture.name);
            let label = label.on_hover_text(texture.format.word());
            if label.clicked() && !is_it {
                session.inspection = Some(Inspection::of(texture));
            }
        }
    });
    if let Some(inspection) = session.inspection.as_mut().filter(|known| known.has_range()) {
        Grid::new("range").num_columns(2).show(ui, |ui| {
            for (name, number) in [("Black", &mut inspection.low), ("White", &mut inspection.high)]
            {
                let label = ui.label(name);
                let slider = Slider::new(number, -2.0..=2.0).clamping(SliderClamping::Never);
                ui.add(slider).labelled_by(label.id);
                ui.end_row();
            }
        });
    }
}

fn counts(ui: &mut Ui, session: &Session) {
    let Some(tally) = session.statistics.last().and_then(|last| last.tally) else { return };
    ui.heading("Edges in this view");
    Grid::new("counts").num_columns(2).spacing([16.0, 2.0]).show(ui, |ui| {
        let features = tally.features();
        for class in edgemesh::line::LineClass::ALL {
            ui.label(class.name());
            ui.label(grouped(features[class] as usize));
            ui.end_row();
        }
        ui.label("strokes");
        ui.label(grouped(tally.stroke_count as usize));
        ui.end_row();
    });
}

/// Milliseconds of each pass over the last pictures.
fn times(ui: &mut Ui, session: &Session) {
    ui.heading("GPU time");
    let mut by_pass: BTreeMap<&str, Vec<[f64; 2]>> = BTreeMap::new();
    for (at, frame) in session.statistics.iter().enumerate() {
        for (name, ms) in &frame.passes {
            if let Some(ms) = ms {
                #[expect(clippy::cast_precision_loss, reason = "a few frames")]
                by_pass.entry(name).or_default().push([at as f64, *ms]);
            }
        }
    }
    if by_pass.is_empty() {
        ui.weak(
            "No timings: this adapter has no timestamp queries, or nothing has been drawn yet.",
        );
        return;
    }
    #[expect(clippy::cast_precision_loss, reason = "a few frames")]
    let most = KEPT_FRAMES as f64;
    Plot::new("times")
        .height(160.0)
        .legend(Legend::default())
        .allow_drag(false)
        .allow_zoom(false)
        .allow_scroll(false)
        .include_x(0.0)
        .include_x(most)
        .include_y(0.0)
        .y_axis_label("ms")
        .show_x(false)
        .show(ui, |plot| {
            for (name, points) in &by_pass {
                let is_shown = points.iter().any(|point| point[1] >= 0.05);
                if is_shown {
                    plot.line(Line::new(*name, PlotPoints::from(points.clone())));
                }
            }
        });
    Grid::new("times now").num_columns(2).spacing([16.0, 2.0]).show(ui, |ui| {
        let last = session.statistics.last().map_or(&[][..], |last| &last.passes);
        for (name, ms) in last {
            ui.label(name);
            ui.label(ms.map_or_else(|| "—".to_owned(), |ms| format!("{ms:.2} ms")));
            ui.end_row();
        }
    });
}

/// The repairs to each model.
fn repairs(ui: &mut Ui, session: &Session) {
    let Some(scene) = &session.scene else { return };
    ui.heading("Repairs");
    for model in scene.models.iter().take(scene.file_count) {
        let lines = model.report.warning_lines(&model.name, "");
        if lines.is_empty() {
            ui.weak(format!("{}: none", model.name.trim_end_matches(':')));
        }
        for line in lines {
            ui.label(line);
        }
    }
}
