//! Files made to be slow or large to read: small files that take minutes if any step takes
//! more than linear time. The time limit is that of `child`.

use std::f64::consts::TAU;
use std::fs::{self, File};
use std::io::{BufWriter, Write};

use serde_json::Value;

use crate::child::{info, json, stderr};
use crate::expectations::{write_big, write_cone};

/// The JSON of `edgemesh info` for the file that `write` makes.
fn info_of(write: impl FnOnce(&mut BufWriter<File>)) -> Value {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("hostile.obj");
    let mut out = BufWriter::new(File::create(&path).unwrap());
    write(&mut out);
    out.flush().unwrap();
    let output = info(&path);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    json(&output)
}

#[test]
fn a_quarter_of_a_million_faces_may_share_a_vertex() {
    let info = info_of(|out| write_cone(out, 250_000));
    assert_eq!(info["edges"].as_u64(), Some(500_000));
}

#[test]
fn a_hundred_thousand_faces_may_share_an_edge() {
    let info = info_of(|out| {
        writeln!(out, "v 0 0 0\nv 0 0 1").unwrap();
        for page in 0..100_000 {
            let (sin, cos) = (f64::from(page) * TAU / 100_000.0).sin_cos();
            writeln!(out, "v {cos:.7} {sin:.7} 0\nf 1 2 -1").unwrap();
        }
    });
    assert_eq!(info["non_manifold_edges"].as_u64(), Some(1));
}

#[test]
fn two_hundred_thousand_faces_may_have_a_material_each() {
    let info = info_of(|out| {
        writeln!(out, "v 0 0 0\nv 1 0 0\nv 0 1 0").unwrap();
        for face in 0..200_000 {
            writeln!(out, "v {face} 0 1\nusemtl a_material_of_its_own_{face}\nf 1 2 -1").unwrap();
        }
    });
    assert_eq!(info["source"]["polygons"].as_u64(), Some(200_000));
}

/// Each triangle lies flat on the next larger one, so that its plane comes all the way
/// from the last.
///
/// ```text
///   .                 a face with a plane
///   -----------
///    --------         faces without area, longest sides outward
///      ----
/// ```
#[test]
fn two_hundred_thousand_faces_may_hand_on_a_plane() {
    const COUNT: i32 = 200_000;
    let info = info_of(|out| {
        writeln!(out, "v 0 1 0").unwrap();
        for step in 0..COUNT + 2 {
            writeln!(out, "v {} 0 0", if step % 2 == 0 { step } else { -step }).unwrap();
        }
        writeln!(out, "f 1 {} {}", COUNT + 2, COUNT + 3).unwrap();
        for step in 0..COUNT {
            writeln!(out, "f {} {} {}", step + 2, step + 3, step + 4).unwrap();
        }
    });
    assert_eq!(info["repairs"]["zero_area_triangles"].as_u64(), Some(200_000));
}

/// Polygons with few ears: the outline of a spiral, in and out again.
#[test]
fn forty_spirals_of_four_thousand_corners_are_cut() {
    const TURNS: i32 = 2048;
    let info = info_of(|out| {
        let mut corner = |step: i32, radius: f64, height: i32| {
            let (sin, cos) = (f64::from(step) * 0.05).sin_cos();
            let radius = radius + f64::from(step) * 0.05;
            writeln!(out, "v {:.5} {:.5} {height}", radius * cos, radius * sin).unwrap();
        };
        for height in 0..40 {
            (0..TURNS).for_each(|step| corner(step, 1.0, height));
            (0..TURNS).rev().for_each(|step| corner(step, 1.2, height));
        }
        for spiral in 0..40 {
            let corners = (0..2 * TURNS).map(|k| (spiral * 2 * TURNS + k + 1).to_string());
            writeln!(out, "f {}", corners.collect::<Vec<_>>().join(" ")).unwrap();
        }
    });
    assert_eq!(info["triangles"].as_u64(), Some(40 * 4094));
}

/// Vertices that no face uses must not cost much: the table allows ten times the size of
/// the file. The limit here is on addresses, which include memory.
#[cfg(target_os = "linux")]
#[test]
fn isolated_vertices_fit_into_ten_times_the_file() {
    use std::process::{Command, Stdio};
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("isolated.obj");
    write_big("obj/big_isolated_vertices.obj", &path);
    let kibibytes = fs::metadata(&path).unwrap().len() * 10 / 1024;
    let script = format!("ulimit -v {kibibytes} && exec \"$0\" info \"$1\"");
    let program = testkit::locate::program("edgemesh");
    let mut command = Command::new("sh");
    command.args(["-c", &script]).arg(program).arg(&path).stdout(Stdio::piped());
    let output = crate::child::run(&mut command);
    assert_eq!(output.status.code(), Some(0), "in {kibibytes} KiB: {}", stderr(&output));
}
