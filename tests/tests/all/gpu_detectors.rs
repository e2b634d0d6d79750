//! Detectors on real pictures: the GPU against its CPU twin, pixel for pixel.

use std::fmt::Write as _;

use edgemesh::build::{BuildOptions, build_edge_mesh};
use edgemesh::edge_mesh::EdgeMesh;
use edgemesh::format::read::read_model;
use edgemesh::oracle::detector::chiang::{ChiangOptions, chiang};
use edgemesh::oracle::detector::depth::{self, DepthMapping, distance_of};
use edgemesh::oracle::detector::gradient::{Magnitude, of_intensity, of_largest_channel, sobel};
use edgemesh::oracle::detector::normals::{self, dot_products, normal_of_rgb};
use edgemesh::oracle::detector::planes::{ImageView, plane_distance_px};
use edgemesh::oracle::detector::second_derivative::{laplacian_of_gaussian, zero_crossing};
use edgemesh::oracle::detector::{Image, Texel, regions};
use edgemesh::view::Camera;
use glam::{Mat4, Vec2, Vec3, Vec4};
use strokes::{FrameUniform, Tile, read_texels};
use testkit::locate::{left_out, shared};
use viewer::picture::renderer::{PictureInput, PictureOptions, PictureRenderer};
use viewer::scene::lighting::Lighting;
use viewer::technique::library::Library;

use crate::gpu_device::gpu;
use crate::gpu_render::{own_model, scene_of};

/// Not square, and no multiple of the size of a workgroup.
const SIZE: [u32; 2] = [237, 181];

/// The expected value of a texel.
enum Wanted {
    /// A strength within an error.
    Strength(f32, f32),
    /// A line if this is positive; either if it is nearly zero.
    Margin(f32),
}
use Wanted::{Margin, Strength};

/// A detector; `@name` is short for a generated texture.
struct Case {
    component: &'static str,
    values: &'static str,
    wanted: fn(&Inputs, Texel) -> Wanted,
}

const fn case(
    component: &'static str,
    values: &'static str,
    wanted: fn(&Inputs, Texel) -> Wanted,
) -> Case {
    Case { component, values, wanted }
}

/// No sum of bytes equals the threshold.
macro_rules! chiang_values {
    ($more:literal) => {
        concat!(
            "normal_texture = @bytes_color\ndepth_texture = @scene_depth\n",
            "normal_threshold = 0.801",
            $more
        )
    };
}

const CASES: [Case; 18] = [
    case("edge_detect_normals", "normal_texture = @scene_normal", |inputs, at| {
        Margin(0.8 - dot_products(&inputs.normals, at)[0])
    }),
    case(
        "edge_detect_normals",
        "normal_texture = @scene_normal\napply_threshold = false\nthreshold = 0.5",
        |inputs, at| Strength(0.5 * (4.0 - dot_products(&inputs.normals, at)[1]), 1e-5),
    ),
    case("edge_detect_normals_5_taps", "normal_texture = @scene_normal", |inputs, at| {
        Margin(0.85 - normals::five_taps(&inputs.normals, at))
    }),
    case(
        "edge_detect_depth_deltas",
        "depth_texture = @scene_depth\nunit = 'scene'\nthreshold = 0.05",
        |inputs, at| Margin(depth::delta(&inputs.distances, at) - 0.05),
    ),
    case(
        "edge_detect_depth_deltas",
        "depth_texture = @scene_depth\napply_threshold = false\nthreshold = 3.0",
        |inputs, at| {
            let radius = inputs.frame.scene_radius;
            Strength(3.0 * depth::delta(&inputs.distances, at) / radius, 2e-5)
        },
    ),
    case(
        "edge_detect_depth_2nd_derivative",
        "depth_texture = @scene_depth\nthreshold = 0.05",
        |inputs, at| {
            Margin(depth::laplacian(&inputs.distances, at) / inputs.frame.scene_radius - 0.05)
        },
    ),
    case(
        "edge_detect_depth_2nd_derivative",
        "depth_texture = @scene_depth\nunit = 'scene'\napply_threshold = false\nthreshold = 3.0",
        |inputs, at| Strength(3.0 * depth::laplacian(&inputs.distances, at), 5e-5),
    ),
    case(
        "edge_detect_depth_5_taps",
        "normal_texture = @map_color\nthreshold = 0.05",
        |inputs, at| Margin(depth::five_taps(&inputs.map_depths, at) - 0.05),
    ),
    case(
        "edge_detect_planes",
        "normal_texture = @scene_normal\ndepth_texture = @scene_depth",
        |inputs, at| Margin(0.01 * (inputs.plane_distance_px(at) - 3.0)),
    ),
    case(
        "edge_detect_planes",
        "normal_texture = @scene_normal\ndepth_texture = @scene_depth\napply_threshold = false",
        |inputs, at| Strength(inputs.plane_distance_px(at) / 3.0, 1e-3),
    ),
    case("edge_detect_ids", "id_texture = @scene_region", |inputs, at| {
        Strength(f32::from(regions::differ(&inputs.ids, at)), 0.0)
    }),
    case("edge_detect_sobel", "texture = @scene_color", |inputs, at| {
        let gradient = of_intensity(&sobel(&inputs.colors, at));
        Margin(Magnitude::Root.of(gradient) - 0.5)
    }),
    case(
        "edge_detect_sobel",
        "texture = @scene_color\nmagnitude = 'sum'\nchannels = 'largest'\nshow = 'intensities'",
        |inputs, at| {
            let gradient = sobel(&inputs.colors, at);
            let largest = of_largest_channel(&gradient, Magnitude::Sum);
            Strength(0.5 * Magnitude::Sum.of(largest), 1e-5)
        },
    ),
    case("edge_detect_zero_crossings", "texture = @second_color", |inputs, at| {
        Margin(zero_crossing(&inputs.second_derivative, at) - 0.01)
    }),
    case("edge_detect_chiang", chiang_values!(""), |inputs, at| {
        Strength(f32::from(inputs.chiang[0].at(at)), 0.0)
    }),
    case("edge_detect_chiang", chiang_values!("\nextra_filter = false"), |inputs, at| {
        Strength(f32::from(inputs.chiang[1].at(at)), 0.0)
    }),
    case("edge_detect_chiang", chiang_values!("\ngradient = 'printed'"), |inputs, at| {
        Strength(f32::from(inputs.chiang[2].at(at)), 0.0)
    }),
    case(
        "edge_detect_combined",
        "normal_texture = @scene_normal\ndepth_texture = @scene_depth\nid_texture = @scene_region\n\
         normal_color = '#ff0000'\ndepth_color = '#ff0000'\nid_color = '#ff0000'",
        |inputs, at| {
            let bend = depth::laplacian(&inputs.distances, at) / inputs.frame.scene_radius;
            let of_ids = if regions::differ(&inputs.ids, at) { 1.0 } else { -1.0 };
            let of_normals = 0.8 - dot_products(&inputs.normals, at)[0];
            Margin(of_normals.max(bend - 0.05).max(of_ids))
        },
    ),
];

/// The inputs of detectors on the CPU.
struct Inputs {
    normals: Image<Vec3>,
    depths: Image<f32>,
    distances: Image<f32>,
    /// Depths from 0 at the near to 1 at the far plane, beside Card and Mitchell's normals.
    map_depths: Image<f32>,
    colors: Image<Vec4>,
    ids: Image<[u8; 4]>,
    second_derivative: Image<f32>,
    /// With the extra filter, without it, and with the gradient as printed.
    chiang: [Image<u8>; 3],
    frame: FrameUniform,
}

/// The passes before the detectors.
const SCENE: &str = "
[[pass]]
component = 'render_scene_data'
regions = 'materials'
render_target = 'scene'
render_target_format = 'rgba8, rgba32f, rgba8'

[[pass]]
component = 'render_normals'
render_target = 'bytes'
render_target_format = 'rgba8'

[[pass]]
component = 'render_normals_and_depth'
render_target = 'map'
render_target_format = 'rgba32f'

[[pass]]
component = 'laplacian_of_gaussian'
texture = '<generated>:scene_color'
render_target = 'second'
";

/// All detectors as one technique, each with its own texture.
fn passes() -> String {
    let mut text = SCENE.to_owned();
    for (at, case) in CASES.iter().enumerate() {
        let _ = write!(
            text,
            "[[pass]]\nname = 'of_{at}'\ncomponent = '{}'\nrender_target = 'of_{at}'\n\
             render_target_format = 'rgba32f'\nbackground_color = '#000000'\n\
             edge_color = '#ff0000'\n",
            case.component
        );
        for line in case.values.lines() {
            let line = match line.split_once('@') {
                Some((variable, texture)) => format!("{variable}'<generated>:{texture}'"),
                None => line.to_owned(),
            };
            let _ = writeln!(text, "{line}");
        }
    }
    text
}

impl Inputs {
    fn read(renderer: &PictureRenderer, frame: FrameUniform) -> Self {
        let texture = |name: &str| renderer.generated(name).unwrap();
        let width = SIZE[0] as usize;
        let floats = |name: &str| -> Image<Vec4> {
            Image::new(width, read_texels(gpu(), texture(name)).unwrap()).unwrap()
        };
        let bytes = |name: &str| -> Image<[u8; 4]> {
            Image::new(width, read_texels(gpu(), texture(name)).unwrap()).unwrap()
        };
        let single = |name: &str| -> Image<f32> {
            Image::new(width, read_texels(gpu(), texture(name)).unwrap()).unwrap()
        };
        let (scene_normal, map, scene_color) =
            (floats("scene_normal"), floats("map_color"), bytes("scene_color"));
        let depths = single("scene_depth");
        let normal_bytes = bytes("bytes_color");
        let options = ChiangOptions {
            normal_threshold: 0.801,
            depth_threshold: 0.1,
            extra_threshold: Some(0.06),
            is_as_printed: false,
        };
        let kinds = [
            options,
            ChiangOptions { extra_threshold: None, ..options },
            ChiangOptions { is_as_printed: true, ..options },
        ];
        let chiang = kinds
            .map(|options| chiang(&normal_bytes, &depths, &mapping_of(&frame), &options).unwrap());
        Self {
            normals: scene_normal.measured(|at| normal_of_rgb(scene_normal.at(at).truncate())),
            distances: depths.measured(|at| distance_of(depths.at(at), &mapping_of(&frame))),
            depths,
            map_depths: map.measured(|at| map.at(at).w),
            colors: scene_color
                .measured(|at| Vec4::from(scene_color.at(at).map(f32::from)) / 255.0),
            ids: bytes("scene_region"),
            second_derivative: single("second_color"),
            chiang,
            frame,
        }
    }

    fn plane_distance_px(&self, at: Texel) -> f32 {
        let view = ImageView {
            viewport_px: Vec2::from(self.frame.viewport_px),
            px_per_unit: self.frame.px_per_unit,
            mapping: mapping_of(&self.frame),
            world_from_clip: Mat4::from_cols_array_2d(&self.frame.world_from_clip),
        };
        plane_distance_px(&self.depths, &self.normals, &view, at)
    }
}

fn mapping_of(frame: &FrameUniform) -> DepthMapping {
    DepthMapping { projection: frame.projection, range: frame.depth_range }
}

fn compare(mesh: &EdgeMesh, camera: &Camera) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("detectors.toml");
    std::fs::write(&path, passes()).unwrap();
    let technique =
        Library::shipped().technique_file(&path).unwrap_or_else(|mistakes| panic!("{mistakes}")).0;
    let options = PictureOptions { size: SIZE, samples: 1, ..PictureOptions::default() };
    let scene = scene_of(mesh);
    let mut renderer =
        PictureRenderer::new(gpu(), PictureInput::new(&scene, &technique), &options).unwrap();
    renderer.render(camera).unwrap();
    let viewport_px = Vec2::new(237.0, 181.0);
    let view = camera.view(&scene.bounds, f64::from(viewport_px.x) / f64::from(viewport_px.y));
    let around = Lighting::default().surroundings(&view, &scene.bounds, &scene.frame);
    let inputs =
        Inputs::read(&renderer, FrameUniform::new(&view, &Tile::whole(viewport_px), &around));
    for (at, case) in CASES.iter().enumerate() {
        let what = format!("{} {}", case.component, case.values.replace('\n', ", "));
        let texture = renderer.generated(&format!("of_{at}_color")).unwrap();
        let found: Vec<[f32; 4]> = read_texels(gpu(), texture).unwrap();
        let found = Image::new(SIZE[0] as usize, found).unwrap();
        check(case, &inputs, &found, &what);
    }
    // The second derivative.
    let colors = inputs.colors.measured(|at| inputs.colors.at(at).truncate());
    let second = colors.measured(|at| laplacian_of_gaussian(&colors, 1.4, at));
    for (wanted, found) in second.texels().iter().zip(inputs.second_derivative.texels()) {
        assert!((wanted - found).abs() < 1e-5, "Laplacian of the Gaussian: {found}, not {wanted}");
    }
}

fn check(case: &Case, inputs: &Inputs, found: &Image<[f32; 4]>, what: &str) {
    let (mut lines, mut undecided) = (0, 0);
    let [width, height] = SIZE.map(|side| isize::try_from(side).unwrap());
    for (row, column) in (0..height).flat_map(|row| (0..width).map(move |column| (row, column))) {
        let at = [column, row];
        let [red, ..] = found.at(at);
        lines += usize::from(red > 0.5);
        match (case.wanted)(inputs, at) {
            Strength(wanted, error) => {
                let wanted = wanted.clamp(0.0, 1.0);
                assert!((wanted - red).abs() <= error, "{what}: {at:?} is {red}, not {wanted}");
            }
            Margin(margin) if margin.abs() < 1e-5 => undecided += 1,
            Margin(margin) => {
                assert!((margin > 0.0) == (red > 0.5), "{what}: {at:?} is {red}, not {margin}");
            }
        }
    }
    // Of 42,897 texels.
    assert!((200..20_000).contains(&lines), "{what}: {lines} texels of lines");
    assert!(undecided < 40, "{what}: {undecided} texels could be either");
}

#[test]
fn gpu_and_cpu_detect_the_same_texels() {
    let mut meshes: Vec<EdgeMesh> = ["torus_knot", "bracket"].map(own_model).into();
    match shared() {
        Some(folder) => {
            for name in ["stanford-bunny", "fandisk"] {
                let path = folder.join(format!("models/{name}.obj"));
                let (model, mut report) = read_model(&path).unwrap();
                meshes.push(build_edge_mesh(&model, &BuildOptions::default(), &mut report));
            }
        }
        None => left_out("detectors", 2),
    }
    for mesh in &meshes {
        let camera = Camera::default_view(&mesh.bounds);
        compare(mesh, &camera);
        compare(mesh, &Camera { is_orthographic: true, ..camera });
    }
}
