//! Borders: which file, folder and crate may name which, read from the source.
//!
//! The three tables below define staircases, doors and crates. Every name in a file, outside
//! its tests, is resolved to the file that defines it. The tests fail with the file and the
//! name if the tables do not allow it, or if files name each other in a circle.

mod manifest;
mod source;
mod tree;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use testkit::locate::workspace_root;

use self::tree::{Named, Tree, Use, circles};

/// The rooms of a crate: its top-level folders and files.
struct House {
    /// The name of the crate in code.
    name: &'static str,
    /// Its folder of source files.
    source: &'static str,
    /// Its rooms from the ground up. A room sees the rooms below its line; rooms on one
    /// line do not see each other.
    stairs: &'static [&'static [&'static str]],
}

const HOUSES: [House; 7] = [
    House {
        name: "edgemesh_shaders",
        source: "shaders/src",
        stairs: &[
            &["files"],  // WGSL texts, embedded
            &["source"], // imports resolved
        ],
    },
    House { name: "edgemesh_brushes", source: "brushes/src", stairs: &[] },
    House { name: "edgemesh_models", source: "models/src", stairs: &[] },
    House { name: "edgemesh_techniques", source: "techniques/src", stairs: &[] },
    House {
        name: "edgemesh",
        source: "crates/edgemesh/src",
        stairs: &[
            &["index", "report"],         // numbers of things; warnings
            &["model"],                   // polygons as files have them
            &["edge_mesh"],               // what is built and drawn
            &["line"],                    // classes and kinds of lines
            &["format", "build", "view"], // files; polygons to edges; a camera
            &["load"],                    // a file to an edge mesh
            &["arguments", "oracle"],     // options of commands; CPU twins for tests
            &["command"],
        ],
    },
    House {
        name: "strokes",
        source: "crates/strokes/src",
        stairs: &[
            &["gpu"],           // the device
            &["mesh", "style"], // what is drawn, and how
            &["view"],          // what one eye sees
            &["graph", "draw"], // edges to ribbons; passes
            &["render"],        // a frame
        ],
    },
    House {
        name: "viewer",
        source: "crates/viewer/src",
        stairs: &[
            &["watch", "technique"], // what a picture is made of, without a GPU
            &["error"],
            &["scene"],
            &["pass_graph"], // techniques on the GPU
            &["picture", "comparison"],
            &["arguments"], // a picture as a command line says it
            &["window"],
            &["command"],
        ],
    },
];

/// Rooms that only some of the rooms above see: a room, and those that see it. A crate
/// stands for all its rooms, `main` for its program.
const DOORS: &[(&str, &[&str])] = &[
    // The product uses twins only to measure against them.
    ("edgemesh/oracle", &["viewer/comparison"]),
    // Exit statuses and options belong to commands.
    ("edgemesh/command", &["edgemesh/main", "viewer/command", "viewer/main"]),
    ("edgemesh/arguments", &["edgemesh", "viewer/arguments", "viewer/window", "viewer/command"]),
    ("viewer/command", &["viewer/main"]),
    // The GPU crate knows no files.
    ("edgemesh/format", &["edgemesh", "viewer"]),
    ("edgemesh/load", &["edgemesh", "viewer"]),
    ("edgemesh/build", &["edgemesh", "viewer"]),
    // What is embedded has one reader.
    ("edgemesh_brushes", &["viewer"]),
    ("edgemesh_models", &["edgemesh/load"]),
    ("edgemesh_techniques", &["viewer/technique"]),
];

/// The rooms that know the options of commands.
const OPTIONS: &[&str] = &[
    "edgemesh/arguments",
    "edgemesh/command",
    "edgemesh/main",
    "viewer/arguments",
    "viewer/command",
    "viewer/main",
];

/// External crates and modules, and the only rooms that name them.
const CRATES: &[(&str, &[&str])] = &[
    ("wgpu", &["strokes", "viewer/error", "viewer/pass_graph", "viewer/picture", "viewer/window"]),
    ("naga", &["edgemesh_shaders", "viewer/technique"]),
    ("egui", &["viewer/window"]),
    ("eframe", &["viewer/window"]),
    ("egui_wgpu", &["viewer/window"]),
    ("egui_plot", &["viewer/window"]),
    ("rfd", &["viewer/window"]),
    ("zbus", &["viewer/window"]),
    ("notify", &["viewer/watch"]),
    ("clap", OPTIONS),
    ("std::process", &["edgemesh/command", "edgemesh/main", "viewer/command", "viewer/main"]),
    ("image", &["strokes", "viewer"]),
    // `strokes` reads and returns pixels: no files, no decoders.
    ("std::fs", &["edgemesh", "viewer"]),
    ("std::path", &["edgemesh", "viewer"]),
    ("std::env", &["edgemesh", "viewer"]),
    ("image::ImageReader", &["viewer"]),
    ("image::ImageDecoder", &["viewer"]),
    ("image::DynamicImage", &["viewer"]),
    ("image::codecs", &["viewer"]),
    ("image::load_from_memory", &["viewer"]),
    ("image::load_from_memory_with_format", &["viewer"]),
    ("image::open", &["viewer"]),
];

/// The room of a file, such as `viewer/window`; only the crate for its `lib.rs` and for files
/// outside the houses.
fn room_of(file: &str) -> String {
    for House { name, source, .. } in &HOUSES {
        if let Some(inner) = file.strip_prefix(source).and_then(|rest| rest.strip_prefix('/')) {
            let first = inner.split('/').next().unwrap_or(inner);
            return match first.trim_end_matches(".rs") {
                "lib" => (*name).to_owned(),
                room => format!("{name}/{room}"),
            };
        }
    }
    file.to_owned()
}

fn crate_of(room: &str) -> &str {
    room.split('/').next().unwrap_or(room)
}

/// Whether a list of rooms and crates contains a room.
fn has_room(rooms: &[&str], room: &str) -> bool {
    rooms.iter().any(|&known| known == room || known == crate_of(room))
}

/// The step of a room in its staircase; `None` for a crate's `lib.rs` and `main.rs`.
fn step_of(room: &str) -> Option<usize> {
    let (name, room) = room.split_once('/')?;
    let house = HOUSES.iter().find(|house| house.name == name)?;
    house.stairs.iter().position(|rooms| rooms.contains(&room))
}

/// The reason why one room may not see another.
fn forbidden_room(from: &str, to: &str) -> Option<&'static str> {
    let inside = crate_of(from) == crate_of(to);
    let few = DOORS.iter().find(|(room, _)| *room == to);
    let is_root = from == crate_of(from);
    if from == to || inside && is_root {
        return None;
    }
    if let (true, Some(from), Some(to)) = (inside, step_of(from), step_of(to)) {
        match from.cmp(&to) {
            std::cmp::Ordering::Less => return Some("is above it"),
            std::cmp::Ordering::Equal => return Some("is beside it"),
            std::cmp::Ordering::Greater => {}
        }
    }
    let is_let_in = few.is_none_or(|(_, guests)| has_room(guests, from));
    (!is_let_in).then_some("is closed to it")
}

/// Whether a path leads to or through a module of another crate, even if one crate exports
/// another, as in `eframe::wgpu`.
fn leads_to(path: &[String], wanted: &str) -> bool {
    let wanted: Vec<&str> = wanted.split("::").collect();
    path.starts_with(&wanted.iter().map(|&word| word.to_owned()).collect::<Vec<_>>())
        || wanted.len() == 1 && path.iter().any(|segment| *segment == wanted[0])
}

/// A line for each file and a name that it should not see.
fn crossings(uses: &BTreeSet<Use>) -> Vec<String> {
    let mut crossed: BTreeMap<(&str, String), BTreeSet<String>> = BTreeMap::new();
    for Use { from, to, .. } in uses {
        let room = room_of(from);
        let found = match to {
            Named::Item { file, .. } | Named::Module { file } => {
                let other = room_of(file);
                forbidden_room(&room, &other).map(|why| format!("{file}, but {other} {why}"))
            }
            Named::Foreign(path) => CRATES
                .iter()
                .find(|(wanted, rooms)| leads_to(path, wanted) && !has_room(rooms, &room))
                .map(|(wanted, _)| format!("{wanted}, which is closed to {room}")),
        };
        let name = match to {
            Named::Item { name, .. } => name.clone(),
            Named::Module { .. } => "the module".to_owned(),
            Named::Foreign(path) => path.join("::"),
        };
        if let Some(found) = found {
            crossed.entry((from, found)).or_default().insert(name);
        }
    }
    let line = |((from, found), names): ((&str, String), BTreeSet<String>)| {
        let names: Vec<String> = names.into_iter().collect();
        format!("{from} names {} of {found}", names.join(", "))
    };
    crossed.into_iter().map(line).collect()
}

/// The lines of each circle: its arrows with the names.
fn circle_lines(uses: &BTreeSet<Use>) -> Vec<String> {
    let mut lines = Vec::new();
    for circle in circles(uses) {
        let files: BTreeSet<&str> = circle.iter().map(|arrow| arrow.from.as_str()).collect();
        lines.push(format!("a circle of {} files:", files.len()));
        for arrow in circle {
            let names: Vec<&str> = arrow.names.iter().map(String::as_str).collect();
            lines.push(format!("    {} -> {}: {}", arrow.from, arrow.to, names.join(", ")));
        }
    }
    lines
}

/// The source files below a folder by their path from the root of the workspace.
fn sources(folder: &str) -> BTreeMap<String, String> {
    let mut files = BTreeMap::new();
    let mut open = vec![folder.to_owned()];
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(workspace_root().join(&folder)).into_iter().flatten() {
            let entry = entry.unwrap();
            let path = format!("{folder}/{}", entry.file_name().to_string_lossy());
            if entry.file_type().unwrap().is_dir() {
                open.push(path);
            } else if path.ends_with(".rs") {
                let text = fs::read_to_string(entry.path()).unwrap();
                files.insert(path, text);
            }
        }
    }
    files
}

/// The houses, read from the source; `None` if the tests run without it.
fn houses() -> Option<Tree> {
    if !workspace_root().join("Cargo.toml").is_file() {
        eprintln!("skipped the borders: no source in {}", workspace_root().display());
        return None;
    }
    let mut tree = Tree::default();
    for House { name, source, .. } in &HOUSES {
        let files = sources(source);
        tree.add_crate(Some(name), &format!("{source}/lib.rs"), &files).unwrap();
        let main = format!("{source}/main.rs");
        if files.contains_key(&main) {
            tree.add_crate(None, &main, &files).unwrap();
        }
    }
    Some(tree)
}

fn assert_none(lines: &[String]) {
    assert!(lines.is_empty(), "{} lines:\n{}", lines.len(), lines.join("\n"));
}

#[test]
fn no_files_name_each_other_in_a_circle() {
    let Some(tree) = houses() else { return };
    assert_none(&circle_lines(&tree.uses()));
}

#[test]
fn rooms_see_what_lies_below_them() {
    let Some(tree) = houses() else { return };
    assert_none(&crossings(&tree.uses()));
}

/// A line for each folder or file that has no place in a staircase, and each place without
/// a room.
#[test]
fn every_room_has_its_place() {
    let Some(tree) = houses() else { return };
    let files = tree.files();
    let rooms: BTreeSet<String> = files.iter().map(|file| room_of(file)).collect();
    let mut lines = Vec::new();
    for room in &rooms {
        let is_root = !room.contains('/') || room.ends_with("/main");
        if !is_root && step_of(room).is_none() {
            lines.push(format!("{room} has no place in HOUSES"));
        }
    }
    for House { name, stairs, .. } in &HOUSES {
        for room in stairs.iter().copied().flatten() {
            if !rooms.contains(&format!("{name}/{room}")) {
                lines.push(format!("HOUSES has a place for {name}/{room}, which does not exist"));
            }
        }
    }
    assert_none(&lines);
}

/// The checks see all files and resolve names to their definitions.
#[test]
fn the_source_is_read_whole() {
    let Some(tree) = houses() else { return };
    let (files, uses) = (tree.files(), tree.uses());
    assert!(files.len() > 250 && uses.len() > 3000, "{} files, {}", files.len(), uses.len());
    let is_known = |from: &str, file: &str, name: &str| {
        let to = Named::Item { file: file.to_owned(), name: name.to_owned() };
        uses.iter().any(|one| one.from == from && one.to == to)
    };
    // Through the `pub use self::mesh::EdgeMesh` of `edge_mesh/mod.rs`.
    let mesh = "crates/edgemesh/src/edge_mesh/mesh.rs";
    assert!(is_known("crates/edgemesh/src/build/mod.rs", mesh, "EdgeMesh"), "within a crate");
    assert!(is_known("crates/strokes/src/mesh/buffers.rs", mesh, "EdgeMesh"), "across crates");
}

/// A house in memory: files of `strokes` and `viewer`.
fn small_house(files: &[(&str, &str)]) -> BTreeSet<Use> {
    let files: BTreeMap<String, String> =
        files.iter().map(|&(file, text)| (file.to_owned(), text.to_owned())).collect();
    let mut tree = Tree::default();
    for name in ["strokes", "viewer"] {
        let root = format!("crates/{name}/src/lib.rs");
        if files.contains_key(&root) {
            tree.add_crate(Some(name), &root, &files).unwrap();
        }
    }
    tree.uses()
}

#[test]
fn a_circle_of_two_is_found_with_its_names() {
    let house = |back: &str| {
        small_house(&[
            ("crates/strokes/src/lib.rs", "pub mod mesh; pub mod view; pub use view::View;"),
            ("crates/strokes/src/mesh.rs", back),
            ("crates/strokes/src/view.rs", "use crate::mesh::Mesh; pub struct View(Mesh);"),
        ])
    };
    for back in [
        "pub struct Mesh(crate::view::View);",
        "use super::View; pub struct Mesh(View);",
        "use super::view; pub struct Mesh(view::View);",
        "use crate::view::{self as seen}; pub struct Mesh { list: Vec<seen::View> }",
        "pub struct Mesh; fn print() { println!(\"{}\", crate::view::View::new()) }",
        "pub struct Mesh; fn read() { use crate::view::View; }",
    ] {
        let lines = circle_lines(&house(back));
        let expected = [
            "a circle of 2 files:",
            "    crates/strokes/src/mesh.rs -> crates/strokes/src/view.rs: View",
            "    crates/strokes/src/view.rs -> crates/strokes/src/mesh.rs: Mesh",
        ];
        assert_eq!(lines, expected, "{back}");
    }
    for back in [
        "pub struct Mesh;",
        "/// Seen by [`crate::view::View`].\npub struct Mesh;",
        "pub struct Mesh; #[cfg(test)] mod tests { use crate::view::View; }",
        "pub struct Mesh; #[cfg(test)] use crate::view::View;",
        "pub struct Mesh; fn of(view: &str) -> &str { view }",
        "pub use crate::view::View; pub struct Mesh;",
    ] {
        assert_none(&circle_lines(&house(back)));
    }
}

/// Items of a folder's `mod.rs` make no circle with the files in it.
#[test]
fn a_folder_may_share_what_its_mod_rs_defines() {
    let uses = small_house(&[
        ("crates/strokes/src/lib.rs", "pub mod gpu;"),
        ("crates/strokes/src/gpu/mod.rs", "mod timer; pub struct Gpu(timer::Timer);"),
        ("crates/strokes/src/gpu/timer.rs", "use super::Gpu; pub struct Timer(Gpu);"),
    ]);
    assert_none(&circle_lines(&uses));
}

#[test]
fn a_room_that_looks_up_or_aside_is_found() {
    let cases = [
        (
            "use crate::view::View;",
            "names View of crates/strokes/src/view.rs, but strokes/view is above it",
        ),
        (
            "use crate::view;",
            "names the module of crates/strokes/src/view.rs, but strokes/view is above it",
        ),
        (
            "pub use crate::view::View;",
            "names View of crates/strokes/src/view.rs, but strokes/view is above it",
        ),
        (
            "fn of(_: super::style::Style) {}",
            "names Style of crates/strokes/src/style.rs, but strokes/style is beside it",
        ),
        ("use std::fs;", "names std::fs of std::fs, which is closed to strokes/mesh"),
        (
            "use std::{fs::File, io};",
            "names std::fs::File of std::fs, which is closed to strokes/mesh",
        ),
        (
            "fn of() { let _ = image::open(\"a\"); }",
            "names image::open of image::open, which is closed to strokes/mesh",
        ),
        ("use egui::Color32;", "names egui::Color32 of egui, which is closed to strokes/mesh"),
        ("use crate::gpu::Gpu; use image::GrayImage; use wgpu::Buffer;", ""),
    ];
    for (text, expected) in cases {
        let uses = small_house(&[
            ("crates/strokes/src/lib.rs", "mod gpu; mod mesh; mod style; mod view;"),
            ("crates/strokes/src/gpu.rs", "pub struct Gpu;"),
            ("crates/strokes/src/mesh.rs", text),
            ("crates/strokes/src/style.rs", "pub struct Style;"),
            ("crates/strokes/src/view.rs", "pub struct View;"),
        ]);
        let lines = crossings(&uses);
        let file = "crates/strokes/src/mesh.rs ";
        let lines: Vec<&str> = lines.iter().map(|line| line.trim_start_matches(file)).collect();
        let expected: Vec<&str> =
            Some(expected).filter(|line| !line.is_empty()).into_iter().collect();
        assert_eq!(lines, expected, "{text}");
    }
}

#[test]
fn closed_doors_and_crates_handed_on_are_found() {
    let root = "pub mod command; pub mod scene; pub mod window;";
    let house = |scene: &str, window: &str| {
        let uses = small_house(&[
            ("crates/strokes/src/lib.rs", "pub use wgpu; pub mod gpu;"),
            ("crates/strokes/src/gpu.rs", "pub struct Gpu;"),
            ("crates/viewer/src/lib.rs", root),
            ("crates/viewer/src/command.rs", "pub struct Options;"),
            ("crates/viewer/src/scene.rs", scene),
            ("crates/viewer/src/window.rs", window),
        ]);
        crossings(&uses)
    };
    assert_none(&house("use strokes::gpu::Gpu;", "use crate::scene; use eframe::wgpu::Device;"));
    for (scene, window) in [
        ("use strokes::wgpu::Device;", ""),
        ("use strokes::wgpu;", ""),
        ("use eframe::wgpu::Device;", ""),
        ("fn of(_: ::wgpu::Device) {}", ""),
        ("#[derive(clap::Parser)] struct Of;", ""),
        ("", "use crate::command::Options;"),
        ("", "use std::process::ExitCode;"),
    ] {
        let lines = house(scene, window);
        assert_eq!(lines.len(), 1, "{scene}{window}: {lines:#?}");
    }
}
