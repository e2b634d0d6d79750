//! The buffers of one eye: the frame uniform, and a uniform per instance.
//!
//! A scene that several eyes look at (a window and a light, two halves of a comparison) has one
//! set of [`MeshInstance`]s, and a view state for each eye. A view state outlives changes of
//! style and technique.

use edgemesh::edge_mesh::Bounds;
use edgemesh::view::{View, to_pixels};
use glam::{Mat4, Vec2, Vec3, Vec4};

use crate::gpu::bind::uniform_buffer;
use crate::gpu::device::Gpu;
use crate::mesh::instance::MeshInstance;
use crate::view::frame::{FrameBinding, FrameUniform, ObjectUniform};

/// The buffers of one eye: the frame uniform, and a uniform per instance.
///
/// A scene that several eyes look at has one set of [`MeshInstance`]s, and a view state for
/// each eye.
#[derive(Debug)]
pub struct ViewState {
    frame: FrameBinding,
    uniform: FrameUniform,
    objects: Vec<ObjectState>,
}

/// One instance as an eye sees it.
#[derive(Debug)]
pub struct ObjectState {
    uniform: wgpu::Buffer,
    screen_box: Option<ScreenBox>,
    is_placed: bool,
}

impl ViewState {
    /// A state of no instances; [`Self::set`] sets view and instances.
    #[must_use]
    pub fn new(device: &wgpu::Device) -> Self {
        let uniform: FrameUniform = bytemuck::Zeroable::zeroed();
        Self { frame: FrameBinding::new(device, &uniform), uniform, objects: Vec::new() }
    }

    /// Makes room for `count` instances. The buffers of instances that stay are not replaced.
    pub fn resize(&mut self, device: &wgpu::Device, count: usize) {
        let empty: ObjectUniform = bytemuck::Zeroable::zeroed();
        let state = || ObjectState {
            uniform: uniform_buffer(device, "object", &empty),
            screen_box: None,
            is_placed: false,
        };
        self.objects.resize_with(count, state);
    }

    /// Writes the uniforms for the next submission: `instances` as `view` sees them, and
    /// `frame`, the uniform of the same view.
    pub fn set(
        &mut self,
        gpu: &Gpu,
        view: &View,
        frame: &FrameUniform,
        instances: &[MeshInstance],
    ) {
        self.resize(&gpu.device, instances.len());
        self.uniform = *frame;
        self.frame.write(&gpu.queue, frame);
        let viewport_px = frame.viewport_px.into();
        for (state, instance) in self.objects.iter_mut().zip(instances) {
            let bounds = instance.mesh().bounds();
            let mut uniform =
                ObjectUniform::new(view, &frame.tile(), instance.world_from_object, bounds);
            // An object that is cut open shows its inside, as to an eye within.
            if let Some(uniform) = uniform.as_mut().filter(|_| frame.clip_plane_count > 0) {
                uniform.eye_is_outside = 0;
            }
            state.is_placed = uniform.is_some();
            state.screen_box = uniform.and_then(|uniform| {
                ScreenBox::of(&uniform.clip_from_object(), bounds, viewport_px)
            });
            if let Some(uniform) = uniform {
                gpu.queue.write_buffer(&state.uniform, 0, bytemuck::bytes_of(&uniform));
            }
        }
    }

    /// The frame uniform that was set last.
    #[must_use]
    pub const fn uniform(&self) -> &FrameUniform {
        &self.uniform
    }

    /// The frame uniform as a bind group of the layout
    /// [`frame_layout`](crate::frame_layout).
    #[must_use]
    pub const fn frame_group(&self) -> &wgpu::BindGroup {
        self.frame.bind_group()
    }

    /// The buffer of the frame uniform, for bind groups of a program's own.
    #[must_use]
    pub const fn frame_buffer(&self) -> &wgpu::Buffer {
        self.frame.buffer()
    }

    pub(crate) const fn frame(&self) -> &FrameBinding {
        &self.frame
    }

    /// The instances, in order.
    #[must_use]
    pub fn objects(&self) -> &[ObjectState] {
        &self.objects
    }
}

impl ObjectState {
    /// The instance's uniform buffer; its fields are in `shaders/common/frame.wgsl`.
    #[must_use]
    pub const fn uniform(&self) -> &wgpu::Buffer {
        &self.uniform
    }

    /// False if the transform flattens the instance.
    #[must_use]
    pub const fn is_placed(&self) -> bool {
        self.is_placed
    }

    /// The box around the instance on the screen; `None` if a corner of its box is behind the
    /// eye.
    pub(crate) const fn screen_box(&self) -> Option<ScreenBox> {
        self.screen_box
    }
}

/// A box on the screen, in pixels from its upper left corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ScreenBox {
    pub(crate) min: Vec2,
    pub(crate) max: Vec2,
}

impl ScreenBox {
    /// The box around the corners of `bounds`.
    fn of(clip_from_object: &Mat4, bounds: &Bounds, viewport_px: Vec2) -> Option<Self> {
        let [low, high] = [Vec3::from(bounds.min), Vec3::from(bounds.max)];
        let mut around: Option<Self> = None;
        for corner in 0..8_u32 {
            let pick = |axis: usize| if corner >> axis & 1 == 0 { low[axis] } else { high[axis] };
            let clip = *clip_from_object * Vec4::new(pick(0), pick(1), pick(2), 1.0);
            if clip.w <= 0.0 || clip.z > clip.w {
                return None;
            }
            let px = to_pixels(clip, viewport_px) * Vec2::new(1.0, -1.0) + 0.5 * viewport_px;
            let point = Self { min: px, max: px };
            around = Some(around.map_or(point, |around| around.union(&point)));
        }
        around
    }

    /// The box around both.
    pub(crate) fn union(&self, other: &Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The pixels within `reach_px` of the box, in a picture of this size: left, top, width
    /// and height.
    pub(crate) fn pixels(&self, reach_px: f32, size: [u32; 2]) -> [u32; 4] {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
        let clamped = |value: f32, side: u32| (value.max(0.0) as u32).min(side);
        let [width, height] = size;
        let (min, max) = (self.min - reach_px, self.max + reach_px);
        let (left, top) = (clamped(min.x.floor(), width), clamped(min.y.floor(), height));
        let (right, bottom) = (clamped(max.x.ceil(), width), clamped(max.y.ceil(), height));
        [left, top, right.saturating_sub(left), bottom.saturating_sub(top)]
    }
}
