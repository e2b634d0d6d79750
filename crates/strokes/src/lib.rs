//! Finds the feature edges of edge meshes on the GPU and draws them as thick strokes, with no
//! work on the CPU that grows with the mesh.
//!
//! Based on M. McGuire and J. F. Hughes, *Hardware-Determined Feature Edges* (NPAR 2004),
//! sections 3 and 4, with compute shaders where the paper had vertex programs only; its own way
//! and layouts are there too, to compare with.
//!
//! The rooms, in the order in which an edge goes through them on its way to a pixel:
//!
//! | room | what is done there |
//! |---|---|
//! | [`gpu`] | the device, and what every room does with it |
//! | [`mesh`] | an edge mesh is uploaded, once |
//! | [`style`] | what its lines look like is decided |
//! | [`view`] | an eye looks: facing bits, live edges by layer |
//! | [`graph`] | live edges become chains, chains become ribbons |
//! | [`draw`] | the surface, and strokes over it: each pixel |
//! | [`render`] | all of that in the order of a frame |
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

pub mod draw;
pub mod gpu;
pub mod graph;
pub mod mesh;
pub mod render;
pub mod style;
pub mod view;

pub use glam;
pub use wgpu;

pub use self::draw::targets::{TargetError, TargetTextures, Targets};
pub use self::gpu::device::{Gpu, GpuError};
pub use self::gpu::readback::read_picture;
pub use self::gpu::target_formats::TargetFormats;
pub use self::mesh::buffers::{MeshBuffers, MeshOptions, MeshTooLarge};
pub use self::mesh::instance::MeshInstance;
pub use self::mesh::layout::Layout;
pub use self::render::drawing::Drawing;
pub use self::render::error::RenderError;
pub use self::render::frame_request::{Fill, FrameRequest};
pub use self::render::pipelines::{DetectionStage, RendererOptions};
pub use self::render::prepared_style::PreparedStyle;
pub use self::render::renderer::Renderer;
pub use self::render::scene_view::SceneView;
pub use self::style::brush::Brush;
pub use self::style::drawing_style::{DrawingStyle, Layer, StrokeStyle, Width};
pub use self::style::link_style::LinkStyle;
pub use self::view::frame::{FrameUniform, Surroundings};
pub use self::view::tile::Tile;
pub use self::view::view_state::ViewState;
