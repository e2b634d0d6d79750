//! Draws a model as line art to a PNG.
//!
//! ```sh
//! cargo run --release -p strokes --example mesh_to_png -- bunny.obj bunny.png
//! ```

use std::error::Error;
use std::sync::Arc;

use edgemesh::{BuildOptions, Camera, LineClass, build_edge_mesh, read_model};
use glam::DMat4;
use strokes::{
    DrawingStyle, Gpu, Layer, Layout, MeshBuffers, MeshInstance, Renderer, RendererOptions,
    SceneView, StrokeStyle, TargetFormats, Targets, read_picture,
};

fn main() -> Result<(), Box<dyn Error>> {
    let [model, out] = [1, 2].map(|at| std::env::args().nth(at).ok_or("mesh_to_png MODEL OUT"));
    let (model, mut report) = read_model(model?.as_ref())?;
    let mesh = build_edge_mesh(&model, &BuildOptions::default(), &mut report);

    let gpu = pollster::block_on(Gpu::open(None))?;
    let formats = TargetFormats::new(4);
    let mut renderer = Renderer::new(&gpu, RendererOptions::new(formats))?;
    let ink = Layer::visible(LineClass::ALL, StrokeStyle::default());
    let white = Some([1.0; 4]);
    let style = DrawingStyle { fill_color: white, layers: vec![ink], ..DrawingStyle::default() };
    let buffers = Arc::new(MeshBuffers::new(&gpu.device, &mesh, Layout::Indexed)?);
    let instance = MeshInstance::new(&buffers, DMat4::IDENTITY);
    let style = renderer.prepare(&gpu, &style)?;
    let mut scene = SceneView::new(&gpu, vec![instance], vec![style]);

    let targets = Targets::new(&gpu.device, [1024, 1024], formats);
    let view = Camera::default_view(&mesh.bounds).view(&mesh.bounds, 1.0);
    renderer.render(&gpu, &targets, &mut scene, &view, [1.0; 4], None)?;
    Ok(read_picture(&gpu, targets.picture())?.save(out?)?)
}
