//! Pictures: goldens, and properties in closed form.

use std::sync::LazyLock;

use edgemesh::build::{BuildOptions, build_edge_mesh};
use edgemesh::edge_mesh::EdgeMesh;
use edgemesh::load::LoadedMesh;
use edgemesh::model::Model;
use edgemesh::report::Report;
use edgemesh::view::Camera;
use glam::DVec3;
use image::{GrayImage, Luma, RgbaImage};
use strokes::DrawingStyle;
use testkit::compare::Golden;
use viewer::pass_graph::strokes_of;
use viewer::picture::renderer::{PictureInput, PictureOptions, PictureRenderer};
use viewer::scene::models::Scene;
use viewer::technique::Technique;
use viewer::technique::library::Library;

use crate::gpu_device::{gpu, is_pinned_driver};
use crate::own_models::own_models;

pub(crate) fn technique(name: &str, settings: &[&str]) -> Technique {
    static LIBRARY: LazyLock<Library> = LazyLock::new(Library::shipped);
    let mut technique = LIBRARY.technique(name).unwrap().0;
    for setting in settings {
        technique.set(setting).unwrap();
    }
    technique
}

/// The strokes of a technique over a white fill.
pub(crate) fn drawing_style_of(technique: &Technique, mesh: &EdgeMesh) -> DrawingStyle {
    let built = [30_f64.to_radians(); 2];
    DrawingStyle {
        fill_color: Some([1.0; 4]),
        ..strokes_of(technique, &mesh.frame, built).unwrap()
    }
}

pub(crate) fn picture(
    mesh: &EdgeMesh,
    camera: &Camera,
    technique: &Technique,
    size_px: u32,
    samples: u32,
) -> RgbaImage {
    let options = PictureOptions { size: [size_px; 2], samples, ..PictureOptions::default() };
    picture_with(mesh, camera, technique, &options)
}

pub(crate) fn picture_with(
    mesh: &EdgeMesh,
    camera: &Camera,
    technique: &Technique,
    options: &PictureOptions,
) -> RgbaImage {
    let mut renderer =
        PictureRenderer::new(gpu(), PictureInput::new(&scene_of(mesh), technique), options)
            .unwrap();
    renderer.render(camera).unwrap().0
}

pub(crate) fn scene_of(mesh: &EdgeMesh) -> Scene {
    let (name, report) = ("test".into(), Report::default());
    Scene::of(vec![LoadedMesh::new(name, mesh.clone(), report)])
}

pub(crate) fn own_model(name: &str) -> EdgeMesh {
    own_models().into_iter().find(|(known, _)| known == name).unwrap().1
}

/// The pixels that are darker than middle gray.
fn ink(picture: &RgbaImage) -> GrayImage {
    GrayImage::from_fn(picture.width(), picture.height(), |x, y| {
        Luma([u8::from(picture.get_pixel(x, y).0[0] < 128)])
    })
}

fn ink_count(picture: &RgbaImage) -> usize {
    ink(picture).iter().filter(|&&pixel| pixel > 0).count()
}

fn from(mesh: &EdgeMesh, direction: DVec3, radii: f64) -> Camera {
    let default = Camera::default_view(&mesh.bounds);
    let eye = default.target + direction.normalize_or_zero() * mesh.bounds.radius() * radii;
    Camera { eye, ..default }
}

fn check_golden(name: &str, picture: &RgbaImage) {
    Golden::lines(is_pinned_driver()).check(name, picture);
}

#[test]
fn golden_models() {
    for (name, mesh) in own_models() {
        let camera = Camera::default_view(&mesh.bounds);
        check_golden(
            &format!("{name}-ink"),
            &picture(&mesh, &camera, &technique("ink", &[]), 256, 4),
        );
    }
}

/// Linked strokes: tapered, dashed where hidden, with two brushes, with wobble, and with
/// the joins and corners of a style.
#[test]
fn golden_linked() {
    for (golden, model, name, settings) in [
        ("torus_knot-linked", "torus_knot", "ink", &["strokes.width=5", "strokes.taper=25"][..]),
        ("torus_knot-linked-watercolor", "torus_knot", "watercolour", &[]),
        (
            "wave_blob-linked-charcoal",
            "wave_blob",
            "charcoal",
            &["strokes.wobble=3", "strokes.wobble_length=40"],
        ),
        (
            "bracket-linked-dashes",
            "bracket",
            "hidden_line",
            &["hidden.linked=true", "hidden.brush=none", "hidden.dash=8,5", "strokes.width=3"],
        ),
        (
            "cube-linked-mitred",
            "cube",
            "ink",
            &[
                "strokes.width=12",
                "strokes.opacity=0.5",
                "strokes.join=mitred",
                "strokes.corner=180",
                "strokes.ends=flat",
            ],
        ),
        (
            "cylinder-linked-curves",
            "cylinder",
            "ink",
            &["strokes.width=8", "strokes.width-curve=0.2,1,0.2", "strokes.overshoot=8"],
        ),
    ] {
        let mesh = own_model(model);
        let camera = Camera::default_view(&mesh.bounds);
        let technique = technique(name, &[&["strokes.linked=true"], settings].concat());
        check_golden(golden, &picture(&mesh, &camera, &technique, 256, 4));
    }
}

#[test]
fn golden_pen() {
    for name in ["bracket", "plane_with_hole"] {
        let mesh = own_model(name);
        let technique = technique("pen", &["strokes.width=8"]);
        let camera = from(&mesh, DVec3::new(-1.0, 0.8, 1.0), 2.4);
        check_golden(&format!("{name}-pen"), &picture(&mesh, &camera, &technique, 256, 4));
    }
}

/// The four brushes of the paper's Figure 6 on a smooth body, an open surface and a body
/// with sharp corners; dashes where lines are hidden; the other kinds of lines.
#[test]
fn golden_styles() {
    for (golden, model, name, settings) in [
        ("torus_knot-charcoal", "torus_knot", "charcoal", &[][..]),
        ("torus_knot-watercolor", "torus_knot", "watercolour", &[]),
        ("torus_knot-fur", "torus_knot", "fur", &["contour.width=20"]),
        ("plane_with_hole-watercolor", "plane_with_hole", "watercolour", &[]),
        (
            "cylinder-inside",
            "cylinder",
            "ink",
            &["contour.placement=inside", "strokes.width=10", "ridge.color=#c04000"],
        ),
        (
            "torus_knot-silhouette-inside",
            "torus_knot",
            "ink",
            &[
                "silhouette.render=true",
                "silhouette.width=6",
                "silhouette.placement=inside",
                "silhouette.color=#c04000",
            ],
        ),
        ("torus_knot-centred", "torus_knot", "charcoal", &["contour.placement=centred"]),
        ("bracket-charcoal", "bracket", "charcoal", &["strokes.parameterization=screen"]),
        ("bracket-hidden", "bracket", "hidden_line", &["hidden.color=#c04000", "hidden.width=3"]),
        (
            "bracket-silhouette",
            "bracket",
            "ink",
            &["silhouette.render=true", "silhouette.width=8", "silhouette.color=#2040c0"],
        ),
        ("cylinder-disks", "cylinder", "ink", &["strokes.width=10", "strokes.ends=disks"]),
        ("wave_blob-fins", "wave_blob", "ink", &["strokes.width=8", "strokes.kind=fin"]),
        ("bracket-thin", "bracket", "ink", &["strokes.kind=thin", "ridge.color=#c00000"]),
        (
            "torus_knot-world",
            "torus_knot",
            "ink",
            &["strokes.width=0.1", "strokes.width_unit=model", "strokes.fade=2.5,5"],
        ),
    ] {
        let mesh = own_model(model);
        let camera = from(&mesh, DVec3::new(0.9, 0.7, 1.0), 2.3);
        check_golden(golden, &picture(&mesh, &camera, &technique(name, settings), 256, 4));
    }
}

/// The end of the cylinder in wide strokes, where the paper's caps leave gaps (Figure 5).
#[test]
fn golden_caps() {
    let mesh = own_model("cylinder");
    let technique = technique("ink", &["strokes.width=10"]);
    let camera = from(&mesh, DVec3::new(0.1, 1.0, 0.35), 2.4);
    check_golden("cylinder-caps", &picture(&mesh, &camera, &technique, 256, 4));
}

#[test]
fn golden_orthographic_and_inside() {
    let mesh = own_model("bracket");
    let mut camera = from(&mesh, DVec3::new(1.0, 1.0, 1.0), 3.0);
    camera.is_orthographic = true;
    check_golden("bracket-ortho", &picture(&mesh, &camera, &technique("ink", &[]), 256, 4));
    let cube = own_model("cube");
    let inside = Camera { eye: DVec3::new(0.1, 0.05, 0.2), ..Camera::default_view(&cube.bounds) };
    let technique = technique("ink", &["strokes.width=4"]);
    check_golden("cube-inside", &picture(&cube, &inside, &technique, 256, 4));
}

#[test]
fn the_same_view_gives_the_same_bytes() {
    let mesh = own_model("wave_blob");
    let camera = Camera::default_view(&mesh.bounds);
    let technique = technique("pen", &[]);
    let first = picture(&mesh, &camera, &technique, 200, 4);
    let again = picture(&mesh, &camera, &technique, 200, 4);
    assert_eq!(first, again);
    assert!(ink_count(&first) > 500, "and there is something to see");
}

/// Half quads lie outside: around a convex body without creases, every pixel next to its
/// silhouette is inked, and none inside it.
#[test]
fn contours_of_a_convex_body_ring_it_from_outside() {
    for (body, stroke, direction) in rings("outside") {
        let [mut ring, mut gaps, mut inside] = [0; 3];
        for pixel in inner_pixels() {
            let is_inked = is_marked(&stroke, pixel);
            // A neighbor along a side, not only across a corner.
            if !is_marked(&body, pixel) && marked_around(&body, pixel, 1) >= 2 {
                ring += 1;
                gaps += usize::from(!is_inked);
            }
            inside += usize::from(is_inked && marked_around(&body, pixel, 2) == 25);
        }
        assert!(ring > 200, "the body is in the picture");
        assert_eq!((gaps, inside), (0, 0), "from {direction}, of {ring} pixels around");
    }
}

/// Inside, the surface turns toward the eye and could hide them: every pixel of the body
/// along its silhouette is inked, and none around it.
#[test]
fn contours_of_a_convex_body_ring_it_from_inside() {
    for (body, stroke, direction) in rings("inside") {
        let [mut ring, mut gaps, mut outside] = [0; 3];
        for pixel in inner_pixels() {
            let is_inked = is_marked(&stroke, pixel);
            // Two rows of pixels; the third is cut.
            if is_marked(&body, pixel) && marked_around(&body, pixel, 2) < 24 {
                ring += 1;
                gaps += usize::from(!is_inked);
            }
            outside += usize::from(is_inked && marked_around(&body, pixel, 1) == 0);
        }
        assert!(ring > 400, "the body is in the picture");
        assert_eq!(outside, 0, "from {direction}, of {ring} pixels around");
        assert_eq!(gaps, 0, "from {direction}: of {ring} pixels around");
    }
}

/// A convex body without creases and its contours, 3 pixels wide, from three directions.
fn rings(placement: &str) -> Vec<(GrayImage, GrayImage, DVec3)> {
    let mesh = without_creases(&own_model("cylinder"));
    let solid = technique("ink", &["fill.color=#000000", "strokes.color=#00000000"]);
    let placement = format!("contour.placement={placement}");
    let lines = technique("ink", &["strokes.width=3", &placement]);
    let directions = [DVec3::new(1.0, 0.6, 1.2), DVec3::new(0.2, -1.0, 0.3), DVec3::X];
    directions
        .map(|direction| {
            let camera = from(&mesh, direction, 3.0);
            let body = ink(&picture(&mesh, &camera, &solid, 256, 1));
            let stroke = ink(&picture(&mesh, &camera, &lines, 256, 1));
            (body, stroke, direction)
        })
        .into()
}

/// The pixels of a picture of 256 x 256 pixels, without a rim of 2 pixels.
fn inner_pixels() -> impl Iterator<Item = [u32; 2]> {
    (2..254).flat_map(|y| (2..254).map(move |x| [x, y]))
}

fn is_marked(picture: &GrayImage, [x, y]: [u32; 2]) -> bool {
    picture.get_pixel(x, y).0[0] > 0
}

/// The number of marked pixels in the square around a pixel, including it.
fn marked_around(picture: &GrayImage, [x, y]: [u32; 2], reach: u32) -> usize {
    (x - reach..=x + reach)
        .flat_map(|x| (y - reach..=y + reach).map(move |y| [x, y]))
        .filter(|&pixel| is_marked(picture, pixel))
        .count()
}

fn without_creases(mesh: &EdgeMesh) -> EdgeMesh {
    use edgemesh::edge_mesh::EdgeFlags;
    let mut mesh = mesh.clone();
    for record in &mut mesh.records {
        let creases = EdgeFlags::RIDGE | EdgeFlags::VALLEY | EdgeFlags::MATERIAL;
        record.word.set(creases, false);
    }
    mesh
}

/// A cube seen exactly from the front draws its front outline: the side faces are edge-on,
/// which counts as back.
#[test]
fn a_cube_from_the_front_is_one_square() {
    let cube = own_model("cube");
    let mut camera = from(&cube, DVec3::Z, 3.0);
    camera.is_orthographic = true;
    let stroke = ink(&picture(&cube, &camera, &technique("ink", &["strokes.width=2"]), 256, 1));
    let row: Vec<u32> = (0..256).filter(|&x| stroke.get_pixel(x, 128).0[0] > 0).collect();
    assert_eq!(row.len(), 4, "two pixels on each side: {row:?}");
    assert_eq!((row[1] - row[0], row[3] - row[2]), (1, 1), "{row:?}");
}

/// A floor that extends behind the eye draws the same as one that ends in front of the eye,
/// below the picture.
#[test]
fn an_edge_through_the_eye_plane_draws_like_its_visible_part() {
    let floor = |near_z: f32| {
        let corners = [[-1., 0., near_z], [1., 0., near_z], [1., 0., -20.], [-1., 0., -20.]];
        let model = Model::from_polygons(&corners, &[&[0, 1, 2, 3]]);
        build_edge_mesh(&model, &BuildOptions::default(), &mut Report::default())
    };
    let camera = Camera {
        eye: DVec3::new(0.3, 0.5, 0.0),
        target: DVec3::new(0.2, 0.4, -1.0),
        up: DVec3::Y,
        fov_y_rad: 1.0,
        is_orthographic: false,
    };
    let technique = technique("ink", &["strokes.width=4"]);
    let (through, before) = (floor(30.0), floor(-0.5));
    let through = picture(&through, &camera, &technique, 256, 4);
    let before = picture(&before, &camera, &technique, 256, 4);
    assert!(ink_count(&before) > 500, "{}", ink_count(&before));
    let differing =
        through.pixels().zip(before.pixels()).filter(|(a, b)| a.0[0].abs_diff(b.0[0]) > 64);
    assert!(differing.count() <= 4, "the near planes differ, the lines do not");
}

/// An eye at a vertex, on an edge or in a face draws no strokes across the picture.
#[test]
fn the_eye_on_the_mesh_leaves_no_spikes() {
    let cube = own_model("cube");
    let corner = cube.bounds.max[0];
    for at in [DVec3::splat(0.5), DVec3::new(0.5, 0.5, 0.1), DVec3::new(0.5, 0.2, 0.1)] {
        let eye = at * f64::from(corner) * 2.0;
        let camera = Camera {
            eye,
            target: DVec3::new(-0.3, -0.1, -0.2),
            ..Camera::default_view(&cube.bounds)
        };
        let technique = technique("ink", &["strokes.width=2"]);
        let inked = ink_count(&picture(&cube, &camera, &technique, 256, 1));
        // Ten edges across the picture, two pixels wide, would be 5,000.
        assert!(inked < 5000, "{inked} pixels from {eye}");
    }
}

#[test]
fn one_triangle_front_edge_on_and_none() {
    let model = Model::from_polygons(&[[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]], &[&[0, 1, 2]]);
    let mesh = build_edge_mesh(&model, &BuildOptions::default(), &mut Report::default());
    let technique = technique("ink", &["strokes.width=2"]);
    let count = |direction: DVec3| {
        ink_count(&picture(&mesh, &from(&mesh, direction, 3.0), &technique, 128, 1))
    };
    let (front, back, edge_on) = (count(DVec3::Z), count(DVec3::NEG_Z), count(DVec3::X));
    assert!(front > 200, "{front}");
    assert!(front.abs_diff(back) < 20, "both sides: {front} {back}");
    assert!((20..front / 2).contains(&edge_on), "a line: {edge_on}");
}

#[test]
fn transparency_leaves_the_paper_out() {
    let mesh = own_model("cube");
    let options =
        PictureOptions { size: [64; 2], is_transparent: true, ..PictureOptions::default() };
    let camera = Camera::default_view(&mesh.bounds);
    let picture = picture_with(&mesh, &camera, &technique("ink", &[]), &options);
    assert_eq!(picture.get_pixel(0, 0).0[3], 0);
    assert_eq!(picture.get_pixel(32, 32).0[3], 255);
}
