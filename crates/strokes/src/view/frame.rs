//! What one view needs, the same for every pass, and what it makes of one object.

use bytemuck::{Pod, Zeroable};
use edgemesh::edge_mesh::{Bounds, Quantization};
use edgemesh::index::to_u32;
use edgemesh::view::{View, eye_is_outside, to_pixels};
use glam::{DMat3, DMat4, Mat4, Vec4};

use crate::gpu::bind::{bind_buffers, uniform_buffer, uniform_entry};
use crate::view::tile::Tile;

/// The uniform of a view: `@group(0)` everywhere. WGSL twin:
/// `shaders/common/frame.wgsl`.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct FrameUniform {
    /// Size of what is drawn: the picture, or a part of it.
    pub viewport_px: [f32; 2],
    /// Pixels that a unit of the world has at w = 1.
    pub px_per_unit: f32,
    /// How many of `clip_planes` there are.
    pub clip_plane_count: u32,
    /// At a distance d along the line of sight, clip z is x d + y, and w is z d + w.
    pub projection: [f32; 4],
    /// Size of the whole picture.
    pub picture_px: [f32; 2],
    /// The upper left corner of what is drawn, from that of the picture.
    pub corner_px: [f32; 2],
    /// Where edges are clipped at the sides: left, right, bottom, top, at w = 1.
    pub guard_band: [f32; 4],
    /// Takes points of clip space back to the world.
    pub world_from_clip: [[f32; 4]; 4],
    /// The eye with w = 1, or the direction to the viewer with w = 0.
    pub eye: [f32; 4],
    /// The distance from the eye along the line of sight is the product of a point of
    /// the world with this.
    pub sight: [f32; 4],
    /// What is right in the picture, of unit length; w is 0.
    pub right: [f32; 4],
    /// What is up in the picture, of unit length; w is 0.
    pub up: [f32; 4],
    /// A light at a point with w = 1, or in a direction of unit length with w = 0.
    pub light: [f32; 4],
    /// Its colour.
    pub light_color: [f32; 3],
    /// Half the diagonal of the box around the scene.
    pub scene_radius: f32,
    /// A point of the world is drawn where its product with each of these is not
    /// negative; those beyond the count are zero.
    pub clip_planes: [[f32; 4]; MAX_CLIP_PLANES],
}

/// Clip planes that a view can have. WGSL twin: the constant of this name.
pub const MAX_CLIP_PLANES: usize = 6;

/// What belongs to a view besides the eye.
#[derive(Debug, Clone, PartialEq)]
pub struct Surroundings {
    /// A light at a point with w = 1, or in a direction of unit length with w = 0.
    pub light: [f32; 4],
    /// Its colour.
    pub light_color: [f32; 3],
    /// Half the diagonal of the box around the scene.
    pub scene_radius: f32,
    /// What is behind any of these planes is cut away; at most [`MAX_CLIP_PLANES`].
    pub clip_planes: Vec<[f32; 4]>,
}

impl Default for Surroundings {
    /// White light along z, and nothing cut away.
    fn default() -> Self {
        let light = [0.0, 0.0, 1.0, 0.0];
        Self { light, light_color: [1.0; 3], scene_radius: 1.0, clip_planes: Vec::new() }
    }
}

impl FrameUniform {
    /// The uniform of `view` on a part of a picture; `view` sees the whole.
    #[must_use]
    pub fn new(view: &View, tile: &Tile, around: &Surroundings) -> Self {
        // How long the row that makes y is, in units of the clip volume.
        let y_row = view.clip_from_world.row(1).truncate();
        let px_per_unit = y_row.length() * tile.picture_px.y * 0.5;
        let [[z_scale, z_offset], [w_scale, w_offset]] =
            [2, 3].map(|row| along_sight(view.clip_from_world.row(row), view.distance));
        // Rows of the view's matrix, but for the projection's scale.
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
            clip_planes,
        }
    }

    /// The part of the picture that is drawn.
    #[must_use]
    pub fn tile(&self) -> Tile {
        Tile {
            picture_px: self.picture_px.into(),
            corner_px: self.corner_px.into(),
            size_px: self.viewport_px.into(),
        }
    }
}

/// A row of the projection as a function of the distance along the line of sight,
/// the only thing that z and w depend on: its factor and what is added.
fn along_sight(row: Vec4, distance: Vec4) -> [f32; 2] {
    let (row, distance) = (row.as_dvec4(), distance.as_dvec4());
    let direction = distance.truncate();
    let scale = row.truncate().dot(direction) / direction.length_squared();
    let offset = row.w - scale * distance.w;
    #[expect(clippy::cast_possible_truncation, reason = "as the shader has it")]
    [scale, offset].map(|value| value as f32)
}

/// What a view makes of one object. WGSL twin: `shaders/common/frame.wgsl`.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct ObjectUniform {
    /// Takes the object's positions to clip space; depth 1 near, 0 far.
    pub clip_from_object: [[f32; 4]; 4],
    /// Takes it back.
    pub object_from_clip: [[f32; 4]; 4],
    /// Takes its normals to clip space, as directions of a unit of the world.
    pub clip_from_normal: [[f32; 4]; 4],
    /// The eye in the object's space with w = 1, or the direction to the viewer
    /// with w = 0.
    pub eye: [f32; 4],
    /// The distance from the eye along the line of sight is the product of a
    /// position with this.
    pub distance: [f32; 4],
    /// The object's origin on the screen, from the middle of what is drawn.
    pub origin_px: [f32; 2],
    /// -1 where the object is seen as in a mirror, else 1.
    pub mirror: f32,
    /// 1 where the eye is outside of the object's box, else 0.
    pub eye_is_outside: u32,
    /// Replicated at 16 bits: the position of step 0.
    pub center: [f32; 3],
    /// Replicated at 16 bits: units a step.
    pub step: f32,
    /// Takes the object's positions to the world.
    pub world_from_object: [[f32; 4]; 4],
    /// Takes its normals to the world, as directions of a unit of the world.
    pub world_from_normal: [[f32; 4]; 4],
}

impl ObjectUniform {
    /// What `view` makes of an object with `bounds` that `world_from_object`
    /// places in the world, on a part of the picture that `view` sees. A transform that
    /// cannot be undone draws nothing.
    #[must_use]
    pub fn new(
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
        // Normals go by the inverse transposed; of unit length where the scale is
        // the same along all axes.
        let normals = DMat3::from_mat4(object_from_world).transpose() * determinant.abs().cbrt();
        let clip_from_normal = (clip_from_world * DMat4::from_mat3(normals)).as_mat4();
        let eye = (object_from_world * view.eye.as_dvec4()).as_vec4();
        let origin = clip_from_object * Vec4::W;
        // Behind the eye the origin has no place; any will do that stays.
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

    /// The matrix that takes the object's positions to clip space.
    #[must_use]
    pub fn clip_from_object(&self) -> Mat4 {
        Mat4::from_cols_array_2d(&self.clip_from_object)
    }
}

/// The layout that all pipelines share for `@group(0)`.
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
pub struct FrameBinding {
    buffer: wgpu::Buffer,
    bind_group: wgpu::BindGroup,
}

impl FrameBinding {
    /// Makes the buffer, holding `uniform`.
    #[must_use]
    pub fn new(device: &wgpu::Device, uniform: &FrameUniform) -> Self {
        let buffer = uniform_buffer(device, "frame", uniform);
        let bind_group = bind_buffers(device, "frame", &frame_layout(device), &[(0, &buffer)]);
        Self { buffer, bind_group }
    }

    /// `@group(0)`.
    #[must_use]
    pub const fn bind_group(&self) -> &wgpu::BindGroup {
        &self.bind_group
    }

    /// The uniform buffer.
    pub(crate) const fn buffer(&self) -> &wgpu::Buffer {
        &self.buffer
    }

    /// Replaces the uniform for the next submission.
    pub fn write(&self, queue: &wgpu::Queue, uniform: &FrameUniform) {
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
