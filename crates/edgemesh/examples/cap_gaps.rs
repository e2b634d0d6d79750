//! Counts how often the caps of the paper leave a gap (Figure 5 and Appendix B).
//!
//! ```sh
//! cargo run --release -p edgemesh --example cap_gaps -- bunny.obj teapot.obj
//! ```
//!
//! A joint is a vertex where exactly two strokes of a class meet, in any of 26 views around a
//! model. Caps should fill the triangle between the two quads on the outside of the bend; the part
//! of it that neither the quads nor the caps of the two edges cover is a gap. Gaps count from a
//! quarter of a square pixel on, with strokes of four pixels in a picture of 1024. Hidden strokes
//! count, too, because caps do not depend on depth.
//!
//! The curvature is the angle by which the line turns in space at the joint. Each model has a
//! table, with a row for each class and curvature.

#![expect(clippy::unwrap_used, reason = "a tool for developers fails by panicking")]
#![expect(clippy::print_stdout, reason = "the tables are its result")]

use std::collections::BTreeMap;
use std::path::Path;

use edgemesh::build::{BuildOptions, build_edge_mesh};
use edgemesh::edge_mesh::{EdgeMesh, EdgeRecord};
use edgemesh::format::read::read_model;
use edgemesh::line::{ClassTable, LineClass, LineKind, Parameterization, Placement};
use edgemesh::oracle::stroke_segment::{ClipEdge, Segment, StrokeShape, stroke_segment};
use edgemesh::oracle::stroke_vertex::segment_vertex;
use edgemesh::view::{Camera, Line, LineBits, View, classify_lines, eye_is_outside};
use glam::{DVec3, Vec2, Vec3};

const SIZE_PX: f32 = 1024.0;
const WIDTH_PX: f32 = 4.0;

/// The area from which a gap counts, in square pixels.
const GAP_PX: f32 = 0.25;

/// Upper bounds of the turns, in degrees.
const TURNS: [f32; 5] = [10.0, 30.0, 60.0, 90.0, 180.0];

const SHAPE: StrokeShape = StrokeShape {
    viewport_px: Vec2::splat(SIZE_PX),
    origin_px: Vec2::ZERO,
    fade: Vec2::ZERO,
    width: WIDTH_PX,
    px_per_unit: 1.0,
    brush_aspect: 1.0,
    mirror: 1.0,
    kind: LineKind::QuadAndCaps,
    placement: Placement::Automatic,
    parameterization: Parameterization::ObjectSpace,
    is_world_width: false,
    guard_band: edgemesh::view::WHOLE_BAND,
};

/// The counts of a class and curvature.
#[derive(Debug, Clone, Copy, Default)]
struct Count {
    joints: u32,
    gaps: u32,
    /// The area of the gaps, in square pixels.
    area_px: f32,
}

/// A drawn stroke.
struct Stroke {
    segment: Segment,
    corners: [Vec2; 10],
}

impl Stroke {
    fn new(mesh: &EdgeMesh, view: &View, record: &EdgeRecord, bits: LineBits) -> Option<Self> {
        let position = |vertex: u32| Vec3::from(mesh.positions[vertex as usize]);
        let clip = |vertex: u32| view.clip_from_world * position(vertex).extend(1.0);
        let normal = |vertex: u32| {
            let normal = Vec3::from(mesh.vertex_normals[vertex as usize]);
            view.clip_from_world * normal.extend(0.0)
        };
        let edge = ClipEdge {
            c0: clip(record.v0),
            c1: clip(record.v1),
            c2: clip(record.v0),
            c3: clip(record.v0),
            n0: normal(record.v0),
            n1: normal(record.v1),
            facing: Vec2::ONE,
            distance: Vec2::ZERO,
            r: 0.0,
        };
        let segment = stroke_segment(&edge, &SHAPE, bits);
        let is_whole = segment.spine.t0 <= 0.0 && segment.spine.t1 >= 1.0;
        let corner =
            |corner| segment_vertex(&segment, &SHAPE, corner).position.truncate() * (SIZE_PX * 0.5);
        (segment.is_drawn && is_whole).then(|| Self {
            segment,
            corners: std::array::from_fn(|at| corner(u32::try_from(at).unwrap())),
        })
    }

    fn covers(&self, point: Vec2) -> bool {
        LineKind::QuadAndCaps.indices().as_chunks::<3>().0.iter().any(|triangle| {
            let [a, b, c] = triangle.map(|corner| self.corners[corner as usize]);
            // Distances to the sides, to a hundredth of a pixel.
            let side =
                |from: Vec2, to: Vec2| (to - from).normalize_or_zero().perp_dot(point - from);
            let sides = [side(a, b), side(b, c), side(c, a)];
            // A cap that is left out repeats one corner.
            let has_area = (b - a).perp_dot(c - a) != 0.0;
            let is_within =
                sides.iter().all(|side| *side >= -0.01) || sides.iter().all(|side| *side <= 0.01);
            has_area && is_within
        })
    }

    /// The position of the joint, the direction away from it, and the two corners there.
    fn end(&self, at_start: bool) -> (Vec2, Vec2, [Vec2; 2]) {
        let spine = &self.segment.spine;
        if at_start {
            (spine.s0, spine.s1 - spine.s0, [self.corners[0], self.corners[3]])
        } else {
            (spine.s1, spine.s0 - spine.s1, [self.corners[1], self.corners[2]])
        }
    }
}

/// The area in square pixels that two strokes leave open at their joint.
fn gap_px(first: (&Stroke, bool), second: (&Stroke, bool)) -> f32 {
    let (joint, first_away, first_rims) = first.0.end(first.1);
    let (_, second_away, second_rims) = second.0.end(second.1);
    let bend = first_away.normalize_or_zero() + second_away.normalize_or_zero();
    // The rims on the outside of the bend point away from both strokes.
    let outer = |rims: [Vec2; 2]| {
        let off = |rim: &Vec2| (*rim - joint).dot(bend);
        rims.into_iter().min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(joint)
    };
    let (a, b) = (outer(first_rims), outer(second_rims));
    let area = 0.5 * (a - joint).perp_dot(b - joint).abs();
    let is_outside = |rim: Vec2| (rim - joint).dot(bend) < -1e-3;
    if area < GAP_PX || !is_outside(a) || !is_outside(b) {
        return 0.0;
    }
    const STEPS: u16 = 12;
    let (mut open, mut all) = (0.0, 0.0);
    for row in 0..STEPS {
        for column in 0..STEPS - row {
            let part = |step: u16| (f32::from(step) + 1.0 / 3.0) / f32::from(STEPS);
            let point = joint + (a - joint) * part(row) + (b - joint) * part(column);
            all += 1.0;
            open += f32::from(u8::from(!first.0.covers(point) && !second.0.covers(point)));
        }
    }
    area * open / all
}

/// Directions to the faces, edges and corners of a slightly turned cube.
fn directions() -> Vec<DVec3> {
    let step = |at: i32| f64::from(at % 3 - 1);
    let all = (0..27).map(|at| DVec3::new(step(at), step(at / 3), step(at / 9)));
    let turn = glam::DQuat::from_euler(glam::EulerRot::XYZ, 0.21, 0.34, 0.13);
    all.filter(|direction| *direction != DVec3::ZERO)
        .map(|direction| turn * direction.normalize_or_zero())
        .collect()
}

fn measure(mesh: &EdgeMesh) -> BTreeMap<(LineClass, usize), Count> {
    let table = ClassTable::new(|class| Some(class as u32));
    let default = Camera::default_view(&mesh.bounds);
    let mut counts = BTreeMap::new();
    for direction in directions() {
        let eye = default.target + direction * mesh.bounds.radius() * 3.0;
        let view = Camera { eye, ..default }.view(&mesh.bounds, 1.0);
        let outside = eye_is_outside(view.eye, mesh.bounds.min.into(), mesh.bounds.max.into());
        let lines = classify_lines(mesh, view.eye, &table, outside);
        count_view(mesh, &view, &lines, &mut counts);
    }
    counts
}

fn count_view(
    mesh: &EdgeMesh,
    view: &View,
    lines: &[Line],
    counts: &mut BTreeMap<(LineClass, usize), Count>,
) {
    // The drawn edges of each vertex, by class.
    let mut joints: BTreeMap<(u32, u32), Vec<usize>> = BTreeMap::new();
    for (edge, line) in
        lines.iter().enumerate().filter(|(_, line)| line.bits.contains(LineBits::DRAWN))
    {
        for vertex in [mesh.records[edge].v0, mesh.records[edge].v1] {
            joints.entry((line.layer, vertex)).or_default().push(edge);
        }
    }
    for ((layer, vertex), edges) in joints {
        let [first, second] = edges[..] else { continue };
        let stroke = |edge: usize| {
            let record = &mesh.records[edge];
            let stroke = Stroke::new(mesh, view, record, lines[edge].bits)?;
            let other = if record.v0 == vertex { record.v1 } else { record.v0 };
            let [here, there] = [vertex, other].map(|v| Vec3::from(mesh.positions[v as usize]));
            Some((stroke, record.v0 == vertex, there - here))
        };
        let (Some(first), Some(second)) = (stroke(first), stroke(second)) else { continue };
        let turn = 180.0 - first.2.angle_between(second.2).to_degrees();
        let bin = TURNS.iter().position(|bound| turn <= *bound).unwrap_or(TURNS.len() - 1);
        let gap = gap_px((&first.0, first.1), (&second.0, second.1));
        let count = counts.entry((LineClass::ALL[layer as usize], bin)).or_default();
        count.joints += 1;
        if gap >= GAP_PX {
            count.gaps += 1;
            count.area_px += gap;
        }
    }
}

fn main() {
    let models: Vec<String> = std::env::args().skip(1).collect();
    assert!(!models.is_empty(), "give the models to measure");
    println!("{WIDTH_PX} px wide on {SIZE_PX} px, {} views", directions().len());
    for model in models {
        let (source, mut report) = read_model(Path::new(&model)).unwrap();
        let mesh = build_edge_mesh(&source, &BuildOptions::default(), &mut report);
        println!("\n{model}: {} triangles", mesh.triangles.len());
        println!(
            "{:<12}{:>12}{:>10}{:>10}{:>9}{:>14}",
            "class", "turn", "joints", "gaps", "%", "px² a gap"
        );
        for ((class, bin), count) in measure(&mesh) {
            let least = if bin == 0 { 0.0 } else { TURNS[bin - 1] };
            let turn = format!("{least}-{}°", TURNS[bin]);
            #[expect(clippy::cast_precision_loss, reason = "counts of joints")]
            let (joints, gaps) = (count.joints as f32, count.gaps as f32);
            println!(
                "{:<12}{turn:>12}{:>10}{:>10}{:>9.2}{:>14.2}",
                class.name(),
                count.joints,
                count.gaps,
                100.0 * gaps / joints,
                count.area_px / gaps.max(1.0)
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A joint on the x axis between an edge from the left and one to the upper
    /// right, as strokes with normals that point this way.
    fn joint(normal: Vec2) -> f32 {
        let stroke = |from: Vec2, to: Vec2| {
            let clip = |point: Vec2| (point / (SIZE_PX * 0.5)).extend(0.5).extend(1.0);
            let n = normal.extend(0.0).extend(0.0);
            let edge = ClipEdge {
                c0: clip(from),
                c1: clip(to),
                c2: clip(from),
                c3: clip(from),
                n0: n,
                n1: n,
                facing: Vec2::ONE,
                distance: Vec2::ZERO,
                r: 0.0,
            };
            let segment = stroke_segment(&edge, &SHAPE, LineBits::empty());
            let corner = |corner| {
                segment_vertex(&segment, &SHAPE, corner).position.truncate() * (SIZE_PX * 0.5)
            };
            let corners = std::array::from_fn(|at| corner(u32::try_from(at).unwrap()));
            Stroke { segment, corners }
        };
        let first = stroke(Vec2::new(-50.0, 0.0), Vec2::ZERO);
        let second = stroke(Vec2::ZERO, Vec2::new(30.0, 40.0));
        gap_px((&first, false), (&second, true))
    }

    #[test]
    fn a_cap_fills_the_gap_where_the_normal_points_out_of_the_bend() {
        assert!(joint(Vec2::new(0.5, -0.9)) < 0.05, "out of the bend: filled");
        let open = joint(Vec2::new(-0.5, 0.9));
        let wedge = 0.5 * 2.0 * 2.0 * (40.0 / 50.0);
        assert!((open - wedge).abs() < 0.15 * wedge, "into the bend: {open} of {wedge}");
    }
}
