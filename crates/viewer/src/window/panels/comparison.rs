//! The line between two looks.

use egui::{Align2, Color32, CursorIcon, FontId, Rect, Sense, Stroke, Ui, pos2, vec2};

/// The line between two looks, at a share of the width of `rect`, with their names at its
/// sides; where it is after a hand has moved it.
pub fn comparison_line(ui: &Ui, rect: Rect, share: f32, names: [String; 2]) -> f32 {
    let x = egui::lerp(rect.left()..=rect.right(), share);
    let handle = Rect::from_center_size(pos2(x, rect.center().y), vec2(14.0, rect.height()));
    let response = ui.interact(handle, ui.scope_id().with("comparison"), Sense::drag());
    response.widget_info(|| {
        egui::WidgetInfo::labeled(egui::Role::Slider, true, "Line between the looks")
    });
    let response = response.on_hover_cursor(CursorIcon::ResizeHorizontal);
    let color = match response.hovered() || response.dragged() {
        true => ui.visuals().selection.bg_fill,
        false => Color32::from_gray(128),
    };
    let painter = ui.painter_at(rect);
    painter.vline(x, rect.y_range(), Stroke::new(2.0, color));
    painter.circle_filled(pos2(x, rect.center().y), 7.0, color);
    let [left, right] = names;
    for (name, align, offset) in [(left, Align2::RIGHT_TOP, -10.0), (right, Align2::LEFT_TOP, 10.0)]
    {
        let at = pos2(x + offset, rect.top() + 10.0);
        let font = FontId::proportional(13.0);
        let galley = painter.layout_no_wrap(name, font, Color32::from_gray(30));
        let place = align.anchor_size(at, galley.size());
        painter.rect_filled(place.expand(4.0), 4.0, Color32::from_white_alpha(220));
        painter.galley(place.min, galley, Color32::BLACK);
    }
    let moved = response.interact_pointer_pos().filter(|_| response.dragged());
    moved.map_or(share, |at| ((at.x - rect.left()) / rect.width()).clamp(0.0, 1.0))
}
