//! Edges where a neighbor leaves the plane through a texel: none on planes at any angle. Not from a
//! paper; Figure 3.11 of the thesis shows the problem that it solves.

use glam::{Mat4, Vec2, Vec3, Vec4};

use super::depth::{DepthMapping, distance_of};
use super::{CROSS, Image, Texel};

/// The view of an image.
#[derive(Debug, Clone, Copy)]
pub struct ImageView {
    /// Size of the image, in pixels.
    pub viewport_px: Vec2,
    /// Pixels per unit of the world at w = 1.
    pub px_per_unit: f32,
    /// The depths of the image.
    pub mapping: DepthMapping,
    /// The transform from clip space to the world.
    pub world_from_clip: Mat4,
}

/// The distance at the background, above every threshold.
const BACKGROUND_PX: f32 = 1.0e9;

/// The distance of neighbors from the plane through a texel, in pixels at its depth. Each pair
/// counts the smaller of the two distances from the plane of the other, so that both sides of a
/// step are edges and smooth bends are not. `depths` are those of the depth buffer, 0 for the
/// background; `normals` have any length, 0 for none.
#[must_use]
pub fn plane_distance_px(
    depths: &Image<f32>,
    normals: &Image<Vec3>,
    view: &ImageView,
    at: Texel,
) -> f32 {
    let is_background = |at: Texel| depths.at(at) <= 0.0;
    let normal = |at: Texel| normals.at(at).normalize_or_zero();
    let center = world_at(depths, view, at);
    let [.., w_scale, w_offset] = view.mapping.projection;
    let w = w_scale * distance_of(depths.at(at), &view.mapping) + w_offset;
    let unit_px = view.px_per_unit / w;
    let beside = CROSS.map(|[x, y]| {
        let other = [at[0] + x, at[1] + y];
        match (is_background(at), is_background(other)) {
            (true, true) => return 0.0,
            (false, false) => {}
            _ => return BACKGROUND_PX,
        }
        let step = world_at(depths, view, other) - center;
        unit_px * normal(at).dot(step).abs().min(normal(other).dot(step).abs())
    });
    beside.into_iter().fold(0.0, f32::max)
}

/// The point of the world at a texel, or at the nearest texel.
fn world_at(depths: &Image<f32>, view: &ImageView, at: Texel) -> Vec3 {
    let [width, height] = depths.size();
    let last = [width, height].map(|count| count.cast_signed() - 1);
    #[expect(clippy::cast_precision_loss, reason = "an image has at most 2^14 columns")]
    let middle = |axis: usize| at[axis].clamp(0, last[axis]) as f32 + 0.5;
    let across = Vec2::new(middle(0), middle(1)) / view.viewport_px;
    let clip = Vec4::new(2.0 * across.x - 1.0, 1.0 - 2.0 * across.y, depths.at(at), 1.0);
    let world = view.world_from_clip * clip;
    world.truncate() / world.w
}
