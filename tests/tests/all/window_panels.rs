//! The panels of the window, through their accessibility tree, without a window or a GPU.

use std::path::PathBuf;
use std::sync::Arc;

use edgemesh::load::{DEMO, LoadOptions, NoProgress};
use egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use viewer::picture::renderer::FrameStatistics;
use viewer::scene::lighting::Light;
use viewer::scene::models::Scene;
use viewer::scene::scene_file::SceneObject;
use viewer::technique::library::Library;
use viewer::technique::texture_format::{PassTexture, TextureFormat};
use viewer::window::hands::{CUT_KEY, Hands, KEYS, LIGHT_KEY};
use viewer::window::panels;
use viewer::window::recipe::Recipe;
use viewer::window::remembered::{Remembered, Tab};
use viewer::window::session::{Request, Session, Work};
use viewer::window::viewpoint::NamedView;

const SIZE: [u32; 2] = [640, 480];

/// A session with the demo in it.
fn session(words: &str) -> Session {
    let library = Library::shipped();
    let words: Vec<String> = words.split_whitespace().map(str::to_owned).collect();
    let recipe = Recipe::of_words(&words, &library).unwrap();
    let mut session = Session::new(library, recipe, Remembered::default());
    let object = SceneObject::plain(DEMO.as_ref());
    let scene = Scene::load(&[object], &LoadOptions::default(), &NoProgress).unwrap();
    session.take_scene(vec![PathBuf::from(DEMO)], Arc::new(scene), Vec::new()).unwrap();
    session
}

/// The side panel with one of its tabs open.
fn side(tab: Tab, mut session: Session) -> Harness<'static, Session> {
    session.remembered.tab = tab;
    let show = |ui: &mut egui::Ui, session: &mut Session| {
        let time = ui.input(|input| input.time);
        session.watch_changes(time);
        panels::side_panel(ui, session, SIZE);
    };
    let mut harness = Harness::builder().with_size([380.0, 1600.0]).build_ui_state(show, session);
    harness.run_ok();
    harness
}

fn value(session: &Session, pass: &str, variable: &str) -> String {
    let technique = &session.recipe.appearance.technique;
    let pass = technique.pass(pass).unwrap();
    let (index, _) = pass.component.variable(variable).unwrap();
    pass.values()[index].to_string()
}

#[test]
fn tabs_open_their_panels() {
    let mut harness = side(Tab::Look, session(""));
    for (tab, part) in [
        ("Lines", "Contour"),
        ("Light", "With the camera"),
        ("View", "Turntable"),
        ("Inspect", "Edge classes"),
        ("Output", "Save picture…"),
        ("Look", "Reset all"),
    ] {
        harness.get_by_label(tab).click();
        harness.run_ok();
        assert!(harness.query_by_label(part).is_some(), "{tab} has {part}");
    }
}

#[test]
fn a_pass_goes_off_and_a_variable_changes_and_both_come_back() {
    let mut harness = side(Tab::Look, session("--technique anime"));
    harness.get_by_label("fill").click();
    harness.run_ok();
    assert_eq!(value(harness.state(), "fill", "render"), "false");
    harness.get_all_by_label("Undo").next().unwrap().click();
    harness.run_ok();
    assert_eq!(value(harness.state(), "fill", "render"), "true", "undone");
    harness.get_by_label("Redo").click();
    harness.run_ok();
    assert_eq!(value(harness.state(), "fill", "render"), "false", "redone");
    harness.get_by_label("Reset all").click();
    harness.run_ok();
    assert_eq!(value(harness.state(), "fill", "render"), "true", "as in its file");
    assert!(!harness.state().recipe.appearance.is_changed());
}

#[test]
fn every_variable_that_is_not_internal_has_a_widget_with_its_name() {
    for name in ["ink", "toon_image", "hatching", "outline_wide"] {
        let harness = side(Tab::Look, session(&format!("--technique {name}")));
        let technique = &harness.state().recipe.appearance.technique;
        for pass in technique.passes.iter().take(2) {
            let shown = pass.component.variables.iter().filter(|variable| !variable.internal);
            for variable in shown.filter(|variable| variable.name != "render") {
                let label = variable.name.replace('_', " ");
                let found = harness.query_all_by_label(&label).count();
                assert!(found > 0, "{name}: {}.{}", pass.name, variable.name);
            }
        }
    }
}

#[test]
fn a_slider_sets_its_variable() {
    let mut harness = side(Tab::Lines, session("--technique ink --set strokes.width=3"));
    let sliders: Vec<_> = harness.get_all_by_label("width").collect();
    let slider = sliders
        .iter()
        .filter(|node| node.accesskit_node().role() == egui::accesskit::Role::Slider)
        .nth(1)
        .unwrap();
    slider.set_value_accesskit(7.5);
    harness.run_ok();
    assert_eq!(value(harness.state(), "strokes", "width"), "7.5");
}

#[test]
fn classes_have_counts_and_go_off() {
    let mut session = session("");
    let mut tally = strokes::Tally::default();
    tally.features[0] = 1234;
    session.keep(FrameStatistics { tally: Some(tally), passes: Vec::new(), frame_ms: 1.0 });
    let mut harness = side(Tab::Lines, session);
    assert!(harness.query_by_label("1\u{202f}234").is_some(), "contours are counted");
    harness.get_by_label("Ridge").click();
    harness.run_ok();
    let classes = value(harness.state(), "strokes", "classes");
    assert!(!classes.contains("ridge") && classes.contains("valley"), "{classes}");
    let command = harness.state().command(SIZE).unwrap();
    assert!(command.contains("strokes.classes="), "{command}");
}

#[test]
fn the_light_goes_to_the_world_and_still_comes_from_there() {
    let mut harness = side(Tab::Light, session("--light 0,0,1"));
    let view = harness.state().recipe.viewpoint.unwrap();
    harness.get_by_label("In the world").click();
    harness.run_ok();
    let Light::World(direction) = harness.state().recipe.appearance.lighting.light else {
        panic!("the light is in the world");
    };
    assert!(direction.normalize_or_zero().distance(-view.forward()) < 0.01);
    harness.get_by_label("At a point").click();
    harness.run_ok();
    let command = harness.state().command(SIZE).unwrap();
    assert!(command.contains("--light point:"), "{command}");
}

#[test]
fn cuts_are_added_moved_and_removed() {
    let mut harness = side(Tab::Light, session(""));
    harness.get_by_label("Add cut").click();
    harness.run_ok();
    harness.get_by_label("X").click();
    harness.run_ok();
    harness.get_by_label("Flip").click();
    harness.run_ok();
    let planes = harness.state().recipe.appearance.lighting.clip_planes.clone();
    assert_eq!(planes.len(), 1);
    assert_eq!(planes[0][..3], [-1.0, 0.0, 0.0]);
    harness.get_by_label("Remove").click();
    harness.run_ok();
    assert!(harness.state().recipe.appearance.lighting.clip_planes.is_empty());
}

#[test]
fn sides_are_gone_to_and_the_projection_changes() {
    let mut harness = side(Tab::View, session(""));
    harness.get_by_label("Top").click();
    harness.run_ok();
    let requests = std::mem::take(&mut harness.state_mut().requests);
    let [Request::GoTo(view)] = &requests[..] else { panic!("{requests:?}") };
    assert!(view.forward().distance(glam::DVec3::NEG_Y) < 1e-9);
    harness.get_by_label("Orthographic").click();
    harness.run_ok();
    assert!(harness.state().recipe.viewpoint.unwrap().is_orthographic);
}

#[test]
fn inspection_shows_times_and_what_was_repaired() {
    let mut session = session("");
    for frame in 0..3 {
        let passes = vec![("fill".to_owned(), Some(1.5 + f64::from(frame)))];
        session.keep(FrameStatistics { tally: None, passes, frame_ms: 9.0 });
    }
    let harness = side(Tab::Inspect, session);
    assert!(harness.query_by_label("3.50 ms").is_some(), "the last picture's time");
    assert!(harness.query_by_label_contains("demo: none").is_some(), "nothing was repaired");
}

#[test]
fn debug_views_come_and_go() {
    let mut harness = side(Tab::Inspect, session("--technique pen --set strokes.width=5"));
    for (name, technique) in [("Wireframe", "wireframe"), ("Normals", "debug_normals")] {
        harness.get_by_label(name).click();
        harness.run_ok();
        assert_eq!(harness.state().recipe.appearance.technique_name, technique);
    }
    harness.get_by_label("The picture").click();
    harness.run_ok();
    assert_eq!(harness.state().recipe.appearance.technique_name, "pen");
    assert_eq!(value(harness.state(), "strokes", "width"), "5", "as it was changed");
    // The last choice is drawn.
    harness.get_by_label("Regions").click();
    harness.run_ok();
    harness.state_mut().take_technique("toon");
    harness.run_ok();
    harness.get_by_label("The picture").click();
    harness.run_ok();
    assert_eq!(harness.state().recipe.appearance.technique_name, "toon");
}

/// A key event.
fn pressed(key: Key, pressed: bool) -> egui::Event {
    let (physical_key, repeat, modifiers) = (None, false, Modifiers::NONE);
    egui::Event::Key { key, physical_key, pressed, repeat, modifiers }
}

#[test]
fn drags_over_the_picture_turn_it_or_the_light_or_move_a_cut() {
    let mut hands = Hands::default();
    let show = move |ui: &mut egui::Ui, session: &mut Session| {
        let rect = ui.available_rect_before_wrap();
        let response = ui.allocate_rect(rect, egui::Sense::click_and_drag());
        hands.pointer(ui, &response, session);
    };
    let session = session("--clip 0,0,-1,0.2 --light 0,0,1");
    let mut harness = Harness::builder().with_size([800.0, 600.0]).build_ui_state(show, session);
    let mut drag = |key: Option<Key>| {
        let before = harness.state().recipe.clone();
        if let Some(key) = key {
            harness.event(pressed(key, true));
        }
        let at = |x: f32| egui::pos2(300.0 + x, 300.0 - x);
        harness.drag_at(at(0.0));
        harness.run_ok();
        for step in [20.0, 60.0] {
            harness.hover_at(at(step));
            harness.run_ok();
        }
        harness.drop_at(at(60.0));
        if let Some(key) = key {
            harness.event(pressed(key, false));
        }
        harness.run_ok();
        let after = harness.state().recipe.clone();
        let lighting = [&before, &after].map(|recipe| recipe.appearance.lighting.clone());
        (
            before.viewpoint != after.viewpoint,
            lighting[0].light != lighting[1].light,
            lighting[0].clip_planes != lighting[1].clip_planes,
        )
    };
    assert_eq!(drag(None), (true, false, false), "the eye");
    assert_eq!(drag(Some(LIGHT_KEY)), (false, true, false), "the light");
    assert_eq!(drag(Some(CUT_KEY)), (false, false, true), "the cut");
}

#[test]
fn textures_between_passes_are_listed_and_looked_at() {
    let mut session = session("--technique outline_combined");
    let texture = |name: &str, format| PassTexture { name: name.to_owned(), format };
    session.generated = vec![
        texture("scene_normal", TextureFormat::Rgba16Float),
        texture("scene_depth", TextureFormat::Depth32Float),
    ];
    let mut harness = side(Tab::Inspect, session);
    harness.get_by_label("scene_normal").click();
    harness.run_ok();
    assert!(harness.query_all_by_label("White").count() > 0, "its range can be chosen");
    harness.get_by_label("scene_depth").click();
    harness.run_ok();
    assert!(harness.query_all_by_label("White").count() == 0, "depths have their own");
    let inspection = harness.state().inspection.clone().unwrap();
    assert_eq!(inspection.texture.name, "scene_depth");
    let command = harness.state().command(SIZE).unwrap();
    assert!(!command.contains("shown"), "it is no part of the picture's recipe: {command}");
    harness.get_by_label("None").click();
    harness.run_ok();
    assert_eq!(harness.state().inspection, None);
}

#[test]
fn a_look_is_compared_with_another_and_changes_sides() {
    let mut session = session("--technique pen");
    session.compare_with(Some("toon"));
    let mut harness = side(Tab::Look, session);
    assert!(harness.query_by_label("pen").is_some(), "the left one is the one that is changed");
    harness.get_by_label("Swap").click();
    harness.run_ok();
    assert_eq!(harness.state().recipe.appearance.technique_name, "toon");
    let comparison = harness.state().comparison.clone().unwrap();
    assert_eq!(comparison.appearance.technique_name, "pen");
    harness.state_mut().compare_with(None);
    harness.run_ok();
    assert!(harness.query_by_label("Swap").is_none());
}

#[test]
fn output_shows_the_command_and_asks_for_pictures() {
    let mut harness = side(Tab::Output, session("--technique pen"));
    let shown = harness.query_by_label_contains("viewer render demo: --technique pen").is_some();
    assert!(shown, "the command");
    harness.get_by_label("Save picture…").click();
    harness.run_ok();
    harness.get_by_label("Save window…").click();
    harness.run_ok();
    harness.get_by_label("Save turntable…").click();
    harness.run_ok();
    harness.get_by_label("Copy command").click();
    harness.run_ok();
    let requests = &harness.state().requests;
    assert!(
        matches!(
            requests[..],
            [
                Request::SavePicture(None),
                Request::SaveWindow,
                Request::SavePicture(Some(72)),
                Request::Copy(..)
            ]
        ),
        "{requests:?}"
    );
}

#[test]
fn bars_choose_techniques_and_open_menus() {
    let show = |ui: &mut egui::Ui, session: &mut Session| {
        panels::top_bar(ui, session, SIZE);
        panels::status_bar(ui, session);
    };
    let mut harness =
        Harness::builder().with_size([900.0, 900.0]).build_ui_state(show, session(""));
    harness.run_ok();
    assert!(harness.query_by_label_contains("triangles").is_some(), "the status bar counts");
    let combo = harness.get_by_role_and_label(egui::accesskit::Role::ComboBox, "Technique");
    combo.click();
    harness.run_ok();
    assert_eq!(harness.state().requests, [Request::DrawThumbnails], "once the list is open");
    harness.state_mut().requests.clear();
    let top = |name: &str| harness.get_by_label(name).rect().top();
    assert!(top("charcoal") - top("anime") > 54.0, "there is room for the pictures to come");
    harness.get_by_label("anime").click();
    harness.run_ok();
    assert_eq!(harness.state().recipe.appearance.technique_name, "anime");
    harness.get_by_label("File").click();
    harness.run_ok();
    harness.get_by_label_contains("Open…").click();
    harness.run_ok();
    assert_eq!(harness.state().requests, [Request::ChooseFiles]);
}

#[test]
fn notes_tell_mistakes_and_can_be_dismissed() {
    let mut session = session("");
    session.take_technique("no such technique");
    session.messages.error("the file is gone");
    session.messages.note("saved as picture.png");
    let since = std::time::Instant::now();
    session.work.push(Work { what: "reading a.obj".into(), since, saving: None });
    let show = |ui: &mut egui::Ui, session: &mut Session| {
        let rect = ui.available_rect_before_wrap();
        panels::notes(ui, session, rect);
    };
    let mut harness = Harness::builder().with_size([800.0, 600.0]).build_ui_state(show, session);
    harness.run_ok();
    let has =
        |harness: &Harness<Session>, part: &str| harness.query_by_label_contains(part).is_some();
    for part in ["unknown technique", "the file is gone", "saved as", "reading a.obj"] {
        assert!(has(&harness, part), "{part}");
    }
    harness.get_by_label("Cancel").click();
    harness.run_ok();
    assert_eq!(harness.state().requests, [Request::Cancel(None)]);
    for _ in 0..2 {
        harness.get_all_by_label("Dismiss").next().unwrap().click();
        harness.run_ok();
    }
    assert!(!has(&harness, "the file is gone") && !has(&harness, "there is no technique"));
    assert_eq!(harness.state().recipe.appearance.technique_name, "ink", "the last good one stays");
}

#[test]
fn keys_do_what_their_sheet_says() {
    let mut hands = Hands::default();
    let show = move |ui: &mut egui::Ui, session: &mut Session| {
        hands.keys(ui, session, SIZE);
        if session.shows_keys {
            panels::keys_sheet(ui, session);
        }
    };
    let mut harness =
        Harness::builder().with_size([1200.0, 700.0]).build_ui_state(show, session(""));
    harness.key_press(Key::H);
    harness.run_ok();
    assert!(harness.query_by_label("perspective or orthographic").is_some(), "the sheet");
    harness.key_press(Key::Num5);
    harness.run_ok();
    assert!(harness.state().recipe.viewpoint.unwrap().is_orthographic);
    harness.key_press(Key::Num3);
    harness.run_ok();
    let side = harness.state().recipe.viewpoint.unwrap();
    let side = side.from_side(NamedView::Right, Default::default());
    assert_eq!(harness.state().requests, [Request::GoTo(harness.state().fitted(&side))]);
    harness.key_press(Key::N);
    harness.run_ok();
    assert!(!harness.state().remembered.shows_panels);
    harness.key_press(Key::CloseBracket);
    harness.run_ok();
    assert_eq!(harness.state().recipe.appearance.technique_name, "linked", "the one after ink");
    // A held key repeats: nothing may flicker or be requested repeatedly.
    for _ in 0..4 {
        harness.event(pressed(Key::N, true));
        harness.event(pressed(Key::Num4, true));
    }
    harness.run_ok();
    assert!(harness.state().remembered.shows_panels, "changed once");
    let rolls = harness.state().requests.iter().filter(|asked| matches!(asked, Request::GoTo(_)));
    assert_eq!(rolls.count(), 1 + 4, "but it rolls on");
    let is_held = |key: &Key| [LIGHT_KEY, CUT_KEY].contains(key);
    assert!(!KEYS.iter().any(|(key, ..)| is_held(key)), "what is held for a drag does no more");
    harness.state_mut().requests.clear();
    harness.key_press_modifiers(Modifiers::SHIFT, Key::C);
    harness.run_ok();
    let [Request::Copy(camera, _)] = &harness.state().requests[..] else { panic!("copied") };
    assert!(camera.starts_with("--eye "), "{camera}");
    let pasted = "viewer render a.obj --eye 9,0,0 --target 0,0,0";
    harness.event(egui::Event::Paste(pasted.to_owned()));
    harness.run_ok();
    let Some(Request::GoTo(view)) = harness.state().requests.last() else { panic!("pasted") };
    assert_eq!(view.eye, glam::DVec3::new(9.0, 0.0, 0.0));
}

#[test]
fn the_line_between_two_looks_is_moved_by_hand_and_by_keys() {
    let show = |ui: &mut egui::Ui, share: &mut f32| {
        let rect = ui.available_rect_before_wrap();
        *share = panels::comparison_line(ui, rect, *share, ["ink", "pen"].map(str::to_owned));
    };
    let builder = Harness::builder().with_size([400.0, 300.0]);
    let mut harness = builder.build_ui_state(show, 0.5);
    let line = harness.get_by_label("Comparison line").rect();
    let step = egui::vec2(80.0, 30.0);
    harness.drag_at(line.center());
    harness.run_ok();
    harness.hover_at(line.center() + step);
    harness.run_ok();
    harness.drop_at(line.center() + step);
    harness.run_ok();
    let dragged = *harness.state();
    assert!((0.65..0.75).contains(&dragged), "{dragged}");
    harness.get_by_label("Comparison line").focus();
    harness.run_ok();
    for _ in 0..3 {
        harness.key_press(Key::ArrowLeft);
        harness.run_ok();
    }
    let stepped = *harness.state();
    assert!((dragged - stepped - 0.06).abs() < 1e-4, "{stepped}: the focus stays");
    for _ in 0..60 {
        harness.key_press(Key::ArrowRight);
        harness.run_ok();
    }
    assert!((*harness.state() - 1.0).abs() < 1e-6, "not beyond the picture");
}

#[test]
fn without_a_picture_there_is_a_way_to_one() {
    let show = |ui: &mut egui::Ui, (session, is_waiting): &mut (Session, bool)| {
        let rect = ui.available_rect_before_wrap();
        panels::no_picture(ui, session, rect, *is_waiting);
    };
    let mut harness = Harness::new_ui_state(show, (session(""), true));
    assert!(harness.query_by_label_contains("Open").is_none(), "models are on their way");
    (harness.state_mut().1, harness.state_mut().0.scene) = (false, None);
    harness.run_ok();
    harness.get_by_label_contains("Open…").click();
    harness.run_ok();
    harness.get_by_label("Open the demo").click();
    harness.run_ok();
    let wanted = [Request::ChooseFiles, Request::Open(vec![PathBuf::from(DEMO)])];
    assert_eq!(harness.state().0.requests, wanted);
}

#[test]
fn a_recipe_of_other_models_waits_for_them() {
    let mut session = session("");
    let before = session.recipe.clone();
    let cube = testkit::locate::workspace_root().join("models/cube.obj");
    let words = [cube.to_str().unwrap(), "--technique", "pen", "--eye", "0,0,9"];
    let recipe = session.take_words(&words.map(str::to_owned)).unwrap();
    let recipe = recipe.expect("the cube is to be loaded");
    assert_eq!(recipe.models, [cube]);
    assert_eq!(recipe.appearance.technique_name, "pen");
    // If they do not load, nothing changes.
    assert_eq!(session.recipe.appearance, before.appearance);
    assert_eq!(session.recipe.viewpoint, before.viewpoint);
    // If the models are gone, the rest of the recipe applies at once.
    let words = ["gone.obj", "--technique", "pen", "--eye", "0,0,9", "--target", "0,0,0"];
    assert!(session.take_words(&words.map(str::to_owned)).unwrap().is_none());
    assert_eq!(session.recipe.appearance.technique_name, "pen");
    assert_eq!(session.recipe.viewpoint.unwrap().eye, glam::DVec3::new(0.0, 0.0, 9.0));
}

/// The fonts of the window contain every character of the panels.
#[test]
fn no_sign_is_missing_in_the_fonts() {
    let window = testkit::locate::workspace_root().join("crates/viewer/src/window");
    let folders = [window.clone(), window.join("panels")];
    let files = folders.iter().flat_map(|folder| std::fs::read_dir(folder).unwrap());
    let mut signs = std::collections::BTreeSet::new();
    for path in files.map(|file| file.unwrap().path()).filter(|path| path.is_file()) {
        let text = std::fs::read_to_string(path).unwrap();
        let code = text.lines().filter(|line| !line.trim_start().starts_with("//"));
        signs.extend(code.flat_map(str::chars).filter(|sign| !sign.is_ascii()));
    }
    assert!(signs.contains(&'…'), "{signs:?}");
    let harness = Harness::new_ui(|ui| {
        ui.label("");
    });
    let font = egui::FontId::proportional(13.0);
    signs.retain(|&sign| !harness.ctx.fonts_mut(|fonts| fonts.has_glyph(&font, sign)));
    assert!(signs.is_empty(), "{signs:?}");
}
