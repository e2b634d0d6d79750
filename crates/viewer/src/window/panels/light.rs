//! The light, which can be dragged, and the clip planes.

use egui::{Color32, DragValue, Grid, Sense, Slider, Ui, Vec2};
use glam::DVec3;
use strokes::MAX_CLIP_PLANES;

use crate::scene::lighting::{Light, Lighting};
use crate::scene::models::Scene;
use crate::window::hands::{CUT_KEY, LIGHT_KEY, drag_with};
use crate::window::light_hand::{in_camera, in_world, point_at, rounded, shone_from};
use crate::window::session::Session;
use crate::window::viewpoint::Viewpoint;

pub(super) fn light_panel(ui: &mut Ui, session: &mut Session) {
    let view = session.recipe.viewpoint;
    let scene = session.scene.clone();
    let lighting = &mut session.recipe.appearance.lighting;
    ui.heading("Light");
    kind(ui, lighting, view.as_ref(), scene.as_deref());
    ui.add_space(6.0);
    ui.horizontal(|ui| {
        if let Some(view) = &view {
            ball(ui, lighting, view, scene.as_deref());
        }
        ui.vertical(|ui| numbers(ui, lighting));
    });
    ui.horizontal(|ui| {
        let label = ui.label("Color");
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
        let mut color = lighting.color.map(|c| (c * 255.0).round().clamp(0.0, 255.0) as u8);
        if ui.color_edit_button_srgb(&mut color).labelled_by(label.id).changed() {
            lighting.color = color.map(|channel| f32::from(channel) / 255.0);
        }
        if ui.button("Reset light").clicked() {
            let default = Lighting::default();
            (lighting.light, lighting.color) = (default.light, default.color);
        }
    });
    ui.weak(format!("{} over the picture also turns the light", drag_with(LIGHT_KEY)));
    ui.add_space(10.0);
    ui.heading("Cuts");
    if let Some(scene) = scene {
        cuts(ui, lighting, &mut session.chosen_cut, &scene, view.as_ref());
    }
}

/// Switches the kind of light; its direction stays the same in this view.
fn kind(ui: &mut Ui, lighting: &mut Lighting, view: Option<&Viewpoint>, scene: Option<&Scene>) {
    let (Some(view), Some(scene)) = (view, scene) else { return };
    let in_camera = in_camera(&lighting.light, view, scene);
    let is = |light: &Light| match light {
        Light::Camera(_) => 0,
        Light::World(_) => 1,
        Light::Point(_) => 2,
    };
    ui.horizontal(|ui| {
        for (number, name) in ["With the camera", "In the world", "At a point"].iter().enumerate() {
            let is_it = is(&lighting.light) == number;
            if ui.radio(is_it, *name).clicked() && !is_it {
                lighting.light = match number {
                    0 => Light::Camera(rounded(in_camera)),
                    1 => Light::World(rounded(in_world(in_camera, view))),
                    _ => Light::Point(point_at(in_camera, view, scene)),
                };
            }
        }
    });
}

/// A ball that is lit like the scene; dragging over it moves the light.
fn ball(ui: &mut Ui, lighting: &mut Lighting, view: &Viewpoint, scene: Option<&Scene>) {
    let Some(scene) = scene else { return };
    let (response, painter) = ui.allocate_painter(Vec2::splat(96.0), Sense::click_and_drag());
    response.widget_info(|| {
        egui::WidgetInfo::labeled(egui::Role::Canvas, true, "Direction of the light")
    });
    let rect = response.rect;
    let radius = rect.width() / 2.0 - 4.0;
    if let Some(at) = response.interact_pointer_pos() {
        let at = (at - rect.center()) / radius;
        let (x, y) = (f64::from(at.x), -f64::from(at.y));
        let flat = x.hypot(y);
        // Outside the ball the light comes from the side.
        let (x, y) = if flat > 1.0 { (x / flat, y / flat) } else { (x, y) };
        let direction = DVec3::new(x, y, (1.0 - x * x - y * y).max(0.0).sqrt());
        lighting.light = shone_from(&lighting.light, direction, view, scene);
    }
    let light = in_camera(&lighting.light, view, scene);
    let base = egui::Rgba::from(ui.visuals().widgets.inactive.bg_fill);
    // Rings from the rim to the center, each darker at the rim.
    const STEPS: u8 = 24;
    for step in 0..STEPS {
        let share = f32::from(step) / f32::from(STEPS);
        let offset = Vec2::new(f64_to_f32(light.x), -f64_to_f32(light.y)) * (share * radius * 0.7);
        let bright = 0.25 + 0.75 * share * f64_to_f32(light.z.max(0.0)).mul_add(0.6, 0.4);
        let color = Color32::from(base * (1.0 - share) + egui::Rgba::from_gray(bright) * share);
        painter.circle_filled(rect.center() + offset, radius * (1.0 - share), color);
    }
    let stroke = ui.visuals().widgets.noninteractive.fg_stroke;
    painter.circle_stroke(rect.center(), radius, stroke);
    let dot = rect.center() + Vec2::new(f64_to_f32(light.x), -f64_to_f32(light.y)) * radius;
    let color = if light.z < 0.0 { Color32::GRAY } else { Color32::from_rgb(255, 190, 60) };
    painter.circle_filled(dot, 5.0, color);
    painter.circle_stroke(dot, 5.0, stroke);
}

#[expect(clippy::cast_possible_truncation, reason = "a position on the screen")]
const fn f64_to_f32(number: f64) -> f32 {
    number as f32
}

fn numbers(ui: &mut Ui, lighting: &mut Lighting) {
    let vector = match &mut lighting.light {
        Light::Camera(vector) | Light::World(vector) | Light::Point(vector) => vector,
    };
    let before = *vector;
    Grid::new("light").num_columns(2).show(ui, |ui| {
        for (name, number) in [("x", &mut vector.x), ("y", &mut vector.y), ("z", &mut vector.z)] {
            let label = ui.label(name);
            ui.add(DragValue::new(number).speed(0.01).max_decimals(4)).labelled_by(label.id);
            ui.end_row();
        }
    });
    if *vector == DVec3::ZERO && !matches!(lighting.light, Light::Point(_)) {
        let light = &mut lighting.light;
        // A zero vector is no direction: the one before stays.
        *light = match light {
            Light::Camera(_) => Light::Camera(before),
            _ => Light::World(before),
        };
    }
}

fn cuts(
    ui: &mut Ui,
    lighting: &mut Lighting,
    chosen: &mut usize,
    scene: &Scene,
    view: Option<&Viewpoint>,
) {
    let center = scene.frame.to_file(scene.bounds.center());
    let radius = scene.bounds.radius() / scene.frame.scale;
    let mut removed = None;
    for (at, plane) in lighting.clip_planes.iter_mut().enumerate() {
        ui.push_id(at, |ui| {
            let mut normal = DVec3::new(plane[0], plane[1], plane[2]);
            let length = normal.length();
            // Distance of the plane from the center of the scene.
            let mut offset = -(normal.dot(center) + plane[3]) / length;
            let before = (normal, offset);
            ui.horizontal(|ui| {
                for (name, axis) in [("X", DVec3::X), ("Y", DVec3::Y), ("Z", DVec3::Z)] {
                    let is_it = normal == axis || normal == -axis;
                    if ui.selectable_label(is_it, name).clicked() {
                        normal = axis;
                    }
                }
                if ui
                    .button("Along view")
                    .on_hover_text("perpendicular to the line of sight")
                    .clicked()
                    && let Some(view) = view
                {
                    normal = rounded(view.forward());
                }
                if ui.button("Flip").clicked() {
                    (normal, offset) = (-normal, -offset);
                }
                if ui.button("Remove").clicked() {
                    removed = Some(at);
                }
            });
            ui.horizontal(|ui| {
                let label = ui.selectable_label(*chosen == at, "Position");
                let hint = format!("{} over the picture moves this cut", drag_with(CUT_KEY));
                let label = label.on_hover_text(hint);
                if label.clicked() {
                    *chosen = at;
                }
                let slider = Slider::new(&mut offset, -radius..=radius)
                    .clamping(egui::SliderClamping::Never);
                ui.add(slider).labelled_by(label.id);
            });
            if (normal, offset) != before {
                let d = -(normal.dot(center) + offset * normal.length());
                *plane = [normal.x, normal.y, normal.z, d];
                *chosen = at;
            }
        });
    }
    if let Some(at) = removed {
        lighting.clip_planes.remove(at);
    }
    let can_add = lighting.clip_planes.len() < MAX_CLIP_PLANES;
    if ui.add_enabled(can_add, egui::Button::new("Add cut")).clicked() {
        *chosen = lighting.clip_planes.len();
        lighting.clip_planes.push([0.0, 0.0, -1.0, center.z]);
    }
}
