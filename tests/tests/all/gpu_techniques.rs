//! Techniques on the GPU: textures between passes, and pictures of the built-in techniques.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use edgemesh::build::{BuildOptions, build_edge_mesh};
use edgemesh::edge_mesh::EdgeMesh;
use edgemesh::model::{Attributes, Material, Model, PolygonRun};
use edgemesh::report::Report;
use edgemesh::view::{Camera, to_pixels};
use glam::{DVec3, Vec2};
use image::RgbaImage;
use strokes::{Layout, read_texels};
use testkit::compare::Golden;
use testkit::locate::workspace_root;
use viewer::picture::renderer::{PictureInput, PictureOptions, PictureRenderer};
use viewer::scene::lighting::Lighting;
use viewer::scene::models::Scene;
use viewer::technique::Technique;
use viewer::technique::library::Library;

use crate::gpu_device::{gpu, is_pinned_driver};
use crate::gpu_render::{own_model, picture, picture_with, scene_of, technique};

/// A technique from the texts of its files; the first is the technique file.
fn written(folder: &Path, files: &[(&str, &str)]) -> Technique {
    for (name, text) in files {
        std::fs::write(folder.join(name), text).unwrap();
    }
    let path = folder.join(files[0].0);
    Library::shipped().technique_file(&path).unwrap_or_else(|mistakes| panic!("{mistakes}")).0
}

fn small(size: [u32; 2]) -> PictureOptions {
    PictureOptions { size, samples: 1, ..PictureOptions::default() }
}

/// Draws `frames` pictures and reads a generated texture of four floats.
fn read_generated(technique: &Technique, frames: usize, name: &str) -> (u32, Vec<[f32; 4]>) {
    let mesh = own_model("cube");
    let scene = scene_of(&mesh);
    let mut renderer =
        PictureRenderer::new(gpu(), PictureInput::new(&scene, technique), &small([32, 16]))
            .unwrap();
    for _ in 0..frames {
        renderer.render(&Camera::default_view(&mesh.bounds)).unwrap();
    }
    let texture = renderer.generated(name).unwrap();
    (texture.width(), read_texels(gpu(), texture).unwrap())
}

/// An endless loop is ended, the rest of the picture is drawn, and the device is not lost.
#[test]
fn a_shader_that_never_ends_ends() {
    let folder = tempfile::tempdir().unwrap();
    let shader = "@fragment\n\
        fn forever(@builtin(position) at: vec4f) -> @location(0) vec4f {\n\
            var x = at.x;\n\
            loop { x = x * 1.000001; if x < 0.0 { break; } }\n\
            return vec4f(0.25, 0.5, select(0.75, 1.0, x < 0.0), 1.0);\n\
        }\n";
    let text = "[[pass]]\nname = \"forever\"\ncomponent = \"process_texture\"\n\
                fragment_program = \"forever:forever\"\n";
    let technique = written(folder.path(), &[("forever.toml", text), ("forever.wgsl", shader)]);
    let mesh = own_model("cube");
    let scene = scene_of(&mesh);
    let mut renderer =
        PictureRenderer::new(gpu(), PictureInput::new(&scene, &technique), &small([8, 8])).unwrap();
    let (picture, _) = renderer.render(&Camera::default_view(&mesh.bounds)).unwrap();
    assert!(
        picture.pixels().all(|pixel| pixel.0 == [64, 128, 191, 255]),
        "{:?}",
        picture.get_pixel(0, 0)
    );
}

/// The files of the guide's effect, as a reader would copy them.
#[test]
fn the_effect_in_the_guide_runs_without_a_build() {
    let guide = std::fs::read_to_string(workspace_root().join("docs/techniques.md")).unwrap();
    let block = |kind: &str| {
        let start = guide.find(&format!("```{kind}\n")).unwrap() + kind.len() + 4;
        let end = start + guide[start..].find("```").unwrap();
        guide[start..end].to_owned()
    };
    let folder = tempfile::tempdir().unwrap();
    let files = [("halftone.toml", block("toml")), ("halftone.wgsl", block("wgsl"))];
    let files = files.each_ref().map(|(name, text)| (*name, text.as_str()));
    let mut technique = written(folder.path(), &files);
    technique.set("dots.ink_color=#ff0000").unwrap();
    technique.set("strokes.render=false").unwrap();
    let mesh = own_model("torus_knot");
    let picture = picture(&mesh, &Camera::default_view(&mesh.bounds), &technique, 256, 4);
    let reds = picture.pixels().filter(|pixel| pixel.0 == [255, 0, 0, 255]).count();
    let whites = picture.pixels().filter(|pixel| pixel.0 == [255, 255, 255, 255]).count();
    assert!(reds > 1500 && whites > 30_000, "{reds} red, {whites} white");
}

const COUNT: &str = r#"
[component.count]
inherits = "process_texture"
[component.count.variable]
before = { type = "texture" }
step = { type = "vector2", default = [0.25, 1], fragment_parameter = true }
[component.count.modify]
fragment_program = { default = "count:count" }
render_target_format = { default = "rgba32f" }

[[pass]]
component = "count"
render_target = "sum"
before = "<generated>:sum_color"
"#;

const COUNT_SHADER: &str = "
struct Params { step: vec2f }
@group(1) @binding(0) var<uniform> params: Params;
@group(1) @binding(1) var before: texture_2d<f32>;
@fragment
fn count(@builtin(position) at: vec4f) -> @location(0) vec4f {
    return textureLoad(before, vec2i(at.xy), 0) + vec4f(params.step, 0.0, 0.0);
}
";

#[test]
fn a_pass_in_place_sees_the_frame_before_and_nothing_at_first() {
    let folder = tempfile::tempdir().unwrap();
    let technique = written(folder.path(), &[("count.toml", COUNT), ("count.wgsl", COUNT_SHADER)]);
    for frames in [1_u8, 2, 5] {
        let (_, texels) = read_generated(&technique, frames.into(), "sum_color");
        let wanted = [0.25 * f32::from(frames), f32::from(frames), 0.0, 0.0];
        assert!(texels.iter().all(|texel| *texel == wanted), "{frames}: {:?}", texels[0]);
    }
}

#[test]
fn passes_run_once_or_when_something_has_changed() {
    for (run, after_a_change) in [("always", 5.0), ("once", 1.0), ("changed", 2.0)] {
        let folder = tempfile::tempdir().unwrap();
        let text = format!("{COUNT}run = \"{run}\"\n");
        let mut technique =
            written(folder.path(), &[("count.toml", &text), ("count.wgsl", COUNT_SHADER)]);
        let mesh = own_model("cube");
        let (scene, camera) = (scene_of(&mesh), Camera::default_view(&mesh.bounds));
        let mut renderer =
            PictureRenderer::new(gpu(), PictureInput::new(&scene, &technique), &small([8, 8]))
                .unwrap();
        let frames = |renderer: &mut PictureRenderer, count: usize| {
            (0..count).for_each(|_| drop(renderer.render(&camera).unwrap()));
        };
        frames(&mut renderer, 3);
        renderer.reload(PictureInput::new(&scene, &technique), &small([8, 8])).unwrap();
        technique.set("count.step=2,1").unwrap();
        renderer.reload(PictureInput::new(&scene, &technique), &small([8, 8])).unwrap();
        frames(&mut renderer, 2);
        let texels: Vec<[f32; 4]> =
            read_texels(gpu(), renderer.generated("sum_color").unwrap()).unwrap();
        assert_eq!(texels[0][1].to_bits(), f32::to_bits(after_a_change), "{run}");
    }
}

/// Two valid programs that do not fit together, which only the device finds.
#[test]
fn a_technique_that_cannot_be_built_leaves_the_last_picture() {
    let folder = tempfile::tempdir().unwrap();
    let text = "[[pass]]\ncomponent = \"simple_render\"\nfragment_program = \"own:own\"\n";
    let shader =
        "@fragment fn own(@location(9) more: vec4f) -> @location(0) vec4f { return more; }";
    let broken = written(folder.path(), &[("own.toml", text), ("own.wgsl", shader)]);
    let mesh = own_model("cube");
    let (scene, camera) = (scene_of(&mesh), Camera::default_view(&mesh.bounds));
    // With and without strokes and a stencil.
    for settings in [&[][..], &["silhouette.render=true"], &["strokes.render=false"]] {
        let (ink, pen) = (technique("ink", settings), technique("pen", &[]));
        let options = small([40, 30]);
        let mut renderer =
            PictureRenderer::new(gpu(), PictureInput::new(&scene, &ink), &options).unwrap();
        let picture = renderer.render(&camera).unwrap().0;
        let failure = renderer.reload(PictureInput::new(&scene, &broken), &options).unwrap_err();
        assert!(failure.to_string().contains("do not fit together"), "{}", failure);
        assert!(renderer.render(&camera).unwrap().0 == picture, "{settings:?}");
        renderer.reload(PictureInput::new(&scene, &ink), &options).unwrap();
        assert!(renderer.render(&camera).unwrap().0 == picture, "{settings:?}, built again");
        renderer.reload(PictureInput::new(&scene, &pen), &options).unwrap();
        assert!(renderer.render(&camera).unwrap().0 != picture, "another technique");
    }
}

#[test]
fn targets_have_the_sizes_that_are_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    for (width, height, scale, wanted) in
        [(0, 0, 1.0, [32, 16]), (-2, -4, 1.0, [16, 4]), (7, 0, 1.0, [7, 16]), (0, 0, 2.0, [64, 32])]
    {
        let text = format!(
            "[[pass]]\ncomponent = \"render_normals\"\nrender_target = \"n\"\n\
             render_target_format = \"rgba32f\"\nrender_target_width = {width}\n\
             render_target_height = {height}\nrender_target_scale = {scale:.1}\n"
        );
        let technique = written(folder.path(), &[("n.toml", &text)]);
        let (row, texels) = read_generated(&technique, 1, "n_color");
        assert_eq!([row, u32::try_from(texels.len()).unwrap() / row], wanted);
        let unlike = texels.iter().filter(|texel| **texel != texels[0]).count();
        assert!(unlike > 2, "no cube in {width} x {height}");
    }
}

/// A copy equals the picture so far, and the depth of the model is nearer than empty depth.
#[test]
fn the_picture_so_far_and_its_depth_are_copied() {
    let folder = tempfile::tempdir().unwrap();
    let text = "[[pass]]\ncomponent = \"render_gooch\"\n\
        [[pass]]\ncomponent = \"copy_to_texture\"\ntexture = \"kept\"\n\
        [[pass]]\nname = \"deep\"\ncomponent = \"copy_to_texture\"\ntexture = \"far\"\ndepth = true\n\
        [[pass]]\nname = \"black\"\ncomponent = \"render_flat\"\ncolor = \"#000000\"\nclear_color = \"#000000\"\n\
        [[pass]]\ncomponent = \"composite\"\ntexture = \"<generated>:kept\"\nblend = \"replace\"\n";
    let copied = written(folder.path(), &[("copied.toml", text)]);
    let plain =
        written(folder.path(), &[("plain.toml", "[[pass]]\ncomponent = \"render_gooch\"\n")]);
    let mesh = own_model("torus_knot");
    let camera = Camera::default_view(&mesh.bounds);
    for samples in [1, 4] {
        let draw = |technique| picture(&mesh, &camera, technique, 128, samples);
        assert!(draw(&copied) == draw(&plain), "{samples} samples");
        let scene = scene_of(&mesh);
        let options = PictureOptions { size: [64; 2], samples, ..PictureOptions::default() };
        let mut renderer =
            PictureRenderer::new(gpu(), PictureInput::new(&scene, &copied), &options).unwrap();
        renderer.render(&camera).unwrap();
        let depths: Vec<f32> = read_texels(gpu(), renderer.generated("far").unwrap()).unwrap();
        let covered = depths.iter().filter(|depth| **depth > 0.0).count();
        assert!((300..2000).contains(&covered), "{covered} of {} pixels", depths.len());
    }
}

/// A half transparent color over another in each blend mode, against its definition.
#[test]
fn blends_are_the_usual_ones() {
    let folder = tempfile::tempdir().unwrap();
    let (below, above) = ([0.8, 0.4, 0.2], [0.5, 0.25, 1.0]);
    let laid = |blend: &str, b: f64, s: f64| match blend {
        "replace" => s,
        "over" => s + b * 0.5,
        "multiply" => s * b + b * 0.5,
        "add" => (s + b).min(1.0),
        "screen" => s + b - s * b,
        "darken" => s.min(b),
        _ => s.max(b),
    };
    for blend in ["replace", "over", "multiply", "add", "screen", "darken", "lighten"] {
        let text = format!(
            "[[pass]]\nname = \"above\"\ncomponent = \"render_flat\"\nclear_color = {above:?}\n\
             color = {above:?}\nrender_target = \"above\"\nrender_target_format = \"rgba16f\"\n\
             [[pass]]\nname = \"below\"\ncomponent = \"render_flat\"\nclear_color = {below:?}\ncolor = {below:?}\n\
             [[pass]]\ncomponent = \"composite\"\ntexture = \"<generated>:above_color\"\nopacity = 0.5\nblend = \"{blend}\"\n"
        );
        let technique = written(folder.path(), &[("blend.toml", &text)]);
        let mesh = own_model("cube");
        let drawn = picture(&mesh, &Camera::default_view(&mesh.bounds), &technique, 16, 1);
        for pixel in [drawn.get_pixel(0, 0), drawn.get_pixel(8, 8)] {
            for channel in 0..3 {
                // Half transparent, premultiplied.
                let wanted = laid(blend, below[channel], 0.5 * above[channel]) * 255.0;
                let found = f64::from(pixel.0[channel]);
                assert!((found - wanted).abs() <= 1.0, "{blend}: {found}, not {wanted:.1}");
            }
        }
    }
}

/// Fills, strokes and detectors draw nothing behind a clip plane, and detectors outline the
/// cut.
#[test]
fn clip_planes_cut_everything_and_detectors_outline_the_cut() {
    let mesh = own_model("torus_knot");
    let mut camera = Camera::default_view(&mesh.bounds);
    camera.eye = camera.target + glam::DVec3::Z * mesh.bounds.radius() * 3.0;
    camera.is_orthographic = true;
    let lighting = Lighting { clip_planes: vec![[0.0, -1.0, 0.0, 0.0]], ..Lighting::default() };
    let cut = PictureOptions { size: [200; 2], lighting, ..PictureOptions::default() };
    let dark = |picture: &RgbaImage, rows: std::ops::Range<u32>| {
        let dark = |x: &u32, y: u32| picture.get_pixel(*x, y).0[1] < 128;
        rows.map(|y| (0..200).filter(|x| dark(x, y)).count()).sum::<usize>()
    };
    for name in ["ink", "linked", "hidden_line", "cartoon", "toon_image", "outline_planes"] {
        let drawn = picture_with(&mesh, &camera, &technique(name, &[]), &cut);
        let above = dark(&drawn, 0..97);
        let below = dark(&drawn, 103..200);
        assert!(above == 0 && below > 200, "{name}: {above} above the cut, {below} below");
    }
    let rim =
        |name: &str| dark(&picture_with(&mesh, &camera, &technique(name, &[]), &cut), 98..102);
    let (detected, drawn) = (rim("outline_planes"), rim("ink"));
    assert!(detected > 3 * drawn.max(30), "{detected} pixels of the cut; strokes have {drawn}");
}

/// An object's own technique changes only its own fill and strokes.
#[test]
fn objects_have_the_fill_and_the_strokes_of_their_own_technique() {
    let mesh = own_model("cube");
    let scene = {
        let mut scene = scene_of(&mesh);
        let mut second = scene.objects[0];
        second.world_from_object = glam::DMat4::from_translation(glam::DVec3::X * 4.0);
        (second.override_index, scene.objects[0].override_index) = (0, 9);
        scene.objects.push(second);
        Scene::placed(scene.models, scene.objects)
    };
    let overrides = &[technique("ink", &["fill.color=#00ff00", "strokes.color=#ff0000"])];
    let options = small([256, 128]);
    let main = technique("ink", &[]);
    let input = PictureInput { scene: &scene, technique: &main, overrides };
    let mut renderer = PictureRenderer::new(gpu(), input, &options).unwrap();
    let drawn = renderer.render(&Camera::default_view(&scene.bounds)).unwrap().0;
    let count = |color: [u8; 4]| drawn.pixels().filter(|pixel| pixel.0 == color).count();
    let (green, red, black) =
        (count([0, 255, 0, 255]), count([255, 0, 0, 255]), count([0, 0, 0, 255]));
    assert!(green > 500 && red > 100 && black > 100, "{green} green, {red} red, {black} black");
}

/// The passes that shade by the material, one technique each.
const SHADING_PASSES: [&str; 10] = [
    "component = \"render_phong\"",
    "component = \"render_unlit\"",
    "component = \"render_cartoon\"",
    "component = \"render_toon\"",
    "component = \"render_toon_per_vertex\"",
    "component = \"render_gooch\"",
    "component = \"render_hatching\"\nfrom_material = true",
    "component = \"render_hatching_per_vertex\"\nfrom_material = true",
    "component = \"render_scene_data\"\n[[pass]]\ncomponent = \"composite\"\n\
     blend = \"replace\"\ntexture = \"<generated>:scene_color\"",
    "component = \"own\"",
];

/// A fill of a user, of a component that knows nothing of colors.
const OWN_FILL: &str = "[component.own]\ninherits = \"simple_render\"\n\
    [component.own.modify]\nfragment_program = { default = \"own:own\" }\n";
const OWN_SHADER: &str = "
#import <common/light.wgsl>
@fragment
fn own(at: SurfaceVarying, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let lit = 0.5 + 0.5 * diffuse_factor(surface_at(at, is_front));
    return vec4f(lit * material_at(at.material_range, vec4f(1.0), at.color).diffuse.rgb, 1.0);
}
";

/// The corners of a box and its sides, as in `vertex_colours.ply`; the corners have all colors of
/// full and empty channels.
fn painted_box() -> Model {
    let corner = |k: u8| [k & 1, k >> 1 & 1, k >> 2].map(f32::from);
    let positions: Vec<[f32; 3]> = (0..8).map(corner).map(|[x, y, z]| [2.0 * x, y, z]).collect();
    let sides: [&[u32]; 6] =
        [&[0, 2, 3, 1], &[4, 5, 7, 6], &[0, 1, 5, 4], &[2, 6, 7, 3], &[0, 4, 6, 2], &[1, 3, 7, 5]];
    let mut model = Model::from_polygons(&positions, &sides);
    model.colors = (0..8).map(corner).map(|[x, y, z]| [x, y, z, 1.0]).collect();
    model
}

/// A box with one material for all of it.
fn plain_box(diffuse: Option<[f32; 3]>) -> Model {
    let mut model = Model { colors: Vec::new(), ..painted_box() };
    if diffuse.is_some() {
        model.materials = vec![Material { diffuse, ..Material::default() }];
        let attributes = Attributes { material: 0, ..Attributes::default() };
        model.runs = vec![PolygonRun { first_polygon: 0, attributes }];
    }
    model
}

fn built(model: &Model) -> EdgeMesh {
    build_edge_mesh(model, &BuildOptions::default(), &mut Report::default())
}

/// Pixels of each visible side near each of its corners, with the corner.
fn pixels_at_corners(mesh: &EdgeMesh, camera: &Camera, size_px: u16) -> Vec<(usize, [u32; 2])> {
    let model = painted_box();
    let view = camera.view(&mesh.bounds, 1.0);
    let mut pixels = Vec::new();
    for side in 0..6 {
        let corners = &model.corner_positions[model.corner_range(side)];
        let at = |corner: u32| DVec3::from(model.positions[corner as usize]);
        let middle = corners.iter().map(|&corner| at(corner)).sum::<DVec3>() / 4.0;
        if (middle - mesh.bounds.center()).dot(camera.eye - middle) <= 0.0 {
            continue;
        }
        for &corner in corners {
            let point = at(corner).lerp(middle, 0.05).as_vec3();
            let clip = view.clip_from_world * point.extend(1.0);
            let from_middle = to_pixels(clip, Vec2::splat(size_px.into()));
            let px = 0.5 * f32::from(size_px) + from_middle * Vec2::new(1.0, -1.0);
            pixels.push((corner as usize, px.as_uvec2().to_array()));
        }
    }
    pixels
}

/// Near each corner of a painted box, every fill that shades has the color that a box of a
/// material of that color has there; without vertex colors, that of a box without any.
#[test]
fn corners_have_their_colors_in_every_fill_that_shades() {
    const SIZE_PX: u16 = 240;
    let painted = built(&painted_box());
    let references: Vec<EdgeMesh> = painted_box()
        .colors
        .iter()
        .map(|&[red, green, blue, _]| built(&plain_box(Some([red, green, blue]))))
        .collect();
    let front = Camera::default_view(&painted.bounds);
    let back = Camera { eye: 2.0 * painted.bounds.center() - front.eye, ..front };
    for pass in SHADING_PASSES {
        let folder = tempfile::tempdir().unwrap();
        let of_text = |more: &str| {
            let own = if pass.contains("own") { OWN_FILL } else { "" };
            let text = format!("{own}[[pass]]\nname = \"fill\"\n{pass}\n{more}");
            written(folder.path(), &[("fill.toml", &text), ("own.wgsl", OWN_SHADER)])
        };
        let on = of_text("");
        let mut off = on.clone();
        off.set("fill.vertex_colors=false").unwrap();
        let mut seen = BTreeSet::new();
        for camera in [front, back] {
            let draw =
                |mesh: &EdgeMesh, technique| picture(mesh, &camera, technique, SIZE_PX.into(), 1);
            let drawn = draw(&painted, &on);
            let expected: Vec<RgbaImage> = references.iter().map(|mesh| draw(mesh, &on)).collect();
            for (corner, [x, y]) in pixels_at_corners(&painted, &camera, SIZE_PX) {
                let [found, wanted] = [&drawn, &expected[corner]].map(|at| at.get_pixel(x, y).0);
                let is_close = found.iter().zip(wanted).all(|(a, b)| a.abs_diff(b) <= 20);
                assert!(is_close, "{pass}: corner {corner} is {found:?}, not {wanted:?}");
                seen.insert(corner);
            }
            let plain = draw(&built(&plain_box(None)), &on);
            assert_eq!(draw(&painted, &off), plain, "{pass}");
            assert_ne!(drawn, plain, "{pass}");
        }
        assert_eq!(seen.len(), 8, "{pass}");
    }
}

/// Vertex colors in every layout and in chunks, of a moved object and of one that an override
/// turns them off for.
#[test]
fn objects_have_colors_of_their_own_in_every_layout() {
    let mesh = built(&painted_box());
    let mut scene = scene_of(&mesh);
    let mut second = scene.objects[0];
    second.world_from_object = glam::DMat4::from_translation(DVec3::X * 3.0);
    (second.override_index, scene.objects[0].override_index) = (0, 9);
    scene.objects.push(second);
    let scene = Scene::placed(scene.models, scene.objects);
    let on = technique("phong", &[]);
    let overrides = &[technique("phong", &["fill.vertex_colors=false"])];
    let camera = Camera::default_view(&scene.bounds);
    let draw = |overrides: &[Technique], layout| {
        let input = PictureInput { scene: &scene, technique: &on, overrides };
        let options = PictureOptions { layout, ..small([256, 128]) };
        PictureRenderer::new(gpu(), input, &options).unwrap().render(&camera).unwrap().0
    };
    let is_colored = |pixel: &image::Rgba<u8>| {
        let [red, green, blue, _] = pixel.0.map(i16::from);
        (red - green).abs().max((green - blue).abs()) > 30
    };
    // The second object covers the right of the picture.
    let colored = |picture: &RgbaImage| {
        let pixels = || picture.enumerate_pixels().filter(|(_, _, pixel)| is_colored(pixel));
        [pixels().filter(|(x, ..)| *x < 110).count(), pixels().filter(|(x, ..)| *x > 145).count()]
    };
    let [left, right] = colored(&draw(&[], Layout::Indexed));
    assert!(left > 300 && right > 300, "{left} {right}");
    for layout in [Layout::Indexed, Layout::Replicated, Layout::FaceNormals] {
        assert_eq!(colored(&draw(overrides, layout)), [left, 0], "{layout:?}");
    }
}

/// A transparent background drops the color that a fill clears to and the image of paper.
#[test]
fn transparency_leaves_every_kind_of_paper_out() {
    let mesh = own_model("torus_knot");
    let camera = Camera::default_view(&mesh.bounds);
    let options = PictureOptions { is_transparent: true, ..small([64; 2]) };
    for name in ["gooch", "cartoon", "blueprint"] {
        let drawn = picture_with(&mesh, &camera, &technique(name, &[]), &options);
        assert_eq!(drawn.get_pixel(0, 0).0, [0; 4], "{name}");
        let covered = drawn.pixels().filter(|pixel| pixel.0[3] == 255).count();
        assert!(covered > 100, "{name}: {covered} opaque pixels");
    }
}

/// The normal of a vertex at a contour can face away though its face is visible, and an open
/// surface shows its inside: light per vertex equals light per pixel, as far as triangles
/// are fine enough.
#[test]
fn light_by_the_vertex_is_on_the_side_that_is_seen() {
    let folder = tempfile::tempdir().unwrap();
    let draw = |model: &str, camera: &dyn Fn(&EdgeMesh) -> Camera, pass: &str| {
        let technique = written(folder.path(), &[("light.toml", &format!("[[pass]]\n{pass}"))]);
        let mesh = own_model(model);
        picture(&mesh, &camera(&mesh), &technique, 256, 1)
    };
    let default = |mesh: &EdgeMesh| Camera::default_view(&mesh.bounds);
    let behind = |mesh: &EdgeMesh| {
        let camera = Camera::default_view(&mesh.bounds);
        Camera { eye: 2.0 * camera.target - camera.eye, ..camera }
    };
    let toon = "toon_map = \"toon_maps:gradient:1\"\ncomponent = \"render_toon";
    let hatching = "from_material = false\nscale = 0.1\ncomponent = \"render_hatching";
    for (passes, most, few) in [
        ([format!("{toon}\""), format!("{toon}_per_vertex\"")], 40, 0),
        ([format!("{hatching}\""), format!("{hatching}_per_vertex\"")], 90, 30),
    ] {
        for model in ["torus_knot", "plane_with_hole"] {
            for camera in [&default as &dyn Fn(&EdgeMesh) -> Camera, &behind] {
                let [pixel, vertex] = passes.each_ref().map(|pass| draw(model, camera, pass));
                let differences = pixel.iter().zip(vertex.iter()).map(|(a, b)| a.abs_diff(*b));
                let far = differences.filter(|difference| *difference > most).count();
                assert!(far <= few, "{}, {model}: {far} values by more than {most}", passes[1]);
            }
        }
    }
}

/// Borders of steps are smoothed over a pixel, and no triangle of a flat cap shows.
#[test]
fn steps_of_light_do_not_show_triangles() {
    let folder = tempfile::tempdir().unwrap();
    let pass = "[[pass]]\ncomponent = \"render_toon\"\ntoon_map = \"toon_maps:three_steps:0\"";
    let technique = written(folder.path(), &[("steps.toml", pass)]);
    let mesh = own_model("cylinder");
    let camera = Camera { eye: DVec3::new(0.0, 5.0, 0.0), ..Camera::default_view(&mesh.bounds) };
    let camera = Camera { target: DVec3::ZERO, ..camera };
    let picture = picture(&mesh, &camera, &technique, 256, 1);
    let mut colors: BTreeMap<[u8; 4], usize> = BTreeMap::new();
    for pixel in picture.pixels() {
        *colors.entry(pixel.0).or_default() += 1;
    }
    let mut counts: Vec<usize> = colors.into_values().collect();
    counts.sort_unstable();
    // The paper and two steps; the border between them is no longer than the cap is wide.
    let between: usize = counts[..counts.len() - 3].iter().sum();
    assert!(counts[counts.len() - 3] > 1000, "two steps: {counts:?}");
    assert!(between < 150, "{between} pixels are between steps");
}

#[test]
fn a_technique_whose_passes_are_all_switched_off_draws_nothing() {
    let mesh = own_model("cube");
    let off = technique("ink", &["fill.render=false", "strokes.render=false"]);
    let drawn = picture(&mesh, &Camera::default_view(&mesh.bounds), &off, 32, 4);
    assert!(drawn.pixels().all(|pixel| pixel.0 == [0; 4]), "something is drawn");
}

fn golden(name: &str, mesh: &EdgeMesh, technique: &Technique) {
    let drawn = picture(mesh, &Camera::default_view(&mesh.bounds), technique, 256, 4);
    Golden::shaded(is_pinned_driver()).check(name, &drawn);
}

#[test]
fn golden_techniques() {
    let (knot, bracket) = (own_model("torus_knot"), own_model("bracket"));
    for name in ["anime", "blueprint", "cartoon", "gooch", "hatching", "toon_image"] {
        golden(&format!("torus_knot-{name}"), &knot, &technique(name, &[]));
    }
    for name in ["outline_combined", "outline_thick", "outline_planes", "sobel", "debug_features"] {
        golden(&format!("bracket-{name}"), &bracket, &technique(name, &[]));
    }
}
