//! `viewer`, run as users run it. Tests without an adapter run everywhere.

use std::path::Path;
use std::process::{Command, Output};

use testkit::locate::{program, workspace_root};

fn viewer(arguments: &[&str]) -> Output {
    Command::new(program("viewer")).args(arguments).output().unwrap()
}

fn message(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn cube() -> String {
    workspace_root().join("models/cube.obj").display().to_string()
}

#[test]
fn wrong_command_lines_exit_with_2_and_say_why() {
    let cube = cube();
    for (arguments, word) in [
        (vec!["--technique"], "--technique"),
        (vec!["--ortho", "render", &cube, "-o", "a.png"], "--ortho stands before"),
        (vec!["render"], "MODEL"),
        (vec!["render", &cube], "--output"),
        (vec!["render", &cube, "-o", "a.jpg"], ".png"),
        (vec!["render", &cube, "-o", "a.gif"], "--turntable"),
        (vec!["render", &cube, "-o", "a.jpg", "--turntable", "3"], ".apng"),
        (vec!["render", &cube, "-o", "a.png", "--size", "10"], "1920x1080"),
        (vec!["render", &cube, "-o", "a.png", "--samples", "2"], "samples"),
        (vec!["render", &cube, "-o", "a.png", "--eye", "1,2"], "three numbers"),
        (vec!["render", &cube, "-o", "a.png", "--set", "strokes.width=x"], "a number"),
        (vec!["render", &cube, "-o", "a.png", "--set", "strokes.widht=2"], "did you mean 'width'"),
        (vec!["render", &cube, "-o", "a.png", "--set", "lines.width=2"], "silhouette"),
        (vec!["render", &cube, "-o", "a.png", "--light", "0,0,0"], "0,0,0"),
        (vec!["render", &cube, "-o", "a.png", "--clip", "1,2,3"], "NX,NY,NZ,D"),
        (vec!["render", &cube, "-o", "a.png", "--watch"], "--watch"),
        (vec!["render", &cube, "-o", "-", "--stats", "-"], "both"),
        (vec!["render", &cube, "-o", &cube], ".png"),
    ] {
        let output = viewer(&arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", message(&output));
        assert!(message(&output).contains(word), "{arguments:?}: {}", message(&output));
    }
}

#[test]
fn without_a_display_there_is_no_window_and_the_message_says_what_draws_without_one() {
    let mut command = std::process::Command::new(testkit::locate::program("viewer"));
    command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
    let output = crate::child::run(command.stdout(std::process::Stdio::piped()));
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    assert!(message(&output).contains("viewer render draws without one"), "{}", message(&output));
}

#[test]
fn wrong_inputs_and_outputs_exit_with_1_and_leave_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out.png").display().to_string();
    let cube = cube();
    for (arguments, word) in [
        (vec!["render", "no/such.obj", "-o", &out], "no/such.obj"),
        (vec!["render", &cube, "-o", "no/such/folder/out.png"], "no/such/folder does not exist"),
        (vec!["render", &cube, "-o", &out, "--reference", "no/such.png"], "no/such.png"),
        (vec!["render", &cube, "-o", &out, "--brush", "no/such.png"], "charcoal"),
        (vec!["render", &cube, "-o", &out, "--brush", &cube], "PNG"),
        (vec!["render", "no/such.toml", "-o", &out], "no/such.toml"),
    ] {
        let output = viewer(&arguments);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {}", message(&output));
        assert!(message(&output).contains(word), "{arguments:?}: {}", message(&output));
    }
    assert_eq!(folder.path().read_dir().unwrap().count(), 0);
}

#[test]
fn an_unknown_technique_exits_with_4_and_names_those_there_are() {
    let output = viewer(&["render", &cube(), "-o", "a.png", "--technique", "oil"]);
    assert_eq!(output.status.code(), Some(4));
    assert!(message(&output).contains("ink, linked"), "{}", message(&output));
}

#[test]
fn without_an_adapter_the_status_is_3_and_the_message_says_what_to_install() {
    for arguments in
        [vec!["adapters".to_owned()], vec!["render".into(), cube(), "-o".into(), "a.png".into()]]
    {
        let output = Command::new(program("viewer"))
            .args(&arguments)
            .env("VK_DRIVER_FILES", "/nonexistent")
            .env("VK_ICD_FILENAMES", "/nonexistent")
            .env("WGPU_BACKEND", "vulkan")
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(3), "{arguments:?}: {}", message(&output));
        assert!(message(&output).contains("mesa-vulkan-drivers"), "{}", message(&output));
    }
    assert!(!Path::new("a.png").exists());
}

#[cfg(feature = "gpu")]
mod with_adapter {
    use serde_json::Value;
    use testkit::locate::{left_out, shared};
    use viewer::picture::png::read_png;

    use super::*;

    fn statistics(arguments: &[&str]) -> Value {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("out.png").display().to_string();
        let mut all = vec!["-q", "render", "-o", &out, "--stats", "-", "--size", "64x64"];
        all.extend(arguments);
        let output = viewer(&all);
        assert_eq!(output.status.code(), Some(0), "{}", message(&output));
        assert!(Path::new(&out).is_file(), "no picture");
        serde_json::from_slice(&output.stdout).unwrap()
    }

    /// A scene file places models, each with its own look.
    #[test]
    fn scene_files_draw_their_objects() {
        let folder = tempfile::tempdir().unwrap();
        let file = |name: &str| folder.path().join(name).display().to_string();
        let bracket = workspace_root().join("models/bracket.obj").display().to_string();
        let object = |more: &str| format!("[[object]]\nmodel = '{bracket}'\n{more}\n");
        let (scene, out) = (file("scene.toml"), file("out.png"));
        let draw = |text: &str| {
            std::fs::write(&scene, text).unwrap();
            let stats = file("stats.json");
            let output =
                viewer(&["render", &scene, "-o", &out, "--size", "128x128", "--stats", &stats]);
            assert_eq!(output.status.code(), Some(0), "{}", message(&output));
            let stats = std::fs::read_to_string(&stats).unwrap();
            let stats: serde_json::Value = serde_json::from_str(&stats).unwrap();
            let picture = image::open(&out).unwrap().to_rgba8();
            let reds = picture.pixels().filter(|pixel| pixel.0 == [255, 0, 0, 255]).count();
            (stats["edges"].as_u64().unwrap(), reds)
        };
        let (edges, reds) = draw(&object(""));
        assert_eq!(reds, 0);
        let red = "translate = [4, 0, 0]\nrotate = [0, 30, 0]\nset = [\"strokes.color=#ff0000\"]";
        let (twice, reds) = draw(&[object(""), object(red)].concat());
        assert_eq!(twice, 2 * edges);
        assert!(reds > 50, "{reds} red pixels");
        std::fs::write(&scene, object("size = 3")).unwrap();
        let output = viewer(&["render", &scene, "-o", &out]);
        assert_eq!(output.status.code(), Some(1));
        assert!(message(&output).contains("scene.toml:3:"), "{}", message(&output));
    }

    #[test]
    fn statistics_have_the_keys_that_scripts_rely_on() {
        let statistics = statistics(&[&cube()]);
        for key in [
            "adapter",
            "backend",
            "size",
            "triangles",
            "edges",
            "features",
            "strokes",
            "passes",
            "frame_ms",
        ] {
            assert!(statistics.get(key).is_some(), "{key}");
        }
        assert_eq!((&statistics["triangles"], &statistics["edges"]), (&12.into(), &18.into()));
        assert_eq!(statistics["features"]["ridge"], 12);
        let names: Vec<_> =
            statistics["passes"].as_array().unwrap().iter().map(|pass| &pass["name"]).collect();
        let of_strokes = ["detect", "link", "expand", "fill", "paths", "coverage", "strokes"];
        let of_strokes = of_strokes.map(|name| format!("strokes.{name}"));
        assert_eq!(names[0], "fill");
        assert!(names[1..].iter().map(|name| name.as_str().unwrap()).eq(&of_strokes), "{names:?}");
    }

    /// The counts of the GPU equal those of the reference program in 64 bits.
    #[test]
    fn counts_equal_the_reference_on_every_shared_model() {
        let Some(shared) = shared() else { return left_out("models with reference counts", 7) };
        let text = std::fs::read_to_string(shared.join("models/reference_counts.json")).unwrap();
        let reference: Value = serde_json::from_str(&text).unwrap();
        let models = reference["models"].as_object().unwrap();
        assert!(models.len() >= 7);
        for (name, counts) in models {
            let vector = |key: &str| {
                let parts = counts[key].as_array().unwrap().iter().map(Value::to_string);
                parts.collect::<Vec<_>>().join(",")
            };
            let file = shared.join(format!("models/{name}.obj")).display().to_string();
            let got = statistics(&[&file, "--eye", &vector("eye"), "--target", &vector("center")]);
            let pairs = [
                (&got["edges"], "edges"),
                (&got["features"]["contour"], "contour_edges_manifold"),
                (&got["features"]["boundary"], "boundary_edges"),
                (&got["features"]["ridge"], "crease_ridge"),
                (&got["features"]["valley"], "crease_valley"),
            ];
            for (got, key) in pairs {
                // The reference counts no creases between polygons.
                if let Some(want) = counts.get(key) {
                    assert_eq!(got, want, "{name}: {key}");
                }
            }
        }
    }

    #[test]
    fn a_reference_that_differs_exits_with_5_and_writes_the_difference() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name).display().to_string();
        let (cube, first, second) = (cube(), path("first.png"), path("second.png"));
        let size = ["--size", "64x64"];
        let run = |extra: &[&str]| viewer(&[&["render", &cube], &size[..], extra].concat());
        assert_eq!(run(&["-o", &first]).status.code(), Some(0));
        let same = run(&["-o", &second, "--reference", &first]);
        assert_eq!(same.status.code(), Some(0), "{}", message(&same));
        let other = run(&["-o", &second, "--reference", &first, "--set", "strokes.width=6"]);
        assert_eq!(other.status.code(), Some(5), "{}", message(&other));
        assert!(message(&other).contains("pixels"), "{}", message(&other));
        assert!(Path::new(&second).is_file());
        let wrong_size = viewer(&["render", &cube, "-o", &second, "--reference", &first]);
        assert_eq!(wrong_size.status.code(), Some(1), "{}", message(&wrong_size));
    }

    /// Two sheets side by side, one of them too far away for 32 bits without a frame, as
    /// models and with the first as an edge mesh in its own frame.
    #[test]
    fn models_far_away_keep_their_places_in_one_scene() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name).display().to_string();
        let write_sheet = |name: &str, x: f64| {
            let corner = |dx: f64, y: u32| format!("v {} {y} 0\n", x + dx);
            let corners = [corner(0.0, 0), corner(1.0, 0), corner(1.0, 1), corner(0.0, 1)];
            std::fs::write(path(name), corners.concat() + "f 1 2 3 4\n").unwrap();
            path(name)
        };
        let render = |models: [&str; 2], out: &str, more: &[&str]| {
            let target = path(out);
            let ahead = ["-o", &target, "--size", "64x64", "--samples", "1"];
            let output = viewer(&[&["render"], &models[..], &ahead, more].concat());
            assert_eq!(output.status.code(), Some(0), "{}", message(&output));
            target
        };
        let [a, b] =
            [("a.obj", 4_500_000.0), ("b.obj", 4_500_001.5)].map(|(name, x)| write_sheet(name, x));
        let [near_a, near_b] = [("c.obj", 0.0), ("d.obj", 1.5)].map(|(n, x)| write_sheet(n, x));
        let near = render([&near_a, &near_b], "near.png", &[]);
        let built = path("a.edgemesh");
        let output = crate::child::edgemesh(&["build", &a, "-o", &built]);
        assert_eq!(output.status.code(), Some(0), "{}", message(&output));
        let same = ["--reference", &near, "--reference-threshold", "0"];
        render([&a, &b], "far.png", &same);
        render([&built, &b], "built.png", &same);
    }

    #[test]
    fn a_turntable_writes_numbered_pictures_and_a_stream_is_a_png() {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("turn.png").display().to_string();
        let cube = cube();
        let output = viewer(&["render", &cube, "-o", &out, "--size", "32x16", "--turntable", "3"]);
        assert_eq!(output.status.code(), Some(0), "{}", message(&output));
        for step in 0..3 {
            assert!(folder.path().join(format!("turn-{step}.png")).is_file());
        }
        for (ending, magic) in [("gif", &b"GIF89a"[..]), ("apng", b"\x89PNG")] {
            let out = folder.path().join(format!("turn.{ending}"));
            let path = out.display().to_string();
            let arguments = ["render", &cube, "-o", &path, "--size", "32x16", "--turntable", "3"];
            let output = viewer(&arguments);
            assert_eq!(output.status.code(), Some(0), "{}", message(&output));
            assert!(std::fs::read(&out).unwrap().starts_with(magic), "{ending}");
        }
        let output = viewer(&["render", &cube, "-o", "-", "--size", "32x16", "--transparent"]);
        let picture = image::load_from_memory(&output.stdout).unwrap();
        assert_eq!((picture.width(), picture.height()), (32, 16));
        assert!(picture.color().has_alpha());
    }

    #[test]
    fn a_picture_beyond_the_adapter_is_drawn_and_one_beyond_the_memory_refused() {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("wide.png");
        let render =
            |size: &str| viewer(&["render", &cube(), "-o", out.to_str().unwrap(), "--size", size]);
        let output = render("4000000000x4000000000");
        assert_eq!(output.status.code(), Some(1), "{}", message(&output));
        assert!(
            message(&output).contains("not enough memory for a picture"),
            "{}",
            message(&output)
        );
        assert!(!out.exists());
        let output = render("17000x30");
        assert_eq!(output.status.code(), Some(0), "{}", message(&output));
        let picture = read_png(&out).unwrap();
        assert_eq!(picture.dimensions(), (17_000, 30));
        let dark = picture.pixels().filter(|pixel| pixel.0[0] < 100).count();
        assert!(dark > 20, "too little of the cube: {dark} dark pixels");
    }

    #[test]
    fn an_unknown_adapter_names_those_there_are() {
        let output = viewer(&["render", &cube(), "-o", "a.png", "--adapter", "no such"]);
        assert_eq!(output.status.code(), Some(3), "{}", message(&output));
        assert!(message(&output).contains("there are: "), "{}", message(&output));
    }

    #[test]
    fn an_empty_picture_says_why() {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("a.png").display().to_string();
        let cube = cube();
        for (arguments, what) in [
            (
                &["--eye", "5,5,5", "--target", "9,9,9"][..],
                Some("no part of the scene is in sight"),
            ),
            (&["--clip", "0,0,1,-100"], Some("cut away all")),
            (&["--eye", "0,0,0.5", "--target", "0,0,1"], Some("draws nothing of what is in sight")),
            (&[], None),
        ] {
            let mut all = vec!["render", &cube, "-o", &out, "--size", "64x64"];
            all.extend(arguments);
            let output = viewer(&all);
            assert_eq!(output.status.code(), Some(0), "{}", message(&output));
            match what {
                Some(what) => assert!(message(&output).contains(what), "{}", message(&output)),
                None => assert_eq!(message(&output), ""),
            }
        }
    }
}
