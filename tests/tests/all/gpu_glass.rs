//! Transparent surfaces: colors by hand, any order, and strokes behind them.

use edgemesh::build::{BuildOptions, build_edge_mesh};
use edgemesh::edge_mesh::EdgeMesh;
use edgemesh::model::{Attributes, Corner, Material, Model};
use edgemesh::report::Report;
use edgemesh::view::Camera;
use glam::DVec3;
use image::RgbaImage;
use viewer::technique::Technique;
use viewer::technique::library::Library;

use crate::gpu_render::{picture, technique};

/// A square across the line of sight: its distance behind z = 0, half its side, and the color and
/// opacity of its material.
type Pane = (f32, f32, [f32; 3], f32);

const PANES: [Pane; 4] = [
    (0.0, 0.6, [0.0, 0.0, 1.0], 0.3),
    (1.0, 0.8, [0.0, 1.0, 0.0], 0.5),
    (2.0, 0.4, [1.0, 1.0, 0.0], 0.25),
    (3.0, 1.0, [1.0, 0.0, 0.0], 1.0),
];

fn model_of(panes: &[Pane]) -> Model {
    let mut model = Model::default();
    for (at, &(distance, half, color, opacity)) in (0..).zip(panes) {
        let corners = [[-half, -half], [half, -half], [half, half], [-half, half]];
        model
            .positions
            .extend(corners.map(|[x, y]| [f64::from(x), f64::from(y), -f64::from(distance)]));
        model.materials.push(Material {
            name: format!("pane {at}"),
            diffuse: Some(color),
            opacity: Some(opacity),
            ..Material::default()
        });
        model.set_attributes(Attributes { material: at, ..Attributes::default() });
        model.push_polygon(&[0, 1, 2, 3].map(|corner| Corner::at(4 * at + corner)), 0);
    }
    model
}

fn mesh_of(model: &Model) -> EdgeMesh {
    build_edge_mesh(model, &BuildOptions::default(), &mut Report::default())
}

fn camera() -> Camera {
    Camera {
        eye: DVec3::Z * 5.0,
        target: DVec3::ZERO,
        up: DVec3::Y,
        fov_y_rad: 2.0 * (1.25_f64 / 5.0).atan(),
        is_orthographic: true,
    }
}

/// The materials' own colors over white.
fn unlit() -> Technique {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("unlit.toml");
    let text = "about = 'a test'\n[[pass]]\nname = 'fill'\ncomponent = 'render_unlit'\n\
                clear_color = [1, 1, 1]\n";
    std::fs::write(&path, text).unwrap();
    Library::shipped().technique_file(&path).unwrap_or_else(|mistakes| panic!("{mistakes}")).0
}

/// The color at x on the middle line, from -1.25 to 1.25.
fn color_at(picture: &RgbaImage, x: f64) -> [u8; 4] {
    let middle = picture.width() / 2;
    let column = f64::from(picture.width()) * (x + 1.25) / 2.5;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "in the picture")]
    picture.get_pixel(column as u32, middle).0
}

/// What is seen at x: each pane over the farther ones, over white.
fn wanted_at(x: f64) -> [f64; 3] {
    let mut color = [1.0; 3];
    for (.., own, opacity) in PANES.iter().rev().filter(|pane| x.abs() < f64::from(pane.1)) {
        for (color, own) in color.iter_mut().zip(own) {
            *color = f64::from(*own) * f64::from(*opacity) + *color * f64::from(1.0 - opacity);
        }
    }
    color.map(|value| 255.0 * value)
}

#[test]
fn panes_show_what_is_behind_them_in_any_order() {
    for samples in [1, 4] {
        let mut first: Option<RgbaImage> = None;
        for order in [[0, 1, 2, 3], [3, 2, 1, 0], [2, 0, 3, 1]] {
            let panes = order.map(|at: usize| PANES[at]);
            let found = picture(&mesh_of(&model_of(&panes)), &camera(), &unlit(), 250, samples);
            for x in [0.0, 0.2, 0.5, 0.7, 0.9, 1.1] {
                let (found, wanted) = (color_at(&found, x), wanted_at(x));
                let differs =
                    |(found, wanted): (&u8, &f64)| (f64::from(*found) - wanted).abs() > 2.0;
                let wrong = found.iter().zip(&wanted).any(differs);
                assert!(!wrong, "{order:?}, {samples} samples, x {x}: {found:?}, not {wanted:?}");
            }
            match &first {
                None => first = Some(found),
                Some(first) => assert!(*first == found, "{order:?}: another picture"),
            }
        }
    }
}

/// Panes that cross each other: left of the crossing one is nearer, right of it the other.
#[test]
fn panes_that_cross_are_seen_through_on_both_sides() {
    let mut model = model_of(&[(0.0, 0.8, [0.0, 0.0, 1.0], 0.5), (0.0, 0.8, [1.0, 0.0, 0.0], 0.5)]);
    for (at, position) in model.positions.iter_mut().enumerate() {
        position[2] = if at < 4 { position[0] } else { -position[0] };
    }
    let found = picture(&mesh_of(&model), &camera(), &unlit(), 250, 4);
    // The nearer one has a half, the farther one a quarter, white the rest.
    let [left, right] = [-0.5, 0.5].map(|x| color_at(&found, x));
    for (color, wanted) in [(left, [191, 64, 128]), (right, [128, 64, 191])] {
        let near = color.iter().zip(wanted).all(|(&a, b)| a.abs_diff(b) <= 2);
        assert!(near, "{color:?}, not {wanted:?}");
    }
}

/// A red square behind a pane: its rim is as dark as asked for, and never hidden.
#[test]
fn strokes_behind_glass_are_as_faint_as_asked_for() {
    let panes = [(0.0, 1.0, [0.0, 0.0, 1.0], 0.3), (1.0, 0.5, [1.0, 0.0, 0.0], 1.0)];
    let mesh = mesh_of(&model_of(&panes));
    for style in ["ink", "linked"] {
        for (share, wanted) in [("1", 0), ("0.4", 153), ("0", 255)] {
            let set = format!("strokes.behind_glass={share}");
            let technique = technique(style, &[&set, "strokes.width=6", "strokes.taper=0"]);
            let found = picture(&mesh, &camera(), &technique, 250, 4);
            // The right side of the square behind, and of the pane.
            let [behind, own] = [0.5, 1.0].map(|x| {
                (-6..=6).map(|step| color_at(&found, x + 0.01 * f64::from(step))[0]).min().unwrap()
            });
            assert!(behind.abs_diff(wanted) <= 3, "{style}, {share}: {behind}, not {wanted}");
            assert!(own <= 3, "{style}: the pane's own rim is {own}");
        }
    }
}

/// A box of glass shows its far edges; a box of wood does not.
#[test]
fn the_far_edges_of_a_box_of_glass_are_seen() {
    let ink_of = |opacity: f32| {
        let mut model = edgemesh::model::Model::from_polygons(
            &[0_u8, 1, 2, 3, 4, 5, 6, 7].map(|at| [at & 1, at >> 1 & 1, at >> 2].map(f32::from)),
            &[
                &[0, 2, 3, 1],
                &[4, 5, 7, 6],
                &[0, 1, 5, 4],
                &[2, 6, 7, 3],
                &[0, 4, 6, 2],
                &[1, 3, 7, 5],
            ],
        );
        model.materials.push(Material { opacity: Some(opacity), ..Material::default() });
        let first_polygon = 0;
        let attributes = Attributes { material: 0, ..Attributes::default() };
        model.runs.push(edgemesh::model::PolygonRun { first_polygon, attributes });
        let mesh = mesh_of(&model);
        let camera = Camera::default_view(&mesh.bounds);
        let technique = technique("ink", &["strokes.behind_glass=1"]);
        let found = picture(&mesh, &camera, &technique, 300, 1);
        found.pixels().filter(|pixel| pixel.0[0] < 128).count()
    };
    let (wood, glass) = (ink_of(1.0), ink_of(0.5));
    // Nine edges of twelve are seen of a box of wood.
    assert!(glass * 9 > wood * 11, "{wood} dark pixels, {glass} through glass");
}
