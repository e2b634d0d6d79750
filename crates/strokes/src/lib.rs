//! Finds the feature edges of edge meshes on the GPU and draws them as thick strokes, without
//! work on the CPU that grows with the mesh.
//!
//! Based on M. McGuire and J. F. Hughes, *Hardware-Determined Feature Edges* (NPAR 2004),
//! sections 3 and 4, with compute shaders in place of vertex programs. The paper's vertex
//! programs and layouts can be drawn too, to compare with.
//!
//! Programs that draw only strokes need a [`Gpu`], a [`Renderer`], a [`SceneView`] and
//! [`Targets`], as below. Programs with a device, a depth buffer and passes of their own use
//! [`Gpu::from_device`], [`Targets::from_textures`] and [`Renderer::encode`].
//!
//! The rooms of the source, in the order in which an edge passes them on its way to a pixel:
//!
//! | room | contents |
//! |---|---|
//! | `gpu` | the device, shaders, read-back, timers |
//! | `mesh` | edge meshes, uploaded once |
//! | `style` | the look of lines |
//! | `view` | what one eye sees: facing bits, live edges by layer |
//! | `graph` | live edges to chains, chains to ribbons |
//! | `draw` | the surface, and strokes over it |
//! | `render` | all of it in the order of a frame |
//!
//! ```no_run
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! use std::sync::Arc;
//!
//! use edgemesh::{BuildOptions, Camera, LineClass, build_edge_mesh, read_model};
//! use strokes::{
//!     DrawingStyle, Gpu, Layer, Layout, MeshBuffers, MeshInstance, Renderer, RendererOptions,
//!     SceneView, StrokeStyle, TargetFormats, Targets, glam::DMat4, read_picture,
//! };
//!
//! let (model, mut report) = read_model("bunny.obj".as_ref())?;
//! let mesh = build_edge_mesh(&model, &BuildOptions::default(), &mut report);
//!
//! let gpu = pollster::block_on(Gpu::open(None))?;
//! let formats = TargetFormats::new(4);
//! let mut renderer = Renderer::new(&gpu, RendererOptions::new(formats))?;
//! let ink = Layer::visible(LineClass::ALL, StrokeStyle::default());
//! let style = renderer
//!     .prepare(&gpu, &DrawingStyle { layers: vec![ink], ..DrawingStyle::default() })?;
//! let buffers = Arc::new(MeshBuffers::new(&gpu.device, &mesh, Layout::Indexed)?);
//! let instance = MeshInstance::new(&buffers, DMat4::IDENTITY);
//! let mut scene = SceneView::new(&gpu, vec![instance], vec![style]);
//!
//! let targets = Targets::new(&gpu.device, [1024, 1024], formats);
//! let view = Camera::default_view(&mesh.bounds).view(&mesh.bounds, 1.0);
//! renderer.render(&gpu, &targets, &mut scene, &view, [1.0; 4], None)?;
//! let picture = read_picture(&gpu, targets.picture())?;
//! # Ok(()) }
//! ```

#![warn(clippy::print_stdout, clippy::print_stderr)]

mod draw;
mod gpu;
mod graph;
mod mesh;
mod render;
mod style;
mod view;

pub use glam;
pub use wgpu;

pub use self::draw::fill::push_away;
pub use self::draw::targets::{TargetError, TargetTextures, Targets};
pub use self::gpu::device::{Gpu, GpuError, ResourceError};
pub use self::gpu::readback::{PendingRead, ReadbackError, read_buffer, read_picture, read_texels};
pub use self::gpu::recent::Recent;
pub use self::gpu::shader::shader_module;
pub use self::gpu::target_formats::TargetFormats;
pub use self::gpu::texture::upload_levels;
pub use self::gpu::timer::{GpuTimer, GpuTimes, TimedPasses};
pub use self::graph::buffers::{Element, GraphHeader, LinkNode, PathPoint, Ribbon, Stroke};
pub use self::graph::readback::GraphReadback;
pub use self::mesh::buffers::{MeshBuffers, MeshOptions, MeshTooLarge};
pub use self::mesh::geometry::SurfaceGeometry;
pub use self::mesh::instance::MeshInstance;
pub use self::mesh::layout::Layout;
pub use self::mesh::surface::{MaterialRange, SurfaceBuffers};
pub use self::render::drawing::{Drawing, DrawnObject};
pub use self::render::error::RenderError;
pub use self::render::frame_request::{Fill, FrameRequest, PASS_NAMES};
pub use self::render::options::{DetectionStage, RendererOptions};
pub use self::render::prepared_style::PreparedStyle;
pub use self::render::renderer::Renderer;
pub use self::render::scene_view::SceneView;
pub use self::style::brush::{Brush, BrushError};
pub use self::style::drawing_style::{DrawingStyle, Layer, StrokeStyle, Width};
pub use self::style::link_style::{BrushFit, CURVE_LENGTH, End, Join, LinkStyle};
pub use self::view::frame::{FrameUniform, MAX_CLIP_PLANES, Surroundings, frame_layout};
pub use self::view::live_lists::Tally;
pub use self::view::tile::Tile;
pub use self::view::view_state::{ObjectState, ViewState};

/// Structs and constants that shaders define too, for the tests that compare them with WGSL: no
/// part of the interface.
#[doc(hidden)]
pub mod layouts {
    pub use crate::draw::coverage::CompositeUniform;
    pub use crate::draw::fill::FillUniform;
    pub use crate::draw::silhouette::NO_OBJECT;
    pub use crate::draw::stroke::StrokeUniform;
    pub use crate::graph::buffers::{
        ARC_PER_PX, BACKWARD, CUT_END, CUT_START, CUT_WHOLE, Chain, ChainState, GraphUniform,
        ITEMS_PER_SUM, Joint, LinkedSet, MAX_LINK_ROUNDS, NO_NODE, NOT_DRAWN, ON_LOOP, arguments,
    };
    pub use crate::graph::path::LinkStyleUniform;
    pub use crate::mesh::layout::{ChunkUniform, EDGES_PER_RUN, PackedRecord};
    pub use crate::mesh::link_table::{REVERSED, SURFACE_CUT, SURFACE_END};
    pub use crate::style::drawing_style::{MAX_LAYERS, MAX_STROKE_SETS, Visibility};
    pub use crate::style::link_style::MITRE_LIMIT;
    pub use crate::view::detect::{DetectUniform, DetectedSet};
    pub use crate::view::frame::ObjectUniform;
    pub use crate::view::live_lists::{DrawArguments, RunState};
}
