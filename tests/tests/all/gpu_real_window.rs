//! A real window on its own display, with real keys, a real pointer and a real drop.

use std::path::Path;
use std::time::Duration;

use image::RgbaImage;
use testkit::locate::{program, workspace_root};
use viewer::picture::png::read_png;

use crate::display::Display;
use crate::drop_file::drop_file;
use crate::gpu_window::ink;

#[test]
fn a_real_window_shows_the_demo_and_follows_keys_and_pointer() {
    let Some(mut display) = Display::start() else { return };
    display.open(&[]);
    // Paper with lines on it.
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
        assert!(display.hand(&["key", key]), "xdotool failed");
        std::thread::sleep(Duration::from_secs(2));
        display.focus();
        let again = display.see(|screen| picture(screen) == top);
        assert!(again.is_some(), "{key}: another window shows another picture");
    }
    display.hands(&[
        "mousedown 1",
        "mousemove_relative 40 30",
        "mousemove_relative 40 30",
        "mouseup 1",
    ]);
    let turned = display.see(|screen| is_drawn(&picture(screen)) && picture(screen) != top);
    assert!(turned.is_some(), "the pointer does not turn the model");
    assert!(display.hand(&["key", "n"]));
    let is_wide = |screen: &RgbaImage| {
        let right = image::imageops::crop_imm(screen, 700, 100, 150, 400).to_image();
        right.pixels().filter(|pixel| pixel.0[..3] == [255; 3]).count() > 50_000
    };
    assert!(display.see(is_wide).is_some(), "without panels the picture does not fill the window");
    assert!(display.hand(&["key", "ctrl+q"]));
    assert!(display.closes());
}

/// The middle of the picture in the window.
fn picture(screen: &RgbaImage) -> RgbaImage {
    image::imageops::crop_imm(screen, 60, 60, 400, 440).to_image()
}

/// Waits until the title of the window begins with `name`; false after a while.
fn is_called(display: &Display, name: &str) -> bool {
    display.until(|display| display.title().starts_with(name).then_some(())).is_some()
}

/// The screen once its picture no longer changes.
fn still(display: &Display) -> RgbaImage {
    let mut before = display.look();
    let still = display.until(|display| {
        std::thread::sleep(Duration::from_millis(400));
        let now = display.look();
        let is_still = now == before;
        before = now;
        is_still.then(|| before.clone())
    });
    still.expect("the picture keeps changing")
}

#[test]
fn a_real_window_opens_changes_saves_and_marks() {
    let Some(mut display) = Display::start() else { return };
    let folder = tempfile::tempdir().unwrap();
    let model = |name: &str| {
        let path = folder.path().join(name);
        std::fs::copy(workspace_root().join("models").join(name), &path).unwrap();
        path
    };
    let (knot, cube) = (model("torus_knot.obj"), model("cube.obj"));
    display.open(&[cube.to_str().unwrap(), "--technique", "phong"]);
    assert!(is_called(&display, "cube.obj"));
    display.answer_dialogs(&knot);
    display.hands(&["mousemove 250 550", "key ctrl+o"]);
    assert!(is_called(&display, "torus_knot.obj"), "the dialog did not open the model");
    let first = picture(&still(&display));

    // Pen precedes phong.
    display.hands(&["key bracketleft"]);
    let pen = still(&display);
    assert!(picture(&pen) != first, "another technique");

    drag_width(&display);
    let wide = still(&display);
    assert!(ink(&picture(&wide)) > ink(&picture(&pen)) * 3 / 2, "the slider of the width");
    // A drag with a pause is several changes.
    let undone = display.until(|display| {
        display.hands(&["mousemove 250 550", "key ctrl+z"]);
        (picture(&still(display)) == picture(&pen)).then_some(())
    });
    assert!(undone.is_some(), "undone");

    save_and_restore(&display, folder.path(), &pen);

    // A marked edge that is no feature draws one line more; then its file.
    display.hands(&["key m", "mousemove 250 300", "mousemove_relative 3 2", "click 1"]);
    display.hands(&["mousemove 100 560", "key m"]);
    // Unsaved marks survive the loss of the graphics device.
    display.hands(&["key ctrl+shift+F9"]);
    std::thread::sleep(Duration::from_secs(2));
    display.focus();
    still(&display);
    display.hands(&["mousemove 630 44", "click 1", "mousemove 773 81", "click 1"]);
    let marks = knot.with_file_name("torus_knot.obj.marks");
    let text = display.until(|_| std::fs::read_to_string(&marks).ok());
    let text = text.expect("no file of marks beside the model");
    assert!(text.lines().filter(|line| !line.starts_with('#')).count() == 1, "{text}");

    display.hands(&["key m", "mousemove 250 300", "mousemove_relative 3 2", "click 1"]);
    display.hands(&["mousemove 100 560", "key m"]);
    let id = display.window_id().unwrap();
    drop_file(&display.number, id, &cube);
    still(&display);
    assert!(
        display.title().starts_with("torus_knot.obj"),
        "the marks were lost without a question"
    );
    drop_file(&display.number, id, &cube);
    assert!(is_called(&display, "cube.obj"), "dropped");
    display.hands(&["key ctrl+q"]);
    assert!(display.closes());
}

#[test]
fn what_a_window_lacks_is_told_on_the_terminal() {
    let Some(display) = Display::start() else { return };
    let told = |settings: &[(&str, &str)]| {
        let mut command = display.command(program("viewer"));
        let output = command.envs(settings.iter().copied()).output().unwrap();
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    let nothing = "/nonexistent.json";
    let (status, text) = told(&[("VK_DRIVER_FILES", nothing), ("VK_ICD_FILENAMES", nothing)]);
    assert_eq!(status, Some(3), "{text}");
    assert!(text.contains("apt-get install mesa-vulkan-drivers"), "{text}");
    let (status, text) = told(&[("DISPLAY", "")]);
    assert_eq!(status, Some(1), "{text}");
    assert!(text.contains("no display") && text.contains("viewer render draws"), "{text}");
}

/// Drags the slider in the third row of the strokes.
fn drag_width(display: &Display) {
    display.hands(&[
        "mousemove 696 386",
        "mousedown 1",
        "mousemove_relative 10 0",
        "mousemove_relative 10 0",
        "mouseup 1",
    ]);
}

/// The saved picture equals the screen to the pixel; dropping it on the window restores
/// its recipe.
fn save_and_restore(display: &Display, folder: &Path, screen: &RgbaImage) {
    let path = folder.join("saved.png");
    display.answer_dialogs(&path);
    display.hands(&["key F12"]);
    let saved = display.until(|_| path.is_file().then(|| read_png(&path).unwrap()));
    let saved = saved.expect("no picture was saved");
    // The picture starts below the bar.
    let shown = image::imageops::crop_imm(screen, 0, 26, saved.width(), saved.height()).to_image();
    assert!(picture(&shown) == picture(&saved), "the picture of the screen");
    display.hands(&["key bracketright"]);
    assert!(picture(&still(display)) != picture(screen), "the next technique");
    drop_file(&display.number, display.window_id().unwrap(), &path);
    let again = display.see(|now| picture(now) == picture(screen));
    assert!(again.is_some(), "its recipe is back");
}
