//! Pictures that the window saves equal those that a copied command draws.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;

use edgemesh::load::{LoadOptions, NoProgress};
use glam::{DVec2, DVec3};
use image::RgbaImage;
use testkit::locate::{program, workspace_root};
use viewer::picture::png::read_png;
use viewer::picture::renderer::{PictureInput, PictureOptions, PictureRenderer};
use viewer::scene::lighting::Light;
use viewer::scene::models::Scene;
use viewer::scene::scene_file::SceneObject;
use viewer::technique::library::Library;
use viewer::technique::texture_format::TextureFormat;
use viewer::window::inspection::Inspection;
use viewer::window::navigation::{Canvas, TurnMode, panned, turned, zoomed};
use viewer::window::recipe::Recipe;
use viewer::window::remembered::Remembered;
use viewer::window::saving::{Order, save, words_in};
use viewer::window::session::Session;
use viewer::window::viewpoint::UpAxis;

use crate::gpu_device::gpu;

fn session(model: &Path, technique: &str) -> Session {
    let library = Library::shipped();
    let words = [model.display().to_string(), "--technique".into(), technique.into()];
    let recipe = Recipe::of_words(&words, &library).unwrap();
    let mut session = Session::new(library, recipe, Remembered::default());
    let object = SceneObject::plain(model);
    let scene = Scene::load(&[object], &LoadOptions::default(), &NoProgress).unwrap();
    session.take_scene(vec![model.to_owned()], Arc::new(scene), Vec::new()).unwrap();
    session
}

fn saved(session: &Session, size: [u32; 2], path: PathBuf, turntable: Option<u32>) -> String {
    let order = Order {
        recipe: session.recipe.clone(),
        scene: session.scene.clone().unwrap(),
        overrides: session.object_overrides().unwrap(),
        size,
        path,
        turntable,
        gpu: gpu().clone(),
    };
    save(&order, &|_| true).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn a_copied_command_draws_what_the_window_saves_and_its_picture_restores_the_recipe() {
    let folder = tempfile::tempdir().unwrap();
    let size = [200, 150];
    let canvas = Canvas { size: DVec2::new(200.0, 150.0) };
    for (model, technique, settings) in [
        ("bracket.obj", "ink", &["ridge.color=#c03000", "strokes.width=3.3"][..]),
        ("torus_knot.obj", "toon_image", &["toon.toon_map=metallic"]),
        ("column.wrl", "linked", &["strokes.wobble=2"]),
    ] {
        let model = workspace_root().join("models").join(model);
        let mut session = session(&model, technique);
        for setting in settings {
            // The same as setting values in the panels.
            let _ = session.recipe.appearance.technique.set(setting);
        }
        let lighting = &mut session.recipe.appearance.lighting;
        lighting.light = Light::World(DVec3::new(0.3, 0.9, 0.123_456_789));
        lighting.clip_planes = vec![[0.0, -1.0, 0.1, 0.7]];
        let mut view = session.recipe.viewpoint.unwrap();
        view = turned(&view, TurnMode::Trackball, UpAxis::Y, canvas, DVec2::new(31.7, -12.3));
        view = panned(&view, canvas, DVec2::new(5.1, 3.9));
        view = zoomed(&view, 0.83, canvas.point_on_target_plane(&view, DVec2::new(40.0, 99.0)));
        session.recipe.viewpoint = Some(view);

        let by_window = folder.path().join(format!("{technique}-window.png"));
        saved(&session, size, by_window.clone(), None);
        let words = session.recipe.words().unwrap();
        let by_command = folder.path().join(format!("{technique}-command.png"));
        let output = Command::new(program("viewer"))
            .arg("render")
            .args(&words)
            .args(["--size", "200x150", "-o"])
            .arg(&by_command)
            .output()
            .unwrap();
        assert!(output.status.success(), "{output:?}");
        let [one, other] = [&by_window, &by_command].map(|path| read_png(path).unwrap());
        assert!(one == other, "{technique}: pixel for pixel");
        assert!(ink(&one) > 100, "{technique}: something is drawn");

        assert_eq!(words_in(&by_window), Some(words.clone()));
        assert_eq!(words_in(&by_command), None, "that is only in what the window saves");
        let mut fresh = self::session(&model, "pen");
        assert!(fresh.take_words(&words).unwrap().is_none(), "the model is open");
        assert_eq!(fresh.recipe.appearance, session.recipe.appearance);
        assert_eq!(fresh.recipe.viewpoint, session.recipe.viewpoint);
    }
}

/// A technique with a texture of integers.
const NUMBERS: &str = r#"
[component.numbers]
inherits = "process_texture"
[component.numbers.variable]
texture = { type = "texture" }
[component.numbers.modify]
fragment_program = { default = "numbers:numbers" }
[[pass]]
name = "light"
component = "render_phong"
render_target = "light"
[[pass]]
name = "count"
component = "numbers"
texture = "<generated>:light_color"
render_target = "count"
render_target_format = "r32u"
[[pass]]
name = "picture"
component = "render_phong"
"#;

const NUMBERS_PROGRAM: &str = "#import <common/screen.wgsl>
@group(1) @binding(1) var texture: texture_2d<f32>;
@fragment
fn numbers(at: ScreenVarying) -> @location(0) u32 {
    return u32(textureLoad(texture, vec2i(at.position.xy), 0).r * 7.0);
}
";

#[test]
fn what_passes_draw_for_each_other_is_seen() {
    let folder = tempfile::tempdir().unwrap();
    let own = folder.path().join("numbers.toml");
    std::fs::write(&own, NUMBERS).unwrap();
    std::fs::write(folder.path().join("numbers.wgsl"), NUMBERS_PROGRAM).unwrap();
    let model = workspace_root().join("models/bracket.obj");
    let mut formats = Vec::new();
    for technique in ["outline_combined", own.to_str().unwrap()] {
        let session = session(&model, technique);
        let (scene, recipe) = (session.scene.as_ref().unwrap(), &session.recipe);
        let original = &recipe.appearance.technique;
        let options = PictureOptions { size: [80, 60], ..PictureOptions::default() };
        let camera = recipe.viewpoint.unwrap().camera(&scene.frame);
        let mut renderer =
            PictureRenderer::new(gpu(), PictureInput::new(scene, original), &options).unwrap();
        for texture in renderer.generated_textures() {
            let shown = Inspection::of(texture.clone()).shown(original, &session.library).unwrap();
            renderer.reload(PictureInput::new(scene, &shown), &options).unwrap();
            let seen = renderer.render(&camera).unwrap().0;
            let background = *seen.get_pixel(0, 0);
            let model = seen.pixels().filter(|pixel| **pixel != background).count();
            assert!(model > 500, "{technique}: {texture:?}: {model} pixels");
            formats.push(texture.format);
        }
    }
    for wanted in [TextureFormat::Rgba16Float, TextureFormat::Depth32Float, TextureFormat::R32Uint]
    {
        assert!(formats.contains(&wanted), "{formats:?}");
    }
}

#[test]
fn turntables_are_written_and_can_be_canceled() {
    let folder = tempfile::tempdir().unwrap();
    let session = session(&workspace_root().join("models/cube.obj"), "ink");
    let path = folder.path().join("turn.png");
    saved(&session, [32, 32], path.clone(), Some(3));
    let names = || {
        let entries = std::fs::read_dir(folder.path()).unwrap();
        let mut names: Vec<String> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    };
    assert_eq!(names(), ["turn-0.png", "turn-1.png", "turn-2.png"]);
    let order = Order {
        recipe: session.recipe.clone(),
        scene: session.scene.clone().unwrap(),
        overrides: Vec::new(),
        size: [32, 32],
        path: folder.path().join("moving.apng"),
        turntable: Some(50),
        gpu: gpu().clone(),
    };
    let canceled = save(&order, &|what| !what.contains("picture 4 ")).unwrap_err();
    assert!(matches!(canceled, viewer::Error::Canceled), "{canceled}");
    assert_eq!(names().len(), 3, "no half file");
}

/// The number of pixels that are not white.
pub(crate) fn ink(picture: &RgbaImage) -> usize {
    picture.pixels().filter(|pixel| pixel.0[..3].iter().any(|&channel| channel < 128)).count()
}
