//! The uniform of a view, the same in every pass, and the uniform of an object in a view.

use bytemuck::{Pod, Zeroable};
use edgemesh::edge_mesh::{Bounds, Quantization};
use edgemesh::index::to_u32;
use edgemesh::view::{View, eye_is_outside, to_pixels};
use glam::{DMat3, DMat4, Mat4, Vec3, Vec4};

use crate::gpu::bind::{bind_buffers, uniform_buffer, uniform_entry};
use crate::view::tile::Tile;

/// The uniform of a view: `@group(0)` of every pass. WGSL twin: `shaders/common/frame.wgsl`.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct FrameUniform {
    /// Size of the tile that is drawn, or of the whole picture.
    pub viewport_px: [f32; 2],
    /// Pixels per unit of the world at w = 1.
    pub px_per_unit: f32,
    /// How many of `clip_planes` are in use.
    pub clip_plane_count: u32,
    /// At the distance d along the line of sight, clip z is x d + y and clip w is z d + w.
    pub projection: [f32; 4],
    /// Size of the whole picture.
    pub picture_px: [f32; 2],
    /// The upper left corner of the tile, from that of the picture.
    pub corner_px: [f32; 2],
    /// Where edges are clipped: left, right, bottom and top, in clip space at w = 1.
    pub guard_band: [f32; 4],
    /// From clip space back to the world.
    pub world_from_clip: [[f32; 4]; 4],
    /// The eye with w = 1, or the direction to the viewer with w = 0.
    pub eye: [f32; 4],
    /// The scalar product with a point of the world is its distance from the eye along the
    /// line of sight.
    pub sight: [f32; 4],
    /// Direction to the right of the picture, of unit length; w is 0.
    pub right: [f32; 4],
    /// Direction to the top of the picture, of unit length; w is 0.
    pub up: [f32; 4],
    /// A light at a point with w = 1, or in a direction of unit length with w = 0.
    pub light: [f32; 4],
    /// RGB, 1 for white.
    pub light_color: [f32; 3],
    /// Half the diagonal of the box around the scene.
    pub scene_radius: f32,
    /// The distances from the eye along the line of sight between which the scene's bounding sphere
    /// lies.
    pub depth_range: [f32; 2],
    /// Unused.
    pub padding: [f32; 2],
    /// A point of the world is drawn if its scalar product with none of these is negative;
    /// planes beyond the count are zero.
    pub clip_planes: [[f32; 4]; MAX_CLIP_PLANES],
}

/// The most clip planes of a view. WGSL twin: the constant of this name.
pub const MAX_CLIP_PLANES: usize = 6;

/// Light and clip planes of a view.
#[derive(Debug, Clone, PartialEq)]
pub struct Surroundings {
    /// A light at a point with w = 1, or in a direction of unit length with w = 0.
    pub light: [f32; 4],
    /// RGB, 1 for white.
    pub light_color: [f32; 3],
    /// The middle of the box around the scene.
    pub scene_center: [f32; 3],
    /// Half the diagonal of that box.
    pub scene_radius: f32,
    /// Points of the world whose scalar product with one of these is negative are cut away.
    /// Planes past [`MAX_CLIP_PLANES`] are ignored.
    pub clip_planes: Vec<[f32; 4]>,
}

impl Default for Surroundings {
    /// White light along z, and nothing cut away.
    fn default() -> Self {
        let light = [0.0, 0.0, 1.0, 0.0];
        Self {
            light,
            light_color: [1.0; 3],
            scene_center: [0.0; 3],
            scene_radius: 1.0,
            clip_planes: Vec::new(),
        }
    }
}

impl FrameUniform {
    /// The uniform of a tile of the picture that `view` sees.
    #[must_use]
    pub fn new(view: &View, tile: &Tile, around: &Surroundings) -> Self {
        // The row of y is as long as a unit of the world is high in clip space.
        let y_row = view.clip_from_world.row(1).truncate();
        let px_per_unit = y_row.length() * tile.picture_px.y * 0.5;
        let [[z_scale, z_offset], [w_scale, w_offset]] =
            [2, 3].map(|row| along_sight(view.clip_from_world.row(row), view.distance));
        // Rows of the view's matrix without the projection's scale.
        let axis = |row: usize| view.clip_from_world.row(row).truncate().normalize_or_zero();
        let mut clip_planes = [[0.0; 4]; MAX_CLIP_PLANES];
        clip_planes.iter_mut().zip(&around.clip_planes).for_each(|(plane, given)| *plane = *given);
        let world_from_clip = tile.view(view).clip_from_world.as_dmat4().inverse().as_mat4();
        Self {
            viewport_px: tile.size_px.to_array(),
            px_per_unit,
            clip_plane_count: to_u32(around.clip_planes.len().min(MAX_CLIP_PLANES)),
            projection: [z_scale, z_offset, w_scale, w_offset],
            picture_px: tile.picture_px.to_array(),
            corner_px: tile.corner_px.to_array(),
            guard_band: tile.guard_band(),
            world_from_clip: world_from_clip.to_cols_array_2d(),
            eye: view.eye.to_array(),
            sight: view.distance.to_array(),
            right: axis(0).extend(0.0).to_array(),
            up: axis(1).extend(0.0).to_array(),
            light: around.light,
            light_color: around.light_color,
            scene_radius: around.scene_radius,
            depth_range: depth_range(view, around),
            padding: [0.0; 2],
            clip_planes,
        }
    }

    /// The tile that is drawn.
    pub(crate) fn tile(&self) -> Tile {
        Tile {
            picture_px: self.picture_px.into(),
            corner_px: self.corner_px.into(),
            size_px: self.viewport_px.into(),
        }
    }
}

/// The distances from the eye along the line of sight between which the scene lies; in perspective,
/// from [`MIN_DEPTH_RADII`] on.
fn depth_range(view: &View, around: &Surroundings) -> [f32; 2] {
    let radius = around.scene_radius;
    let middle = view.distance.dot(Vec3::from(around.scene_center).extend(1.0));
    let (near, far) = (middle - 1.01 * radius, middle + 1.01 * radius);
    if view.eye.w == 0.0 {
        return [near, far];
    }
    let near = near.max(MIN_DEPTH_RADII * radius);
    [near, far.max(2.0 * near)]
}

/// The least distance at which the depth range of a perspective view begins, in radii of the scene.
const MIN_DEPTH_RADII: f32 = 1e-4;

/// A row of the projection as a linear function of the distance along the line of sight, on
/// which alone z and w depend: factor and offset.
fn along_sight(row: Vec4, distance: Vec4) -> [f32; 2] {
    let (row, distance) = (row.as_dvec4(), distance.as_dvec4());
    let direction = distance.truncate();
    let scale = row.truncate().dot(direction) / direction.length_squared();
    let offset = row.w - scale * distance.w;
    #[expect(clippy::cast_possible_truncation, reason = "as the shader has it")]
    [scale, offset].map(|value| value as f32)
}

/// The uniform of an object in a view. WGSL twin: `shaders/common/frame.wgsl`.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct ObjectUniform {
    /// From the object's positions to clip space; depth is 1 near and 0 far.
    pub clip_from_object: [[f32; 4]; 4],
    /// From clip space back to the object.
    pub object_from_clip: [[f32; 4]; 4],
    /// From the object's normals to clip space, as directions of a unit of the world.
    pub clip_from_normal: [[f32; 4]; 4],
    /// The eye in the object's space with w = 1, or the direction to the viewer
    /// with w = 0.
    pub eye: [f32; 4],
    /// The scalar product with a position is its distance from the eye along the line of
    /// sight.
    pub distance: [f32; 4],
    /// The object's origin on the screen, from the middle of the tile.
    pub origin_px: [f32; 2],
    /// -1 if the transform mirrors the object, else 1.
    pub mirror: f32,
    /// 1 if the eye is outside the object's box, else 0.
    pub eye_is_outside: u32,
    /// Replicated at 16 bits: the position of step 0.
    pub center: [f32; 3],
    /// Replicated at 16 bits: units per step.
    pub step: f32,
    /// From the object's positions to the world.
    pub world_from_object: [[f32; 4]; 4],
    /// From the object's normals to the world, as directions of a unit of the world.
    pub world_from_normal: [[f32; 4]; 4],
}

impl ObjectUniform {
    /// The uniform of an object with `bounds`, placed by `world_from_object`, in a tile of the
    /// picture that `view` sees; `None` if the transform flattens the object.
    pub(crate) fn new(
        view: &View,
        tile: &Tile,
        world_from_object: DMat4,
        bounds: &Bounds,
    ) -> Option<Self> {
        let determinant = DMat3::from_mat4(world_from_object).determinant();
        let object_from_world = world_from_object.inverse();
        if determinant == 0.0 || !determinant.is_finite() || !object_from_world.is_finite() {
            return None;
        }
        let clip_from_world = tile.view(view).clip_from_world.as_dmat4();
        let clip_from_object = clip_from_world * world_from_object;
        let object_from_clip = clip_from_object.inverse().as_mat4();
        let clip_from_object = clip_from_object.as_mat4();
        // Normals go by the inverse transposed; they stay of unit length if the scale is the
        // same along all axes.
        let normals = DMat3::from_mat4(object_from_world).transpose() * determinant.abs().cbrt();
        let clip_from_normal = (clip_from_world * DMat4::from_mat3(normals)).as_mat4();
        let eye = (object_from_world * view.eye.as_dvec4()).as_vec4();
        let origin = clip_from_object * Vec4::W;
        // An origin behind the eye has no place on the screen: any fixed one will do.
        let is_in_front = origin.w > f32::EPSILON;
        let origin_px =
            if is_in_front { to_pixels(origin, tile.size_px) } else { -tile.middle_px() };
        let distance = (world_from_object.transpose() * view.distance.as_dvec4()).as_vec4();
        let quantization = Quantization::of(bounds);
        #[expect(clippy::cast_possible_truncation, reason = "as the shader has it")]
        let step = quantization.step as f32;
        let is_outside = eye_is_outside(eye, bounds.min.into(), bounds.max.into());
        Some(Self {
            clip_from_object: clip_from_object.to_cols_array_2d(),
            object_from_clip: object_from_clip.to_cols_array_2d(),
            clip_from_normal: clip_from_normal.to_cols_array_2d(),
            eye: eye.to_array(),
            distance: distance.to_array(),
            origin_px: origin_px.to_array(),
            mirror: if determinant < 0.0 { -1.0 } else { 1.0 },
            eye_is_outside: u32::from(is_outside),
            center: quantization.center.as_vec3().to_array(),
            step,
            world_from_object: world_from_object.as_mat4().to_cols_array_2d(),
            world_from_normal: DMat4::from_mat3(normals).as_mat4().to_cols_array_2d(),
        })
    }

    /// From the object's positions to clip space.
    pub(crate) fn clip_from_object(&self) -> Mat4 {
        Mat4::from_cols_array_2d(&self.clip_from_object)
    }
}

/// The layout of `@group(0)`, which all pipelines share: the [`FrameUniform`] at binding 0.
#[must_use]
pub fn frame_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let visibility = wgpu::ShaderStages::VERTEX_FRAGMENT | wgpu::ShaderStages::COMPUTE;
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("frame"),
        entries: &[uniform_entry(0, visibility)],
    })
}

/// The frame's uniform buffer and bind group.
#[derive(Debug)]
pub(crate) struct FrameBinding {
    buffer: wgpu::Buffer,
    bind_group: wgpu::BindGroup,
}

impl FrameBinding {
    pub(crate) fn new(device: &wgpu::Device, uniform: &FrameUniform) -> Self {
        let buffer = uniform_buffer(device, "frame", uniform);
        let bind_group = bind_buffers(device, "frame", &frame_layout(device), &[(0, &buffer)]);
        Self { buffer, bind_group }
    }

    /// `@group(0)`.
    pub(crate) const fn bind_group(&self) -> &wgpu::BindGroup {
        &self.bind_group
    }

    pub(crate) const fn buffer(&self) -> &wgpu::Buffer {
        &self.buffer
    }

    /// Replaces the uniform for the next submission.
    pub(crate) fn write(&self, queue: &wgpu::Queue, uniform: &FrameUniform) {
        queue.write_buffer(&self.buffer, 0, bytemuck::bytes_of(uniform));
    }
}

#[cfg(test)]
mod tests {
    use edgemesh::view::Camera;
    use glam::DVec3;
    use glam::dcamera::rh::proj::directx;
    use glam::dcamera::rh::view::look_to_mat4;

    use super::*;

    /// The shader's `distance_of`.
    fn distance_of(depth: f32, [z_scale, z_offset, w_scale, w_offset]: [f32; 4]) -> f32 {
        (z_offset - depth * w_offset) / (depth * w_scale - z_scale)
    }

    const PART: Tile = Tile::whole(glam::Vec2::new(300.0, 200.0));

    /// The NPRView thesis, Equation 3.11, for a depth from 0 to 1.
    fn equation_3_11(depth: f64, near: f64, far: f64) -> f64 {
        -2.0 * near * far / ((2.0 * depth - 1.0) * (far - near) - (far + near))
    }

    /// Standard, reversed, infinite, orthographic, and orthographic reversed.
    #[test]
    fn distances_come_back_through_every_projection() {
        let (near, far, fov): (f64, f64, f64) = (0.5, 40.0, 0.7);
        let (eye, sight) = (DVec3::new(1.0, 2.0, 9.0), DVec3::new(0.3, -0.2, -1.0));
        let sight = sight.try_normalize().unwrap();
        let view_from_world = look_to_mat4(eye, sight, DVec3::Y);
        let projections = [
            ("standard", directx::perspective(fov, 1.5, near, far)),
            ("reversed", directx::perspective(fov, 1.5, far, near)),
            ("infinite", directx::perspective_infinite_reverse(fov, 1.5, near)),
            ("orthographic", directx::orthographic(-9.0, 9.0, -6.0, 6.0, near, far)),
            ("orthographic reversed", directx::orthographic(-9.0, 9.0, -6.0, 6.0, far, near)),
        ];
        for (name, clip_from_view) in projections {
            let view = View {
                clip_from_world: (clip_from_view * view_from_world).as_mat4(),
                eye: eye.as_vec3().extend(1.0),
                distance: sight.extend(-sight.dot(eye)).as_vec4(),
            };
            let around = Surroundings::default();
            let frame = FrameUniform::new(&view, &PART, &around);
            for want in [0.6_f32, 1.0, 3.0, 12.5, 39.0] {
                // Exact, as a depth buffer of 32 bits rounds it.
                let clip = clip_from_view * glam::DVec4::new(0.4, -0.3, -f64::from(want), 1.0);
                let depth = clip.z / clip.w;
                #[expect(clippy::cast_possible_truncation, reason = "as the buffer has it")]
                let got = distance_of(depth as f32, frame.projection);
                // A standard depth leaves few steps to what is far.
                let bound = if name == "standard" { 2e-4 } else { 1e-5 };
                assert!((got - want).abs() < bound * want, "{name}: {got} for {want}");
                if name == "standard" {
                    let thesis = equation_3_11(depth, near, far);
                    let error = (thesis - f64::from(want)).abs();
                    assert!(error < 1e-9 * f64::from(want), "{thesis} for {want}");
                }
            }
        }
    }

    #[test]
    fn distances_come_back_from_depths() {
        let bounds = Bounds { min: [-1.0, -2.0, -3.0], max: [3.0, 2.0, 1.0] };
        let around = Surroundings::default();
        for is_orthographic in [false, true] {
            let camera = Camera { is_orthographic, ..Camera::default_view(&bounds) };
            let view = camera.view(&bounds, 1.5);
            let frame = FrameUniform::new(&view, &PART, &around);
            for point in [DVec3::ZERO, DVec3::new(2.0, -1.0, -2.5), camera.target] {
                let point = point.as_vec3().extend(1.0);
                let clip = view.clip_from_world * point;
                let want = view.distance.dot(point);
                let got = distance_of(clip.z / clip.w, frame.projection);
                assert!((got - want).abs() < 1e-4 * want, "{got} for {want}");
            }
        }
    }
}
