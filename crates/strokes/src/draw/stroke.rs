//! Strokes: thin lines, quads with caps, half disks and fins along the edges that a view draws
//! (paper, sections 3.2 to 3.5).
//!
//! Their vertices have one of four sources:
//!
//! | source | the vertex shader |
//! |---|---|
//! | expanded | passes on the vertices of the expansion |
//! | listed | computes those of the edges of the live list that were not expanded |
//! | all | detects too, as in the paper: decides for every edge by its index |
//! | attributes | detects from the paper's layouts: four vertices per edge, in passes for the quad and its ends |
//!
//! All of them call the same functions, so they draw the same picture. Hidden strokes turn the
//! depth test around (section 3.5). A silhouette is drawn where the stencil has not the value of
//! its own object (section 3.4; step 4 of the printed list keeps what the text means to
//! suppress). Contours over the surface that they bound decide both in their fragments
//! (`stroke_over_surface.wgsl`).
//!
//! ```text
//!        6                          9
//!      . |  3 ----------------- 2   | .
//!    5---4  .                   .   7--8
//!           0 ----------------- 1
//! ```

use bytemuck::{Pod, Zeroable};
use edgemesh::index::to_u32;
use edgemesh::line::{ClassTable, LineKind};
use edgemesh_shaders::ShaderError;
use wgpu::{CompareFunction, StencilFaceState, StencilOperation};

use crate::draw::stroke_layouts::StrokeLayouts;
use crate::gpu::bind::uniform_buffer;
use crate::gpu::device::Gpu;
use crate::gpu::target_formats::TargetFormats;
use crate::mesh::capacity::BYTES_PER_VERTEX;
use crate::mesh::layout::Layout;
use crate::style::brush::{Brush, BrushTextures};
use crate::style::drawing_style::{StrokeSet, Visibility, Width};

/// The style of a stroke set. WGSL twin: `shaders/common/stroke_style.wgsl`.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct StrokeUniform {
    /// Premultiplied RGBA.
    pub color: [f32; 4],
    /// Distances at which strokes begin to fade and are gone; equal for no fading.
    pub fade: [f32; 2],
    /// Width in pixels, or in units of the world.
    pub width: f32,
    /// Width of the brush over its height.
    pub brush_aspect: f32,
    /// A [`LineKind`].
    pub kind: u32,
    /// A [`edgemesh::line::Placement`].
    pub placement: u32,
    /// A [`edgemesh::line::Parameterization`].
    pub parameterization: u32,
    /// 1 if the width is in units of the world.
    pub is_world_width: u32,
    /// The layer whose edges are drawn.
    pub layer: u32,
    /// The place of the stroke set in the order of drawing.
    pub set_index: u32,
    /// Indices per edge.
    pub index_count: u32,
    /// 1 if edges that their own solid hides are drawn.
    pub shows_hidden: u32,
    /// Factor of the opacity behind transparent surfaces.
    pub behind_glass: f32,
    /// Unused.
    pub unused: u32,
    /// Unused.
    pub padding: [u32; 2],
    /// The classes, for vertex shaders that detect.
    pub classes: ClassTable,
}

impl StrokeUniform {
    /// The uniform of the stroke set with this number.
    pub(crate) fn new(set: &StrokeSet, set_index: usize, table: &ClassTable) -> Self {
        let style = &set.style;
        let (width, is_world_width) = match style.width {
            Width::Pixels(width) => (width, 0),
            Width::World(width) => (width, 1),
        };
        Self {
            color: style.color,
            fade: style.fade.unwrap_or_default(),
            width,
            brush_aspect: style.brush.as_ref().map_or(1.0, Brush::aspect),
            kind: style.kind as u32,
            placement: style.placement as u32,
            parameterization: style.parameterization as u32,
            is_world_width,
            layer: set.layer,
            set_index: to_u32(set_index),
            index_count: to_u32(style.kind.indices().len()),
            shows_hidden: u32::from(set.visibility == Visibility::Hidden),
            behind_glass: style.behind_glass,
            unused: 0,
            padding: [0; 2],
            classes: *table,
        }
    }
}

/// `@group(1)` of a stroke set.
pub(crate) fn style_group(
    gpu: &Gpu,
    layouts: &StrokeLayouts,
    brushes: &mut BrushTextures,
    set: &StrokeSet,
    set_index: usize,
    table: &ClassTable,
) -> wgpu::BindGroup {
    let device = &gpu.device;
    let solid = Brush::solid();
    let brush = set.style.brush.as_ref().unwrap_or(&solid);
    let texture = brushes.texture(gpu, brush);
    let sampler = &brushes.sampler;
    let uniform = StrokeUniform::new(set, set_index, table);
    let uniform = uniform_buffer(device, "stroke style", &uniform);
    let resources = [
        uniform.as_entire_binding(),
        wgpu::BindingResource::TextureView(&texture),
        wgpu::BindingResource::Sampler(sampler),
    ];
    let entries: Vec<wgpu::BindGroupEntry> = (0..)
        .zip(resources)
        .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
        .collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("stroke style"),
        layout: &layouts.pass,
        entries: &entries,
    })
}

/// The source of the vertices of strokes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum VertexSource {
    Expanded,
    Listed,
    All,
    Attributes,
}

/// The key of a pipeline of strokes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct StrokeVariant {
    pub(crate) source: VertexSource,
    pub(crate) visibility: Visibility,
    pub(crate) is_thin: bool,
    pub(crate) is_textured: bool,
    /// See [`StrokeSet::lies_over_surface`].
    pub(crate) is_over_surface: bool,
    /// Whether surfaces can be transparent.
    pub(crate) has_glass: bool,
}

impl StrokeVariant {
    pub(crate) fn new(source: VertexSource, set: &StrokeSet, has_glass: bool) -> Self {
        Self {
            source,
            visibility: set.visibility,
            is_thin: set.style.kind == LineKind::Thin,
            is_textured: set.style.brush.is_some(),
            is_over_surface: set.lies_over_surface(),
            // Hidden strokes are hidden by opaque surfaces alone.
            has_glass: has_glass && set.visibility != Visibility::Hidden,
        }
    }

    /// Whether fragments read the fill, or transparent surfaces.
    pub(crate) const fn reads_fill(self) -> bool {
        self.is_over_surface || self.has_glass
    }

    /// The shader of the fragments, and its entry point.
    const fn fragment(self, vertex_shader: &'static str, samples: u32) -> [&'static str; 2] {
        let entry = match (self.visibility, samples) {
            _ if !self.reads_fill() => return [vertex_shader, "stroke_fragment"],
            (_, samples) if !self.is_over_surface => {
                let entry = match samples {
                    1 => "behind_glass_of_pixels",
                    _ => "behind_glass_of_samples",
                };
                return ["stroke_behind_glass.wgsl", entry];
            }
            (Visibility::Silhouette, 1) => "silhouette_of_pixels",
            (Visibility::Silhouette, _) => "silhouette_of_samples",
            (_, 1) => "over_surface_of_pixels",
            _ => "over_surface_of_samples",
        };
        ["stroke_over_surface.wgsl", entry]
    }

    const fn shader(self, layout: Layout) -> &'static str {
        match (self.source, layout) {
            (VertexSource::Expanded, _) => "stroke_expanded.wgsl",
            (VertexSource::Listed, _) => "stroke_listed.wgsl",
            (VertexSource::All, _) => "stroke_all.wgsl",
            (VertexSource::Attributes, Layout::Replicated16) => "stroke_replicated_16.wgsl",
            (VertexSource::Attributes, Layout::FaceNormals) => "stroke_face_normals.wgsl",
            (VertexSource::Attributes, _) => "stroke_replicated.wgsl",
        }
    }

    fn groups(self, layouts: &StrokeLayouts) -> [Option<&wgpu::BindGroupLayout>; 4] {
        let mut groups = match self.source {
            VertexSource::Expanded => layouts.groups(None, None),
            VertexSource::Listed => layouts.groups(Some(&layouts.edges), Some(&layouts.listed)),
            VertexSource::All => layouts.groups(Some(&layouts.edges), Some(&layouts.planes)),
            VertexSource::Attributes => layouts.groups(Some(&layouts.object), None),
        };
        if self.reads_fill() {
            groups[0] = Some(&layouts.frame_fill);
        }
        groups
    }

    const fn vertex_buffer(self, layout: Layout) -> Option<wgpu::VertexBufferLayout<'static>> {
        let (array_stride, attributes): (u64, &[wgpu::VertexAttribute]) =
            match (self.source, layout) {
                (VertexSource::Expanded, _) => (BYTES_PER_VERTEX as u64, &EXPANDED),
                (VertexSource::Attributes, Layout::Replicated16) => (40, &REPLICATED_16),
                (VertexSource::Attributes, Layout::FaceNormals) => (48, &FACE_NORMALS),
                (VertexSource::Attributes, _) => (80, &REPLICATED),
                _ => return None,
            };
        let step_mode = wgpu::VertexStepMode::Vertex;
        Some(wgpu::VertexBufferLayout { array_stride, step_mode, attributes })
    }
}

const EXPANDED: [wgpu::VertexAttribute; 3] =
    wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32, 2 => Unorm16x2];

const REPLICATED: [wgpu::VertexAttribute; 8] = wgpu::vertex_attr_array![
    0 => Float32x3, 1 => Float32x3, 2 => Float32x3, 3 => Float32x3,
    4 => Float32x3, 5 => Float32x3, 6 => Float32, 7 => Uint32
];

const FACE_NORMALS: [wgpu::VertexAttribute; 4] =
    wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x3, 3 => Float32x3];

const REPLICATED_16: [wgpu::VertexAttribute; 6] = wgpu::vertex_attr_array![
    0 => Sint16x4, 1 => Sint16x4, 2 => Sint16x4, 3 => Sint16x4, 4 => Sint16x2, 5 => Uint8x4
];

/// Builds the pipeline of a variant.
pub(crate) fn stroke_pipeline(
    device: &wgpu::Device,
    layouts: &StrokeLayouts,
    layout: Layout,
    formats: &TargetFormats,
    variant: StrokeVariant,
) -> Result<wgpu::RenderPipeline, ShaderError> {
    let shader = variant.shader(layout);
    let module = layout.shader_module(device, shader)?;
    let [fragment_shader, fragment_entry] = variant.fragment(shader, formats.samples);
    let fragments = if fragment_shader == shader {
        module.clone()
    } else {
        formats.shader_module(device, fragment_shader)?
    };
    let is_hidden = variant.visibility == Visibility::Hidden;
    let constants = [
        ("IS_TEXTURED", variant.is_textured),
        ("IS_HIDDEN", is_hidden),
        ("HAS_GLASS", variant.has_glass),
    ]
    .map(|(name, value)| (name, f64::from(u8::from(value))));
    let constants = if variant.is_over_surface { &constants[..] } else { &constants[..1] };
    let compilation_options = wgpu::PipelineCompilationOptions { constants, ..Default::default() };
    let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(shader),
        bind_group_layouts: trimmed(&variant.groups(layouts)),
        immediate_size: 0,
    });
    let buffers = [variant.vertex_buffer(layout)];
    let topology = if variant.is_thin {
        wgpu::PrimitiveTopology::LineList
    } else {
        wgpu::PrimitiveTopology::TriangleList
    };
    Ok(device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(shader),
        layout: Some(&pipeline_layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("stroke_vertices"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: if buffers[0].is_some() { &buffers } else { &[] },
        },
        primitive: wgpu::PrimitiveState { topology, ..wgpu::PrimitiveState::default() },
        depth_stencil: Some(depth_stencil(formats, variant)),
        multisample: wgpu::MultisampleState { count: formats.samples, ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module: &fragments,
            entry_point: Some(fragment_entry),
            compilation_options,
            targets: &[Some(wgpu::ColorTargetState {
                format: formats.color,
                blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    }))
}

/// Without the unused groups at the end.
fn trimmed<'a, 'b>(
    groups: &'b [Option<&'a wgpu::BindGroupLayout>],
) -> &'b [Option<&'a wgpu::BindGroupLayout>] {
    let used = groups.iter().rposition(Option::is_some).map_or(0, |last| last + 1);
    &groups[..used]
}

fn depth_stencil(formats: &TargetFormats, variant: StrokeVariant) -> wgpu::DepthStencilState {
    // Depth is reversed. A sample behind something is hidden, any other visible: none is both.
    let compare = match variant.visibility {
        _ if variant.is_over_surface => CompareFunction::Always,
        Visibility::Hidden => CompareFunction::Less,
        Visibility::Visible | Visibility::Silhouette => CompareFunction::GreaterEqual,
    };
    let face = StencilFaceState {
        compare: CompareFunction::NotEqual,
        fail_op: StencilOperation::Keep,
        depth_fail_op: StencilOperation::Keep,
        pass_op: StencilOperation::Keep,
    };
    let stencil = match variant.visibility {
        Visibility::Silhouette if !variant.is_over_surface => {
            wgpu::StencilState { front: face, back: face, read_mask: 0xff, write_mask: 0 }
        }
        _ => wgpu::StencilState::default(),
    };
    wgpu::DepthStencilState {
        format: formats.depth,
        // Strokes hide nothing; they lie over each other in the order of the records.
        depth_write_enabled: Some(false),
        depth_compare: Some(compare),
        stencil,
        bias: wgpu::DepthBiasState::default(),
    }
}
