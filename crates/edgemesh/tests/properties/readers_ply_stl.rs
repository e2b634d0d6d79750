//! PLY and STL files: the same polygons as `ply-rs-bw` and `stl_io`, for files of other projects
//! and for random meshes that those crates write; outcomes of sound, broken and cut files.

use std::path::{Path, PathBuf};
use std::{fs, io};

use edgemesh::format::read::{Format, ReadError, ReadErrorKind, read_model, read_model_bytes};
use edgemesh::model::Model;
use edgemesh::report::{Report, WarningCode};
use ply_rs_bw::parser::Parser;
use ply_rs_bw::ply::{
    Addable, DefaultElement, ElementDef, Encoding, Ply, Property, PropertyDef, PropertyType,
    ScalarType,
};
use ply_rs_bw::writer::Writer;
use proptest::collection::vec;
use proptest::prelude::*;

use crate::config;
use crate::meshes::{Mesh, wild_soup};
use crate::readers::{Polygons, compare, corpus, ours};

/// The sound files with their vertices and faces as the files list them.
const SOUND: [(&str, usize, usize); 21] = [
    ("ply/assimp/Wuson.ply", 11184, 3732),
    ("ply/assimp/cube_binary.ply", 8, 12),
    ("ply/assimp/cube_binary_header_with_RN_newline.ply", 8, 12),
    ("ply/assimp/cube_binary_starts_with_nl.ply", 8, 6),
    ("ply/assimp/float-color.ply", 3, 1),
    ("ply/trimesh/bunny.ply", 8171, 16301),
    ("ply/trimesh/fuze.ply", 502, 1000),
    ("ply/trimesh/fuze_ascii.ply", 502, 1000),
    ("ply/trimesh/reference.ply", 845, 1610),
    ("ply/trimesh/sphere.ply", 642, 1280),
    ("stl/assimp/Spider_ascii.stl", 3 * 1368, 1368),
    ("stl/trimesh/20mm-xyz-cube.stl", 3 * 260, 260),
    ("stl/trimesh/7_8ths_cube.stl", 3 * 24, 24),
    ("stl/trimesh/ADIS16480.STL", 3 * 7436, 7436),
    ("stl/trimesh/box.STL", 3 * 8954, 8954),
    ("stl/trimesh/cylinder.stl", 3 * 416, 416),
    ("stl/trimesh/idler_riser.STL", 3 * 1572, 1572),
    ("stl/trimesh/multibody.stl", 3 * 32, 32),
    ("stl/trimesh/origin_inside.STL", 3 * 28, 28),
    ("stl/trimesh/shared.STL", 3 * 24, 24),
    ("stl/trimesh/unit_cube.STL", 3 * 12, 12),
];

/// Sound files that break a rule harmlessly, with the number of lines and the message.
const WARNED: [(&str, usize, &str); 2] = [
    ("ply/assimp/Wuson.ply", 1, "a header line without 'comment'"),
    ("ply/trimesh/fuze_ascii.ply", 1000, "faces with more values than are announced"),
];

/// Files that have vertices but nothing to draw, and why.
const POINT_CLOUDS: [(&str, &str); 3] = [
    ("ply/assimp/points.ply", "no element face"),
    ("ply/trimesh/points_ascii_with_lists.ply", "lists of points only"),
    ("ply/trimesh/points_emptyface.ply", "an element face of no rows"),
];

/// Rows of EXPECT.tsv for these formats.
const EXPECTED: usize = 11;

/// The least number of lengths to which a file is cut.
const CUTS: usize = 60;

/// The folder of files of other projects; without it, reports the tests that are left out.
fn files_of_others(left_out: &str) -> Option<PathBuf> {
    let folder = corpus();
    if folder.is_none() {
        eprintln!("left out {left_out}: set EDGEMESH_SHARED to the shared files");
    }
    folder.map(|folder| folder.join("corpus"))
}

/// The PLY and STL files in these folders and below, in order.
fn files(folders: &[PathBuf]) -> Vec<PathBuf> {
    let mut files = Vec::new();
    let mut folders = folders.to_vec();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if matches!(Format::of_name(&path), Some(Format::Ply | Format::Stl)) {
                files.push(path);
            }
        }
    }
    files.sort();
    files
}

fn sound_files(corpus: &Path) -> Vec<PathBuf> {
    files(&[corpus.join("ply"), corpus.join("stl")])
}

#[test]
fn every_sound_file_loads() {
    let Some(corpus) = files_of_others("24 sound files") else { return };
    for (name, vertices, faces) in SOUND {
        let (model, report) = read_model(&corpus.join(name)).unwrap();
        assert_eq!((model.positions.len(), model.polygon_count()), (vertices, faces), "{name}");
        let warned = WARNED.iter().find(|(warned, ..)| *warned == name);
        let count = warned.map_or(0, |&(_, count, _)| count);
        assert_eq!(report.count(WarningCode::Syntax), count, "{name}: {report:?}");
        assert_eq!(report.warnings().len(), usize::from(count > 0), "{name}: {report:?}");
    }
    for (name, why) in POINT_CLOUDS {
        let error = read_model(&corpus.join(name)).unwrap_err();
        assert_eq!(error.kind, ReadErrorKind::Empty, "{name}, {why}: {error}");
    }
    assert_eq!(sound_files(&corpus).len(), SOUND.len() + POINT_CLOUDS.len(), "a file is not named");
}

/// Compares the outcome of reading a file with a row of EXPECT.tsv.
fn check(expected: &str, read: &Result<(Model, Report), ReadError>) -> Result<(), String> {
    let mut words = expected.split([' ', '(', ')']);
    let (verdict, code) = (words.next().unwrap_or_default(), words.next().unwrap_or_default());
    let number = |key: &str| {
        let word = expected.split(' ').find_map(|word| word.strip_prefix(key));
        word.map(|word| word.parse::<usize>().unwrap())
    };
    match (verdict, read) {
        ("error", Err(error)) if error.kind.as_str() == code => Ok(()),
        ("either", Err(error)) if error.kind != ReadErrorKind::Internal => Ok(()),
        ("either", Ok((_, report))) if !report.warnings().is_empty() => Ok(()),
        ("ok", Ok((model, report))) if report.warnings().is_empty() => {
            let counts = [("V=", model.positions.len()), ("F=", model.polygon_count())];
            let triangles = model.corner_positions.len() - 2 * model.polygon_count();
            let counts = counts.into_iter().chain([("T=", triangles)]);
            match counts.into_iter().find(|&(key, count)| number(key).is_some_and(|n| n != count)) {
                Some((key, count)) => Err(format!("{key}{count}")),
                None => Ok(()),
            }
        }
        (_, Ok((_, report))) => Err(format!("a model, {report:?}")),
        (_, Err(error)) => Err(error.to_string()),
    }
}

#[test]
fn files_broken_on_purpose_give_what_is_expected() {
    let Some(corpus) = files_of_others("11 files with a stated outcome") else { return };
    let folder = corpus.join("malformed/gen");
    let table = fs::read_to_string(folder.join("EXPECT.tsv")).unwrap();
    let mut checked = 0;
    for row in table.lines().filter(|row| row.starts_with("ply/") || row.starts_with("stl/")) {
        let mut fields = row.split('\t');
        let (name, expected) = (fields.next().unwrap(), fields.nth(1).unwrap());
        let read = read_model(&folder.join(name));
        check(expected, &read).unwrap_or_else(|why| panic!("{name}: {expected}, not {why}"));
        checked += 1;
    }
    assert_eq!(checked, EXPECTED);
}

#[test]
fn expectations_can_fail() {
    let read = |text: &str| read_model_bytes("test", text.as_bytes(), Format::Stl);
    let facet = "facet\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendfacet\n";
    let (sound, broken) = (read(facet), read(&facet.replace("1 0 0", "1 0 x")));
    assert_eq!(check("ok V=3 F=1 T=1", &sound), Ok(()));
    assert_eq!(check("error(number)", &broken), Ok(()));
    assert_eq!(check("either", &broken), Ok(()));
    assert_eq!(check("ok T=2", &sound), Err("T=1".into()));
    for (expected, read) in
        [("either", &sound), ("error(number)", &sound), ("error(index)", &broken), ("ok", &broken)]
    {
        assert!(check(expected, read).is_err(), "{expected}");
    }
}

#[test]
fn broken_files_of_others_end_in_a_model_or_an_error() {
    let Some(corpus) = files_of_others("4 broken files") else { return };
    let files = files(&[corpus.join("malformed/ply"), corpus.join("malformed/stl")]);
    for path in &files {
        let kind = read_model(path).err().map(|error| error.kind);
        assert_ne!(kind, Some(ReadErrorKind::Internal), "{}", path.display());
    }
    assert!(files.len() >= 4, "only {} files", files.len());
}

#[test]
fn cut_files_end_in_a_model_or_an_error() {
    let Some(corpus) = files_of_others("cuts of 18 sound files") else { return };
    let mut files = 0;
    for path in sound_files(&corpus) {
        let bytes = fs::read(&path).unwrap();
        if bytes.len() >= 100_000 {
            continue;
        }
        files += 1;
        let format = Format::of_name(&path).unwrap();
        let whole = read_model(&path).map_or(0, |(model, _)| model.polygon_count());
        for cut in 0..CUTS {
            let length = bytes.len() * cut / CUTS;
            match read_model_bytes("cut", &bytes[..length], format) {
                Ok((model, report)) => {
                    let is_told = report.count(WarningCode::Truncated) > 0;
                    assert!(is_told && model.polygon_count() <= whole, "{}", path.display());
                }
                Err(error) => {
                    let place = path.display();
                    assert_ne!(error.kind, ReadErrorKind::Internal, "{place}, {length}: {error}");
                }
            }
        }
    }
    assert!(files >= 18, "only {files} files below 100 kB");
}

fn by_ply_rs(bytes: &[u8]) -> Option<Polygons> {
    let ply = Parser::<DefaultElement>::new().read_ply(&mut &*bytes).ok()?;
    let coordinate = |vertex: &DefaultElement, name| vertex.get(name)?.to_f32_lossy();
    let position = |vertex: &DefaultElement| {
        Some([coordinate(vertex, "x")?, coordinate(vertex, "y")?, coordinate(vertex, "z")?])
    };
    let positions: Option<Vec<[f32; 3]>> =
        ply.payload.get("vertex")?.iter().map(position).collect();
    let positions = positions?;
    let corners = |face: &DefaultElement| {
        let list =
            face.get("vertex_indices").or_else(|| face.get("vertex_index"))?.to_u32_list()?;
        Some(list.iter().map(|&vertex| positions[vertex as usize]).collect())
    };
    ply.payload.get("face")?.iter().map(corners).collect()
}

fn by_stl_io(bytes: &[u8]) -> Option<Polygons> {
    let mesh = stl_io::read_stl(&mut io::Cursor::new(bytes)).ok()?;
    let position = |&vertex: &usize| mesh.vertices[vertex].0;
    Some(mesh.faces.iter().map(|face| face.vertices.iter().map(position).collect()).collect())
}

/// Compares the sound files of a format, and asserts that at least `minimum` were compared.
fn compare_all(format: Format, minimum: usize, read: impl Fn(&[u8]) -> Option<Polygons>) {
    let name = format.name();
    let Some(corpus) = files_of_others(&format!("{minimum} comparisons of {name} files")) else {
        return;
    };
    let mut compared = 0;
    for path in sound_files(&corpus) {
        if Format::of_name(&path) != Some(format) {
            continue;
        }
        let theirs = read(&fs::read(&path).unwrap());
        let (Ok((model, _)), Some(theirs)) = (read_model(&path), theirs) else { continue };
        let mut ours = ours(&model);
        if let [_, second, ..] = model.runs[..] {
            // `stl_io` stops behind the first solid.
            ours.truncate(second.first_polygon as usize);
        }
        compare(&ours, &theirs).unwrap_or_else(|why| panic!("{}: {why}", path.display()));
        compared += 1;
    }
    assert!(compared >= minimum, "both read only {compared} {name} files");
}

#[test]
fn ply_rs_reads_the_same_polygons() {
    compare_all(Format::Ply, 9, by_ply_rs);
}

#[test]
fn stl_io_reads_the_same_polygons() {
    compare_all(Format::Stl, 11, by_stl_io);
}

fn element(name: &str, properties: &[(&str, PropertyType)]) -> ElementDef {
    let mut element = ElementDef::new(name.into());
    for (name, kind) in properties {
        element.properties.add(PropertyDef::new((*name).into(), kind.clone()));
    }
    element
}

/// The mesh as `ply-rs-bw` writes it.
fn ply_of(mesh: &Mesh, encoding: Encoding) -> Vec<u8> {
    let float = PropertyType::Scalar(ScalarType::Float);
    let list = PropertyType::List(ScalarType::UShort, ScalarType::UInt);
    let axes = ["x", "y", "z"];
    let mut ply = Ply::new();
    ply.header.encoding = encoding;
    ply.header.elements.add(element("vertex", &axes.map(|axis| (axis, float.clone()))));
    ply.header.elements.add(element("face", &[("vertex_indices", list)]));
    let vertex = |position: &[f32; 3]| -> DefaultElement {
        axes.iter().zip(position).map(|(&axis, &x)| (axis.into(), Property::Float(x))).collect()
    };
    let face = |polygon: &Vec<u32>| -> DefaultElement {
        [("vertex_indices".into(), Property::ListUInt(polygon.clone()))].into_iter().collect()
    };
    ply.payload.insert("vertex".into(), mesh.positions.iter().map(vertex).collect());
    ply.payload.insert("face".into(), mesh.polygons.iter().map(face).collect());
    let mut bytes = Vec::new();
    Writer::new().write_ply(&mut bytes, &mut ply).unwrap();
    bytes
}

/// The mesh as `stl_io` writes it.
fn stl_of(mesh: &Mesh) -> Vec<u8> {
    let corner = |vertex: u32| stl_io::Vertex::new(mesh.positions[vertex as usize]);
    let triangle = |polygon: &Vec<u32>| stl_io::Triangle {
        normal: stl_io::Normal::new([f32::NAN; 3]),
        vertices: [0, 1, 2].map(|k| corner(polygon[k])),
    };
    let triangles: Vec<stl_io::Triangle> = mesh.polygons.iter().map(triangle).collect();
    let mut bytes = Vec::new();
    stl_io::write_stl(&mut bytes, triangles.iter()).unwrap();
    bytes
}

proptest! {
    #![proptest_config(config(128))]

    #[test]
    fn random_meshes_survive_the_way_through_a_file(mesh in wild_soup()) {
        prop_assume!(!mesh.polygons.is_empty());
        let polygons = ours(&mesh.model());
        for encoding in [Encoding::Ascii, Encoding::BinaryLittleEndian, Encoding::BinaryBigEndian] {
            let bytes = ply_of(&mesh, encoding);
            let (model, report) = read_model_bytes("test", &bytes, Format::Ply).unwrap();
            prop_assert_eq!(compare(&ours(&model), &polygons), Ok(()));
            prop_assert!(report.warnings().is_empty());
        }
        let mesh = mesh.triangulated();
        let (model, report) = read_model_bytes("test", &stl_of(&mesh), Format::Stl).unwrap();
        prop_assert_eq!(compare(&ours(&model), &ours(&mesh.model())), Ok(()));
        prop_assert!(report.warnings().is_empty());
    }

    #[test]
    fn changed_bytes_end_in_a_model_or_an_error(
        mesh in wild_soup(),
        changes in vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
    ) {
        let encodings = [Encoding::Ascii, Encoding::BinaryLittleEndian];
        let plys = encodings.map(|encoding| (ply_of(&mesh, encoding), Format::Ply));
        let stl = (stl_of(&mesh.triangulated()), Format::Stl);
        for (mut bytes, format) in plys.into_iter().chain([stl]) {
            for (index, byte) in &changes {
                let at = index.index(bytes.len());
                bytes[at] = *byte;
            }
            let kind = read_model_bytes("test", &bytes, format).err().map(|error| error.kind);
            prop_assert_ne!(kind, Some(ReadErrorKind::Internal));
        }
    }
}
