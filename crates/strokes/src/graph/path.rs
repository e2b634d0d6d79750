//! From chains to ribbons: corners, evenly spaced points and their visibility, strokes, and the
//! segments to draw (`shaders/graph/path_*.wgsl`).
//!
//! One run serves all linked stroke sets of an object. It follows the fill, whose depth decides
//! what is visible.

use bytemuck::{Pod, Zeroable};
use edgemesh_shaders::ShaderError;

use crate::gpu::bind::{
    bind_buffers, bind_layout, compute_pipeline, compute_uniform, compute_write, uniform_buffer,
};
use crate::gpu::target_formats::TargetFormats;
use crate::graph::buffers::arguments::{
    JOINT_GROUPS, JOINT_SUM_GROUPS, POINT_GROUPS, POINT_SUM_GROUPS,
};
use crate::graph::buffers::{GraphBuffers, Groups};
use crate::style::brush::Brush;
use crate::style::drawing_style::{DrawingStyle, MAX_STROKE_SETS, StrokeSet, Width};
use crate::style::link_style::{BrushFit, CURVE_LENGTH, LinkStyle};

/// How the strokes of a linked set look. WGSL twin: `shaders/common/link_style.wgsl`.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct LinkStyleUniform {
    /// The layer whose edges are linked.
    pub layer: u32,
    /// A [`crate::style::drawing_style::Visibility`].
    pub visibility: u32,
    /// A [`edgemesh::line::Placement`].
    pub placement: u32,
    /// 1 if the width is in units of the world.
    pub is_world_width: u32,
    /// In pixels, or in units of the world.
    pub width: f32,
    /// Pixels between points along a path.
    pub step_px: f32,
    /// Strokes are cut where the cosine of their turn is smaller.
    pub corner_cosine: f32,
    /// 1 if strokes are cut where they are hidden.
    pub is_cut_where_hidden: u32,
    /// A [`crate::style::link_style::Join`].
    pub join: u32,
    /// A [`crate::style::link_style::End`].
    pub end: u32,
    /// Shorter strokes fade; negative stands for the width.
    pub min_length_px: f32,
    /// Longer strokes are cut; 0 cuts none.
    pub max_length_px: f32,
    /// Width of the brush over its height.
    pub brush_aspect: f32,
    /// 1 if the brush is stretched to the stroke.
    pub is_stretched: u32,
    /// Distances at which strokes begin to fade and are gone; equal for no fading.
    pub fade: [f32; 2],
    /// Over how many pixels a stroke grows at its start and shrinks at its end.
    pub taper_px: [f32; 2],
    /// How far a stroke goes on beyond each end.
    pub overshoot_px: f32,
    /// How far lines swing from their path.
    pub wobble_px: f32,
    /// The wavelength of the swing.
    pub wobble_length_px: f32,
    /// How far strokes tremble around their path.
    pub jitter_px: f32,
    /// Ink and gap of dashes; zeros for whole lines.
    pub dash_px: [f32; 2],
    /// Factors of the width along a stroke.
    pub width_curve: [f32; CURVE_LENGTH],
    /// Factors of the opacity along a stroke.
    pub opacity_curve: [f32; CURVE_LENGTH],
    /// A whole number: another one gives another tremble.
    pub seed: f32,
    /// Unused.
    pub padding: [f32; 3],
}

/// The least distance between the points of a path. Segments shorter than a few pixels would
/// show the mesh, not the shape.
const LEAST_STEP_PX: f32 = 4.0;

impl LinkStyleUniform {
    fn new(set: &StrokeSet, link: &LinkStyle) -> Self {
        let style = &set.style;
        let (width, is_world_width) = match style.width {
            Width::Pixels(width) => (width, 0),
            Width::World(width) => (width, 1),
        };
        let step_px = match style.width {
            Width::Pixels(width) => LEAST_STEP_PX.max(0.25 * width),
            Width::World(_) => LEAST_STEP_PX,
        };
        Self {
            layer: set.layer,
            visibility: set.visibility as u32,
            placement: style.placement as u32,
            is_world_width,
            width,
            step_px,
            corner_cosine: link.corner_rad.min(std::f32::consts::PI).cos(),
            // Dashes go on behind what hides them.
            is_cut_where_hidden: u32::from(link.is_cut_where_hidden && link.dash_px.is_none()),
            join: link.join as u32,
            end: link.end as u32,
            min_length_px: link.min_length_px.unwrap_or(-1.0),
            max_length_px: link.max_length_px,
            brush_aspect: style.brush.as_ref().map_or(1.0, Brush::aspect),
            is_stretched: u32::from(link.brush_fit == BrushFit::Stretched),
            fade: style.fade.unwrap_or_default(),
            taper_px: link.taper_px,
            overshoot_px: link.overshoot_px,
            wobble_px: link.wobble_px,
            wobble_length_px: link.wobble_length_px,
            jitter_px: link.jitter_px,
            width_curve: link.width_curve,
            opacity_curve: link.opacity_curve,
            dash_px: link.dash_px.unwrap_or_default(),
            seed: f32::from(link.seed),
            padding: [0.0; 3],
        }
    }

    /// The uniforms of all stroke sets of a style; zero for sets that are not linked.
    fn of(style: &DrawingStyle) -> [Self; MAX_STROKE_SETS] {
        let mut uniforms = [Self::zeroed(); MAX_STROKE_SETS];
        for (uniform, set) in uniforms.iter_mut().zip(&style.stroke_sets()) {
            if let Some(link) = set.style.link.as_ref().filter(|_| set.style.is_linked()) {
                *uniform = Self::new(set, link);
            }
        }
        uniforms
    }
}

/// The run: files with their entry points and the sizes of their dispatches. Scans of sums run
/// in one workgroup.
const STEPS: &[(&str, &[(&str, Groups)])] = &[
    (
        "graph/path_joints.wgsl",
        &[
            ("measure_turns", Groups::By(JOINT_GROUPS)),
            ("find_corners", Groups::By(JOINT_GROUPS)),
            ("sum_points", Groups::By(JOINT_SUM_GROUPS)),
            ("scan_points", Groups::One),
            ("write_points", Groups::By(JOINT_SUM_GROUPS)),
            ("finish_points", Groups::One),
        ],
    ),
    ("graph/path_points.wgsl", &[("place_points", Groups::By(POINT_GROUPS))]),
    (
        "graph/path_strokes.wgsl",
        &[
            ("sum_strokes", Groups::By(POINT_SUM_GROUPS)),
            ("scan_strokes", Groups::One),
            ("write_strokes", Groups::By(POINT_SUM_GROUPS)),
        ],
    ),
    ("graph/path_ribbons.wgsl", &[("write_ribbons", Groups::By(POINT_GROUPS))]),
];

/// The compute pipelines for one kind of target.
#[derive(Debug)]
pub(crate) struct PathPipeline {
    pass: wgpu::BindGroupLayout,
    object: wgpu::BindGroupLayout,
    paths: wgpu::BindGroupLayout,
    sums: wgpu::BindGroupLayout,
    steps: Vec<(wgpu::ComputePipeline, Groups)>,
}

/// The bind groups for the paths of one object.
#[derive(Debug)]
pub(crate) struct PathBindings {
    object: wgpu::BindGroup,
    paths: wgpu::BindGroup,
    sums: wgpu::BindGroup,
}

impl PathPipeline {
    /// `frame_fill` is the layout of `@group(0)`.
    pub(crate) fn new(
        device: &wgpu::Device,
        frame_fill: &wgpu::BindGroupLayout,
        formats: &TargetFormats,
    ) -> Result<Self, ShaderError> {
        let make = |label: &str, entries: &[wgpu::BindGroupLayoutEntry]| {
            bind_layout(device, label, entries)
        };
        let pass = make("link styles", &[compute_uniform(0)]);
        let object = make("path object", &[compute_uniform(0)]);
        let paths = make("paths", &[0, 2, 3, 4, 5, 6, 7].map(compute_write));
        let sums = make("path sums", &[0, 3, 4, 8].map(compute_write));
        let mut steps = Vec::new();
        for (file, entries) in STEPS {
            let module = formats.shader_module(device, file)?;
            for &(entry, groups) in *entries {
                let buffers = match groups {
                    Groups::One => &sums,
                    Groups::By(_) => &paths,
                };
                let layouts = [Some(frame_fill), Some(&pass), Some(&object), Some(buffers)];
                let pipeline = compute_pipeline(device, &module, entry, &layouts, &[]);
                steps.push((pipeline, groups));
            }
        }
        Ok(Self { pass, object, paths, sums, steps })
    }

    /// `@group(1)` of a style.
    pub(crate) fn pass(&self, device: &wgpu::Device, style: &DrawingStyle) -> wgpu::BindGroup {
        let uniform = uniform_buffer(device, "link styles", &LinkStyleUniform::of(style));
        bind_buffers(device, "link styles", &self.pass, &[(0, &uniform)])
    }

    pub(crate) fn bind(
        &self,
        device: &wgpu::Device,
        object: &wgpu::Buffer,
        graph: &GraphBuffers,
    ) -> PathBindings {
        let paths = [
            (0, &graph.header),
            (2, &graph.elements),
            (3, &graph.joints),
            (4, &graph.sums),
            (5, &graph.points),
            (6, &graph.strokes),
            (7, &graph.ribbons),
        ];
        let sums =
            [(0, &graph.header), (3, &graph.joints), (4, &graph.sums), (8, &graph.arguments)];
        PathBindings {
            object: bind_buffers(device, "path object", &self.object, &[(0, object)]),
            paths: bind_buffers(device, "paths", &self.paths, &paths),
            sums: bind_buffers(device, "path sums", &self.sums, &sums),
        }
    }

    /// Records the run for one object; `@group(0)` must be the frame with the fill, `@group(1)`
    /// the link styles.
    pub(crate) fn record(
        &self,
        pass: &mut wgpu::ComputePass,
        graph: &GraphBuffers,
        bindings: &PathBindings,
    ) {
        pass.set_bind_group(2, &bindings.object, &[]);
        for (pipeline, groups) in &self.steps {
            pass.set_pipeline(pipeline);
            match groups {
                Groups::One => {
                    pass.set_bind_group(3, &bindings.sums, &[]);
                    pass.dispatch_workgroups(1, 1, 1);
                }
                Groups::By(at) => {
                    pass.set_bind_group(3, &bindings.paths, &[]);
                    graph.dispatch(pass, *at);
                }
            }
        }
    }
}
