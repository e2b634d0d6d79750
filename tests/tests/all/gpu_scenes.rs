//! Scenes of several objects: transforms, styles, silhouettes, hidden lines; and cameras
//! that are hard for strokes.

use std::sync::Arc;

use edgemesh::build::{BuildOptions, build_edge_mesh};
use edgemesh::edge_mesh::EdgeMesh;
use edgemesh::load::LoadedMesh;
use edgemesh::model::Model;
use edgemesh::report::Report;
use edgemesh::view::Camera;
use glam::{DMat4, DQuat, DVec3};
use image::RgbaImage;
use strokes::{
    MeshBuffers, MeshInstance, Renderer, RendererOptions, SceneView, TargetFormats, Targets,
};
use viewer::picture::renderer::{PictureInput, PictureOptions, PictureRenderer};
use viewer::scene::models::{PlacedObject, Scene};
use viewer::technique::Technique;

use crate::gpu_device::gpu;
use crate::gpu_render::{drawing_style_of, own_model, picture, scene_of, technique};

/// A scene with a model in several places, each with the number of its technique.
fn scene(mesh: &EdgeMesh, places: &[(DMat4, usize)]) -> Scene {
    let loaded = LoadedMesh::new("test".into(), mesh.clone(), Report::default());
    let placed = places.iter().map(|&(world_from_object, override_index)| PlacedObject {
        model: 0,
        override_index,
        world_from_object,
    });
    Scene::placed(vec![loaded], placed.collect())
}

/// The scene with the technique of each object from `overrides`.
fn scene_picture(
    scene: &Scene,
    overrides: &[Technique],
    size_px: u32,
    camera: &Camera,
) -> RgbaImage {
    let options = PictureOptions { size: [size_px; 2], samples: 1, ..PictureOptions::default() };
    let input = PictureInput { scene, technique: &overrides[0], overrides };
    let mut renderer = PictureRenderer::new(gpu(), input, &options).unwrap();
    renderer.render(camera).unwrap().0
}

fn ink_with(settings: &[&str]) -> Technique {
    technique("ink", settings)
}

fn count(picture: &RgbaImage, is_meant: impl Fn([u8; 4]) -> bool) -> usize {
    picture.pixels().filter(|pixel| is_meant(pixel.0)).count()
}

const RED: [u8; 4] = [255, 0, 0, 255];
const BLUE: [u8; 4] = [0, 0, 255, 255];

/// Three hundred cubes in a grid: each has the same silhouette around it and no line of it
/// inside, also past the 255th, where the stencil starts over.
#[test]
fn three_hundred_silhouettes() {
    let cube = own_model("cube");
    let places: Vec<(DMat4, usize)> = (0..300)
        .map(|at| {
            let (column, row) = (f64::from(at % 20), f64::from(at / 20));
            (DMat4::from_translation(DVec3::new(4.0 * column, 4.0 * row, 0.0)), 0)
        })
        .collect();
    let scene = scene(&cube, &places);
    let mut camera = Camera::default_view(&scene.bounds);
    // From the side, so that there are inner contours and creases to leave out.
    camera.eye = camera.target + DVec3::new(0.5, 0.4, 1.0).normalize_or_zero() * 90.0;
    camera.is_orthographic = true;
    let techniques = [ink_with(&[
        "strokes.render=false",
        "silhouette.render=true",
        "silhouette.width=2",
        "silhouette.color=#ff0000",
    ])];
    let picture = scene_picture(&scene, &techniques, 1600, &camera);
    let solid = [ink_with(&["strokes.render=false", "fill.color=#00ff00"])];
    let bodies = scene_picture(&scene, &solid, 1600, &camera);
    let is_body = |x: u32, y: u32| bodies.get_pixel(x, y).0 == [0, 255, 0, 255];
    // Red is beside a body, never on it.
    let (mut ring, mut gaps, mut on_body) = (0, 0, 0);
    for (x, y) in (1..1599).flat_map(|y| (1..1599).map(move |x| (x, y))) {
        let is_red = picture.get_pixel(x, y).0 == RED;
        on_body += usize::from(is_red && is_body(x, y));
        let beside = [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)];
        let neighbors = beside.iter().filter(|&&(x, y)| is_body(x, y)).count();
        if !is_body(x, y) && neighbors > 0 {
            ring += 1;
            gaps += usize::from(!is_red);
        }
    }
    assert!(ring > 300 * 60, "{ring} pixels around 300 bodies");
    assert_eq!(on_body, 0, "of {ring}");
    assert!(gaps * 200 < ring, "{gaps} of {ring} are missing");
}

/// A silhouette shows in front of another object as in front of the background.
#[test]
fn silhouettes_lie_over_what_is_behind() {
    let cube = own_model("cube");
    let behind = DMat4::from_scale_rotation_translation(
        DVec3::splat(4.0),
        DQuat::IDENTITY,
        DVec3::new(0.0, 0.0, -8.0),
    );
    let only_silhouette = ["strokes.render=false", "silhouette.render=true", "silhouette.width=3"];
    let red = ink_with(&[&only_silhouette[..], &["silhouette.color=#ff0000"]].concat());
    let blue = ink_with(&[&only_silhouette[..], &["silhouette.color=#0000ff"]].concat());
    for order in [[0, 1], [1, 0]] {
        let mut places = [(DMat4::IDENTITY, 0), (behind, 1)];
        places.sort_by_key(|place| order[place.1]);
        let scene = scene(&cube, &places);
        let mut camera = Camera::default_view(&scene.bounds);
        camera.eye = DVec3::new(0.0, 0.0, 30.0);
        camera.target = DVec3::ZERO;
        let picture = scene_picture(&scene, &[red.clone(), blue.clone()], 256, &camera);
        let (reds, blues) = (count(&picture, |pixel| pixel == RED), count(&picture, |p| p == BLUE));
        assert!(reds > 150 && blues > reds, "{order:?}: {reds} red, {blues} blue");
        let mut alone = self::scene(&cube, &[(DMat4::IDENTITY, 0)]);
        alone.bounds = scene.bounds;
        let alone = scene_picture(&alone, std::slice::from_ref(&red), 256, &camera);
        assert_eq!(
            reds,
            count(&alone, |pixel| pixel == RED),
            "the silhouette in front is not whole"
        );
    }
}

/// Hidden lines have the hidden style, and every piece of a line is either hidden or
/// visible.
#[test]
fn hidden_lines_are_what_visible_ones_leave() {
    for name in ["cube", "bracket", "torus_knot"] {
        let mesh = own_model(name);
        let camera = Camera::default_view(&mesh.bounds);
        let draw = |settings: &[&str]| picture(&mesh, &camera, &technique("ink", settings), 256, 1);
        let is_ink = |pixel: [u8; 4]| pixel[0] < 255;
        let all = ["strokes.kind=thin", "hidden.kind=thin", "hidden.color=#000000"];
        let visible = draw(&["strokes.kind=thin"]);
        let hidden = draw(&[&all[..], &["hidden.render=true", "strokes.render=false"]].concat());
        let both = draw(&[&all[..], &["hidden.render=true"]].concat());
        let (mut missing, mut inked) = (0, 0);
        for ((visible, hidden), both) in visible.pixels().zip(hidden.pixels()).zip(both.pixels()) {
            let expected = is_ink(visible.0) || is_ink(hidden.0);
            missing += usize::from(expected != is_ink(both.0));
            inked += usize::from(expected);
        }
        assert!(inked > 500 && missing == 0, "{name}: {missing} of {inked}");
        let hidden_ink = count(&hidden, is_ink);
        assert!(hidden_ink > 100, "{name}: {hidden_ink} pixels are hidden");
    }
}

/// Seen from the middle of a face, the four hidden edges of a cube are a square.
#[test]
fn the_back_of_a_cube_is_drawn_as_hidden() {
    let cube = own_model("cube");
    let mut camera = Camera::default_view(&cube.bounds);
    camera.eye = camera.target + DVec3::Z * 6.0;
    let settings = [
        "strokes.render=false",
        "hidden.render=true",
        "hidden.color=#0000ff",
        "hidden.width=2",
        "hidden.placement=centred",
    ];
    let picture = picture(&cube, &camera, &technique("ink", &settings), 256, 1);
    let row: Vec<u32> = (0..256).filter(|&x| picture.get_pixel(x, 128).0 == BLUE).collect();
    assert_eq!(row.len(), 4, "two pixels on each side: {row:?}");
}

/// A model with a transform draws the same as a model with transformed vertices.
#[test]
fn transforms_move_what_is_drawn() {
    let mesh = own_model("bracket");
    let place = DMat4::from_scale_rotation_translation(
        DVec3::splat(1.7),
        DQuat::from_euler(glam::EulerRot::XYZ, 0.3, -0.8, 0.2),
        DVec3::new(0.4, -0.2, 0.3),
    );
    let mirror = place * DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    let stretched = place * DMat4::from_scale(DVec3::new(1.0, 2.0, 0.6));
    for (name, transform) in [("moved", place), ("mirrored", mirror), ("stretched", stretched)] {
        let mut model = Model::default();
        let (source, _) = edgemesh::format::read::read_model(
            &testkit::locate::workspace_root().join("models/bracket.obj"),
        )
        .unwrap();
        model.clone_from(&source);
        for position in &mut model.positions {
            *position = transform.transform_point3(DVec3::from(*position)).to_array();
        }
        let moved = build_edge_mesh(&model, &BuildOptions::default(), &mut Report::default());
        let scene = scene(&mesh, &[(transform, 0)]);
        let camera = Camera::default_view(&scene.bounds);
        let technique = ink_with(&["strokes.width=5"]);
        let mut baked = self::scene(&moved, &[(DMat4::IDENTITY, 0)]);
        baked.bounds = scene.bounds;
        let placed = scene_picture(&scene, std::slice::from_ref(&technique), 256, &camera);
        let baked = scene_picture(&baked, &[technique], 256, &camera);
        let apart = placed.pixels().zip(baked.pixels());
        let apart = apart.filter(|(a, b)| a.0[0].abs_diff(b.0[0]) > 32).count();
        let inked = count(&baked, |pixel| pixel[0] < 128);
        // Stretching changes angles and so the creases.
        let most = if name == "stretched" { inked / 20 } else { inked / 50 };
        assert!(inked > 1500 && apart <= most, "{name}: {apart} pixels of {inked}");
    }
}

/// An object with a transform that flattens it is not drawn.
#[test]
fn an_object_of_no_size_is_not_drawn() {
    let cube = own_model("cube");
    let flat = DMat4::from_scale(DVec3::new(1.0, 0.0, 1.0));
    let scene = scene(&cube, &[(flat, 0)]);
    let picture = scene_picture(&scene, &[ink_with(&[])], 64, &Camera::default_view(&cube.bounds));
    assert_eq!(count(&picture, |pixel| pixel[0] < 255), 0);
}

/// Lines do not fight the surface at any distance: from 1 to 100 radii, the visible share of
/// a model's strokes stays the same, for every placement.
#[test]
fn lines_stay_whole_in_a_slow_zoom() {
    for (name, placement) in [
        ("cube", "auto"),
        ("bracket", "auto"),
        ("cylinder", "auto"),
        ("bracket", "inside"),
        ("cylinder", "centred"),
    ] {
        let mesh = own_model(name);
        let mut renderers = visible_and_hidden(&mesh, placement);
        let mut last: Option<[usize; 2]> = None;
        for step in 0..=40 {
            let radii = 1.3 * (100.0_f64 / 1.3).powf(f64::from(step) / 40.0);
            let [visible, hidden] = zoomed(&mesh, &mut renderers, radii, false);
            if let Some(last) = last {
                let jump = visible.abs_diff(last[0]).max(hidden.abs_diff(last[1]));
                assert!(
                    jump * 4 < visible + hidden,
                    "{name} {placement} at {radii:.1} radii: {visible} and {hidden} pixels, \
                     {last:?} before"
                );
            }
            assert!(visible > 200, "{name} {placement} at {radii:.1} radii: {visible} pixels");
            last = Some([visible, hidden]);
        }
        // Far away, perspective and orthographic cameras see the same.
        let [far, flat] =
            [false, true].map(|is_flat| zoomed(&mesh, &mut renderers, 100.0, is_flat)[0]);
        assert!(far.abs_diff(flat) * 20 < flat, "{name} {placement}: {far} and {flat}");
    }
}

/// A renderer of the visible strokes alone, and one of the hidden strokes.
fn visible_and_hidden(mesh: &EdgeMesh, placement: &str) -> [PictureRenderer; 2] {
    let hidden = ["strokes.render=false", "hidden.render=true", "hidden.color=#000000"];
    [&[][..], &hidden].map(|settings| {
        let [visible, hidden] =
            ["strokes", "hidden"].map(|pass| format!("{pass}.placement={placement}"));
        let placed = [&visible, &hidden, "hidden.width=2"];
        let technique = technique("ink", &[settings, &placed].concat());
        let options = PictureOptions { size: [256; 2], samples: 1, ..PictureOptions::default() };
        PictureRenderer::new(gpu(), PictureInput::new(&scene_of(mesh), &technique), &options)
            .unwrap()
    })
}

/// The pixels of visible and of hidden strokes, in a picture that keeps the size of the
/// model while the eye is `radii` away.
fn zoomed(
    mesh: &EdgeMesh,
    renderers: &mut [PictureRenderer; 2],
    radii: f64,
    is_orthographic: bool,
) -> [usize; 2] {
    let mut camera = Camera::default_view(&mesh.bounds);
    let direction = (camera.eye - camera.target).normalize_or_zero();
    camera.eye = camera.target + direction * mesh.bounds.radius() * radii;
    camera.fov_y_rad = 2.0 * (0.8 / (radii - 0.2).max(0.9)).atan().min(1.2);
    camera.is_orthographic = is_orthographic;
    renderers
        .each_mut()
        .map(|renderer| count(&renderer.render(&camera).unwrap().0, |pixel| pixel[0] < 128))
}

/// An eye inside, on an edge, at a vertex; edges through the eye plane, along the line of
/// sight, without length, twice in one place: every value of the target is a number from 0
/// to 1.
#[test]
fn no_view_draws_what_is_no_number() {
    let formats =
        TargetFormats { color: wgpu::TextureFormat::Rgba16Float, ..TargetFormats::new(1) };
    let gpu = gpu();
    let targets = Targets::new(&gpu.device, [64; 2], formats);
    let settings: [&[&str]; 4] = [
        &["strokes.width=9", "hidden.render=true"],
        &[
            "strokes.ends=disks",
            "strokes.width=0.4",
            "strokes.width_unit=model",
            "strokes.fade=0.1,3",
        ],
        &[
            "strokes.kind=fin",
            "strokes.width=0.5",
            "strokes.width_unit=model",
            "strokes.brush=pen",
            "strokes.parameterization=screen",
        ],
        &["strokes.placement=inside", "strokes.brush=fur", "ridge.kind=thin"],
    ];
    for how in crate::noop::layouts_and_stages() {
        let options =
            RendererOptions { layout: how.0, stage: how.1, ..RendererOptions::new(formats) };
        let mut renderer = Renderer::new(gpu, options).unwrap();
        for (mesh_name, mesh) in awkward_meshes() {
            let buffers = Arc::new(MeshBuffers::new(&gpu.device, &mesh, how.0).unwrap());
            for settings in settings {
                let style =
                    renderer.prepare(gpu, &drawing_style_of(&ink_with(settings), &mesh)).unwrap();
                let instance = MeshInstance::new(&buffers, DMat4::IDENTITY);
                let mut scene = SceneView::new(gpu, vec![instance], vec![style]);
                for (view_name, camera) in awkward_cameras(&mesh) {
                    let view = camera.view(&mesh.bounds, 1.0);
                    renderer.render(gpu, &targets, &mut scene, &view, [1.0; 4], None).unwrap();
                    let halves = read_halves(&targets);
                    let odd = halves.iter().filter(|&&half| half > HALF_ONE + 1).count();
                    assert_eq!(odd, 0, "{mesh_name}, {view_name}, {how:?}, {settings:?}");
                }
            }
        }
    }
}

/// 1 as a 16-bit float: larger bit patterns are negative, larger or not a number.
const HALF_ONE: u16 = 0x3c00;

fn read_halves(targets: &Targets) -> Vec<u16> {
    strokes::read_texels(gpu(), targets.picture()).unwrap()
}

fn awkward_meshes() -> Vec<(&'static str, EdgeMesh)> {
    let build = |positions: &[[f32; 3]], polygons: &[&[u32]]| {
        let model = Model::from_polygons(positions, polygons);
        let options =
            BuildOptions { welding: edgemesh::build::Welding::Off, ..BuildOptions::default() };
        build_edge_mesh(&model, &options, &mut Report::default())
    };
    let twice =
        [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 0.], [1., 0., 0.], [0., 1., 0.]];
    let needle = [[0., 0., 0.], [1., 0., 0.], [0.5, 1e-12, 0.], [0.5, -1., 0.], [0.5, 1., 1e-20]];
    vec![
        ("cube", own_model("cube")),
        ("one triangle", build(&twice[..3], &[&[0, 1, 2]])),
        ("two triangles in one place", build(&twice, &[&[0, 1, 2], &[3, 4, 5]])),
        ("edges of no length", build(&needle, &[&[0, 1, 2], &[1, 0, 3], &[2, 4, 0]])),
        ("a line", build(&[[0., 0., 0.], [1., 0., 0.], [2., 0., 0.]], &[&[0, 1, 2]])),
    ]
}

fn awkward_cameras(mesh: &EdgeMesh) -> Vec<(&'static str, Camera)> {
    let default = Camera::default_view(&mesh.bounds);
    let [low, high] =
        [mesh.bounds.min, mesh.bounds.max].map(|corner| DVec3::from(corner.map(f64::from)));
    let at = |eye: DVec3, target: DVec3| Camera { eye, target, ..default };
    vec![
        ("from outside", default),
        ("inside", at(default.target + DVec3::new(0.01, 0.02, 0.03), high)),
        ("at a vertex", at(high, low)),
        ("on an edge", at(DVec3::new((low.x + high.x) / 2.0, high.y, high.z), low)),
        ("along an edge", at(DVec3::new(low.x - 3.0, low.y, low.z), low)),
        ("in a face", at(DVec3::new(default.target.x, default.target.y, high.z), low)),
        ("through the eye plane", at(DVec3::new(0.5, 0.1, 0.05), DVec3::new(1.5, 0.1, 0.05))),
        ("far away", at(default.target + DVec3::splat(1e6), default.target)),
        ("flat", Camera { is_orthographic: true, ..at(default.target + DVec3::X, default.target) }),
    ]
}

fn differing_pixels(one: &RgbaImage, other: &RgbaImage) -> usize {
    one.pixels().zip(other.pixels()).filter(|(one, other)| one != other).count()
}

/// The mesh of polygons that are added to a cube of side 1 at the origin.
fn cube_with(positions: &[[f32; 3]], polygons: &[&[u32]]) -> EdgeMesh {
    let side = |bit: u8| f32::from(bit);
    let mut all: Vec<[f32; 3]> =
        (0..8_u8).map(|at| [side(at & 1), side(at >> 1 & 1), side(at >> 2)]).collect();
    let cube: [&[u32]; 6] =
        [&[0, 2, 3, 1], &[4, 5, 7, 6], &[0, 1, 5, 4], &[2, 6, 7, 3], &[0, 4, 6, 2], &[1, 3, 7, 5]];
    all.extend(positions);
    let added = polygons.iter().map(|polygon| polygon.iter().map(|corner| corner + 8).collect());
    let added: Vec<Vec<u32>> = added.collect();
    let polygons: Vec<&[u32]> = cube.into_iter().chain(added.iter().map(Vec::as_slice)).collect();
    let model = Model::from_polygons(&all, &polygons);
    build_edge_mesh(&model, &BuildOptions::default(), &mut Report::default())
}

/// What lies far away, out of sight or under the cube, does not move the near plane past it.
#[test]
fn what_is_near_is_drawn_whatever_is_far() {
    let camera = Camera {
        eye: DVec3::new(3.0, 2.0, 4.0),
        target: DVec3::splat(0.5),
        up: DVec3::Y,
        fov_y_rad: 40_f64.to_radians(),
        is_orthographic: false,
    };
    let alone = cube_with(&[], &[]);
    for (distance, name) in [(1e5, "far"), (1e7, "very far")] {
        // Behind the eye.
        let stray = [[distance, 0.0, distance], [distance, 1.0, distance], [distance; 3]];
        let with_stray = cube_with(&stray, &[&[0, 1, 2]]);
        for style in ["ink", "linked", "phong", "hidden_line"] {
            let technique = technique(style, &[]);
            let [wanted, found] = [&alone, &with_stray].map(|mesh| {
                scene_picture(&scene_of(mesh), std::slice::from_ref(&technique), 300, &camera)
            });
            // In the box of the larger mesh, turned-away edges are left to the depth test.
            let differing = differing_pixels(&wanted, &found);
            assert!(differing < 12, "{style}, {name}: {differing} pixels");
        }
    }
    // A ground of 30,000 units, of which no edge comes into the picture. The cube stands 0.01
    // above it, so no line of it is in doubt.
    let camera = Camera { target: DVec3::new(0.5, 0.1, 0.5), ..camera };
    let level = -0.01;
    let ground = [[-3e4, level, -3e4], [3e4, level, -3e4], [3e4, level, 3e4], [-3e4, level, 3e4]];
    let on_ground = cube_with(&ground, &[&[3, 2, 1, 0]]);
    let ink = ink_with(&[]);
    let [wanted, found] = [&alone, &on_ground]
        .map(|mesh| scene_picture(&scene_of(mesh), std::slice::from_ref(&ink), 300, &camera));
    let ink_of = |picture: &RgbaImage| count(picture, |[red, ..]| red < 128);
    let differing = differing_pixels(&wanted, &found);
    assert!(ink_of(&wanted) > 500 && differing < 12, "{differing} of {}", ink_of(&wanted));
}
