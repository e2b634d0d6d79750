//! Compares the OBJ reader with two other parsers, `tobj` and `obj-rs`: the polygons of
//! files, and the materials of random MTL texts.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::{env, fs};

use edgemesh::format::read::read_model;
use edgemesh::model::{Material, Model};
use obj::raw::object::Polygon;
use proptest::collection::vec;
use proptest::prelude::*;

use crate::config;

/// The polygons of a file, as the positions of their corners.
pub(crate) type Polygons = Vec<Vec<[f32; 3]>>;

/// At least this many files are read by both parsers of a comparison.
const COMPARED: usize = 40;

/// `EDGEMESH_SHARED`, else `../shared` beside the workspace.
pub(crate) fn corpus() -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    let folder = env::var_os("EDGEMESH_SHARED").map_or(beside, PathBuf::from);
    Some(folder).filter(|folder| folder.is_dir())
}

fn obj_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(obj_files(&path));
        } else if path.extension().is_some_and(|extension| extension == "obj") {
            files.push(path);
        }
    }
    files.sort();
    files
}

#[expect(clippy::cast_possible_truncation, reason = "the other parsers give 32 bits")]
pub(crate) fn ours(model: &Model) -> Polygons {
    let position = |corner: usize| {
        model.positions[model.corner_positions[corner] as usize].map(|coordinate| coordinate as f32)
    };
    let polygons = 0..model.polygon_count();
    polygons.map(|polygon| model.corner_range(polygon).map(position).collect()).collect()
}

fn by_tobj(path: &Path) -> Option<Polygons> {
    let bytes = fs::read(path).unwrap();
    let no_materials = |_: &Path| Err(tobj::LoadError::OpenFileFailed);
    let options = tobj::LoadOptions::default();
    let (models, _) = tobj::load_obj_buf(&mut bytes.as_slice(), &options, no_materials).ok()?;
    let mut polygons = Polygons::new();
    for mesh in models.into_iter().map(|model| model.mesh) {
        let positions = mesh.positions.as_chunks::<3>().0;
        let mut rest = mesh.indices.as_slice();
        // Without arities all faces are triangles.
        let mut arities = mesh.face_arities.iter().map(|&arity| arity as usize);
        while !rest.is_empty() {
            let (face, after) = rest.split_at(arities.next().unwrap_or(3));
            rest = after;
            // `tobj` counts points and lines as faces.
            if face.len() > 2 {
                polygons.push(face.iter().map(|&vertex| positions[vertex as usize]).collect());
            }
        }
    }
    Some(polygons)
}

fn by_obj_rs(path: &Path) -> Option<Polygons> {
    let bytes = fs::read(path).unwrap();
    let raw = obj::raw::parse_obj(bytes.as_slice()).ok()?;
    let position = |&index: &usize| {
        let (x, y, z, _) = raw.positions[index];
        [x, y, z]
    };
    let corners = |polygon: &Polygon| -> Vec<usize> {
        match polygon {
            Polygon::P(corners) => corners.clone(),
            Polygon::PT(corners) | Polygon::PN(corners) => {
                corners.iter().map(|corner| corner.0).collect()
            }
            Polygon::PTN(corners) => corners.iter().map(|corner| corner.0).collect(),
        }
    };
    Some(
        raw.polygons
            .iter()
            .map(|polygon| corners(polygon).iter().map(position).collect())
            .collect(),
    )
}

/// Fails with the first difference.
pub(crate) fn compare(ours: &Polygons, theirs: &Polygons) -> Result<(), String> {
    if ours.len() != theirs.len() {
        return Err(format!("{} polygons, theirs {}", ours.len(), theirs.len()));
    }
    match ours.iter().zip(theirs).position(|(a, b)| a != b) {
        Some(at) => Err(format!("polygon {at}: {:?}, theirs {:?}", ours[at], theirs[at])),
        None => Ok(()),
    }
}

fn compare_all(parser: &str, read: impl Fn(&Path) -> Option<Polygons>) {
    let Some(shared) = corpus() else {
        eprintln!("left out {COMPARED} cases of {parser}: set EDGEMESH_SHARED to the shared files");
        return;
    };
    let mut compared = 0;
    let mut wrong = Vec::new();
    for path in [obj_files(&shared.join("corpus/obj")), obj_files(&shared.join("models"))].concat()
    {
        let (Ok((model, _)), Some(theirs)) = (read_model(&path), read(&path)) else { continue };
        compared += 1;
        if let Err(why) = compare(&ours(&model), &theirs) {
            wrong.push(format!("{}: {why}", path.display()));
        }
    }
    assert!(wrong.is_empty(), "{} of {compared} differ:\n{}", wrong.len(), wrong.join("\n"));
    assert!(compared >= COMPARED, "{parser} and this crate both read only {compared} files");
}

#[test]
fn tobj_reads_the_same_polygons() {
    compare_all("tobj", by_tobj);
}

#[test]
fn obj_rs_reads_the_same_polygons() {
    compare_all("obj-rs", by_obj_rs);
}

/// A cursor over a result that `rapidobj` has stored: lists of little-endian numbers, each
/// after its count in 64 bits.
struct StoredCursor<'a>(&'a [u8]);

impl StoredCursor<'_> {
    fn bytes(&mut self, count: usize) -> &[u8] {
        let (bytes, rest) = self.0.split_at(count);
        self.0 = rest;
        bytes
    }

    fn count(&mut self) -> usize {
        usize::try_from(u64::from_le_bytes(self.bytes(8).try_into().unwrap())).unwrap()
    }

    /// A list of elements of `words` words of four bytes.
    fn list(&mut self, words: usize) -> Vec<[u8; 4]> {
        let count = self.count() * words;
        self.bytes(4 * count).as_chunks::<4>().0.to_vec()
    }
}

/// The polygons of a stored result with one shape: a byte, the positions, texture
/// coordinates, normals, the number of shapes; then the name of the shape, its corners of
/// three indices, and the number of corners of each face in a byte.
fn by_rapidobj(bytes: &[u8]) -> Polygons {
    let mut stored = StoredCursor(&bytes[1..]);
    let positions: Vec<f32> = stored.list(1).into_iter().map(f32::from_le_bytes).collect();
    let unused = [stored.list(1).len(), stored.list(1).len()];
    assert_eq!(unused, [0, 0], "texture coordinates and normals");
    assert_eq!(stored.count(), 1, "shapes");
    let name = stored.count();
    stored.bytes(name);
    let corners = stored.list(3);
    let mut corners = corners.as_chunks::<3>().0.iter();
    let faces = stored.count();
    let sizes = stored.bytes(faces).to_vec();
    let position = |corner: &[[u8; 4]; 3]| {
        let index = usize::try_from(i32::from_le_bytes(corner[0])).unwrap();
        positions.as_chunks::<3>().0[index]
    };
    let mut face = |size: u8| corners.by_ref().take(size.into()).map(position).collect();
    sizes.into_iter().map(&mut face).collect()
}

#[test]
fn rapidobj_has_stored_the_same_polygons() {
    let Some(shared) = corpus() else {
        eprintln!("left out 2 cases of rapidobj: set EDGEMESH_SHARED to the shared files");
        return;
    };
    for name in ["cube/cube.obj", "color/color.obj"] {
        let path = shared.join("corpus/obj/rapidobj").join(name);
        let (model, _) = read_model(&path).unwrap();
        let theirs = by_rapidobj(&fs::read(path.with_extension("obj.ref")).unwrap());
        assert!(theirs.len() >= 6, "{name}: {theirs:?}");
        assert_eq!(compare(&ours(&model), &theirs), Ok(()), "{name}");
    }
}

#[test]
fn a_difference_is_found() {
    let triangle = vec![[0.0; 3], [1.0; 3], [2.0; 3]];
    let mut moved = triangle.clone();
    moved[2][1] = 2.000_000_2;
    assert_eq!(compare(&vec![triangle.clone()], &vec![triangle.clone()]), Ok(()));
    assert!(compare(&vec![triangle.clone()], &vec![moved]).is_err());
    assert!(compare(&vec![triangle.clone()], &vec![triangle.clone(), triangle]).is_err());
}

/// A line of an MTL text that `tobj` accepts.
fn mtl_line() -> impl Strategy<Value = String> {
    let number = prop_oneof![
        (-10.0_f32..10.0).prop_map(|number| number.to_string()),
        any::<f32>().prop_map(|number| format!("{number:e}")),
        "[0-9]{1,3}(\\.[0-9]{0,12})?",
    ];
    let numbers =
        move |count| vec(number.clone(), count).prop_map(|numbers| numbers.join(" ")).boxed();
    let statement = prop_oneof![
        4 => "newmtl [ab]( ?[ab1.]){0,2}",
        2 => ("K[ads]", numbers(3)).prop_map(|(keyword, rest)| format!("{keyword} {rest}")),
        1 => ("K[ads]", numbers(4)).prop_map(|(keyword, rest)| format!("{keyword}\t{rest}")),
        2 => ("Ns|d|Ni", numbers(1)).prop_map(|(keyword, rest)| format!("{keyword} {rest}")),
        1 => numbers(3).prop_map(|rest| format!("Ke {rest}")),
        2 => "illum [0-9]|sharpness 60|#.{0,9}|refl -type sphere a.png|Tf 1 1 1|",
    ];
    ("[ \t]{0,2}", statement, "[ \t]{0,2}").prop_map(|(a, b, c)| a + &b + &c)
}

/// The materials with these names that our reader finds in an MTL text.
fn our_materials(mtl: &str, names: &BTreeSet<String>) -> Vec<Material> {
    let folder = tempfile::tempdir().unwrap();
    let mut obj = String::from("mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    for name in names {
        obj += &format!("usemtl {name}\nf 1 2 3\n");
    }
    fs::write(folder.path().join("a.mtl"), mtl).unwrap();
    fs::write(folder.path().join("a.obj"), obj).unwrap();
    let (model, report) = read_model(&folder.path().join("a.obj")).unwrap();
    assert!(report.warnings().is_empty(), "{report:?}");
    model.materials
}

proptest! {
    #![proptest_config(config(512))]

    /// Both read the same numbers, bit by bit; of several materials with one name, our
    /// reader takes the first.
    #[test]
    fn tobj_reads_the_same_materials(lines in vec(mtl_line(), 0..30), end in "\n|\r\n") {
        let mtl = lines.join(&end);
        let theirs = tobj::load_mtl_buf(&mut mtl.as_bytes());
        let (theirs, _) = theirs.map_err(|error| TestCaseError::fail(error.to_string()))?;
        let names = theirs.iter().map(|material| material.name.clone()).collect();
        let ours = our_materials(&mtl, &names);
        prop_assert_eq!(ours.len(), names.len());
        let colors = |colors: [Option<[f32; 3]>; 3]| {
            colors.map(|color| color.map(|color| color.map(f32::to_bits)))
        };
        let bits = |number: Option<f32>| number.map(f32::to_bits);
        for ours in ours {
            let theirs = theirs.iter().find(|theirs| theirs.name == ours.name).unwrap();
            prop_assert_eq!(
                colors([ours.ambient, ours.diffuse, ours.specular]),
                colors([theirs.ambient, theirs.diffuse, theirs.specular])
            );
            prop_assert_eq!(bits(ours.shininess), bits(theirs.shininess));
            prop_assert_eq!(bits(ours.opacity), bits(theirs.dissolve));
        }
    }
}
