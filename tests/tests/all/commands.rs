//! The contract of the commands: exit statuses, messages, JSON.

use std::ffi::{OsStr, OsString};
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;
use tempfile::TempDir;
use testkit::locate::program;

use crate::child::{edgemesh, json, one_error, run, stderr};

/// A sound cube of six quads, which causes no warnings.
const CUBE: &str = "\
v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 1 5 8 4\n";

/// A duplicate triangle, and two faces with a NaN.
const BROKEN: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\nf 1 2 3\nf 1 2 3\nf 1 2 4\nf 1 2 3 4\n";

/// A folder with the file `name`; it lasts as long as the first value.
fn file(name: impl AsRef<Path>, bytes: &[u8]) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    (folder, path)
}

fn info_with(path: &Path, arguments: &[&str]) -> Output {
    let mut all: Vec<&OsStr> = vec![OsStr::new("info"), path.as_os_str()];
    all.extend(arguments.iter().map(OsStr::new));
    edgemesh(&all)
}

fn assert_status(output: &Output, status: i32) {
    assert_eq!(output.status.code(), Some(status), "{output:?}");
}

/// Asserts that a file is refused with one message that contains its name and `part`.
fn assert_refused(path: &Path, part: &str) {
    let output = info_with(path, &[]);
    assert_status(&output, 1);
    assert_eq!(one_error(&output, &[&path.display().to_string(), part]), Ok(()), "{output:?}");
    assert!(output.stdout.is_empty(), "a failure has no results: {output:?}");
}

#[test]
fn wrong_command_lines_end_with_2_and_say_why() {
    let (_folder, cube) = file("cube.obj", CUBE.as_bytes());
    let cases: [(&[&str], &str); 12] = [
        (&["--eye", "1,2"], "--eye"),
        (&["--eye", "1,2,x"], "--eye"),
        (&["--eye", "1,nan,0"], "--eye"),
        (&["--eye", "1,2,3", "--target", "1,2,3"], "--target"),
        (&["--eye", "0,5,0", "--target", "0,0,0", "--up", "0,1,0"], "--up"),
        (&["--fov", "180"], "--fov"),
        (&["--crease", "-1"], "-1"),
        (&["--crease", "20", "--ridge", "20"], "--ridge"),
        (&["--frobnicate"], "--frobnicate"),
        (&["--weld=-1"], "--weld"),
        (&["--weld", "1", "--no-weld"], "--no-weld"),
        (&["--format", "dxf"], "--format"),
    ];
    for (arguments, part) in cases {
        let output = info_with(&cube, arguments);
        assert_status(&output, 2);
        let message = stderr(&output);
        assert!(message.starts_with("error: "), "{arguments:?}: {message}");
        assert!(message.contains(part), "{arguments:?}: {message}");
        assert!(output.stdout.is_empty(), "{output:?}");
    }
}

/// A value that begins with a hyphen is a wrong value, not an unknown option.
#[test]
fn negative_values_are_out_of_range() {
    let (_folder, cube) = file("cube.obj", CUBE.as_bytes());
    let cases = [("--weld", "0 or more"), ("--fov", "0.001 to 179"), ("--ridge", "0 to 180")];
    for (option, range) in cases {
        let output = info_with(&cube, &[option, "-10"]);
        assert_status(&output, 2);
        let message = stderr(&output);
        assert!(message.contains("'-10'") && message.contains(range), "{message}");
        assert!(!message.contains("tip:"), "{message}");
    }
}

#[test]
fn good_models_are_printed_beside_bad_ones() {
    let (folder, cube) = file("cube.obj", CUBE.as_bytes());
    let bad = folder.path().join("bad.obj");
    fs::write(&bad, "v 0 0 0\nv 1 x 0\n").unwrap();
    let names = [bad.to_str().unwrap(), cube.to_str().unwrap()];
    let output = info_with(&cube, &names);
    assert_status(&output, 1);
    assert_eq!(one_error(&output, &["bad.obj:2"]), Ok(()), "{output:?}");
    let text = String::from_utf8_lossy(&output.stdout);
    assert_eq!(text.matches("cube.obj\nvertices").count(), 2, "{text}");
    let output = info_with(&cube, &[names[0], "--json"]);
    assert_status(&output, 1);
    let list = json(&output);
    assert_eq!(list.as_array().map(Vec::len), Some(1), "a list, because several were named");
    assert_eq!(list[0]["triangles"], 12);
}

#[test]
fn a_command_line_without_a_command_is_wrong() {
    let cases: [&[&str]; 4] = [&[], &["info"], &["frobnicate"], &["--frobnicate"]];
    for arguments in cases {
        let output = edgemesh(arguments);
        assert_status(&output, 2);
        let message = stderr(&output);
        assert!(message.contains("Usage: edgemesh"), "{arguments:?}: {message}");
    }
}

#[test]
fn help_and_version_go_to_standard_output() {
    let cases: [(&[&str], &str); 8] = [
        (&["--help"], "validate"),
        (&["build", "--help"], "--layout"),
        (&["export", "--help"], "--to"),
        (&["validate", "--help"], "--strict"),
        (&["-h"], "export"),
        (&["info", "--help"], "--crease"),
        (&["help", "info"], "--crease"),
        (&["--version"], "edgemesh "),
    ];
    for (arguments, part) in cases {
        let output = edgemesh(arguments);
        assert_status(&output, 0);
        let text = String::from_utf8_lossy(&output.stdout);
        assert!(text.contains(part), "{arguments:?}: {text}");
        assert!(output.stderr.is_empty(), "{output:?}");
    }
}

#[test]
fn what_is_no_model_is_named() {
    let folder = tempfile::tempdir().unwrap();
    assert_refused(&folder.path().join("missing.obj"), "cannot be read");
    assert_refused(folder.path(), "is a folder");
    assert_refused(&folder.path().join("cube.obj").join("cube.obj"), "cannot be read");
}

#[test]
fn other_formats_under_obj_are_named() {
    let iges = format!("{:<72}S      1\n", "a part of our own");
    let cases: [(&[u8], &str); 18] = [
        (b"ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('AP214'));\n", "a STEP model: convert it"),
        (b"ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('IFC4'));\n", "an IFC model: convert it"),
        (iges.as_bytes(), "an IGES model: convert it"),
        (b"0\nSECTION\n2\nENTITIES\n", "a DXF drawing: convert it"),
        (b"# vtk DataFile Version 3.0\n", "a VTK data set: save it"),
        (b"<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\">", "a VTK data set: save it"),
        (b"#usda 1.0\n", "a USD model: convert it"),
        (b"<?xml version=\"1.0\"?>\n<COLLADA>", "a COLLADA model: convert it"),
        (b"<?xml version=\"1.0\"?>\n<X3D>", "an X3D model: convert it"),
        (b"#X3D V3.3 utf8\n", "an X3D model: convert it"),
        (b"; FBX 7.4.0 project file\n", "an FBX model: convert it"),
        (b"0 A brick\n3 16 0 0 0 1 0 0 0 1 0\n", "an LDraw model: convert it"),
        (b"#Inventor V2.1 ascii\n", "an Open Inventor model: convert it"),
        (b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR", "a PNG picture"),
        (b"<!DOCTYPE html>\n<html><body>404</body></html>\n", "HTML"),
        (b"\x1f\x8b\x08\0\0\0\0\0", "gzip"),
        (b"version https://git-lfs.github.com/spec/v1\noid sha256:00\n", "Git LFS"),
        (b"v 0 0 0\nv 1 0 0\0\n", "binary data"),
    ];
    for (bytes, what) in cases {
        let (_folder, path) = file("model.obj", bytes);
        assert_refused(&path, what);
    }
}

#[test]
fn warnings_are_said_once_and_q_silences_them() {
    let (_folder, broken) = file("broken.obj", BROKEN.as_bytes());
    let output = info_with(&broken, &["--json"]);
    assert_status(&output, 0);
    let message = stderr(&output);
    for (line, code) in [(6, "duplicate"), (4, "nonfinite")] {
        let start = format!("{}:{line}: warning: ", broken.display());
        let found: Vec<&str> =
            message.lines().filter(|text| text.ends_with(&format!("[{code}]"))).collect();
        assert_eq!(found.len(), 1, "{code} once in {message:?}");
        assert!(found[0].starts_with(&start), "{found:?}");
    }
    let warnings = json(&output)["warnings"].clone();
    assert_eq!(warnings.as_array().unwrap().len(), message.lines().count(), "{warnings}");

    let quiet = info_with(&broken, &["--json", "-q"]);
    assert_status(&quiet, 0);
    assert!(quiet.stderr.is_empty(), "{quiet:?}");
    assert_eq!(quiet.stdout, output.stdout, "the results are the same");
}

#[test]
fn sound_models_give_results_and_no_messages() {
    let (_folder, cube) = file("cube.obj", CUBE.as_bytes());
    let output = info_with(&cube, &[]);
    assert_status(&output, 0);
    assert!(output.stderr.is_empty(), "{output:?}");
    let text = String::from_utf8_lossy(&output.stdout);
    for (name, count) in [("edges", "18"), ("diagonals", "6"), ("ridge", "12")] {
        let row = text.lines().find(|line| line.trim_start().starts_with(name)).unwrap();
        assert_eq!(row.split_whitespace().nth(1), Some(count), "{row}");
    }
}

#[test]
fn lines_are_counted_however_they_end() {
    for line_end in ["\n", "\r\n", "\r"] {
        let text = ["# comment", "v 0 0 0", "v 1 0 0", "v 0 1 0", "f 1 2 7", ""].join(line_end);
        let (_folder, path) = file("broken.obj", text.as_bytes());
        assert_refused(&path, "broken.obj:5: ");
    }
}

#[test]
fn a_byte_order_mark_is_no_part_of_the_first_line() {
    let (_folder, cube) = file("cube.obj", format!("\u{feff}{CUBE}").as_bytes());
    assert_eq!(json(&info_with(&cube, &["--json"]))["vertices"].as_u64(), Some(8));
}

#[test]
fn models_far_from_the_origin_are_recentered_and_keep_their_place() {
    for (offset, is_recentered) in [(0, 0), (1000, 0), (4_000_000_000_u32, 1)] {
        let text = format!("v {offset}.5 0 0\nv {} 0 0\nv {offset}.5 1 0\nf 1 2 3\n", offset + 1);
        let (_folder, path) = file("far.obj", text.as_bytes());
        let info = json(&info_with(&path, &["--json"]));
        assert_eq!(info["warnings"].as_array().unwrap().len(), 0, "{info}");
        assert_eq!(info["repairs"]["recentred"].as_u64(), Some(is_recentered), "{info}");
        let bounds = &info["bounds"];
        assert_eq!(bounds["min"][0].as_f64(), Some(f64::from(offset) + 0.5), "{bounds}");
        assert_eq!(bounds["max"][0].as_f64(), Some(f64::from(offset) + 1.0), "{bounds}");
    }
}

#[test]
fn json_has_the_keys_that_scripts_rely_on() {
    let (_folder, broken) = file("broken.obj", BROKEN.as_bytes());
    let info = json(&info_with(&broken, &["--json"]));
    let counts = [
        "vertices",
        "welded_vertices",
        "triangles",
        "degenerate_triangles",
        "duplicate_triangles",
        "edges",
        "diagonal_edges",
        "boundary_edges",
        "non_manifold_edges",
        "inconsistent_edges",
        "components",
        "records",
    ];
    assert_counts(&info, &counts);
    assert_counts(&info["bytes"], &["input", "indexed", "replicated_f32", "replicated_i16"]);
    assert_counts(&info["chains"], &["count", "loops", "edges", "longest"]);
    let source = [
        "vertices",
        "polygons",
        "triangles",
        "edges",
        "boundary_edges",
        "non_manifold_edges",
        "inconsistent_edges",
    ];
    assert_counts(&info["source"], &source);
    let features = ["contour", "ridge", "valley", "boundary", "marked", "material", "smoothing"];
    assert_counts(&info["features"], &features);
    assert_eq!(info["file"].as_str(), broken.to_str());
    for corner in ["min", "max"] {
        let corner = info["bounds"][corner].as_array().unwrap();
        assert!(corner.len() == 3 && corner.iter().all(Value::is_number), "{corner:?}");
    }
    let warnings = info["warnings"].as_array().unwrap();
    assert!(!warnings.is_empty(), "the file is broken: {info}");
    for warning in warnings {
        assert_counts(warning, &["count"]);
        let place = warning["place"].as_str().unwrap();
        assert!(warning["code"].is_string() && place.contains("broken.obj:"), "{warning}");
    }
}

fn assert_counts(object: &Value, keys: &[&str]) {
    for key in keys {
        assert!(object[key].is_u64(), "{key:?} is a count in {object}");
    }
}

#[test]
fn counts_of_a_cube_follow_the_options() {
    let (_folder, cube) = file("cube.obj", CUBE.as_bytes());
    let features = |arguments: &[&str]| {
        let output = info_with(&cube, &[&["--json"], arguments].concat());
        json(&output)["features"].clone()
    };
    let ridges = |arguments: &[&str]| features(arguments)["ridge"].as_u64();
    assert_eq!(ridges(&[]), Some(12));
    assert_eq!(ridges(&["--crease", "89"]), Some(12));
    assert_eq!(ridges(&["--crease", "91"]), Some(0));
    assert_eq!(ridges(&["--ridge", "91", "--valley", "10"]), Some(0));
    // Three faces are visible from a corner, one from straight ahead.
    assert_eq!(features(&[])["contour"].as_u64(), Some(6));
    let ahead = ["--eye", "0.5,0.5,9", "--target", "0.5,0.5,0.5"];
    assert_eq!(features(&ahead)["contour"].as_u64(), Some(4));
    let parallel = [&ahead[..], &["--ortho"]].concat();
    assert_eq!(features(&parallel)["contour"].as_u64(), Some(4));
    // From the side the eye sees two faces, in parallel projection only one.
    let aside = ["--eye=9,0.5,9", "--target=9,0.5,0.5"];
    assert_eq!(features(&aside)["contour"].as_u64(), Some(6));
    assert_eq!(features(&[&aside[..], &["--ortho"]].concat())["contour"].as_u64(), Some(4));
}

/// Runs `edgemesh info --json cube.obj` in a shell, which can close its output.
#[cfg(unix)]
fn info_in_shell(redirection: &str) -> Output {
    let (_folder, cube) = file("cube.obj", CUBE.as_bytes());
    let script = format!("exec \"$0\" info --json \"$1\" {redirection}");
    run(Command::new("sh").args(["-c", &script]).arg(program("edgemesh")).arg(&cube))
}

#[cfg(unix)]
#[test]
fn a_closed_output_ends_quietly() {
    let (_folder, cube) = file("cube.obj", CUBE.as_bytes());
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let mut command = Command::new(program("edgemesh"));
    let output = run(command.arg("info").arg(&cube).stdout(writer));
    assert_status(&output, 0);
    assert!(output.stderr.is_empty(), "{output:?}");

    let output = info_in_shell(">&-");
    assert!(matches!(output.status.code(), Some(0 | 1)), "{output:?}");
    assert!(!stderr(&output).contains("panic"), "{output:?}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error() {
    let output = info_in_shell(">/dev/full");
    assert_status(&output, 1);
    assert_eq!(one_error(&output, &["standard output", "No space"]), Ok(()));
}

#[cfg(target_os = "linux")]
#[test]
fn endless_input_is_refused() {
    assert_refused(Path::new("/dev/zero"), "a device, not a regular file");
}

#[cfg(target_os = "linux")]
#[test]
fn a_path_may_be_any_bytes() {
    use std::os::unix::ffi::OsStringExt as _;
    let name = OsString::from_vec(b"cube-\xff.obj".to_vec());
    let (_folder, cube) = file(name, CUBE.as_bytes());
    let output = info_with(&cube, &["--json"]);
    assert_status(&output, 0);
    assert_eq!(json(&output)["source"]["polygons"].as_u64(), Some(6));
}

/// A pipe may wait for its writer forever, so only standard input is read as a stream.
#[cfg(target_os = "linux")]
#[test]
fn a_model_comes_through_a_pipe_as_standard_input_only() {
    let run_with_cube = |script: &str| {
        let (reader, mut writer) = std::io::pipe().unwrap();
        writer.write_all(CUBE.as_bytes()).unwrap();
        drop(writer);
        let mut command = Command::new("sh");
        command.args(["-c", script]).arg(program("edgemesh"));
        command.stdin(reader).output().unwrap()
    };
    let output = run_with_cube("exec \"$0\" info - --format obj");
    assert_status(&output, 0);
    assert!(String::from_utf8_lossy(&output.stdout).contains("polygons"), "{output:?}");
    let output = run_with_cube("exec \"$0\" info /dev/fd/3 3<&0");
    assert_status(&output, 1);
    assert_eq!(one_error(&output, &["/dev/fd/3: ", "a pipe, not a regular file"]), Ok(()));
}

/// Opening a pipe without a writer would wait forever.
#[cfg(unix)]
#[test]
fn a_pipe_without_a_writer_is_refused_at_once() {
    let (folder, cube) = file("cube.obj", CUBE.as_bytes());
    let pipe = folder.path().join("pipe.obj");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    assert_refused(&pipe, "a pipe, not a regular file");
    let output = info_with(&cube, &["--marks", pipe.to_str().unwrap()]);
    assert_eq!(one_error(&output, &["pipe.obj: ", "a pipe, not a regular file"]), Ok(()));
    let output = info_with(&pipe, &["--format", "edgemesh"]);
    assert_eq!(one_error(&output, &["pipe.obj: ", "a pipe, not a regular file"]), Ok(()));
}
