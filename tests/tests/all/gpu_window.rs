//! The window's pictures: what it saves is what a copied command draws; and a real window
//! on a display of its own, moved by real keys.

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::Arc;
use std::time::{Duration, Instant};

use edgemesh::command::Listener;
use edgemesh::command::input::InputOptions;
use glam::{DVec2, DVec3};
use image::RgbaImage;
use testkit::locate::{left_out, program, workspace_root};
use viewer::lighting::Light;
use viewer::picture::read_png;
use viewer::render::Scene;
use viewer::scene_file::SceneObject;
use viewer::technique::library::Library;
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
    let scene = Scene::load(&[object], &InputOptions::default(), Listener::Nobody).unwrap();
    session.take_scene(vec![model.to_owned()], Arc::new(scene), Vec::new()).unwrap();
    session
}

fn saved(session: &Session, size: [u32; 2], path: PathBuf, turntable: Option<u32>) -> String {
    let order = Order {
        recipe: session.recipe.clone(),
        scene: session.scene.clone().unwrap(),
        looks: session.object_looks().unwrap(),
        size,
        path,
        turntable,
        gpu: gpu().clone(),
    };
    save(&order, &|_| true).unwrap_or_else(|failure| panic!("{}", failure.message))
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
            // The panels set values, which is the same.
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

#[test]
fn turntables_are_written_and_can_be_cancelled() {
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
        looks: Vec::new(),
        size: [32, 32],
        path: folder.path().join("moving.apng"),
        turntable: Some(50),
        gpu: gpu().clone(),
    };
    let cancelled = save(&order, &|what| !what.contains("picture 4 ")).unwrap_err();
    assert!(cancelled.message.contains("cancelled"), "{}", cancelled.message);
    assert_eq!(names().len(), 3, "no half file");
}

/// Pixels that are not white.
fn ink(picture: &RgbaImage) -> usize {
    picture.pixels().filter(|pixel| pixel.0[..3].iter().any(|&channel| channel < 128)).count()
}

/// A display without a screen, and a window on it.
struct Display {
    server: Child,
    number: String,
    home: tempfile::TempDir,
    window: Option<Child>,
}

impl Display {
    /// None where there is no such server to start, or no hands and eyes for it.
    fn start() -> Option<Self> {
        let has = |name: &str| {
            let mut command = Command::new(name);
            command.arg("-version").stdout(Stdio::null()).stderr(Stdio::null());
            command.status().is_ok()
        };
        if !["Xvfb", "xdotool", "import"].iter().all(|name| has(name)) {
            left_out("a real window (no Xvfb, xdotool or ImageMagick)", 1);
            return None;
        }
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", "900x600x24"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut line = String::new();
        let stdout = server.stdout.take().unwrap();
        std::io::BufRead::read_line(&mut std::io::BufReader::new(stdout), &mut line).unwrap();
        let number = format!(":{}", line.trim());
        Some(Self { server, number, home: tempfile::tempdir().unwrap(), window: None })
    }

    fn command(&self, name: impl AsRef<std::ffi::OsStr>) -> Command {
        let mut command = Command::new(name);
        command.env("DISPLAY", &self.number).env("HOME", self.home.path());
        command.env_remove("WAYLAND_DISPLAY").env_remove("XDG_CONFIG_HOME");
        command.env_remove("XDG_DATA_HOME").env("XDG_RUNTIME_DIR", self.home.path());
        command
    }

    fn open(&mut self, arguments: &[&str]) {
        let mut command = self.command(program("viewer"));
        self.window = Some(command.args(arguments).spawn().unwrap());
        self.focus();
    }

    /// Gives the window the keys, once it is there.
    fn focus(&self) {
        let found = self.until(|display| {
            let search = display.command("xdotool").args(["search", "--name", "Edgemesh"]).output();
            let id = String::from_utf8(search.unwrap().stdout).unwrap();
            let id = id.lines().last()?.to_owned();
            // Without a window manager nobody gives it the keys.
            display.hand(&["windowfocus", &id]).then_some(())
        });
        assert!(found.is_some(), "a window opens");
    }

    fn hand(&self, arguments: &[&str]) -> bool {
        let moved = self.command("xdotool").args(arguments).stderr(Stdio::null()).status();
        moved.unwrap().success()
    }

    fn look(&self) -> RgbaImage {
        let path = self.home.path().join("look.png");
        let took = self.command("import").args(["-window", "root"]).arg(&path).status();
        assert!(took.unwrap().success(), "a look is taken");
        read_png(&path).unwrap()
    }

    /// The picture of the display once it fulfils `wanted`.
    fn see(&self, wanted: impl Fn(&RgbaImage) -> bool) -> Option<RgbaImage> {
        self.until(|display| Some(display.look()).filter(&wanted))
    }

    fn until<T>(&self, mut wanted: impl FnMut(&Self) -> Option<T>) -> Option<T> {
        let started = Instant::now();
        while started.elapsed() < Duration::from_secs(60) {
            if let Some(found) = wanted(self) {
                return Some(found);
            }
            std::thread::sleep(Duration::from_millis(100));
        }
        None
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        for child in self.window.iter_mut().chain([&mut self.server]) {
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

#[test]
fn a_real_window_shows_the_demo_and_follows_keys_and_pointer() {
    let Some(mut display) = Display::start() else { return };
    display.open(&[]);
    // The middle of the picture: paper with lines on it.
    let picture =
        |screen: &RgbaImage| image::imageops::crop_imm(screen, 60, 60, 400, 440).to_image();
    let is_drawn = |picture: &RgbaImage| {
        let paper = picture.pixels().filter(|pixel| pixel.0[..3] == [255; 3]).count();
        paper > 100_000 && ink(picture) > 200
    };
    let first = display.see(|screen| is_drawn(&picture(screen))).expect("the demo is drawn");
    let first = picture(&first);
    assert!(display.hand(&["mousemove", "300", "300", "key", "7"]));
    let is_new = |screen: &RgbaImage| is_drawn(&picture(screen)) && picture(screen) != first;
    display.see(is_new).expect("the view from the top is another one");
    std::thread::sleep(Duration::from_secs(1));
    let top = picture(&display.look());
    for key in ["ctrl+shift+F9", "ctrl+shift+F10"] {
        assert!(display.hand(&["key", key]), "its graphics device is lost");
        std::thread::sleep(Duration::from_secs(2));
        display.focus();
        let again = display.see(|screen| picture(screen) == top);
        assert!(again.is_some(), "{key}: and another window shows the same");
    }
    for part in ["mousedown 1", "mousemove_relative 40 30", "mousemove_relative 40 30", "mouseup 1"]
    {
        assert!(display.hand(&part.split(' ').collect::<Vec<_>>()));
        // As slow as a hand: several frames.
        std::thread::sleep(Duration::from_millis(300));
    }
    let turned = display.see(|screen| is_drawn(&picture(screen)) && picture(screen) != top);
    assert!(turned.is_some(), "the pointer turns it");
    assert!(display.hand(&["key", "n"]));
    let is_wide = |screen: &RgbaImage| {
        let right = image::imageops::crop_imm(screen, 700, 100, 150, 400).to_image();
        right.pixels().filter(|pixel| pixel.0[..3] == [255; 3]).count() > 50_000
    };
    assert!(display.see(is_wide).is_some(), "without panels the picture is the window");
    assert!(display.hand(&["key", "ctrl+q"]));
    let window = display.window.as_mut().unwrap();
    let started = Instant::now();
    let status = loop {
        if let Some(status) = window.try_wait().unwrap() {
            break status;
        }
        assert!(started.elapsed() < Duration::from_secs(30), "the window closes");
        std::thread::sleep(Duration::from_millis(50));
    };
    assert!(status.success(), "{status}");
}
