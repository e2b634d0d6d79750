//! Widgets for variables, made from their descriptors: sliders over the range for the UI,
//! typed values beyond it; colors, words, textures.

use std::path::PathBuf;

use egui::{Button, ComboBox, DragValue, Id, Response, Slider, SliderClamping, TextEdit, Ui};

use super::image_preview::image_preview;
use crate::technique::descriptor::VariableDescriptor;
use crate::technique::image_file::images_of;
use crate::technique::texture_name::{TextureName, TextureSource};
use crate::technique::value::{Value, VariableType};

/// A changed value of a variable.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Edit {
    /// Index of the pass.
    pub(super) pass: usize,
    /// Index of the variable in its component.
    pub(super) variable: usize,
    /// The new value.
    pub(super) value: Value,
}

/// A widget for a variable, labeled by `label`; returns the new value if it has changed.
pub(super) fn variable_widget(
    ui: &mut Ui,
    variable: &VariableDescriptor,
    value: &Value,
    label: Id,
    folders: &[PathBuf],
) -> Option<Value> {
    let changed = |response: Response| response.labelled_by(label).changed();
    ui.add_enabled_ui(!variable.read_only, |ui| match value {
        Value::Bool(is_on) => {
            let mut is_on = *is_on;
            changed(ui.checkbox(&mut is_on, "")).then_some(Value::Bool(is_on))
        }
        Value::Int(number) => {
            let mut number = *number;
            let ends = (int(variable.ui_minimum.as_ref()), int(variable.ui_maximum.as_ref()));
            let response = match ends {
                (Some(low), Some(high)) => {
                    ui.add(Slider::new(&mut number, low..=high).clamping(SliderClamping::Never))
                }
                _ => ui.add(DragValue::new(&mut number)),
            };
            changed(response).then_some(Value::Int(number))
        }
        Value::Numbers(numbers) if variable.kind.is_color() => color(ui, numbers, label),
        Value::Numbers(numbers) => self::numbers(ui, variable, numbers, label),
        Value::String(text) => self::text(ui, variable, text, label).map(Value::String),
        Value::Texture(name) => texture(ui, variable, name, label, folders).map(Value::Texture),
    })
    .inner
}

const fn int(value: Option<&Value>) -> Option<i32> {
    match value {
        Some(Value::Int(value)) => Some(*value),
        _ => None,
    }
}

fn number_at(value: Option<&Value>, at: usize) -> Option<f32> {
    match value {
        Some(Value::Numbers(numbers)) => numbers.get(at).copied(),
        _ => None,
    }
}

/// One slider, or several numbers in a row.
fn numbers(
    ui: &mut Ui,
    variable: &VariableDescriptor,
    numbers: &[f32],
    label: Id,
) -> Option<Value> {
    let mut new = numbers.to_vec();
    let mut is_changed = false;
    ui.horizontal(|ui| {
        for (at, number) in new.iter_mut().enumerate() {
            let low = number_at(variable.ui_minimum.as_ref(), at);
            let high = number_at(variable.ui_maximum.as_ref(), at);
            let response = match (low, high) {
                (Some(low), Some(high)) if numbers.len() == 1 => {
                    let is_wide = low >= 0.0 && high / low.max(1e-3) > 2e4;
                    let slider = Slider::new(number, low..=high)
                        .max_decimals(4)
                        .clamping(SliderClamping::Never)
                        .logarithmic(is_wide);
                    ui.add(slider)
                }
                (low, high) => {
                    let reach = match (low, high) {
                        (Some(low), Some(high)) => f64::from(high - low),
                        _ => f64::from(number.abs()).max(1.0),
                    };
                    ui.add(DragValue::new(number).speed(reach / 200.0).max_decimals(4))
                }
            };
            is_changed |= response.labelled_by(label).changed();
        }
    });
    is_changed.then_some(Value::Numbers(new))
}

fn color(ui: &mut Ui, numbers: &[f32], label: Id) -> Option<Value> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
    let byte = |number: f32| (number * 255.0).round().clamp(0.0, 255.0) as u8;
    let number = |byte: u8| f32::from(byte) / 255.0;
    match *numbers {
        [r, g, b] => {
            let mut color = [r, g, b].map(byte);
            let response = ui.color_edit_button_srgb(&mut color).labelled_by(label);
            response.changed().then(|| Value::Numbers(color.map(number).to_vec()))
        }
        [r, g, b, a] => {
            let mut color = [r, g, b, a].map(byte);
            let response = ui.color_edit_button_srgba_unmultiplied(&mut color).labelled_by(label);
            response.changed().then(|| Value::Numbers(color.map(number).to_vec()))
        }
        _ => None,
    }
}

/// A choice of words, or a text.
fn text(ui: &mut Ui, variable: &VariableDescriptor, text: &str, label: Id) -> Option<String> {
    let mut new = text.to_owned();
    if variable.one_of.is_empty() {
        let edit = TextEdit::singleline(&mut new).desired_width(160.0);
        return ui.add(edit).labelled_by(label).changed().then_some(new);
    }
    ComboBox::from_id_salt(&variable.name)
        .selected_text(text)
        .show_ui(ui, |ui| {
            for word in &variable.one_of {
                ui.selectable_value(&mut new, word.clone(), word);
            }
        })
        .response
        .labelled_by(label);
    (new != text).then_some(new)
}

/// A choice of the images in the variable's directory, or the name of any texture.
fn texture(
    ui: &mut Ui,
    variable: &VariableDescriptor,
    name: &TextureName,
    label: Id,
    folders: &[PathBuf],
) -> Option<TextureName> {
    let Some(directory) = variable.directory.as_deref() else {
        let mut text = name.to_string();
        let edit = TextEdit::singleline(&mut text).desired_width(160.0);
        let is_changed = ui.add(edit).labelled_by(label).changed();
        return VariableType::Texture.parse(&text).ok().filter(|_| is_changed).and_then(|value| {
            match value {
                Value::Texture(name) => Some(name),
                _ => None,
            }
        });
    };
    let mut new = name.source.clone();
    let shown = match &name.source {
        TextureSource::Image { image, .. } => image.clone(),
        _ => name.to_string(),
    };
    let list = ComboBox::from_id_salt(&variable.name).selected_text(shown).show_ui(ui, |ui| {
        if variable.default.as_ref() == Some(&Value::Texture(TextureName::NONE)) {
            ui.selectable_value(&mut new, TextureSource::None, "none");
        }
        for (image, file) in images_of(directory, folders) {
            let directory = Some(directory.to_owned());
            let source = TextureSource::Image { directory, image: image.clone() };
            let is_it = source == new;
            let button = match image_preview(ui, &file) {
                Some(texture) => Button::image_and_text(&texture, image.as_str()),
                None => Button::new(image.as_str()),
            };
            if ui.add(button.selected(is_it).frame_when_inactive(is_it)).clicked() {
                new = source;
            }
        }
    });
    list.response.labelled_by(label).on_hover_ui(|ui| {
        // The folders are read only while the list is open.
        let TextureSource::Image { image, .. } = &new else { return };
        let images = images_of(directory, folders);
        let file = images.iter().find(|(known, _)| known == image).map(|(_, file)| file);
        if let Some(texture) = file.and_then(|file| image_preview(ui, file)) {
            ui.image(&texture);
        }
    });
    (new != name.source).then_some(TextureName { source: new, is_filtered: name.is_filtered })
}
