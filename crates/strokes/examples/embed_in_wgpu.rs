//! Draws strokes over the scene of a program that has a device, a camera and a depth buffer:
//! a game, a tool, a plug-in.
//!
//! The program fills the model with a pipeline of its own. Then `strokes` draws lines into
//! the same textures, in the same command buffer, and hides those behind the surface.
//!
//! ```sh
//! cargo run --release -p strokes --example embed_in_wgpu -- bunny.obj bunny.png
//! ```

use std::error::Error;
use std::sync::Arc;

use edgemesh::{Bounds, BuildOptions, EdgeMesh, LineClass, View, build_edge_mesh, read_model};
use strokes::glam::{DMat4, Mat4, Vec3, camera};
use strokes::wgpu::util::{BufferInitDescriptor, DeviceExt as _};
use strokes::{
    Drawing, DrawingStyle, Fill, FrameRequest, FrameUniform, Gpu, Layer, Layout, MeshBuffers,
    MeshInstance, Renderer, RendererOptions, StrokeStyle, Surroundings, TargetFormats,
    TargetTextures, Targets, Tile, ViewState, push_away, read_picture, wgpu,
};

const SIZE_PX: [u32; 2] = [1024, 768];
/// Floats work too, and formats that convert to sRGB.
const COLOR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
const SAMPLES: u32 = 4;

fn main() -> Result<(), Box<dyn Error>> {
    let [model, out] = [1, 2].map(|at| std::env::args().nth(at).ok_or("embed_in_wgpu MODEL OUT"));
    let (model, mut report) = read_model(model?.as_ref())?;
    let mesh = build_edge_mesh(&model, &BuildOptions::default(), &mut report);

    let (device, queue) = pollster::block_on(open_device())?;
    let scene = Scene::new(&device, &mesh);
    let camera = Camera::around(&mesh.bounds);
    queue.write_buffer(&scene.camera, 0, bytemuck::bytes_of(&camera.clip_from_world));
    let lines = Lines::new(&Gpu::from_device(device, queue)?, &mesh, &scene.textures)?;
    lines.render(&scene, &camera, &out?)
}

async fn open_device() -> Result<(wgpu::Device, wgpu::Queue), Box<dyn Error>> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = instance.request_adapter(&wgpu::RequestAdapterOptions::default()).await?;
    Ok(adapter.request_device(&wgpu::DeviceDescriptor::default()).await?)
}

/// The program's camera. Depth is reversed: 1 at the near plane, 0 at infinity.
struct Camera {
    clip_from_world: Mat4,
    eye: Vec3,
}

impl Camera {
    fn around(bounds: &Bounds) -> Self {
        let [low, high] = [Vec3::from(bounds.min), Vec3::from(bounds.max)];
        let (center, size) = (0.5 * (low + high), (high - low).length());
        let eye = center + size * Vec3::new(0.9, 0.6, 1.0);
        let view_from_world = camera::rh::view::look_at_mat4(eye, center, Vec3::Y);
        let aspect = SIZE_PX[0] as f32 / SIZE_PX[1] as f32;
        let projection = camera::rh::proj::directx::perspective_infinite_reverse;
        let clip_from_view = projection(40_f32.to_radians(), aspect, 0.01 * size);
        Self { clip_from_world: clip_from_view * view_from_world, eye }
    }
}

/// What the program draws, and its textures.
struct Scene {
    textures: TargetTextures,
    pipeline: wgpu::RenderPipeline,
    camera: wgpu::Buffer,
    bindings: wgpu::BindGroup,
    positions: wgpu::Buffer,
    corners: wgpu::Buffer,
    corner_count: u32,
}

const SHADER: &str = "
@group(0) @binding(0) var<uniform> clip_from_world: mat4x4f;

struct Vertex { @builtin(position) clip: vec4f, @location(0) position: vec3f }

@vertex fn vertex(@location(0) position: vec3f) -> Vertex {
    return Vertex(clip_from_world * vec4f(position, 1.0), position);
}

@fragment fn fragment(vertex: Vertex) -> @location(0) vec4f {
    let normal = normalize(cross(dpdy(vertex.position), dpdx(vertex.position)));
    let light = 0.75 + 0.25 * dot(normal, normalize(vec3f(0.3, 1.0, 0.6)));
    return vec4f(light * vec3f(1.0, 0.86, 0.62), 1.0);
}
";

impl Scene {
    fn new(device: &wgpu::Device, mesh: &EdgeMesh) -> Self {
        let buffer = |contents, usage| {
            device.create_buffer_init(&BufferInitDescriptor { label: None, contents, usage })
        };
        let pipeline = fill_pipeline(device);
        let camera = buffer(&[0; 64], wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST);
        let entry = wgpu::BindGroupEntry { binding: 0, resource: camera.as_entire_binding() };
        let bindings = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[entry],
        });
        Self {
            textures: textures(device),
            pipeline,
            camera,
            bindings,
            positions: buffer(bytemuck::cast_slice(&mesh.positions), wgpu::BufferUsages::VERTEX),
            corners: buffer(bytemuck::cast_slice(&mesh.triangles), wgpu::BufferUsages::INDEX),
            corner_count: u32::try_from(3 * mesh.triangles.len()).unwrap_or(u32::MAX),
        }
    }

    fn encode(&self, encoder: &mut wgpu::CommandEncoder) {
        let samples = self.textures.samples.as_ref().unwrap_or(&self.textures.color);
        let view = |texture: &wgpu::Texture| texture.create_view(&Default::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view(samples),
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color { r: 0.9, g: 0.94, b: 1.0, a: 1.0 }),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &view(&self.textures.depth),
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0.0),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.bindings, &[]);
        pass.set_vertex_buffer(0, self.positions.slice(..));
        pass.set_index_buffer(self.corners.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..self.corner_count, 0, 0..1);
    }
}

/// Color of one sample and of four, and depth that shaders can read.
fn textures(device: &wgpu::Device) -> TargetTextures {
    let texture = |format, sample_count, usage| {
        device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d {
                width: SIZE_PX[0],
                height: SIZE_PX[1],
                depth_or_array_layers: 1,
            },
            mip_level_count: 1,
            sample_count,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: usage | wgpu::TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        })
    };
    TargetTextures {
        color: texture(COLOR, 1, wgpu::TextureUsages::COPY_SRC),
        samples: Some(texture(COLOR, SAMPLES, wgpu::TextureUsages::empty())),
        depth: texture(DEPTH, SAMPLES, wgpu::TextureUsages::TEXTURE_BINDING),
    }
}

fn fill_pipeline(device: &wgpu::Device) -> wgpu::RenderPipeline {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(SHADER.into()),
    });
    let positions = wgpu::VertexBufferLayout {
        array_stride: 12,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &wgpu::vertex_attr_array![0 => Float32x3],
    };
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            buffers: &[Some(positions)],
        },
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            targets: &[Some(COLOR.into())],
        }),
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Greater),
            stencil: wgpu::StencilState::default(),
            // Surfaces lie a little behind the lines on them.
            bias: push_away(),
        }),
        multisample: wgpu::MultisampleState { count: SAMPLES, ..Default::default() },
        multiview_mask: None,
        cache: None,
    })
}

/// The lines over the scene: what a program keeps from frame to frame.
struct Lines {
    gpu: Gpu,
    renderer: Renderer,
    targets: Targets,
    instances: Vec<MeshInstance>,
    styles: Vec<Arc<strokes::PreparedStyle>>,
    view: ViewState,
    drawing: Drawing,
}

impl Lines {
    fn new(gpu: &Gpu, mesh: &EdgeMesh, textures: &TargetTextures) -> Result<Self, Box<dyn Error>> {
        let formats = TargetFormats { color: COLOR, depth: DEPTH, samples: SAMPLES };
        let mut renderer = Renderer::new(gpu, RendererOptions::new(formats))?;
        let ink = Layer::visible(LineClass::ALL, StrokeStyle::default());
        let style =
            renderer.prepare(gpu, &DrawingStyle { layers: vec![ink], ..Default::default() })?;
        let buffers = Arc::new(MeshBuffers::new(&gpu.device, mesh, Layout::Indexed)?);
        Ok(Self {
            renderer,
            targets: Targets::from_textures(textures.clone())?,
            instances: vec![MeshInstance::new(&buffers, DMat4::IDENTITY)],
            styles: vec![style],
            view: ViewState::new(&gpu.device),
            drawing: Drawing::default(),
            gpu: gpu.clone(),
        })
    }

    /// Draws one frame, the scene and the lines over it.
    fn render(mut self, scene: &Scene, camera: &Camera, out: &str) -> Result<(), Box<dyn Error>> {
        let view = View::from_matrix(camera.clip_from_world, camera.eye.extend(1.0));
        let tile = Tile::whole(self.targets.viewport_px());
        let frame = FrameUniform::new(&view, &tile, &Surroundings::default());
        self.view.set(&self.gpu, &view, &frame, &self.instances);

        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        scene.encode(&mut encoder);
        let request = FrameRequest {
            targets: &self.targets,
            instances: &self.instances,
            styles: &self.styles,
            view: &self.view,
            fill: Fill::Done,
            glass_depth: None,
            overview: None,
            resolves: true,
            timer: None,
        };
        self.renderer.encode(&self.gpu, &mut encoder, &mut self.drawing, &request)?;
        self.gpu.queue.submit([encoder.finish()]);
        Ok(read_picture(&self.gpu, &scene.textures.color)?.save(out)?)
    }
}
