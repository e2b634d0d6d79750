//! Draws a map of the strokes of a view: linked edges in gray, every point of every path as a
//! square, drawn segments in one color per stroke, and places where strokes are split as red
//! squares.
//!
//! ```sh
//! cargo run --release -p strokes --example stroke_map -- bunny.obj map.png 4 [X Y]
//! ```
//!
//! The number enlarges the view of 1024 pixels; X and Y are the pixel of the view in the middle
//! of the map.

#![expect(clippy::unwrap_used, reason = "a tool for developers fails by panicking")]
#![expect(clippy::print_stdout, reason = "the counts are its result")]

use std::path::Path;
use std::sync::Arc;

use edgemesh::build::{BuildOptions, build_edge_mesh};
use edgemesh::format::read::read_model;
use edgemesh::line::LineClass;
use edgemesh::view::Camera;
use glam::{DMat4, Vec2};
use image::{Rgb, RgbImage};
use strokes::{
    DrawingStyle, GraphReadback, Layer, LinkStyle, MeshBuffers, MeshInstance, MeshOptions,
    Renderer, RendererOptions, SceneView, StrokeStyle, TargetFormats, Targets,
};

/// Pixels of the view, and of the map.
const SIZE: u16 = 1024;

fn graph_of(path: &Path) -> GraphReadback {
    let gpu = pollster::block_on(strokes::Gpu::open(None)).unwrap();
    let (model, mut report) = read_model(path).unwrap();
    let mesh = build_edge_mesh(&model, &BuildOptions::default(), &mut report);
    let style = StrokeStyle { link: Some(LinkStyle::default()), ..StrokeStyle::default() };
    let layers = vec![Layer { classes: LineClass::ALL.into(), visible: Some(style), hidden: None }];
    let style = DrawingStyle { fill_color: Some([1.0; 4]), layers, ..DrawingStyle::default() };
    let formats = TargetFormats::new(4);
    let mut renderer = Renderer::new(&gpu, RendererOptions::new(formats)).unwrap();
    let style = renderer.prepare(&gpu, &style).unwrap();
    let options = MeshOptions { links: true, ..MeshOptions::default() };
    let buffers = Arc::new(MeshBuffers::new(&gpu.device, &mesh, options).unwrap());
    let instance = MeshInstance::new(&buffers, DMat4::IDENTITY);
    let mut scene = SceneView::new(&gpu, vec![instance], vec![style]);
    let targets = Targets::new(&gpu.device, [SIZE.into(); 2], formats);
    let view = Camera::default_view(&mesh.bounds).view(&mesh.bounds, 1.0);
    renderer.render(&gpu, &targets, &mut scene, &view, [1.0; 4], None).unwrap();
    scene.drawing.objects()[0].read_graph(&gpu).unwrap().unwrap()
}

struct Map {
    picture: RgbImage,
    scale: f32,
    center: Vec2,
}

impl Map {
    fn place(&self, position: [f32; 2]) -> Vec2 {
        let half = f32::from(SIZE) / 2.0;
        let pixel = Vec2::new(position[0], -position[1]) + half;
        (pixel - self.center) * self.scale + half
    }

    fn dot(&mut self, at: Vec2, color: Rgb<u8>) {
        if at.cmpge(Vec2::ZERO).all() && at.cmplt(Vec2::splat(f32::from(SIZE))).all() {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "inside")]
            self.picture.put_pixel(at.x as u32, at.y as u32, color);
        }
    }

    fn line(&mut self, [a, b]: [Vec2; 2], color: Rgb<u8>) {
        let mut t = 0.0;
        let step = 0.5 / a.distance(b).max(0.5);
        while t <= 1.0 {
            self.dot(a.lerp(b, t), color);
            t += step;
        }
    }

    fn square(&mut self, at: Vec2, reach: f32, color: Rgb<u8>) {
        let corner = |x, y| at + Vec2::new(x, y) * reach;
        let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
        for side in 0..4 {
            self.line([corners[side], corners[(side + 1) % 4]], color);
        }
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let graph = graph_of(Path::new(&arguments[0]));
    let number = |at: usize, otherwise: f32| {
        arguments.get(at).map_or(otherwise, |text| text.parse().unwrap())
    };
    let half = f32::from(SIZE) / 2.0;
    let mut map = Map {
        picture: RgbImage::from_pixel(SIZE.into(), SIZE.into(), Rgb([255; 3])),
        scale: number(2, 1.0),
        center: Vec2::new(number(3, half), number(4, half)),
    };
    for node in &graph.nodes {
        let line = [map.place(node.s0), map.place(node.s1)];
        map.line(line, Rgb([200; 3]));
    }
    for (at, pair) in graph.points.windows(2).enumerate() {
        let [a, b] = [map.place(pair[0].position), map.place(pair[1].position)];
        let is_drawn = pair[0].cut[0] < pair[0].cut[1] && graph.ribbons[at].is_drawn();
        let hue = pair[0].stroke.wrapping_mul(2_654_435_761);
        let color = Rgb([hue >> 24, hue >> 16, hue >> 8].map(|word| (word & 0xbf) as u8));
        if is_drawn {
            let [from, to] = pair[0].cut;
            map.line([a.lerp(b, from), a.lerp(b, to)], color);
        }
        let flags = pair[0].flags;
        if flags & 4 != 0 {
            map.square(a, 4.0, Rgb([255, 0, 0]));
        }
        map.square(
            a,
            if flags & 8 != 0 { 1.0 } else { 2.0 },
            if flags & 8 != 0 { color } else { Rgb([160; 3]) },
        );
    }
    let lengths: Vec<f32> = graph
        .strokes
        .iter()
        .map(|stroke| (stroke.end_arc.wrapping_sub(stroke.start_arc)) as f32 / 1024.0)
        .collect();
    let total: f32 = lengths.iter().sum();
    println!("{:?}", graph.header);
    for bound in [2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 1e9] {
        let shorter = lengths.iter().filter(|length| **length < bound).count();
        println!("{shorter} strokes shorter than {bound} px");
    }
    println!(
        "{} strokes, {total} px, {} a 1000 px",
        lengths.len(),
        1e3 * lengths.len() as f32 / total
    );
    map.picture.save(&arguments[1]).unwrap();
}
