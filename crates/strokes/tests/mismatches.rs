//! Parts that do not fit together give errors, not panics: on wgpu's noop device, which checks
//! calls and draws nothing.

use std::sync::Arc;

use edgemesh::edge_mesh::EdgeMesh;
use edgemesh::{BuildOptions, Camera, LineClass, Model, Report, build_edge_mesh};
use strokes::glam::DMat4;
use strokes::{
    DetectionStage, Drawing, DrawingStyle, Fill, FrameRequest, Gpu, Layer, Layout, LinkStyle,
    MeshBuffers, MeshInstance, MeshOptions, PreparedStyle, RenderError, Renderer, RendererOptions,
    StrokeStyle, TargetError, TargetFormats, TargetTextures, Targets, ViewState, read_buffer,
    read_picture, read_texels, wgpu,
};

fn noop() -> Gpu {
    let backend_options = wgpu::BackendOptions {
        noop: wgpu::NoopBackendOptions::enabled(),
        ..wgpu::BackendOptions::default()
    };
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends: wgpu::Backends::NOOP,
        backend_options,
        // wgpu 30 checks indirect draws in buffers that need an alignment, and this backend
        // has none: with the check, encoding such a draw panics.
        flags: wgpu::InstanceFlags::VALIDATION,
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    let device = async {
        let adapter = instance.request_adapter(&wgpu::RequestAdapterOptions::default()).await;
        adapter.expect("the noop adapter").request_device(&Default::default()).await
    };
    let (device, queue) = pollster::block_on(device).expect("the noop device");
    Gpu::from_device(device, queue).expect("a device of the default limits")
}

fn tetrahedron() -> EdgeMesh {
    let corners = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]];
    let model = Model::from_polygons(&corners, &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[0, 3, 2]]);
    build_edge_mesh(&model, &BuildOptions::default(), &mut Report::default())
}

fn style(link: Option<LinkStyle>) -> DrawingStyle {
    let ink = StrokeStyle { link, ..StrokeStyle::default() };
    DrawingStyle { layers: vec![Layer::visible(LineClass::ALL, ink)], ..DrawingStyle::default() }
}

/// A renderer with everything that one frame needs.
struct Studio {
    gpu: Gpu,
    renderer: Renderer,
    targets: Targets,
    instances: Vec<MeshInstance>,
    view: ViewState,
    drawing: Drawing,
}

impl Studio {
    fn new(options: RendererOptions) -> Self {
        let gpu = noop();
        let mesh = tetrahedron();
        let buffers = MeshBuffers::new(&gpu.device, &mesh, options.layout);
        let buffers = Arc::new(buffers.expect("a small mesh"));
        let instances = vec![MeshInstance::new(&buffers, DMat4::IDENTITY)];
        let targets = Targets::new(&gpu.device, [64, 64], options.formats);
        let mut view = ViewState::new(&gpu.device);
        let seen = Camera::default_view(&mesh.bounds).view(&mesh.bounds, 1.0);
        let tile = strokes::Tile::whole(targets.viewport_px());
        let frame = strokes::FrameUniform::new(&seen, &tile, &strokes::Surroundings::default());
        view.set(&gpu, &seen, &frame, &instances);
        let renderer = Renderer::new(&gpu, options).expect("valid shaders");
        Self { gpu, renderer, targets, instances, view, drawing: Drawing::new() }
    }

    fn prepare(&mut self, style: &DrawingStyle) -> Result<Arc<PreparedStyle>, RenderError> {
        self.renderer.prepare(&self.gpu, style)
    }

    /// Encodes a frame of the studio's parts, changed by `change`.
    fn encode<'a>(
        &'a mut self,
        styles: &'a [Arc<PreparedStyle>],
        change: impl FnOnce(&mut FrameRequest<'a>),
    ) -> Result<(), RenderError> {
        let Self { gpu, renderer, targets, instances, view, drawing } = self;
        let fill = Fill::Clear([1.0; 4]);
        let mut request = FrameRequest {
            targets,
            instances,
            styles,
            view,
            fill,
            glass_depth: None,
            overview: None,
            resolves: true,
            timer: None,
        };
        change(&mut request);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        renderer.encode(gpu, &mut encoder, drawing, &request)?;
        gpu.queue.submit([encoder.finish()]);
        Ok(())
    }
}

fn options() -> RendererOptions {
    RendererOptions::new(TargetFormats::new(4))
}

#[test]
fn parts_of_a_frame_must_fit() {
    let mut studio = Studio::new(options());
    let styles = [studio.prepare(&style(None)).unwrap()];
    assert_eq!(studio.encode(&styles, |_| ()), Ok(()));

    let none = studio.encode(&[], |_| ());
    assert_eq!(none, Err(RenderError::StyleCount { styles: 0, instances: 1 }));

    let empty = ViewState::new(&studio.gpu.device);
    let unset = studio.encode(&styles, |request| request.view = &empty);
    assert_eq!(unset, Err(RenderError::ViewState { view: 0, instances: 1 }));

    let formats = TargetFormats::new(1);
    let targets = Targets::new(&studio.gpu.device, [64, 64], formats);
    let expected = Err(RenderError::Formats { targets: formats, renderer: options().formats });
    assert_eq!(studio.encode(&styles, |request| request.targets = &targets), expected);
    assert_eq!(studio.encode(&styles, |request| request.overview = Some(&targets)), expected);

    let links = [studio.prepare(&style(Some(LinkStyle::default()))).unwrap()];
    assert_eq!(studio.encode(&links, |_| ()), Err(RenderError::NoLinks));

    let mesh = MeshBuffers::new(&studio.gpu.device, &tetrahedron(), Layout::Replicated).unwrap();
    let replicated = [MeshInstance::new(&Arc::new(mesh), DMat4::IDENTITY)];
    let other = studio.encode(&styles, |request| request.instances = &replicated);
    let (mesh, renderer) = (Layout::Replicated, Layout::Indexed);
    assert_eq!(other, Err(RenderError::Layout { mesh, renderer }));
}

#[test]
fn styles_belong_to_renderers_with_the_same_options() {
    let vertex = RendererOptions { stage: DetectionStage::Vertex, ..options() };
    let styles = [Studio::new(vertex).prepare(&style(None)).unwrap()];
    let mut studio = Studio::new(options());
    assert_eq!(studio.encode(&styles, |_| ()), Err(RenderError::OtherRenderer));
}

#[test]
fn styles_that_cannot_be_drawn_are_not_prepared() {
    let mut studio = Studio::new(options());
    let silhouette = DrawingStyle { silhouette: Some(StrokeStyle::default()), ..style(None) };
    assert_eq!(studio.prepare(&silhouette).unwrap_err(), RenderError::NoStencil);
    let layers = vec![Layer::visible([], StrokeStyle::default()); 20];
    let many = DrawingStyle { layers, ..DrawingStyle::default() };
    let expected = RenderError::TooManyLayers { layers: 20, limit: LineClass::COUNT };
    assert_eq!(studio.prepare(&many).unwrap_err(), expected);
}

#[test]
fn a_drawing_may_go_to_another_renderer() {
    let mut studio = Studio::new(options());
    let (compute, vertex) = (DetectionStage::Compute, DetectionStage::Vertex);
    for stage in [compute, vertex, vertex, compute, compute] {
        let options = RendererOptions { stage, ..options() };
        studio.renderer = Renderer::new(&studio.gpu, options).unwrap();
        let styles = [studio.prepare(&style(None)).unwrap()];
        assert_eq!(studio.encode(&styles, |_| ()), Ok(()));
    }
}

fn texture(gpu: &Gpu, format: wgpu::TextureFormat, samples: u32) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: 8, height: 8, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    })
}

#[test]
fn textures_of_a_program_must_fit() {
    use wgpu::TextureFormat::{Bgra8Unorm, Depth32Float, Rgba8Unorm};
    let gpu = noop();
    let textures = |samples, depth| TargetTextures {
        color: texture(&gpu, Rgba8Unorm, 1),
        samples: Some(texture(&gpu, samples, 4)),
        depth,
    };
    let depth = || texture(&gpu, Depth32Float, 4);
    let targets = Targets::from_textures(textures(Rgba8Unorm, depth())).unwrap();
    assert_eq!(*targets.formats(), TargetFormats::new(4));
    let error = |textures| Targets::from_textures(textures).unwrap_err();
    let format = error(textures(Bgra8Unorm, depth()));
    assert_eq!(format, TargetError::Format { name: "samples" });
    let samples = error(textures(Rgba8Unorm, texture(&gpu, Depth32Float, 1)));
    assert_eq!(samples, TargetError::Samples { name: "depth" });
    let no_depth = error(textures(Rgba8Unorm, texture(&gpu, Rgba8Unorm, 4)));
    assert_eq!(no_depth, TargetError::NoDepth { format: Rgba8Unorm });
}

#[test]
fn what_cannot_be_read_back_says_why() {
    let gpu = noop();
    let reads = |texture: &wgpu::Texture| read_texels::<u8>(&gpu, texture).unwrap_err().reason;
    let color = texture(&gpu, wgpu::TextureFormat::Rgba8Unorm, 1);
    assert!(reads(&color).contains("COPY_SRC"), "{}", reads(&color));
    let samples = texture(&gpu, wgpu::TextureFormat::Rgba8Unorm, 4);
    assert!(reads(&samples).contains("samples"), "{}", reads(&samples));
    let floats = texture(&gpu, wgpu::TextureFormat::Rgba16Float, 1);
    let reason = read_picture(&gpu, &floats).unwrap_err().reason;
    assert!(reason.contains("Rgba16Float"), "{reason}");

    let buffer = |usage| {
        let (size, mapped_at_creation) = (16, false);
        let label = None;
        gpu.device.create_buffer(&wgpu::BufferDescriptor { label, size, usage, mapped_at_creation })
    };
    let reads = |usage, count| read_buffer::<u8>(&gpu, &buffer(usage), count).unwrap_err().reason;
    let source = wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
    assert_eq!(reads(source, 20), "20 bytes of a buffer of 16");
    assert_eq!(reads(source, 3), "3 bytes are not a multiple of 4");
    assert!(reads(wgpu::BufferUsages::COPY_DST, 4).contains("COPY_SRC"), "no source");
}

#[test]
fn meshes_without_a_surface_have_none() {
    let gpu = noop();
    for surface in [false, true] {
        let options = MeshOptions { surface, ..MeshOptions::default() };
        let mesh = Arc::new(MeshBuffers::new(&gpu.device, &tetrahedron(), options).unwrap());
        let instance = MeshInstance::new(&mesh, DMat4::IDENTITY);
        assert_eq!(mesh.surface().is_some(), surface);
        assert_eq!(instance.surface_geometry().is_some(), surface);
    }
}
