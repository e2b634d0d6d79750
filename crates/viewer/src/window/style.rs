//! Colors, fonts and spacing of the window, for the light and the dark theme.

use egui::{Color32, Context, CornerRadius, FontId, TextStyle, Visuals, vec2};

/// Sets the styles of both themes.
pub(super) fn apply(context: &Context) {
    context.set_visuals_of(egui::Theme::Light, light());
    context.set_visuals_of(egui::Theme::Dark, dark());
    context.all_styles_mut(|style| {
        style.spacing.item_spacing = vec2(8.0, 5.0);
        style.spacing.button_padding = vec2(8.0, 3.0);
        style.spacing.slider_width = 100.0;
        style.spacing.combo_width = 130.0;
        // Lists may be as high as a small window.
        style.spacing.default_area_size = vec2(640.0, 700.0);
        style.text_styles.insert(TextStyle::Heading, FontId::proportional(15.0));
        style.text_styles.insert(TextStyle::Body, FontId::proportional(13.0));
        style.text_styles.insert(TextStyle::Button, FontId::proportional(13.0));
        style.text_styles.insert(TextStyle::Monospace, FontId::monospace(12.0));
        style.text_styles.insert(TextStyle::Small, FontId::proportional(11.0));
    });
}

fn light() -> Visuals {
    let mut visuals = rounded(Visuals::light());
    visuals.widgets.noninteractive.fg_stroke.color = Color32::from_gray(40);
    visuals.weak_text_color = Some(Color32::from_gray(105));
    visuals
}

fn dark() -> Visuals {
    let mut visuals = rounded(Visuals::dark());
    visuals.widgets.noninteractive.fg_stroke.color = Color32::from_gray(205);
    visuals.weak_text_color = Some(Color32::from_gray(145));
    visuals
}

fn rounded(mut visuals: Visuals) -> Visuals {
    visuals.window_corner_radius = CornerRadius::same(8);
    visuals.menu_corner_radius = CornerRadius::same(6);
    let widgets = &mut visuals.widgets;
    for widget in [
        &mut widgets.noninteractive,
        &mut widgets.inactive,
        &mut widgets.hovered,
        &mut widgets.active,
        &mut widgets.open,
    ] {
        widget.corner_radius = CornerRadius::same(4);
    }
    visuals
}
