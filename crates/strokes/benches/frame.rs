//! The cost of frames on the GPU: `cargo bench -p strokes`.
//!
//! Frames are timed by timestamp queries from the start of the first pass to the end of the last,
//! detection included. Each line of a table is a drawing style with its median frame, and the
//! ratio to the median of the fill alone in the same targets. The styles of a table take turns
//! frame by frame, so that a slow moment slows all of them.
//!
//! `cargo bench -p strokes -- bunny` runs the tables whose title contains the word.
//! `EDGEMESH_BENCH_MODELS=A.obj:B.ply` adds models; `WGPU_BACKEND` chooses the backend.

#![expect(clippy::unwrap_used, reason = "a bench fails by panicking")]
#![expect(clippy::print_stdout, reason = "the tables are its result")]

use std::path::Path;
use std::sync::Arc;

use edgemesh::build::{BuildOptions, build_edge_mesh};
use edgemesh::edge_mesh::EdgeMesh;
use edgemesh::format::read::read_model;
use edgemesh::line::{LineClass, LineKind, Placement};
use edgemesh::model::Model;
use edgemesh::report::Report;
use edgemesh::view::{Camera, View};
use glam::DMat4;
use strokes::{
    Brush, DetectionStage, DrawingStyle, Gpu, GpuTimer, GpuTimes, Layer, Layout, LinkStyle,
    MeshBuffers, MeshInstance, MeshOptions, PASS_NAMES, Renderer, RendererOptions, SceneView,
    StrokeStyle, TargetFormats, Targets, Width,
};

const SIZE_PX: u32 = 1024;

/// Frames of each style; the median counts.
const FRAMES: usize = 21;

/// Triangles of the measured balls.
const BALLS: [u32; 3] = [10_000, 100_000, 1_100_000];

/// A drawing style to measure.
struct Contender {
    name: String,
    style: DrawingStyle,
    layout: Layout,
    stage: DetectionStage,
}

/// A drawing style on the GPU.
struct Runner {
    name: String,
    renderer: Renderer,
    scene: SceneView,
    timer: GpuTimer,
    times: Vec<GpuTimes>,
    byte_count: u64,
}

fn drawing(classes: &[LineClass], stroke: StrokeStyle) -> DrawingStyle {
    let layer = Layer { classes: classes.to_vec(), visible: Some(stroke), hidden: None };
    DrawingStyle { fill_color: Some([1.0; 4]), layers: vec![layer], ..DrawingStyle::default() }
}

fn fill_alone() -> DrawingStyle {
    DrawingStyle { fill_color: Some([1.0; 4]), ..DrawingStyle::default() }
}

/// The shipped pen: its alpha is the coverage.
fn pen() -> Brush {
    let image = edgemesh_brushes::image("brushes", "pen").unwrap();
    let image = image::load_from_memory(image.png).unwrap().to_luma_alpha8();
    let coverage = image.pixels().map(|texel| texel.0[1]).collect();
    Brush::new(image.width(), image.height(), coverage).unwrap()
}

fn stroke(kind: LineKind, is_textured: bool) -> StrokeStyle {
    let brush = is_textured.then(pen);
    StrokeStyle { kind, brush, width: Width::Pixels(2.0), ..StrokeStyle::default() }
}

impl Contender {
    fn new(name: &str, style: DrawingStyle) -> Self {
        let (layout, stage) = (Layout::Indexed, DetectionStage::Compute);
        Self { name: name.into(), style, layout, stage }
    }
}

impl Runner {
    fn new(gpu: &Gpu, mesh: &EdgeMesh, formats: TargetFormats, contender: &Contender) -> Self {
        let Contender { layout, stage, .. } = *contender;
        let mut renderer =
            Renderer::new(gpu, RendererOptions { layout, stage, ..RendererOptions::new(formats) })
                .unwrap();
        let style = renderer.prepare(gpu, &contender.style).unwrap();
        let options = MeshOptions { layout, links: style.is_linked(), ..MeshOptions::default() };
        let buffers = Arc::new(MeshBuffers::new(&gpu.device, mesh, options).unwrap());
        let byte_count = buffers.byte_count();
        let instance = MeshInstance::new(&buffers, DMat4::IDENTITY);
        let scene = SceneView::new(gpu, vec![instance], vec![style]);
        let passes = u32::try_from(PASS_NAMES.len()).unwrap();
        let timer = GpuTimer::new(gpu, passes).expect("an adapter with timestamps");
        let name = contender.name.clone();
        Self { name, renderer, scene, timer, times: Vec::new(), byte_count }
    }

    fn frame(&mut self, gpu: &Gpu, targets: &Targets, view: &View) {
        let timer = Some(&self.timer);
        self.renderer.render(gpu, targets, &mut self.scene, view, [1.0; 4], timer).unwrap();
        gpu.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
        self.times.push(self.timer.read(gpu).unwrap());
    }

    fn median(&self, value: impl Fn(&GpuTimes) -> f64) -> f64 {
        let mut values: Vec<f64> = self.times.iter().map(value).collect();
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    }
}

struct Bench {
    gpu: Gpu,
    frames: usize,
    /// Word in the titles of tables to run; empty for all.
    wanted: String,
}

impl Bench {
    /// Measures the contenders in turns, after the fill, and prints the table.
    fn table(&self, title: &str, mesh: &EdgeMesh, samples: u32, contenders: &[Contender]) {
        if !title.contains(&self.wanted) {
            return;
        }
        let formats = TargetFormats::new(samples);
        let targets = Targets::new(&self.gpu.device, [SIZE_PX; 2], formats);
        let view = Camera::default_view(&mesh.bounds).view(&mesh.bounds, 1.0);
        let fill = Contender::new("fill alone", fill_alone());
        let mut runners: Vec<Runner> = std::iter::once(&fill)
            .chain(contenders)
            .map(|contender| Runner::new(&self.gpu, mesh, formats, contender))
            .collect();
        for frame in 0..=self.frames {
            for runner in &mut runners {
                runner.frame(&self.gpu, &targets, &view);
                if frame == 0 {
                    // The first frame also finds the static edges.
                    runner.times.clear();
                }
            }
        }
        let (triangles, edges) = (mesh.triangles.len(), mesh.records.len());
        println!("\n{title}: {triangles} triangles, {edges} edges, {samples} samples");
        print!("{:<44}{:>9}{:>8}", "", "ms", "ratio");
        for pass in PASS_NAMES {
            print!("{pass:>9}");
        }
        println!("{:>11}{:>10}", "strokes", "MB");
        let yardstick = runners[0].median(|times| times.frame_ms);
        for runner in &runners {
            let frame = runner.median(|times| times.frame_ms);
            print!("{:<44}{frame:>9.2}{:>8.2}", runner.name, frame / yardstick);
            for pass in 0..PASS_NAMES.len() {
                print!("{:>9.2}", runner.median(|times| times.passes_ms[pass]));
            }
            let tally = runner.scene.drawing.objects()[0].read_tally(&self.gpu).unwrap();
            #[expect(clippy::cast_precision_loss, reason = "megabytes")]
            let megabytes = runner.byte_count as f64 / 1e6;
            println!("{:>11}{megabytes:>10.1}", tally.stroke_count);
        }
    }

    fn kinds(&self, name: &str, mesh: &EdgeMesh, samples: u32) {
        let all = LineClass::ALL;
        let centered =
            StrokeStyle { placement: Placement::Centered, ..stroke(LineKind::QuadAndCaps, false) };
        let contenders = [
            ("thin lines", drawing(&all, stroke(LineKind::Thin, false))),
            ("quads", drawing(&all, stroke(LineKind::Quad, false))),
            ("quads with caps", drawing(&all, stroke(LineKind::QuadAndCaps, false))),
            ("quads with caps, textured", drawing(&all, stroke(LineKind::QuadAndCaps, true))),
            ("quads with half disks", drawing(&all, stroke(LineKind::QuadAndDisks, false))),
            ("quads with caps, centered on contours too", drawing(&all, centered)),
            ("fins", drawing(&all, stroke(LineKind::Fin, false))),
            (
                "quads with caps, contours only",
                drawing(&[LineClass::Contour], stroke(LineKind::QuadAndCaps, false)),
            ),
        ]
        .map(|(name, style)| Contender::new(name, style));
        self.table(&format!("{name}, kinds of lines"), mesh, samples, &contenders);
    }

    /// Linked strokes beside edges drawn one by one.
    fn linked(&self, name: &str, mesh: &EdgeMesh, samples: u32) {
        let all = LineClass::ALL;
        let linked = |is_textured| {
            let link = Some(LinkStyle::default());
            StrokeStyle { link, ..stroke(LineKind::QuadAndCaps, is_textured) }
        };
        let wide = |style| StrokeStyle { width: Width::Pixels(7.0), ..style };
        let contenders = [
            ("quads with caps", drawing(&all, stroke(LineKind::QuadAndCaps, false))),
            ("linked", drawing(&all, linked(false))),
            ("quads with caps, textured", drawing(&all, stroke(LineKind::QuadAndCaps, true))),
            ("linked, textured", drawing(&all, linked(true))),
            (
                "quads with caps, textured, 7 px",
                drawing(&all, wide(stroke(LineKind::QuadAndCaps, true))),
            ),
            ("linked, textured, 7 px", drawing(&all, wide(linked(true)))),
        ]
        .map(|(name, style)| Contender::new(name, style));
        self.table(&format!("{name}, linked"), mesh, samples, &contenders);
    }

    fn layouts(&self, name: &str, mesh: &EdgeMesh, samples: u32) {
        let mut contenders = Vec::new();
        for (layout_name, layout) in [
            ("indexed", Layout::Indexed),
            ("replicated f32", Layout::Replicated),
            ("replicated 16-bit", Layout::Replicated16),
        ] {
            for (stage_name, stage) in
                [("compute", DetectionStage::Compute), ("vertex shader", DetectionStage::Vertex)]
            {
                let name = format!("{layout_name}, detected in {stage_name}");
                let style = drawing(&LineClass::ALL, stroke(LineKind::QuadAndCaps, true));
                contenders.push(Contender { name, style, layout, stage });
            }
        }
        let name = name.to_owned();
        contenders.push(Contender {
            name: "Card and Mitchell's face normals".into(),
            style: drawing(
                &[LineClass::Contour, LineClass::Boundary],
                stroke(LineKind::Fin, false),
            ),
            layout: Layout::FaceNormals,
            stage: DetectionStage::Vertex,
        });
        self.table(&format!("{name}, layouts and paths"), mesh, samples, &contenders);
    }

    /// The measurements of the paper's section 5: contours of 100,000 polygons at 250 frames per
    /// second without lines, 36 with thin lines (7 times as long), 5 with quads (50 times);
    /// 163,000 polygons with thin lines and 4 samples at 25.
    fn section_5(&self, balls: [&EdgeMesh; 2]) {
        let contours = |kind| drawing(&[LineClass::Contour], stroke(kind, false));
        let ways = [
            ("the paper's way", Layout::Replicated, DetectionStage::Vertex),
            ("the paper's way, 16 bits", Layout::Replicated16, DetectionStage::Vertex),
            ("our way", Layout::Indexed, DetectionStage::Compute),
        ];
        let contenders = |kinds: &[(&str, LineKind)]| -> Vec<Contender> {
            let of_way = |&(way, layout, stage): &(&str, Layout, DetectionStage)| {
                kinds
                    .iter()
                    .map(|&(kind_name, kind)| {
                        let name = format!("{kind_name}, {way}");
                        Contender { name, style: contours(kind), layout, stage }
                    })
                    .collect::<Vec<_>>()
            };
            ways.iter().flat_map(of_way).collect()
        };
        let both = [("thin", LineKind::Thin), ("quads and caps", LineKind::QuadAndCaps)];
        self.table("the paper's section 5, first scene", balls[0], 1, &contenders(&both));
        self.table("the paper's section 5, second scene", balls[1], 4, &contenders(&both[..1]));
    }
}

/// A ball with waves on it, of about `triangles` triangles.
fn ball(triangles: u32) -> EdgeMesh {
    let rings = (f64::from(triangles) / 4.0).sqrt();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
    let rings = rings as u32;
    let around = 2 * rings;
    let mut positions = Vec::new();
    for ring in 0..=rings {
        for step in 0..around {
            let theta = std::f64::consts::PI * f64::from(ring) / f64::from(rings);
            let phi = std::f64::consts::TAU * f64::from(step) / f64::from(around);
            let radius = 1.0 + 0.15 * (5.0 * phi).sin() * (4.0 * theta).sin() * theta.sin();
            let flat = theta.sin() * radius;
            let point = [flat * phi.cos(), theta.cos() * radius, flat * phi.sin()];
            #[expect(clippy::cast_possible_truncation, reason = "meshes are in 32 bits")]
            positions.push(point.map(|coordinate| coordinate as f32));
        }
    }
    let corner = |ring: u32, step: u32| ring * around + step % around;
    let polygons: Vec<[u32; 3]> = (0..rings)
        .flat_map(|ring| (0..around).map(move |step| (ring, step)))
        .flat_map(|(ring, step)| {
            let [a, b] = [corner(ring, step), corner(ring, step + 1)];
            let [c, d] = [corner(ring + 1, step), corner(ring + 1, step + 1)];
            [[a, b, d], [a, d, c]]
        })
        .collect();
    let polygons: Vec<&[u32]> = polygons.iter().map(|polygon| &polygon[..]).collect();
    let model = Model::from_polygons(&positions, &polygons);
    build_edge_mesh(&model, &BuildOptions::default(), &mut Report::default())
}

fn load(path: &Path) -> EdgeMesh {
    let (model, mut report) = read_model(path).unwrap();
    build_edge_mesh(&model, &BuildOptions::default(), &mut report)
}

fn main() {
    // `cargo test --benches` only checks that they run.
    let is_test = !std::env::args().any(|word| word == "--bench");
    let mut words = std::env::args().skip(1).filter(|word| !word.starts_with("--"));
    let wanted = words.next_back().unwrap_or_default();
    let gpu = pollster::block_on(Gpu::open(None)).unwrap();
    println!("{} ({}), {SIZE_PX}x{SIZE_PX}", gpu.info.name, gpu.info.backend);
    let bench = Bench { gpu, frames: if is_test { 1 } else { FRAMES }, wanted };
    let balls = if is_test { &BALLS[..1] } else { &BALLS };
    let mut meshes: Vec<(String, EdgeMesh)> =
        balls.iter().map(|&triangles| (format!("ball of {triangles}"), ball(triangles))).collect();
    if let Some(models) = std::env::var_os("EDGEMESH_BENCH_MODELS") {
        for path in std::env::split_paths(&models) {
            meshes.push((path.file_stem().unwrap().to_string_lossy().into_owned(), load(&path)));
        }
    }
    if !is_test {
        bench.section_5([&ball(100_000), &ball(163_000)]);
    }
    for (name, mesh) in &meshes {
        bench.kinds(name, mesh, 4);
        bench.linked(name, mesh, 4);
        bench.layouts(name, mesh, 4);
    }
}
