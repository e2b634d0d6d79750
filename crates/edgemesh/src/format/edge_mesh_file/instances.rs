//! Instanced meshes as sections: the file of each mesh, and its placements.
//!
//! ```text
//! INST  end of file 0, end of places 0    end 1, end 1 ---.
//! IMSH  |file of mesh 0|zeros|file of mesh 1|  <----------'
//! IPLC  |places of mesh 0|places of mesh 1|    <----------'
//! ```
//!
//! A mesh is a whole file with a checksum of its own, so that it is read as any other. It cannot
//! have instances itself, so files do not nest any deeper.

use super::error::{FileError, FileErrorKind};
use super::numbers::{Placement, of_frame, of_transform, to_transform};
use super::section::{ALIGNMENT, Sections, Tag};
use super::stored::StoredMesh;
use crate::edge_mesh::{InstancedMesh, MeshFrame};
use crate::index::MAX_PLACEMENTS;
use crate::report::Place;

/// The sections of instanced meshes.
#[derive(Debug, Default)]
pub(super) struct InstanceSections {
    /// For each mesh, the ends of its file and of its placements.
    pub(super) ends: Vec<[u64; 2]>,
    pub(super) files: Vec<u8>,
    pub(super) placements: Vec<Placement>,
}

impl InstanceSections {
    /// The sections of meshes with the bytes of their files.
    pub(super) fn new(meshes: Vec<(&InstancedMesh, Vec<u8>)>) -> Self {
        let mut sections = Self::default();
        for (InstancedMesh { placements, .. }, file) in meshes {
            let start = sections.files.len().next_multiple_of(ALIGNMENT);
            sections.files.resize(start, 0);
            sections.files.extend(file);
            sections.placements.extend(placements.iter().map(of_transform));
            sections.ends.push([sections.files.len() as u64, sections.placements.len() as u64]);
        }
        sections
    }
}

/// Reads the instanced meshes of a file whose mesh has a frame; `parse` reads a file without any.
///
/// # Errors
/// Fails if an end is out of order, if a mesh cannot be read or has another frame, or if there are
/// more than [`MAX_PLACEMENTS`] placements, or one that is not finite.
pub(super) fn read(
    sections: &Sections<'_>,
    frame: &MeshFrame,
    parse: impl Fn(&[u8]) -> Result<StoredMesh<'_>, FileError>,
) -> Result<Vec<InstancedMesh>, FileError> {
    let ends = sections.optional::<[u64; 2]>(Tag::INSTANCES)?.unwrap_or_default();
    let files = sections.optional::<u8>(Tag::INSTANCED_MESHES)?.unwrap_or_default();
    let places = sections.optional::<Placement>(Tag::PLACEMENTS)?.unwrap_or_default();
    let error = |tag: Tag, element: usize, what: String| FileError {
        kind: FileErrorKind::Inconsistent,
        place: sections.place(tag, element),
        what: format!("section {tag}, element {element}: {what}; build the file again"),
    };
    if places.len() > MAX_PLACEMENTS {
        let what = format!("there are {}, the most is {MAX_PLACEMENTS}", places.len());
        return Err(error(Tag::PLACEMENTS, 0, what));
    }
    if let Some(at) = places.iter().position(|place| !place.iter().all(|x| x.is_finite())) {
        return Err(error(Tag::PLACEMENTS, at, "is not finite".into()));
    }
    let mut all = Vec::with_capacity(ends.len());
    let (mut file_start, mut first_place) = (0, 0);
    for (at, &[file_end, last_place]) in ends.iter().enumerate() {
        let range = |start: usize, end: u64| Some(start..usize::try_from(end).ok()?);
        let file = range(file_start, file_end).and_then(|range| files.get(range));
        let own = range(first_place, last_place).and_then(|range| places.get(range));
        let (Some(file), Some(own)) = (file, own) else {
            let (bytes, count) = (files.len(), places.len());
            let what = format!(
                "ends at byte {file_end} of {bytes} and at placement {last_place} of {count}"
            );
            return Err(error(Tag::INSTANCES, at, what));
        };
        let before = sections.place(Tag::INSTANCED_MESHES, file_start);
        let stored = parse(file).map_err(|error| within(at, before, error))?;
        let bits = |frame: &MeshFrame| of_frame(frame).map(f64::to_bits);
        if bits(&stored.frame) != bits(frame) {
            return Err(error(Tag::INSTANCES, at, "has another frame".into()));
        }
        file_start = (file_start + file.len()).next_multiple_of(ALIGNMENT);
        first_place += own.len();
        let placements = own.iter().map(to_transform).collect();
        all.push(InstancedMesh { mesh: stored.to_mesh(), placements });
    }
    Ok(all)
}

/// The error of instanced mesh `at`, whose file begins at `before`.
fn within(at: usize, before: Option<Place>, error: FileError) -> FileError {
    let place = match (error.place, before) {
        (Some(Place::Byte(byte)), Some(Place::Byte(before))) => {
            Some(Place::Byte(before.saturating_add(byte)))
        }
        (_, before) => before,
    };
    FileError { place, what: format!("instanced mesh {at}: {}", error.what), ..error }
}

#[cfg(test)]
mod tests {
    use glam::{DMat4, DVec3};

    use super::*;
    use crate::edge_mesh::EdgeMesh;
    use crate::format::edge_mesh_file::draft::Draft;
    use crate::format::edge_mesh_file::samples::{sheet, textured, triangle};
    use crate::format::edge_mesh_file::{Layout, parse, to_bytes, to_bytes_with_instances};
    use crate::report::Report;

    fn places() -> Vec<DMat4> {
        let mirror = DMat4::from_scale(DVec3::new(-2.0, 2.0, 2.0));
        vec![DMat4::IDENTITY, DMat4::from_translation(DVec3::new(0.1, -0.0, 1e9)) * mirror]
    }

    /// A sheet with a textured mesh in two places and a triangle in one.
    fn scene() -> (EdgeMesh, Vec<InstancedMesh>) {
        let instanced = vec![
            InstancedMesh { mesh: textured().mesh, placements: places() },
            InstancedMesh { mesh: triangle().mesh, placements: places()[1..].to_vec() },
        ];
        (sheet(2).mesh, instanced)
    }

    fn file() -> Vec<u8> {
        let (mesh, instanced) = scene();
        to_bytes_with_instances(&mesh, &instanced, "scene", &Report::default(), &[]).unwrap()
    }

    #[test]
    fn meshes_and_places_are_read_back() {
        let (mesh, instanced) = scene();
        let report = Report::default();
        for layouts in [&[][..], &Layout::ALL] {
            let bytes =
                to_bytes_with_instances(&mesh, &instanced, "scene", &report, layouts).unwrap();
            let stored = parse(&bytes).unwrap();
            assert_eq!((stored.to_mesh(), &stored.instanced), (mesh.clone(), &instanced));
        }
        let bytes = to_bytes_with_instances(&mesh, &[], "a", &report, &[]).unwrap();
        assert!(bytes == to_bytes(&mesh, "a", &report, &[]).unwrap(), "no section without any");
    }

    #[test]
    fn every_flipped_bit_and_every_truncation_is_found() {
        let mut bytes = file();
        for length in 0..bytes.len() {
            assert!(parse(&bytes[..length]).is_err(), "{length}");
        }
        for bit in 0..8 * bytes.len() {
            bytes[bit / 8] ^= 1 << (bit % 8);
            assert!(parse(&bytes).is_err(), "bit {bit}");
            bytes[bit / 8] ^= 1 << (bit % 8);
        }
        assert!(parse(&bytes).is_ok());
    }

    /// The triangle with another in some places; `change` makes it wrong.
    fn error(change: impl FnOnce(&mut Draft)) -> FileError {
        let inner = Draft::triangle().to_bytes();
        let mut draft = Draft::triangle();
        let end = inner.len() as u64;
        let ends: Vec<u8> = [end, 2].iter().flat_map(|end| end.to_le_bytes()).collect();
        draft.push("INST", 16, &ends);
        draft.push("IMSH", 1, &inner);
        let place = of_transform(&DMat4::IDENTITY).map(f64::to_le_bytes);
        draft.push("IPLC", 96, &[place.as_flattened(), place.as_flattened()].concat());
        assert_eq!(parse(&draft.to_bytes()).unwrap().instanced[0].placements.len(), 2);
        change(&mut draft);
        let error = parse(&draft.to_bytes()).unwrap_err();
        assert!(error.what.ends_with("build it again") || error.what.ends_with("the file again"));
        assert!(error.place.is_some(), "{error}");
        error
    }

    #[test]
    fn wrong_sections_are_refused() {
        let what = |change: &dyn Fn(&mut Draft)| error(change).to_string();
        for (number, value) in [(0, 0), (0, 7), (0, u32::MAX), (1, 1), (2, 3), (3, 1)] {
            let wrong = what(&|draft| draft.set("INST", number, value));
            let is_told = wrong.contains("ends at byte") || wrong.contains("instanced mesh 0: ");
            assert!(is_told, "{number} {value}: {wrong}");
        }
        let wrong = what(&|draft| draft.remove("IMSH"));
        assert!(wrong.contains("section INST, element 0: ends at byte"), "{wrong}");
        let wrong = what(&|draft| draft.section("IPLC").bytes[96..].fill(0xff));
        assert!(wrong.contains("section IPLC, element 1: is not finite"), "{wrong}");
        let wrong = what(&|draft| draft.resize("IPLC", MAX_PLACEMENTS + 1));
        assert!(wrong.contains("there are 10001, the most is 10000"), "{wrong}");
        let wrong = what(&|draft| draft.section("IMSH").bytes[200] ^= 1);
        assert!(wrong.contains("instanced mesh 0: the checksum does not match"), "{wrong}");
        let wrong = what(&|draft| draft.section("FRAM").bytes[7] ^= 1);
        assert!(wrong.contains("has another frame"), "{wrong}");
    }

    #[test]
    fn files_do_not_nest_deeper() {
        let inner = file();
        let end = inner.len() as u64;
        let mut draft = Draft::triangle();
        draft.push("INST", 16, &[end.to_le_bytes(), 0_u64.to_le_bytes()].concat());
        draft.push("IMSH", 1, &inner);
        let error = parse(&draft.to_bytes()).unwrap_err();
        assert!(error.what.contains("instanced mesh 0: section INST: has instances"), "{error}");
    }

    #[test]
    fn too_many_places_are_not_written() {
        let instanced = InstancedMesh {
            mesh: triangle().mesh,
            placements: vec![DMat4::IDENTITY; MAX_PLACEMENTS + 1],
        };
        let report = Report::default();
        let written = to_bytes_with_instances(&triangle().mesh, &[instanced], "", &report, &[]);
        let error = written.unwrap_err();
        assert_eq!(error.kind, FileErrorKind::Size);
        assert!(error.what.contains("10001 placements; the limit is 10000"), "{error}");
    }
}
