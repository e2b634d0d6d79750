//! Runs `edgemesh info` and `edgemesh build` on every file of the shared corpus: no panic,
//! no signal, no process over its limits of time and memory; sound files load, and `info`
//! reports the same for a model and its edge mesh.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::{fs, thread};

use serde_json::Value;
use testkit::locate::{left_out, program, shared};

use crate::child::{json, run, stderr};
use crate::expectations::check_any;

/// The extensions of model files.
const ENDINGS: [&str; 9] = ["obj", "ply", "stl", "gltf", "glb", "wrl", "gz", "off", "3mf"];

/// The least number of files in the corpus.
const FILES: usize = 450;

/// The limit of a process: 1 GiB of addresses, which include memory.
const LIMIT_KIB: usize = 1 << 20;

/// Files in the folders of sound files that do not load, with the reasons.
const REFUSED: [(&str, &str); 17] = [
    ("gltf/blender-io/00_empty_scene/00_empty_scene.gltf", "no mesh in it"),
    ("gltf/gltf-transform/cli/ACMEBox.gltf", "requires an unknown extension"),
    ("gltf/gltf-transform/functions/DenseSphere.glb", "requires Draco"),
    ("obj/assimp/point_cloud.obj", "points without faces"),
    ("obj/assimp/testpoints.obj", "points without faces"),
    ("obj/tinyobjloader/issue-356-leading-spaces-newmtl.obj", "no geometry at all"),
    ("obj/tinyobjloader/points-prim.obj", "points without faces"),
    ("ply/assimp/points.ply", "points without faces"),
    ("ply/trimesh/points_ascii_with_lists.ply", "points without faces"),
    ("ply/trimesh/points_emptyface.ply", "points without faces"),
    (PROTO_NESTED, "prototypes only"),
    ("wrl/castle-demo-models/prototypes/proto_nodes.wrl", "prototypes and texts only"),
    ("wrl/castle-demo-models/prototypes/proto_nodes_by_external.wrl", "prototypes only"),
    ("wrl/castle-demo-models/vrml_1/inline_test.wrl", "inlined files that are not there"),
    ("wrl/castle-demo-models/vrml_1/relative_names.wrl", "inlined files that are not there"),
    ("wrl/castle-demo-models/vrml_1/subdir1/relative_inline2.wrl", "as before"),
    (LOAD_CONTROL, "a text and sensors only"),
];

const PROTO_NESTED: &str = "wrl/castle-demo-models/prototypes/proto_nested.wrl";
const LOAD_CONTROL: &str =
    "wrl/castle-demo-models/vrml_2/castle_extensions/inline_load_control_test_1.wrl";

/// All files under `folder` with one of the [`ENDINGS`], sorted.
fn models(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let ending = path.extension().and_then(OsStr::to_str).map(str::to_ascii_lowercase);
            if path.is_dir() {
                folders.push(path);
            } else if ending.is_some_and(|ending| ENDINGS.contains(&ending.as_str())) {
                files.push(path);
            }
        }
    }
    files.sort();
    files
}

/// Runs `edgemesh` with limits; the path goes last.
fn limited(arguments: &[&OsStr]) -> Output {
    let script = format!("ulimit -v {LIMIT_KIB} && exec \"$0\" \"$@\"");
    let mut command = Command::new("sh");
    command.args(["-c", &script]).arg(program("edgemesh")).args(arguments);
    // More threads and arenas take addresses, not memory.
    command.env("RAYON_NUM_THREADS", "2").env("MALLOC_ARENA_MAX", "1");
    run(command.stdout(Stdio::piped()))
}

fn info(path: &Path) -> Output {
    limited(&["info".as_ref(), "--json".as_ref(), path.as_os_str()])
}

/// Runs `work` for all `items` on every core; returns the results.
fn for_all<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let results = Mutex::new(Vec::new());
    let threads = thread::available_parallelism().map_or(2, usize::from);
    thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while let Some(item) = items.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let result = work(item);
                    results.lock().unwrap().push(result);
                }
            });
        }
    });
    results.into_inner().unwrap()
}

/// Runs both commands on a file; the error says what is wrong.
fn check_file(path: &Path) -> Result<(), String> {
    let info = info(path);
    check_any(&info)?;
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let target = folder.path().join("built.edgemesh");
    let built = limited(&[
        "build".as_ref(),
        path.as_os_str(),
        "-o".as_ref(),
        target.as_os_str(),
        "--quiet".as_ref(),
    ]);
    check_any(&built)?;
    if built.status.code() != info.status.code() {
        return Err(format!("info {:?} and build {:?}", info.status, built.status));
    }
    if info.status.code() != Some(0) {
        return if target.exists() { Err("a file was written".into()) } else { Ok(()) };
    }
    let (of_model, of_built) = (json(&info), json(&self::info(&target)));
    match (without_names(of_model), without_names(of_built)) {
        (a, b) if a == b => Ok(()),
        (a, b) => Err(format!("the edge mesh reports {b}, its model {a}")),
    }
}

/// The JSON without file names, which differ.
fn without_names(mut info: Value) -> Value {
    info["file"] = Value::Null;
    for list in ["warnings", "repair_places"] {
        for entry in info[list].as_array_mut().into_iter().flatten() {
            let place = entry["place"].as_str().unwrap_or_default();
            let behind_name = place.rsplit(':').next().unwrap_or_default().to_owned();
            entry["place"] = if place.contains(':') { behind_name.into() } else { Value::Null };
        }
    }
    info
}

#[test]
fn every_file_goes_through_both_commands() {
    let Some(shared) = shared() else { return left_out("files of the corpus", FILES) };
    let files = models(&shared.join("corpus"));
    assert!(files.len() >= FILES, "only {} files", files.len());
    let results = for_all(&files, |path| {
        check_file(path).map_err(|why| format!("{}: {why}", path.display())).err()
    });
    let wrong: Vec<String> = results.into_iter().flatten().collect();
    assert!(wrong.is_empty(), "{} of {} files:\n{}", wrong.len(), files.len(), wrong.join("\n"));
}

#[test]
fn sound_files_load() {
    let Some(shared) = shared() else { return left_out("sound files", FILES) };
    let mut refused = Vec::new();
    for format in ["obj", "ply", "stl", "gltf", "wrl"] {
        let folder = shared.join("corpus").join(format);
        let files = models(&folder);
        let of_format: Vec<(String, String)> = for_all(&files, |path| {
            let output = info(path);
            let name = path.strip_prefix(&folder).unwrap().display().to_string();
            let is_refused = output.status.code() != Some(0);
            is_refused.then(|| (format!("{format}/{name}"), stderr(&output)))
        })
        .into_iter()
        .flatten()
        .collect();
        eprintln!(
            "{format}: {} of {} sound files load",
            files.len() - of_format.len(),
            files.len()
        );
        refused.extend(of_format);
    }
    refused.sort();
    for (name, why) in &refused {
        eprintln!("not read: {name}: {}", why.trim_end());
    }
    let names: Vec<&str> = refused.iter().map(|(name, _)| name.as_str()).collect();
    let expected: Vec<&str> = REFUSED.iter().map(|(name, _)| *name).collect();
    assert_eq!(names, expected, "these files do not load; the list has the known ones");
}
