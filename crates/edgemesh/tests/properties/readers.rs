//! The same polygons as two other OBJ parsers read: `tobj` on the bare file,
//! without the screen that stands before it here, and `obj-rs`.

use std::path::{Path, PathBuf};
use std::{env, fs};

use edgemesh::format::read::read_model;
use edgemesh::model::Model;
use obj::raw::object::Polygon;

/// The polygons of a file, each as the positions of its corners.
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
        // No arities stand for triangles only.
        let mut arities = mesh.face_arities.iter().map(|&arity| arity as usize);
        while !rest.is_empty() {
            let (face, after) = rest.split_at(arities.next().unwrap_or(3));
            rest = after;
            // Points and lines count as faces there.
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

/// Says where the two differ first.
pub(crate) fn compare(ours: &Polygons, theirs: &Polygons) -> Result<(), String> {
    if ours.len() != theirs.len() {
        return Err(format!("{} polygons, there {}", ours.len(), theirs.len()));
    }
    match ours.iter().zip(theirs).position(|(a, b)| a != b) {
        Some(at) => Err(format!("polygon {at}: {:?}, there {:?}", ours[at], theirs[at])),
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

/// A cursor over what `rapidobj` has stored of its own results: lists of
/// little-endian numbers behind their counts in 64 bits.
struct Stored<'a>(&'a [u8]);

impl Stored<'_> {
    fn bytes(&mut self, count: usize) -> &[u8] {
        let (bytes, rest) = self.0.split_at(count);
        self.0 = rest;
        bytes
    }

    fn count(&mut self) -> usize {
        usize::try_from(u64::from_le_bytes(self.bytes(8).try_into().unwrap())).unwrap()
    }

    /// A list of words of four bytes, `words` an element.
    fn list(&mut self, words: usize) -> Vec<[u8; 4]> {
        let count = self.count() * words;
        self.bytes(4 * count).as_chunks::<4>().0.to_vec()
    }
}

/// The polygons of a stored result with a single shape: a byte, then positions,
/// texture coordinates, normals, the number of shapes, and the shape's name,
/// corners of three indices, and corners a face in a byte each.
fn by_rapidobj(bytes: &[u8]) -> Polygons {
    let mut stored = Stored(&bytes[1..]);
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
