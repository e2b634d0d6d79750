//! The line between two compared appearances.

use egui::{
    Align2, Color32, CursorIcon, EventFilter, FontId, Key, Rect, Sense, Stroke, Ui, pos2, vec2,
};

/// How far an arrow key moves the line, as a share of the width.
const STEP: f32 = 0.02;

/// Draws the line at `share` of the width of `rect`, with a technique's name on each side.
/// Returns its position after dragging or, with the focus, arrow keys.
pub fn comparison_line(ui: &Ui, rect: Rect, share: f32, names: [String; 2]) -> f32 {
    let x = egui::lerp(rect.left()..=rect.right(), share);
    let handle = Rect::from_center_size(pos2(x, rect.center().y), vec2(14.0, rect.height()));
    let response = ui.interact(handle, ui.scope_id().with("comparison"), Sense::drag());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Slider, true, "Comparison line"));
    let response = response.on_hover_cursor(CursorIcon::ResizeHorizontal);
    let color = match response.hovered() || response.dragged() || response.has_focus() {
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
    let share = moved.map_or(share, |at| (at.x - rect.left()) / rect.width());
    (share + stepped(ui, &response)).clamp(0.0, 1.0)
}

/// How far arrow keys move the line.
fn stepped(ui: &Ui, response: &egui::Response) -> f32 {
    if !response.has_focus() {
        return 0.0;
    }
    // Otherwise arrows would move the focus.
    let filter = EventFilter { horizontal_arrows: true, ..EventFilter::default() };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
    let presses = |key| ui.input(|input| input.num_presses(key));
    let steps = |key| (0..presses(key)).map(|_| STEP).sum::<f32>();
    steps(Key::ArrowRight) - steps(Key::ArrowLeft)
}
