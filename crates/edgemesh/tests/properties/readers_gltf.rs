//! Sound and broken glTF files of other projects: sound files load, broken files are reported, and
//! the reader never panics.

use std::path::{Path, PathBuf};
use std::{env, fs};

use edgemesh::format::read::{Format, ReadError, ReadErrorKind, read_model, read_model_bytes};
use edgemesh::model::{InstancedModel, Model};
use edgemesh::report::{Report, WarningCode};

/// Sound files that do not load, and why not.
const REFUSED: [(&str, ReadErrorKind, &str); 3] = [
    ("blender-io/00_empty_scene/00_empty_scene.gltf", ReadErrorKind::Empty, "nothing to draw"),
    ("gltf-transform/cli/ACMEBox.gltf", ReadErrorKind::Extension, "it requires an unknown one"),
    ("gltf-transform/functions/DenseSphere.glb", ReadErrorKind::Extension, "it requires Draco"),
];

/// Vertices and faces of some files: skinned, morphed, sparse, with many nodes.
const COUNTS: [(&str, usize, usize); 6] = [
    ("bevy/Fox.glb", 1728, 576),
    ("raylib/robot.glb", 7218, 3238),
    ("meshoptimizer/pirate.glb", 2887, 5010),
    // A plane, and 958 and 941 teapots of 4032 triangles.
    ("blender-io/24_gpu_instancing/24_gpu_instancing.gltf", 4_185_400, 7_656_770),
    ("blender-io/23_multi_prim_vertex_attribute/23_multi_prim_vertex_attribute.gltf", 8, 6),
    ("gltf-transform/functions/many-cubes.gltf", 12_024, 6012),
];

/// Sound files whose pictures are not in the corpus, which is their only warning.
const WITHOUT_PICTURES: [&str; 3] = [
    "blender-io/02_suzanne/02_suzanne.gltf",
    "tinygltf/CubeImageUriSpaces/CubeImageUriMultipleSpaces.gltf",
    "tinygltf/CubeImageUriSpaces/CubeImageUriSpaces.gltf",
];

/// Broken files of other projects, and their outcome.
const BROKEN: [(&str, &str); 14] = [
    ("assimp/BoxBadNormals-glTF-Binary/BoxBadNormals.glb", "ok"),
    ("assimp/BoxWithInfinites-glTF-Binary/BoxWithInfinites.glb", "error(number)"),
    ("assimp/IncorrectVertexArrays/Cube.gltf", "warn(syntax)"),
    ("assimp/RecursiveNodes/RecursiveNodes.gltf", "error(cycle)"),
    ("assimp/SchemaFailures/sceneWrongType.gltf", "error(syntax)"),
    ("assimp/TestNoRootNode/SceneWithoutNodes.gltf", "error(empty)"),
    ("assimp/wrongTypes/badObject.gltf", "error(syntax)"),
    ("assimp/wrongTypes/badString.gltf", "error(uri)"),
    ("meshoptimizer/fuzz.glb", "ok"),
    ("tinygltf/BoundsChecking/integer-out-of-bounds.gltf", "error(syntax)"),
    ("tinygltf/BoundsChecking/invalid-buffer-view-index.gltf", "error(empty)"),
    ("tinygltf/BoundsChecking/invalid-primitive-indices.gltf", "error(empty)"),
    ("tinygltf/issue-416.gltf", "error(format)"),
    ("tinygltf/regression/zero-sized-bin-chunk-issue-440.glb", "ok"),
];

/// Files that the validator passes and this reader does not, and why.
const JUDGED_OTHERWISE: [(&str, &str); 2] = [
    ("base/data/asset/min_version_valid.gltf", "it asks for a reader of version 2.1"),
    ("base/data/node/valid.gltf", "its vertices hang on joints without any weight"),
];

/// The number of places at which each file is cut.
const CUTS: usize = 40;

/// `EDGEMESH_SHARED`, else `../shared` beside the workspace: the folder of its
/// corpus.
fn corpus(cases: &str) -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    let folder = env::var_os("EDGEMESH_SHARED").map_or(beside, PathBuf::from).join("corpus");
    if folder.is_dir() {
        return Some(folder);
    }
    eprintln!("left out {cases}: set EDGEMESH_SHARED to the shared files");
    None
}

/// The glTF files in a folder and below, in order.
fn gltf_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(gltf_files(&path));
        } else if path.extension().is_some_and(|ending| ending == "gltf" || ending == "glb") {
            files.push(path);
        }
    }
    files.sort();
    files
}

/// The path of a file below `folder`, with slashes.
fn name_in(folder: &Path, file: &Path) -> String {
    file.strip_prefix(folder).unwrap().to_string_lossy().replace('\\', "/")
}

#[test]
fn sound_files_load_without_a_word() {
    let Some(corpus) = corpus("34 sound glTF files") else { return };
    let folder = corpus.join("gltf");
    let files = gltf_files(&folder);
    assert!(files.len() >= 34, "only {} files", files.len());
    let mut wrong = Vec::new();
    for file in &files {
        let name = name_in(&folder, file);
        let refused = REFUSED.iter().find(|(refused, ..)| *refused == name);
        match (read_model(file), refused) {
            (Ok((model, report)), None) => wrong.extend(judge_sound(&name, &model, &report)),
            (Err(error), Some((_, kind, _))) if error.kind == *kind => {}
            (Ok(_), Some((.., why))) => wrong.push(format!("{name} loads, although {why}")),
            (Err(error), _) => wrong.push(error.to_string()),
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The defect of the model of a sound file, if any.
fn judge_sound(name: &str, model: &Model, report: &Report) -> Option<String> {
    let warnings: Vec<WarningCode> = report.warnings().iter().map(|told| told.code).collect();
    let expected: &[WarningCode] =
        if WITHOUT_PICTURES.contains(&name) { &[WarningCode::Material] } else { &[] };
    if warnings != expected {
        return Some(format!("{name}: {:?}", report.warnings()));
    }
    let mut counts = (model.positions.len(), model.polygon_count());
    for InstancedModel { model, placements } in &model.instanced {
        counts.0 += placements.len() * model.positions.len();
        counts.1 += placements.len() * model.polygon_count();
    }
    let (_, vertices, faces) = COUNTS.iter().find(|(known, ..)| *known == name)?;
    (counts != (*vertices, *faces)).then(|| format!("{name}: {counts:?} vertices and faces"))
}

#[test]
fn broken_files_give_what_is_expected() {
    let Some(corpus) = corpus("13 glTF files that are broken on purpose") else { return };
    let folder = corpus.join("malformed/gen");
    let table = fs::read_to_string(folder.join("EXPECT.tsv")).unwrap();
    let rows = table.lines().filter(|row| row.starts_with("gltf/"));
    let mut wrong = Vec::new();
    let mut count = 0;
    for row in rows {
        let [name, _, expected, ..] = row.split('\t').collect::<Vec<_>>()[..] else { continue };
        count += 1;
        let read = || outcome(&read_model(&folder.join(name)));
        let found = read();
        let is_right = match expected {
            "either" => found == read() && found != "error(internal)",
            _ => found == expected,
        };
        if !is_right {
            wrong.push(format!("{name}: {found}, not {expected}"));
        }
    }
    assert!(count >= 12, "only {count} rows");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// In the words of the table of expectations.
fn outcome(result: &Result<(Model, Report), ReadError>) -> String {
    match result {
        Err(error) => format!("error({})", error.kind.as_str()),
        Ok((_, report)) => {
            let codes: Vec<&str> = report.warnings().iter().map(|w| w.code.as_str()).collect();
            if codes.is_empty() { "ok".into() } else { format!("warn({})", codes.join(" ")) }
        }
    }
}

#[test]
fn broken_files_of_others_are_told() {
    let Some(corpus) = corpus("broken glTF files of other projects") else { return };
    let folder = corpus.join("malformed/gltf");
    let mut wrong = Vec::new();
    for (name, expected) in BROKEN {
        let result = read_model(&folder.join(name));
        let found = outcome(&result);
        if found != expected {
            let why = result.err().map(|error| error.to_string()).unwrap_or_default();
            wrong.push(format!("{name}: {found}, not {expected} {why}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_validators_errors_are_told() {
    let Some(corpus) = corpus("the cases of the Khronos validator") else { return };
    let folder = corpus.join("malformed/gltf/khronos-validator");
    let files = gltf_files(&folder);
    assert!(files.len() > 150, "only {} files", files.len());
    let mut wrong = Vec::new();
    for file in &files {
        let name = name_in(&folder, file);
        let report = fs::read_to_string(format!("{}.report.json", file.display())).unwrap();
        let is_sound = report.contains("\"numErrors\": 0,");
        let found = outcome(&read_model(file));
        // Most of them have nothing to draw, or lack the file of their buffer.
        let is_right = match is_sound {
            true => ["ok", "warn(truncated)", "error(empty)", "error(uri)"].contains(&&*found),
            false => found != "ok",
        };
        let is_judged_otherwise = JUDGED_OTHERWISE.iter().any(|(file, _)| *file == name);
        if is_right == is_judged_otherwise {
            wrong.push(format!("{name}: {found}, sound: {is_sound}"));
        }
    }
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), files.len(), wrong.join("\n"));
}

#[test]
fn cut_and_flipped_files_do_no_harm() {
    let Some(corpus) = corpus("the glTF files, each cut at 40 places") else { return };
    let files = gltf_files(&corpus);
    assert!(files.len() > 200, "only {} files", files.len());
    let mut wrong = Vec::new();
    let mut judge = |file: &Path, how: String, bytes: &[u8]| {
        let result = read_model_bytes("test", bytes, Format::Gltf);
        let is_internal = result.as_ref().is_err_and(|error| error.kind == ReadErrorKind::Internal);
        let is_half = how.starts_with("cut") && bytes.starts_with(b"glTF") && result.is_ok();
        if is_internal || is_half {
            wrong.push(format!("{} {how}: {}", file.display(), outcome(&result)));
        }
    };
    for file in &files {
        let mut bytes = fs::read(file).unwrap();
        for cut in 0..CUTS {
            let end = bytes.len() * cut / CUTS;
            judge(file, format!("cut behind byte {end}"), &bytes[..end]);
        }
        // Spread over the file without a pattern.
        for flip in 0..CUTS.min(bytes.len()) {
            let at = flip * 7919 * 104_729 % bytes.len();
            bytes[at] ^= 1 << (flip % 8);
            judge(file, format!("with byte {at} flipped"), &bytes);
            bytes[at] ^= 1 << (flip % 8);
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
