//! `viewer techniques`, `viewer components` and `--watch`, run as users run them.

use std::process::{Command, Output};

use edgemesh_techniques::TECHNIQUES;
use testkit::locate::{program, workspace_root};

/// Runs the viewer with an empty folder of the user's techniques.
fn viewer(arguments: &[&str]) -> Output {
    let own = tempfile::tempdir().unwrap();
    let mut command = Command::new(program("viewer"));
    command.args(arguments).env("XDG_CONFIG_HOME", own.path()).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn printed(arguments: &[&str]) -> String {
    let output = viewer(arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", text(&output.stderr));
    text(&output.stdout)
}

#[test]
fn every_technique_file_ships_says_what_it_shows_and_can_be_printed() {
    let list = printed(&["techniques", "list"]);
    let listed: Vec<&str> = list.lines().map(|line| line.split(' ').next().unwrap()).collect();
    assert_eq!(listed, TECHNIQUES.iter().map(|(name, _)| *name).collect::<Vec<_>>());
    for line in list.lines() {
        assert!(line.split_once("  ").is_some_and(|(_, about)| about.trim().len() > 10), "{line}");
    }
    for name in listed {
        let file = workspace_root().join(format!("techniques/{name}.toml"));
        let source = std::fs::read_to_string(file).unwrap();
        assert!(source.starts_with("# "), "{name} begins with a comment that says what it shows");
        let passes = printed(&["techniques", "print", name]);
        assert!(passes.contains("\n1 "), "{name}: {passes}");
    }
}

#[test]
fn a_technique_is_printed_with_its_passes_textures_and_variables() {
    let toon = printed(&["techniques", "print", "toon-image"]);
    for part in [
        "1 data (render_scene_data), by simple_render",
        "draws to <generated>:scene_color, <generated>:scene_normal, <generated>:scene_region, \
         <generated>:scene_depth",
        "reads <generated>:scene_depth as depth_texture, nearest",
        "normal_threshold = 0.8",
        "<generated>:scene_normal  picture, rgba16f",
        "reads toon_maps:three_steps as toon_map, nearest",
    ] {
        assert!(toon.contains(part), "{part:?} is not in\n{toon}");
    }
}

#[test]
fn components_are_described_with_every_variable() {
    let list = printed(&["components", "list"]);
    assert!(list.lines().count() > 30, "{list}");
    let component = printed(&["components", "print", "edge_detect_normals_5_taps"]);
    for part in [
        "inherits from edge_detect_normals",
        "threshold (number)",
        "default 0.85",
        "minimum -1",
        "ui maximum 1",
        "fragment parameter",
        "must be set",
        "render (bool)",
    ] {
        assert!(component.contains(part), "{part:?} is not in\n{component}");
    }
    let wrong = viewer(&["components", "print", "edge_detect_normal"]);
    assert_eq!(wrong.status.code(), Some(4));
    assert!(text(&wrong.stderr).contains("edge_detect_normals"), "{}", text(&wrong.stderr));
}

#[test]
fn all_mistakes_of_all_files_are_told_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    std::fs::write(path("good.toml"), "[[pass]]\ncomponent = \"render_phong\"\n").unwrap();
    let one =
        "[[pass]]\ncomponent = \"render_fong\"\n[[pass]]\ncomponent = \"strokes\"\nwidht = 3\n";
    std::fs::write(path("one.toml"), one).unwrap();
    std::fs::write(path("two.toml"), "[[pass]]\nname = 3\n").unwrap();
    let good = viewer(&["techniques", "check", &path("good.toml")]);
    assert_eq!(good.status.code(), Some(0), "{}", text(&good.stderr));
    let checked =
        viewer(&["techniques", "check", &path("good.toml"), &path("one.toml"), &path("two.toml")]);
    let message = text(&checked.stderr);
    assert_eq!(checked.status.code(), Some(4), "{message}");
    for part in [
        "one.toml:2:13",
        "did you mean 'render_phong'?",
        "one.toml:5:1",
        "did you mean 'width'?",
        "two.toml:1:1",
        "in 2 of 3 files",
    ] {
        assert!(message.contains(part), "{part:?} is not in\n{message}");
    }
}

#[test]
fn a_folder_of_ones_own_is_found_beside_what_ships() {
    let folder = tempfile::tempdir().unwrap();
    let own = folder.path().display().to_string();
    for below in ["components", "techniques"] {
        std::fs::create_dir(folder.path().join(below)).unwrap();
    }
    let component = "[component.render_red]\ninherits = \"render_flat\"\nabout = \"red\"\n\
                     [component.render_red.modify]\ncolor = { default = \"#ff0000\" }\n";
    std::fs::write(folder.path().join("components/mine.toml"), component).unwrap();
    let technique = "about = \"all in red\"\n[[pass]]\ncomponent = \"render_red\"\n";
    std::fs::write(folder.path().join("techniques/red.toml"), technique).unwrap();
    let list = printed(&["techniques", "list", "--folder", &own]);
    assert!(list.contains("red ") && list.contains("all in red"), "{list}");
    assert!(list.contains("\nink "), "those that ship are there, too: {list}");
    let passes = printed(&["techniques", "print", "red", "--folder", &own]);
    assert!(passes.contains("1 render_red (render_red), by simple_render"), "{passes}");
}

#[cfg(feature = "gpu")]
mod with_adapter {
    use std::io::Read as _;
    use std::path::Path;
    use std::process::Stdio;
    use std::time::{Duration, Instant};

    use super::*;

    /// The color in the middle of a picture, once it can be read.
    fn middle(path: &Path) -> Option<[u8; 3]> {
        let picture = image::load_from_memory(&std::fs::read(path).ok()?).ok()?.to_rgb8();
        Some(picture.get_pixel(picture.width() / 2, picture.height() / 2).0)
    }

    fn wait_for(path: &Path, color: [u8; 3]) {
        let started = Instant::now();
        while middle(path) != Some(color) {
            assert!(
                started.elapsed() < Duration::from_secs(60),
                "{:?} for {color:?}",
                middle(path)
            );
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// A valid file is drawn; a mistake or an empty file keeps the last good picture.
    #[test]
    fn a_watched_technique_is_drawn_again_and_mistakes_leave_the_picture() {
        let folder = tempfile::tempdir().unwrap();
        let (file, out) = (folder.path().join("mine.toml"), folder.path().join("out.png"));
        let write = |color: &str| {
            let text = format!("[[pass]]\ncomponent = \"render_flat\"\ncolor = \"{color}\"\n");
            std::fs::write(&file, text).unwrap();
        };
        write("#ff0000");
        let mut child = Command::new(program("viewer"))
            .arg("render")
            .arg(workspace_root().join("models/cube.obj"))
            .args(["--size", "32x32", "--watch", "-o"])
            .arg(&out)
            .arg("--technique")
            .arg(&file)
            // Otherwise Mesa prints a warning.
            .env("XDG_RUNTIME_DIR", folder.path())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        wait_for(&out, [255, 0, 0]);
        // Watching begins before the first picture is written.
        write("#00ff00");
        wait_for(&out, [0, 255, 0]);
        std::fs::write(&file, "").unwrap();
        std::thread::sleep(Duration::from_millis(400));
        write("#00gg00");
        std::thread::sleep(Duration::from_millis(800));
        assert_eq!(middle(&out), Some([0, 255, 0]), "the last good one stays");
        write("#0000ff");
        wait_for(&out, [0, 0, 255]);
        child.kill().unwrap();
        let mut messages = String::new();
        child.stderr.take().unwrap().read_to_string(&mut messages).unwrap();
        child.wait().unwrap();
        assert!(messages.contains("mine.toml:3:9"), "{messages}");
        assert_eq!(messages.matches("error: ").count(), 1, "an empty file waits: {messages}");
    }
}
