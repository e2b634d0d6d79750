//! Every visible piece of every feature edge has ink, and no hidden one has: against rays
//! cast on the CPU, triangle by triangle.

use edgemesh::build::{BuildOptions, build_edge_mesh};
use edgemesh::edge_mesh::EdgeMesh;
use edgemesh::format::read::read_model;
use edgemesh::oracle::spine::project_spine;
use edgemesh::view::{Camera, LineBits, View, WHOLE_BAND, classify_edges};
use glam::{DVec3, Vec2, Vec3, Vec4};
use image::RgbaImage;
use testkit::locate::{left_out, shared};

use crate::gpu_render::{own_model, picture, technique};

const SIZE_PX: u32 = 512;
const WIDTH_PX: f32 = 2.0;

/// Samples along an edge.
const SAMPLES: u32 = 5;

/// A sample is certainly hidden if a surface lies nearer by this many radii, and certainly
/// visible if none lies nearer by this many.
const SURELY_HIDDEN: f64 = 0.03;
const SURELY_VISIBLE: f64 = 1e-4;

struct Sample {
    /// The place of its ink, in pixels from the upper left.
    ink_px: Vec2,
    /// The distance of the nearest surface before it, in radii.
    depth_radii: f64,
}

fn samples(mesh: &EdgeMesh, camera: &Camera, view: &View) -> Vec<Sample> {
    let viewport_px = Vec2::splat(512.0);
    let mut samples = Vec::new();
    for (record, bits) in mesh.records.iter().zip(classify_edges(mesh, view.eye)) {
        if !bits.contains(LineBits::DRAWN) {
            continue;
        }
        let ends = [record.v0, record.v1].map(|v| Vec3::from(mesh.positions[v as usize]));
        let [c0, c1] = ends.map(|end| view.clip_from_world * end.extend(1.0));
        let spine = project_spine(c0, c1, viewport_px, WHOLE_BAND);
        if (spine.s1 - spine.s0).length() < 1.5 {
            continue;
        }
        let outside = match bits.contains(LineBits::CONTOUR) {
            false => 0.0,
            true if bits.contains(LineBits::A_FACES) => -0.5 * WIDTH_PX,
            true => 0.5 * WIDTH_PX,
        };
        for step in 0..SAMPLES {
            let t = (f64::from(step) + 0.5) / f64::from(SAMPLES);
            let point = ends[0].as_dvec3().lerp(ends[1].as_dvec3(), t);
            let clip: Vec4 = view.clip_from_world * point.as_vec3().extend(1.0);
            let screen = clip.truncate().truncate() / clip.w * 256.0 + spine.p * outside;
            samples.push(Sample {
                ink_px: Vec2::new(256.0 + screen.x, 256.0 - screen.y),
                depth_radii: depth_under(mesh, camera.eye, point) / mesh.bounds.radius(),
            });
        }
    }
    samples
}

/// The distance of `point` behind the first triangle on the ray from `eye`; 0 if there is
/// none.
fn depth_under(mesh: &EdgeMesh, eye: DVec3, point: DVec3) -> f64 {
    let direction = point - eye;
    let mut nearest = 1.0_f64;
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|v| Vec3::from(mesh.positions[v as usize]).as_dvec3());
        // Möller and Trumbore 1997.
        let (ab, ac) = (b - a, c - a);
        let h = direction.cross(ac);
        let determinant = ab.dot(h);
        if determinant.abs() < 1e-12 {
            continue;
        }
        let s = (eye - a) / determinant;
        let q = s.cross(ab);
        let (u, v, t) = (s.dot(h), direction.dot(q), ac.dot(q));
        if u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0 {
            nearest = nearest.min(t);
        }
    }
    (1.0 - nearest) * direction.length()
}

/// Whether there is ink within a pixel of `at`; `None` outside the picture.
fn has_ink(picture: &RgbaImage, at: Vec2) -> Option<bool> {
    let inner = f64::from(SIZE_PX - 2);
    let (x, y) = (f64::from(at.x), f64::from(at.y));
    if !(2.0..inner).contains(&x) || !(2.0..inner).contains(&y) {
        return None;
    }
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "inside the picture"
    )]
    let (x, y) = (x as u32, y as u32);
    let dark = |(x, y)| picture.get_pixel(x, y).0[0] < 192;
    Some((y - 1..=y + 1).flat_map(|y| (x - 1..=x + 1).map(move |x| (x, y))).any(dark))
}

#[test]
fn ink_lies_where_edges_are_visible_and_nowhere_else() {
    for name in ["bracket", "cylinder", "torus_knot", "plane_with_hole"] {
        let mesh = own_model(name);
        for direction in
            [DVec3::new(1.0, 0.6, 1.2), DVec3::new(-1.0, 0.3, 0.6), DVec3::new(0.2, -0.7, -1.0)]
        {
            let target = mesh.bounds.center();
            let eye = target + direction.normalize_or_zero() * mesh.bounds.radius() * 3.0;
            let camera = Camera { eye, ..Camera::default_view(&mesh.bounds) };
            let samples = samples(&mesh, &camera, &camera.view(&mesh.bounds, 1.0));
            let picture = picture(&mesh, &camera, &technique("ink", &[]), SIZE_PX, 4);
            let (mut visible, mut missing, mut hidden, mut leaking) = (0, 0, 0, 0);
            for sample in &samples {
                let Some(is_inked) = has_ink(&picture, sample.ink_px) else { continue };
                if sample.depth_radii < SURELY_VISIBLE {
                    visible += 1;
                    missing += usize::from(!is_inked);
                } else if sample.depth_radii > SURELY_HIDDEN && is_alone(&samples, sample) {
                    hidden += 1;
                    leaking += usize::from(is_inked);
                }
            }
            assert!(visible > 100, "{name}: only {visible} samples are visible");
            assert_eq!(missing, 0, "{name} from {direction}: of {visible} visible");
            assert!(
                leaking * 200 <= hidden,
                "{name} from {direction}: {leaking} of {hidden} hidden"
            );
        }
    }
}

/// Whether no sample that may be visible is near enough for its ink to count. Generous,
/// since samples of long edges are far apart.
fn is_alone(samples: &[Sample], sample: &Sample) -> bool {
    samples
        .iter()
        .filter(|other| other.depth_radii <= SURELY_HIDDEN)
        .all(|other| (other.ink_px - sample.ink_px).length() > 12.0)
}

/// Edges that are skipped as hidden by their own solid are hidden: a little beside a contour
/// in a groove, on its back face, a surface lies nearer to the eye.
#[test]
fn contours_in_grooves_are_hidden() {
    for name in ["torus_knot", "wave_blob"] {
        assert!(grooves_all_hidden(name, &own_model(name)) > 0, "{name} has grooves");
    }
}

/// The same on real models with closed surfaces.
#[test]
fn contours_in_grooves_of_real_models_are_hidden() {
    let Some(folder) = shared() else { return left_out("contours in grooves", 4) };
    for name in ["rocker-arm", "fandisk", "spot", "cow"] {
        let path = folder.join("models").join(format!("{name}.obj"));
        let (model, mut report) = read_model(&path).unwrap();
        let mesh = build_edge_mesh(&model, &BuildOptions::default(), &mut report);
        assert!(grooves_all_hidden(name, &mesh) > 100, "{name} has grooves");
    }
}

/// Asserts that rays find every contour in a groove hidden; returns their number.
fn grooves_all_hidden(name: &str, mesh: &EdgeMesh) -> usize {
    let center = |face: u32| {
        let corners = mesh.triangles[face as usize].map(|v| mesh.positions[v as usize]);
        corners.iter().map(|corner| Vec3::from(*corner).as_dvec3()).sum::<DVec3>() / 3.0
    };
    let mut grooves = 0;
    for direction in [DVec3::new(1.0, 0.6, 1.2), DVec3::new(-1.0, 0.3, 0.6), DVec3::NEG_Y] {
        let target = mesh.bounds.center();
        let eye = target + direction.normalize_or_zero() * mesh.bounds.radius() * 3.0;
        let view = Camera { eye, ..Camera::default_view(&mesh.bounds) }.view(&mesh.bounds, 1.0);
        for (record, bits) in mesh.records.iter().zip(classify_edges(mesh, view.eye)) {
            if !bits.contains(LineBits::CONTOUR | LineBits::BEHIND_SOLID) {
                continue;
            }
            grooves += 1;
            let ends = [record.v0, record.v1].map(|v| Vec3::from(mesh.positions[v as usize]));
            let middle = ends[0].midpoint(ends[1]).as_dvec3();
            let a_faces = bits.contains(LineBits::A_FACES);
            let back = center(if a_faces { record.face_b } else { record.face_a });
            let beside = middle.lerp(back, 0.05);
            let cover = depth_under(mesh, eye, beside);
            assert!(cover > 0.0, "{name} from {direction}: {record:?} is seen");
        }
    }
    grooves
}
