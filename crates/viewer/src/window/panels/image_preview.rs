//! Previews of image files in a list of images.

use std::time::SystemTime;

use egui::{Color32, ColorImage, Id, TextureHandle, TextureOptions, Ui, Vec2};
use image::imageops::{FilterType, resize};
use image::{Rgba, RgbaImage};

use crate::pass_graph::textures::decode_image;
use crate::technique::image_file::ImageFile;

/// The largest width and height, in points.
pub(super) const SIZE: Vec2 = Vec2::new(64.0, 24.0);

/// The preview of an image, kept until its file changes; `None` if it cannot be read.
pub(super) fn image_preview(ui: &Ui, file: &ImageFile) -> Option<TextureHandle> {
    let changed = file.changed();
    let id = Id::unique(("image preview", file));
    let known: Option<Preview> = ui.data(|data| data.get_temp(id));
    if let Some(known) = known.filter(|known| known.changed == changed) {
        return known.texture;
    }
    let picture = file.bytes().ok().and_then(|bytes| decode_image(&bytes).ok());
    let texture = picture.map(|picture| {
        let scale = ui.ctx().pixels_per_point();
        let small = on_gray(&picture, SIZE * scale);
        let size = [small.width() as usize, small.height() as usize];
        let small = ColorImage::from_rgba_unmultiplied(size, &small);
        ui.ctx().load_texture(file.name(), small, TextureOptions::LINEAR)
    });
    let made = Preview { changed, texture: texture.clone() };
    ui.data_mut(|data| data.insert_temp(id, made));
    texture
}

#[derive(Clone)]
struct Preview {
    changed: Option<SystemTime>,
    texture: Option<TextureHandle>,
}

/// An image scaled to fit, on gray, so that dark and light images are visible in any theme.
fn on_gray(picture: &RgbaImage, most: Vec2) -> RgbaImage {
    #[expect(clippy::cast_precision_loss, reason = "images have fewer pixels a side")]
    let [width, height] = [picture.width(), picture.height()].map(|side| side as f32);
    let scale = (most.x / width).min(most.y / height).min(1.0);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "positive")]
    let [width, height] = [width, height].map(|side| (side * scale).round().max(1.0) as u32);
    let mut small = resize(picture, width, height, FilterType::Triangle);
    for Rgba([r, g, b, a]) in small.pixels_mut() {
        let gray = Color32::from_gray(150).blend(Color32::from_rgba_unmultiplied(*r, *g, *b, *a));
        [*r, *g, *b, *a] = gray.to_array();
    }
    small
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_preview_fits_and_hides_nothing() {
        let mut brush = RgbaImage::from_pixel(512, 64, Rgba([0, 0, 0, 0]));
        for y in 0..64 {
            for x in 0..256 {
                brush.put_pixel(x, y, Rgba([0, 0, 0, 255]));
            }
        }
        let small = on_gray(&brush, Vec2::new(64.0, 24.0));
        assert_eq!(small.dimensions(), (64, 8));
        assert_eq!(small.get_pixel(4, 4), &Rgba([0, 0, 0, 255]));
        assert_eq!(small.get_pixel(60, 4), &Rgba([150, 150, 150, 255]));
    }
}
