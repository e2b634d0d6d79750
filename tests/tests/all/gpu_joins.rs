//! Composited linked strokes: no gap along them, and no pixel covered more than once, at any
//! width and any angle.

use std::sync::Arc;

use edgemesh::build::{BuildOptions, build_edge_mesh};
use edgemesh::edge_mesh::EdgeMesh;
use edgemesh::line::{LineClass, Placement};
use edgemesh::model::{Model, Segment};
use edgemesh::report::Report;
use edgemesh::view::Camera;
use edgemesh_brushes::BRUSH_NAMES;
use glam::{DMat4, DVec3, Vec2};
use strokes::{
    DrawingStyle, End, GraphReadback, Join, Layer, LinkStyle, MeshBuffers, MeshInstance,
    MeshOptions, Renderer, RendererOptions, Ribbon, SceneView, StrokeStyle, TargetFormats, Targets,
    Width, read_texels,
};
use viewer::technique::shipped_brush;

use crate::gpu_device::gpu;
use crate::random::Random;

/// Pixels per side.
const SIZE: u16 = 384;

/// Half black ink over white paper once, rounded down.
const ONCE: u8 = 127;

/// Lines that wander, some with steps of a fraction of a pixel, some that turn back on
/// themselves, some that cross themselves.
fn wandering(random: &mut Random) -> EdgeMesh {
    let mut model = Model::default();
    for line in 0..10 {
        let steps = 3 + random.below(40);
        let length = 0.7 * random.unit().powi(3) + 0.002;
        let sharpest = [0.2, 1.0, 3.1][line % 3];
        let mut heading = random.between(-3.1, 3.1);
        let mut at = Vec2::new(random.between(-0.8, 0.8), random.between(-0.8, 0.8));
        for step in 0..steps {
            let index = u32::try_from(model.positions.len()).unwrap();
            model.positions.push([at.x.into(), at.y.into(), 0.0]);
            if step > 0 {
                model.segments.push(Segment { ends: [index - 1, index], line: 0 });
            }
            heading += random.between(-sharpest, sharpest);
            at = (at + Vec2::from_angle(heading) * length).clamp(Vec2::splat(-1.0), Vec2::ONE);
        }
    }
    build_edge_mesh(&model, &BuildOptions::default(), &mut Report::default())
}

/// Stars with two sides: their rims are contours that turn by any angle.
fn stars(random: &mut Random) -> EdgeMesh {
    let mut model = Model::default();
    for star in 0..4_u8 {
        let center = Vec2::new(f32::from(star % 2), f32::from(star / 2)) - 0.5;
        let corners = 5 + random.below(20);
        let first = u32::try_from(model.positions.len()).unwrap();
        for corner in 0..corners {
            let angle = std::f32::consts::TAU * f32::from(corner) / f32::from(corners);
            let at = center + Vec2::from_angle(angle) * random.between(0.08, 0.45);
            model.positions.push([at.x.into(), at.y.into(), 0.0]);
        }
        let corners = u32::from(corners);
        let middle = first + corners;
        model.positions.push([center.x.into(), center.y.into(), 0.01]);
        model.positions.push([center.x.into(), center.y.into(), -0.01]);
        for corner in 0..corners {
            let (a, b) = (first + corner, first + (corner + 1) % corners);
            let at = edgemesh::model::Corner::at;
            model.push_polygon(&[at(a), at(b), at(middle)], 0);
            model.push_polygon(&[at(b), at(a), at(middle + 1)], 0);
        }
    }
    build_edge_mesh(&model, &BuildOptions::default(), &mut Report::default())
}

/// The renderer of all pictures of a test.
fn renderer() -> Renderer {
    Renderer::new(gpu(), RendererOptions::new(TargetFormats::new(1))).unwrap()
}

/// Draws a mesh: the red of every pixel, and the ribbons.
fn draw(
    renderer: &mut Renderer,
    mesh: &EdgeMesh,
    style: StrokeStyle,
    classes: &[LineClass],
) -> (Vec<u8>, GraphReadback) {
    let gpu = gpu();
    let layers = vec![Layer { classes: classes.into(), visible: Some(style), hidden: None }];
    let style = renderer.prepare(gpu, &DrawingStyle { layers, ..DrawingStyle::default() }).unwrap();
    let options = MeshOptions { links: true, ..MeshOptions::default() };
    let buffers = Arc::new(MeshBuffers::new(&gpu.device, mesh, options).unwrap());
    let instance = MeshInstance::new(&buffers, DMat4::IDENTITY);
    let mut scene = SceneView::new(gpu, vec![instance], vec![style]);
    let targets = Targets::new(&gpu.device, [SIZE.into(); 2], renderer.options().formats);
    let camera = Camera {
        eye: DVec3::new(0.0, 0.0, 4.0),
        target: DVec3::ZERO,
        ..Camera::default_view(&mesh.bounds)
    };
    let view = camera.view(&mesh.bounds, 1.0);
    renderer.render(gpu, &targets, &mut scene, &view, [1.0; 4], None).unwrap();
    let texels: Vec<[u8; 4]> = read_texels(gpu, targets.picture()).unwrap();
    let graph = scene.drawing.objects()[0].read_graph(gpu).unwrap().unwrap();
    (texels.into_iter().map(|texel| texel[0]).collect(), graph)
}

/// The center of a pixel, from the middle of the picture, y up.
fn center(x: u16, y: u16) -> Vec2 {
    let half = f32::from(SIZE) / 2.0;
    Vec2::new(f32::from(x) + 0.5 - half, half - f32::from(y) - 0.5)
}

/// Every pixel within `reach` of a ribbon, with its place.
fn pixels_near(ribbon: &Ribbon, reach: f32) -> impl Iterator<Item = (usize, Place)> {
    let half = f32::from(SIZE) / 2.0;
    let (a, b) = (Vec2::from(ribbon.a), Vec2::from(ribbon.b));
    let range = |low: f32, high: f32| {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
        let clamped = |value: f32| value.clamp(0.0, f32::from(SIZE)) as u16;
        clamped(low.floor())..clamped(high.ceil())
    };
    let (low, high) = (a.min(b) - reach, a.max(b) + reach);
    let columns = range(low.x + half, high.x + half);
    let ribbon = *ribbon;
    range(half - high.y, half - low.y).flat_map(move |y| {
        columns.clone().map(move |x| {
            let at = usize::from(y) * usize::from(SIZE) + usize::from(x);
            (at, Place::of(&ribbon, center(x, y)))
        })
    })
}

/// The place of a pixel relative to a ribbon.
struct Place {
    /// 0 at the start of the ribbon, 1 at its end.
    along: f32,
    /// Pixels to the left.
    off: f32,
    /// Pixels to the nearest point on it.
    distance: f32,
}

impl Place {
    fn of(ribbon: &Ribbon, center: Vec2) -> Self {
        let (a, b) = (Vec2::from(ribbon.a), Vec2::from(ribbon.b));
        let length = a.distance(b);
        let direction = (b - a) / length;
        let along = (center - a).dot(direction);
        let off = (center - a).dot(Vec2::new(-direction.y, direction.x));
        let nearest = a + direction * along.clamp(0.0, length);
        Self { along: along / length, off, distance: center.distance(nearest) }
    }
}

fn drawn(graph: &GraphReadback) -> Vec<Ribbon> {
    graph.ribbons.iter().filter(|ribbon| ribbon.is_drawn()).copied().collect()
}

#[test]
fn wandering_lines_have_no_gap_and_no_pixel_is_covered_twice() {
    let mut random = Random(11);
    let mut renderer = renderer();
    let mut inside = 0;
    for case in 0..100 {
        let mesh = wandering(&mut random);
        let width = 64.0_f32.powf(random.unit());
        let link = LinkStyle {
            join: if case % 2 == 0 { Join::Round } else { Join::Mitred },
            corner_rad: [1.0, 4.0][case / 2 % 2],
            min_length_px: Some(0.0),
            ..LinkStyle::default()
        };
        let style = StrokeStyle {
            width: Width::Pixels(width),
            color: [0.0, 0.0, 0.0, 0.5],
            placement: Placement::Centered,
            link: Some(link),
            ..StrokeStyle::default()
        };
        let (picture, graph) = draw(&mut renderer, &mesh, style, &LineClass::ALL);
        let ribbons = drawn(&graph);
        assert!(ribbons.len() > 20, "case {case}: {} segments", ribbons.len());
        let reach = 0.5 * width;
        let mut nearest = vec![f32::INFINITY; picture.len()];
        for (at, place) in ribbons.iter().flat_map(|ribbon| pixels_near(ribbon, reach + 2.0)) {
            nearest[at] = nearest[at].min(place.distance);
        }
        for (at, (red, nearest)) in picture.into_iter().zip(nearest).enumerate() {
            let what = || format!("case {case}, {width} px wide, pixel {at}, {nearest} px off");
            assert!(red >= ONCE, "{}: covered twice", what());
            if nearest < reach - 0.55 {
                inside += 1;
                assert!(red <= ONCE + 1, "{}: a gap", what());
            }
            // Miters extend further.
            if case % 2 == 0 && nearest > reach + 0.55 {
                assert_eq!(red, 255, "{}: ink beyond the stroke", what());
            }
        }
    }
    assert!(inside > 500_000, "{inside} pixels of ink");
}

#[test]
fn strokes_outside_of_contours_have_no_gap_either() {
    let mut random = Random(5);
    let mut renderer = renderer();
    let mut inside = 0;
    for case in 0..60 {
        let mesh = stars(&mut random);
        let width = 40.0_f32.powf(random.unit());
        let link = LinkStyle {
            corner_rad: [1.0, 4.0][case % 2],
            min_length_px: Some(0.0),
            ..LinkStyle::default()
        };
        let style = StrokeStyle {
            width: Width::Pixels(width),
            color: [0.0, 0.0, 0.0, 0.5],
            link: Some(link),
            ..StrokeStyle::default()
        };
        let (picture, graph) = draw(&mut renderer, &mesh, style, &[LineClass::Contour]);
        let ribbons = drawn(&graph);
        assert!(ribbons.len() > 100, "case {case}: {} segments", ribbons.len());
        assert!(picture.iter().all(|red| *red >= ONCE), "case {case}: covered twice");
        // Another part of the rim in between leaves less ink.
        let mut is_right_of_all = vec![true; picture.len()];
        for (at, place) in ribbons.iter().flat_map(|ribbon| pixels_near(ribbon, width + 2.0)) {
            is_right_of_all[at] &= place.off < -0.55 || place.distance > width + 1.0;
        }
        for (at, place) in ribbons.iter().flat_map(|ribbon| pixels_near(ribbon, width + 2.0)) {
            let is_beside = (0.0..=1.0).contains(&place.along);
            let is_inside = (0.55..width - 0.55).contains(&-place.off);
            if is_beside && is_inside && is_right_of_all[at] {
                inside += 1;
                let red = picture[at];
                assert!(red <= ONCE + 1, "case {case}, {width} px wide, pixel {at}: a gap");
            }
        }
    }
    assert!(inside > 100_000, "{inside} pixels of ink");
}

/// Brushes, tapers, all ends: never darker than the ink.
#[test]
fn nothing_makes_a_stroke_darker_than_its_ink() {
    let mut random = Random(23);
    let mut renderer = renderer();
    for (case, name) in BRUSH_NAMES.into_iter().cycle().take(20).enumerate() {
        let mesh = wandering(&mut random);
        let link = LinkStyle {
            end: [End::Round, End::Flat, End::Pointed][case % 3],
            taper_px: [20.0, 40.0],
            overshoot_px: 5.0,
            wobble_px: 4.0,
            ..LinkStyle::default()
        };
        let style = StrokeStyle {
            width: Width::Pixels(random.between(2.0, 40.0)),
            color: [0.0, 0.0, 0.0, 0.5],
            brush: shipped_brush(name).map(Result::unwrap),
            link: Some(link),
            ..StrokeStyle::default()
        };
        let (picture, _) = draw(&mut renderer, &mesh, style, &LineClass::ALL);
        assert!(picture.iter().all(|red| *red >= ONCE), "{name}");
        assert!(picture.iter().any(|red| *red < 200), "{name} leaves ink");
    }
}
