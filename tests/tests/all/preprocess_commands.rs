//! `edgemesh build`, `export` and `validate`, and what all commands share: several inputs,
//! standard input, marks, welding, `--strict`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use serde_json::Value;
use tempfile::TempDir;
use testkit::locate::program;

use crate::child::{edgemesh, json, one_error, run, stderr};

/// A cube of six quads with two materials and a line along one edge.
const CUBE: &str = "\
v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
usemtl a\nf 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nusemtl b\nf 3 4 8 7\nf 2 3 7 6\nf 1 5 8 4\nl 1 2\n";

/// A duplicate triangle.
const TWICE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 3\n";

/// A folder with files of the given names and texts.
fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

/// Runs `edgemesh` in a folder.
fn in_folder(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(program("edgemesh"));
    run(command.args(arguments).current_dir(folder).stdout(Stdio::piped()))
}

fn info(folder: &Path, arguments: &[&str]) -> Value {
    let output = in_folder(folder, &[&["info", "--json"], arguments].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    json(&output)
}

fn assert_status(output: &Output, status: i32) {
    assert_eq!(output.status.code(), Some(status), "{output:?}");
}

/// The names of the files in a folder, sorted.
fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let name = |entry: std::io::Result<fs::DirEntry>| entry.unwrap().file_name();
    let mut names: Vec<String> = entries.map(|entry| name(entry).into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn an_edge_mesh_says_what_its_model_says_by_any_threshold() {
    let folder = folder(&[("cube.obj", CUBE)]);
    let folder = folder.path();
    assert_status(&in_folder(folder, &["build", "cube.obj", "-o", "cube.edgemesh"]), 0);
    for arguments in [&[][..], &["--crease", "91"], &["--ridge", "10"], &["--eye", "9,8,7"]] {
        let mut of_model = info(folder, &[arguments, &["cube.obj"]].concat());
        let mut of_built = info(folder, &[arguments, &["cube.edgemesh"]].concat());
        (of_model["file"], of_built["file"]) = (Value::Null, Value::Null);
        assert_eq!(of_model, of_built, "{arguments:?}");
    }
    let cube = info(folder, &["cube.edgemesh"]);
    let feature = |name: &str| cube["features"][name].as_u64();
    assert_eq!(
        (feature("ridge"), feature("marked"), feature("material")),
        (Some(12), Some(1), Some(8))
    );
}

#[test]
fn layouts_are_added_to_the_file() {
    let folder = folder(&[("cube.obj", CUBE)]);
    let folder = folder.path();
    let size = |arguments: &[&str]| {
        let all = [&["build", "cube.obj", "-o", "cube.edgemesh"], arguments].concat();
        assert_status(&in_folder(folder, &all), 0);
        fs::metadata(folder.join("cube.edgemesh")).unwrap().len()
    };
    let indexed = size(&[]);
    assert_eq!(size(&["--layout", "indexed"]), indexed);
    let edges = 18;
    let f32_extra = size(&["--layout", "replicated-f32"]) - indexed;
    assert!((edges * 320..edges * 320 + 64).contains(&f32_extra), "{f32_extra}");
    let both = size(&["--layout", "replicated-f32", "--layout", "replicated-i16"]) - indexed;
    assert!((edges * 480..edges * 480 + 128).contains(&both), "{both}");
    assert_eq!(info(folder, &["cube.edgemesh"])["edges"].as_u64(), Some(edges));
}

#[test]
fn several_models_go_into_a_folder() {
    let folder = folder(&[("a.obj", CUBE), ("b.obj", TWICE)]);
    let folder = folder.path();
    fs::create_dir(folder.join("out")).unwrap();
    let built = in_folder(folder, &["build", "a.obj", "b.obj", "-o", "out", "-q"]);
    assert_status(&built, 0);
    assert_eq!(names(&folder.join("out")), ["a.edgemesh", "b.edgemesh"]);
    let infos = info(folder, &["out/a.edgemesh", "out/b.edgemesh"]);
    let triangles = |at: usize| infos[at]["triangles"].as_u64();
    assert_eq!((triangles(0), triangles(1)), (Some(12), Some(2)));
    let no_folder = in_folder(folder, &["build", "a.obj", "b.obj", "-o", "none.edgemesh"]);
    assert_status(&no_folder, 2);
}

#[test]
fn nothing_is_written_where_something_is_wrong() {
    let folder = folder(&[("broken.obj", "v 0 0 0\nf 1 2 3\n"), ("cube.obj", CUBE)]);
    let folder = folder.path();
    for target in ["x.edgemesh", "x.glb"] {
        let verb = if target.ends_with("glb") { "export" } else { "build" };
        let output = in_folder(folder, &[verb, "broken.obj", "-o", target]);
        assert_status(&output, 1);
        assert_eq!(one_error(&output, &["broken.obj:2"]), Ok(()));
    }
    assert_status(&in_folder(folder, &["build", "cube.obj", "-o", "cube.obj"]), 2);
    assert_status(&in_folder(folder, &["export", "cube.obj", "-o", "cube.xyz"]), 2);
    assert_status(&in_folder(folder, &["build", "cube.obj", "-o", "none/x.edgemesh"]), 1);
    assert_eq!(names(folder), ["broken.obj", "cube.obj"]);
}

#[test]
fn a_damaged_edge_mesh_is_an_error() {
    let folder = folder(&[("cube.obj", CUBE)]);
    let folder = folder.path();
    assert_status(&in_folder(folder, &["build", "cube.obj", "-o", "cube.edgemesh"]), 0);
    let path = folder.join("cube.edgemesh");
    let bytes = fs::read(&path).unwrap();
    for at in [9, 100, bytes.len() / 2, bytes.len() - 1] {
        let mut damaged = bytes.clone();
        damaged[at] ^= 4;
        fs::write(&path, &damaged).unwrap();
        let output = in_folder(folder, &["info", "cube.edgemesh"]);
        assert_status(&output, 1);
        assert_eq!(one_error(&output, &["cube.edgemesh"]), Ok(()), "byte {at}");
    }
    fs::write(&path, &bytes[..bytes.len() - 5]).unwrap();
    assert_status(&in_folder(folder, &["info", "cube.edgemesh"]), 1);
}

#[cfg(target_os = "linux")]
#[test]
fn an_endless_edge_mesh_is_refused() {
    let shell = |script: &str| {
        let script = format!("ulimit -v 1048576; exec {script}");
        let mut command = Command::new("sh");
        command.args(["-c", &script]).arg(program("edgemesh")).env("RAYON_NUM_THREADS", "2");
        run(command.stdout(Stdio::piped()))
    };
    for (script, why) in [
        ("\"$0\" info --format edgemesh /dev/zero", "a device, not a regular file"),
        ("\"$0\" info --format edgemesh - < /dev/zero", "is not an edge mesh"),
    ] {
        let output = shell(script);
        assert_status(&output, 1);
        assert_eq!(one_error(&output, &[why]), Ok(()), "{script}");
    }
}

#[test]
fn strict_makes_errors_of_warnings() {
    let folder = folder(&[("twice.obj", TWICE), ("cube.obj", CUBE)]);
    let folder = folder.path();
    for verb in ["info", "validate"] {
        assert_status(&in_folder(folder, &[verb, "twice.obj", "-q"]), 0);
        assert_status(&in_folder(folder, &[verb, "twice.obj", "--strict"]), 1);
        assert_status(&in_folder(folder, &[verb, "cube.obj", "--strict"]), 0);
    }
    let output = in_folder(folder, &["info", "twice.obj", "--strict"]);
    let message = stderr(&output);
    assert!(message.contains("error: twice.obj:5: a face that repeats another"), "{message}");
    assert!(message.trim_end().ends_with("[duplicate]"), "{message}");
    let built = in_folder(folder, &["build", "twice.obj", "-o", "x.edgemesh", "--strict"]);
    assert_status(&built, 1);
    assert!(!folder.join("x.edgemesh").exists());
}

#[test]
fn validate_tells_sound_files_from_others() {
    let files = [("twice.obj", TWICE), ("cube.obj", CUBE), ("broken.obj", "f 1 2 3\n")];
    let folder = folder(&files);
    let all = ["validate", "cube.obj", "twice.obj", "broken.obj"];
    let output = in_folder(folder.path(), &all);
    assert_status(&output, 1);
    let text = String::from_utf8_lossy(&output.stdout);
    for line in [
        "cube.obj: sound",
        "twice.obj:5: warning: a face that repeats another was dropped [duplicate]",
        "twice.obj: usable, with warnings",
        "broken.obj: cannot be used",
    ] {
        assert!(text.lines().any(|other| other == line), "{line:?} is not in {text}");
    }
    assert!(text.contains("error: broken.obj:1: "), "{text}");
    let output = in_folder(folder.path(), &[&all[..], &["--json"]].concat());
    assert_status(&output, 1);
    let verdicts = json(&output);
    let status = |at: usize| verdicts[at]["status"].as_str();
    assert_eq!([status(0), status(1), status(2)], ["sound", "warnings", "error"].map(Some));
}

#[test]
fn standard_input_needs_a_format_and_standard_output_works() {
    let folder = folder(&[("cube.obj", CUBE)]);
    let shell = |script: &str| {
        let mut command = Command::new("sh");
        command.args(["-c", script]).arg(program("edgemesh")).current_dir(folder.path());
        run(command.stdout(Stdio::piped()))
    };
    assert_status(&shell("\"$0\" info - < cube.obj"), 2);
    let output = shell("\"$0\" info - --format obj --json < cube.obj");
    assert_eq!(json(&output)["triangles"].as_u64(), Some(12));
    let output = shell(
        "\"$0\" build - --format obj -o - < cube.obj | \"$0\" info - --format edgemesh --json",
    );
    assert_eq!(json(&output)["triangles"].as_u64(), Some(12), "{}", stderr(&output));
}

#[test]
fn marks_come_from_a_side_file() {
    let files =
        [("cube.obj", CUBE), ("marks", "# two\n3 4\n2 3\n"), ("far", "1 7\n"), ("bad", "1\n")];
    let folder = folder(&files);
    let folder = folder.path();
    let cube = info(folder, &["cube.obj", "--marks", "marks"]);
    assert_eq!(cube["features"]["marked"].as_u64(), Some(3));
    let far = info(folder, &["cube.obj", "--marks", "far", "-q"]);
    assert_eq!(far["warnings"][0]["code"].as_str(), Some("mark"));
    let output = in_folder(folder, &["info", "cube.obj", "--marks", "bad"]);
    assert_status(&output, 1);
    assert_eq!(one_error(&output, &["bad:1: "]), Ok(()));
    #[cfg(target_os = "linux")]
    {
        let output = in_folder(folder, &["info", "cube.obj", "--marks", "/dev/zero"]);
        assert_status(&output, 1);
        assert_eq!(one_error(&output, &["/dev/zero: ", "a device"]), Ok(()));
    }
}

/// A link could make a command read, and quote, any file.
#[cfg(unix)]
#[test]
fn marks_beside_a_model_are_not_read_through_a_link_out_of_its_folder() {
    use std::os::unix::fs::symlink;
    let outer = folder(&[("outside", "3 4\nsecret\n")]);
    let folder = folder(&[("cube.obj", CUBE), ("inside", "3 4\n2 3\n")]);
    let (folder, side) = (folder.path(), folder.path().join("cube.obj.marks"));
    symlink(folder.join("inside"), &side).unwrap();
    let cube = info(folder, &["cube.obj"]);
    assert_eq!(cube["features"]["marked"].as_u64(), Some(3));
    fs::remove_file(&side).unwrap();
    symlink(outer.path().join("outside"), &side).unwrap();
    let cube = info(folder, &["cube.obj", "-q"]);
    assert_eq!(cube["features"]["marked"].as_u64(), Some(1));
    assert_eq!(cube["warnings"][0]["code"].as_str(), Some("uri"));
    let output = in_folder(folder, &["info", "cube.obj"]);
    assert!(stderr(&output).contains("out of the model's folder"), "{}", stderr(&output));
    assert!(!stderr(&output).contains("secret"), "{}", stderr(&output));
}

#[test]
fn a_tolerance_closes_cracks_and_no_weld_opens_seams() {
    let cracked =
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0.0001234\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 4 5 6\n";
    let folder = folder(&[("cracked.obj", cracked)]);
    let boundary = |arguments: &[&str]| {
        let info = info(folder.path(), &[&["cracked.obj"], arguments].concat());
        info["boundary_edges"].as_u64()
    };
    assert_eq!(boundary(&[]), Some(6));
    assert_eq!(boundary(&["--weld", "1e-3"]), Some(4));
    assert_eq!(boundary(&["--no-weld"]), Some(6));
}

#[test]
fn lines_without_faces_are_a_model() {
    let lines = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nl 1 2 3 4 1\n";
    let folder = folder(&[("lines.obj", lines)]);
    let info = info(folder.path(), &["lines.obj"]);
    let marked = info["features"]["marked"].as_u64();
    assert_eq!((info["triangles"].as_u64(), marked), (Some(0), Some(4)));
    assert_eq!(info["bounds"]["max"][0].as_f64(), Some(1.0));
}

#[test]
fn exports_come_back_with_their_edges() {
    let folder = folder(&[("cube.obj", CUBE)]);
    let folder = folder.path();
    for ending in ["glb", "gltf", "ply", "obj"] {
        let target = format!("out.{ending}");
        assert_status(&in_folder(folder, &["export", "cube.obj", "-o", &target]), 0);
        let info = info(folder, &[&target]);
        let classes = ["marked", "ridge"].map(|class| info["features"][class].as_u64());
        assert_eq!(info["triangles"].as_u64(), Some(12), "{ending}");
        assert_eq!(classes, [Some(1), Some(12)], "its line and its edges, {ending}");
    }
    assert_status(&in_folder(folder, &["export", "cube.obj", "-o", "out.json"]), 0);
    let text = fs::read_to_string(folder.join("out.json")).unwrap();
    let json: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(json["edges"].as_array().map(Vec::len), Some(18));
    let output = in_folder(folder, &["export", "cube.obj", "-o", "-", "--to", "json"]);
    assert_eq!(String::from_utf8_lossy(&output.stdout), text);
}

/// Such a file could not be read again.
#[test]
fn a_model_of_which_nothing_is_left_is_not_exported() {
    let point = "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n";
    let no_number = "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let folder = folder(&[("point.obj", point), ("one.obj", no_number)]);
    let folder = folder.path();
    for model in ["point.obj", "one.obj"] {
        for ending in ["glb", "gltf", "ply", "obj"] {
            let target = format!("out.{ending}");
            let output = in_folder(folder, &["export", "-q", model, "-o", &target]);
            assert_status(&output, 1);
            assert_eq!(one_error(&output, &[model, "no face and no line is left"]), Ok(()));
            assert!(!folder.join(target).exists(), "{model} {ending}");
        }
        assert_status(&in_folder(folder, &["export", "-q", model, "-o", "out.json"]), 0);
    }
}

#[test]
fn completions_and_manuals_come_from_the_same_definitions() {
    for program in ["edgemesh", "viewer"] {
        let run_program = |arguments: &[&str]| {
            let mut command = Command::new(testkit::locate::program(program));
            run(command.args(arguments).stdout(Stdio::piped()))
        };
        for shell in ["bash", "zsh", "fish"] {
            let output = run_program(&["completions", shell]);
            assert_status(&output, 0);
            assert!(String::from_utf8_lossy(&output.stdout).contains("crease"), "{shell}");
        }
        let output = run_program(&["man"]);
        assert!(String::from_utf8_lossy(&output.stdout).contains(".TH"), "{output:?}");
        let folder = tempfile::tempdir().unwrap();
        let path: PathBuf = folder.path().to_owned();
        assert_status(&run_program(&["man", "-o", path.to_str().unwrap()]), 0);
        assert!(names(&path).len() >= 3, "{:?}", names(&path));
    }
    assert_status(&edgemesh(&["completions", "cmd"]), 2);
}
