//! Reads a [`StoredMesh`] from the bytes of a file, without copying aligned lists.

use std::borrow::Cow;

use super::check::{Flaw, check, check_materials};
use super::error::{FileError, FileErrorKind};
use super::header::{Header, Version};
use super::instances;
use super::materials::to_materials;
use super::meta::{MaterialNames, from_json};
use super::numbers::{to_counts, to_frame};
use super::section::{Sections, Tag};
use super::stored::StoredMesh;
use super::version_1::with_crease_angles;
use crate::edge_mesh::{Bounds, FillRun};
use crate::model::Material;

/// Reads the bytes of a whole file.
///
/// # Errors
/// Fails if the file is not an edge mesh, of a newer version, incomplete or damaged, or
/// if its sections contradict each other.
pub fn parse(bytes: &[u8]) -> Result<StoredMesh<'_>, FileError> {
    let (mut mesh, sections) = parse_one(bytes)?;
    mesh.instanced = instances::read(&sections, &mesh.frame, parse_instanced)?;
    Ok(mesh)
}

/// Reads a file within another, which cannot have instances.
fn parse_instanced(bytes: &[u8]) -> Result<StoredMesh<'_>, FileError> {
    let (mesh, sections) = parse_one(bytes)?;
    if let Some(place) = sections.place(Tag::INSTANCES, 0) {
        return Err(FileError {
            kind: FileErrorKind::Inconsistent,
            place: Some(place),
            what: "section INST: has instances itself; build the file again".into(),
        });
    }
    Ok(mesh)
}

/// Reads the bytes of a file without its instances.
fn parse_one(bytes: &[u8]) -> Result<(StoredMesh<'_>, Sections<'_>), FileError> {
    let header = Header::read(bytes)?;
    let sections = Sections::read(bytes, header.section_count)?;
    let mesh = mesh_of(&sections)?;
    check(&mesh).map_err(|flaw| error_of(flaw, &sections))?;
    let mesh = match header.version {
        Version::V1 => with_crease_angles(mesh),
        Version::V2 => mesh,
    };
    Ok((mesh, sections))
}

/// The error of a flaw, with its place in the file.
fn error_of(flaw: Flaw, sections: &Sections) -> FileError {
    let place = sections.place(flaw.tag, flaw.element);
    flaw.at(place)
}

fn mesh_of<'a>(sections: &Sections<'a>) -> Result<StoredMesh<'a>, FileError> {
    let [min, max] = sections.array(Tag::BOUNDS)?;
    let json = sections.list::<u8>(Tag::META)?;
    let meta = from_json(&json).map_err(|error| FileError {
        kind: FileErrorKind::Meta,
        place: sections.place(Tag::META, 0),
        what: format!("section META: {error}; build the file again"),
    })?;
    let fill_indices: Cow<[u32]> = sections.optional(Tag::FILL_INDICES)?.unwrap_or_default();
    // Older files have no material ranges.
    let plain_run = || if fill_indices.is_empty() { vec![] } else { vec![FillRun::PLAIN] };
    let fill_runs = sections.optional(Tag::FILL_RUNS)?.unwrap_or_else(|| plain_run().into());
    Ok(StoredMesh {
        name: meta.name.into(),
        frame: to_frame(sections.array(Tag::FRAME)?),
        positions: sections.list(Tag::POSITIONS)?,
        split_from: sections.list(Tag::SPLIT_FROM)?,
        vertex_normals: sections.list(Tag::VERTEX_NORMALS)?,
        triangles: sections.list(Tag::TRIANGLES)?,
        face_planes: sections.list(Tag::FACE_PLANES)?,
        records: sections.list(Tag::RECORDS)?,
        chains: sections.list(Tag::CHAINS)?,
        links: sections.list(Tag::LINKS)?,
        fill_vertices: sections.optional(Tag::FILL_VERTICES)?.unwrap_or_default(),
        fill_colors: sections.optional(Tag::FILL_COLORS)?.unwrap_or_default(),
        fill_indices,
        fill_runs,
        materials: materials(sections, meta.materials)?.into(),
        groups: meta.groups.into(),
        bounds: Bounds { min, max },
        counts: to_counts(sections.array(Tag::COUNTS)?),
        replicated_f32: sections.optional(Tag::REPLICATED_F32)?,
        replicated_i16: sections.optional(Tag::REPLICATED_I16)?,
        instanced: Vec::new(),
        report: Cow::Owned(meta.report),
    })
}

/// The materials with these names.
fn materials(sections: &Sections, names: Vec<MaterialNames>) -> Result<Vec<Material>, FileError> {
    let stored = sections.optional(Tag::MATERIALS)?.unwrap_or_default();
    let picture_ends = sections.optional(Tag::PICTURE_ENDS)?.unwrap_or_default();
    let pictures = sections.optional(Tag::PICTURES)?.unwrap_or_default();
    check_materials(&stored, &picture_ends, pictures.len(), names.len())
        .map_err(|flaw| error_of(flaw, sections))?;
    Ok(to_materials(&stored, &picture_ends, &pictures, names))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::edge_mesh::{
        Chain, ChainLink, Chains, EdgeCounts, EdgeFlags, EdgeMesh, EdgeRecord, FacePlane, FillMesh,
        FillVertex, MeshCounts, MeshFrame, SourceCounts,
    };
    use crate::format::edge_mesh_file::draft::{Draft, TRIANGLE};
    use crate::format::edge_mesh_file::samples::{samples, sheet, textured};
    use crate::format::edge_mesh_file::{Layout, to_bytes};
    use crate::index::NONE;
    use crate::model::{Texture, TextureSource};
    use crate::report::{Place, Report};

    fn triangle_records() -> Vec<EdgeRecord> {
        let record = |[v0, v1]: [u32; 2]| EdgeRecord {
            v0,
            v1,
            face_a: 0,
            face_b: NONE,
            word: EdgeFlags::BOUNDARY.into(),
        };
        [[0, 1], [2, 0], [1, 2]].map(record).to_vec()
    }

    fn triangle_chains() -> Chains {
        let chain = |(first_link, length): (u32, f32)| Chain {
            first_link,
            link_count: 1,
            length,
            is_loop: 0,
            class: EdgeFlags::BOUNDARY,
        };
        let link = |record: u32| ChainLink { record, chain: record, arc_start: 0., is_reversed: 0 };
        let lengths = [(0, 1.0), (1, 1.0), (2, std::f32::consts::SQRT_2)];
        Chains { chains: lengths.map(chain).to_vec(), links: [0, 1, 2].map(link).to_vec() }
    }

    fn triangle_counts() -> MeshCounts {
        let edges = EdgeCounts { edges: 3, boundary: 3, ..EdgeCounts::default() };
        MeshCounts {
            vertices: 3,
            welded_vertices: 3,
            triangles: 1,
            degenerate_triangles: 2,
            edges,
            components: 1,
            source: SourceCounts { vertices: 5, polygons: 1, triangles: 1, edges },
            ..MeshCounts::default()
        }
    }

    /// The content of [`TRIANGLE`].
    fn triangle_mesh() -> EdgeMesh {
        let positions = vec![[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]];
        let normal = [0., 0., 1.];
        let fill = |position: &[f32; 3]| FillVertex {
            position: *position,
            normal,
            texcoord: [position[0], position[1]],
        };
        EdgeMesh {
            frame: MeshFrame { origin: [10., 20., 30.].into(), scale: 0.5 },
            split_from: vec![],
            vertex_normals: vec![normal; 3],
            triangles: vec![[0, 1, 2]],
            face_planes: vec![FacePlane { normal: [0., 0., 1., 0.], point: [0., 0., 0., 1.] }],
            records: triangle_records(),
            chains: triangle_chains(),
            fill: FillMesh {
                vertices: positions.iter().map(fill).collect(),
                indices: vec![0, 1, 2],
                runs: vec![FillRun::PLAIN],
                ..FillMesh::default()
            },
            bounds: Bounds { min: [0., 0., 0.], max: [1., 1., 0.] },
            counts: triangle_counts(),
            positions,
        }
    }

    #[test]
    fn a_file_of_version_1_is_read() {
        let stored = parse(TRIANGLE).unwrap();
        assert_eq!(stored.to_mesh(), triangle_mesh());
        assert_eq!(stored.name, "triangle.obj");
        let report: &Report = stored.report();
        let [warning] = report.warnings() else { panic!("{report:?}") };
        assert_eq!((warning.code.as_str(), warning.count), ("degenerate", 2));
        assert_eq!(warning.place, Some(Place::Line(9)));
        let [repair] = report.repairs() else { panic!("{report:?}") };
        assert_eq!((repair.kind.as_str(), repair.count), ("flipped_faces", 1));
        assert_eq!(repair.place, Some(Place::Face(1)));
        assert!(stored.layouts().eq([Layout::Indexed]));
    }

    #[test]
    fn sections_come_in_any_order_and_unknown_ones_are_skipped() {
        let mut draft = Draft::triangle();
        draft.sections.reverse();
        draft.push("NEWS", 5, b"something new, 20 by");
        draft.push("NEWS", 1, b"twice");
        draft.push("\n\u{7f}\t\0", 1, b"");
        let bytes = draft.to_bytes();
        assert_eq!(parse(&bytes).unwrap().to_mesh(), triangle_mesh());
    }

    #[test]
    fn materials_are_read_from_their_sections() {
        let mut expected = triangle_mesh();
        expected.fill.runs =
            vec![FillRun { first_triangle: 0, material: 1, group: 0, has_texcoords: 1 }];
        expected.fill.groups = vec!["g".into()];
        let texture = Texture {
            name: "m.png".into(),
            source: TextureSource::Bytes(b"picture".as_slice().into()),
        };
        expected.fill.materials = vec![
            Material { name: "plain".into(), ..Material::default() },
            Material {
                name: "m".into(),
                diffuse: Some([1.0, 0.5, 0.0]),
                opacity: Some(0.25),
                diffuse_texture: Some(texture),
                ..Material::default()
            },
        ];
        let bytes = Draft::with_materials().to_bytes();
        let stored = parse(&bytes).unwrap();
        assert_eq!(stored.to_mesh(), expected);
        let again = to_bytes(&expected, "textured", stored.report(), &[]).unwrap();
        assert_eq!(parse(&again).unwrap().to_mesh(), expected);
    }

    #[test]
    fn a_mesh_without_fill_is_valid() {
        let mut draft = Draft::triangle();
        draft.remove("FVTX");
        draft.remove("FIDX");
        let expected = EdgeMesh { fill: FillMesh::default(), ..triangle_mesh() };
        assert_eq!(parse(&draft.to_bytes()).unwrap().to_mesh(), expected);
    }

    #[test]
    fn every_other_section_must_occur_once_with_its_element_size() {
        let kind_and_place = |draft: &Draft| {
            let error = parse(&draft.to_bytes()).unwrap_err();
            assert!(error.what.ends_with("; build the file again"), "{error}");
            (error.kind, error.place)
        };
        let at = |index: usize| (FileErrorKind::Section, Some(Place::Byte(56 + 24 * index as u64)));
        let whole = Draft::with_materials();
        for (index, section) in whole.sections.iter().enumerate() {
            let tag = std::str::from_utf8(&section.tag).unwrap();
            let mut draft = whole.clone();
            draft.push(tag, section.element_bytes, &section.bytes);
            assert_eq!(kind_and_place(&draft), at(whole.sections.len()), "{tag} twice");
            draft = whole.clone();
            draft.section(tag).element_bytes *= 2;
            assert_eq!(kind_and_place(&draft), at(index), "{tag} of another size");
            draft = whole.clone();
            draft.remove(tag);
            match tag {
                // Without material ranges all triangles are one.
                "FRUN" => assert!(parse(&draft.to_bytes()).is_ok(), "{tag} missing"),
                "FVTX" | "FIDX" | "MTRL" | "PEND" | "PICT" => {
                    assert_eq!(kind_and_place(&draft).0, FileErrorKind::Inconsistent)
                }
                _ => assert_eq!(kind_and_place(&draft), at(0), "{tag} missing"),
            }
        }
        for tag in ["FRAM", "BNDS", "CNTS"] {
            for more in [1, 3, 19] {
                let mut draft = whole.clone();
                draft.resize(tag, more);
                let (kind, place) = kind_and_place(&draft);
                assert_eq!(kind, FileErrorKind::Section, "{tag} of {more}");
                let table_end = 56 + 24 * whole.sections.len() as u64;
                let is_in_section = matches!(place, Some(Place::Byte(byte)) if byte >= table_end);
                assert!(is_in_section, "{place:?}");
            }
        }
    }

    #[test]
    fn broken_json_has_its_place() {
        let mut draft = Draft::triangle();
        draft.section("META").bytes.truncate(20);
        let bytes = draft.to_bytes();
        let error = parse(&bytes).unwrap_err();
        assert_eq!(error.kind, FileErrorKind::Meta);
        let Some(Place::Byte(byte)) = error.place else { panic!("{error:?}") };
        assert!(bytes[usize::try_from(byte).unwrap()..].starts_with(b"{\"name\""));
    }

    #[test]
    fn a_newer_version_is_reported_before_its_content() {
        let draft = Draft { version: 7, ..Draft::triangle() };
        let error = parse(&draft.to_bytes()).unwrap_err();
        assert_eq!(error.kind, FileErrorKind::Version);
        assert!(error.what.starts_with("written by a newer Edgemesh: version 7, this one reads 2"));
    }

    /// A small file with every section.
    fn small_file() -> Vec<u8> {
        let sample = textured();
        to_bytes(&sample.mesh, sample.name, &sample.report, &Layout::ALL).unwrap()
    }

    #[test]
    fn every_truncation_is_found() {
        let bytes = small_file();
        assert!(parse(&bytes).is_ok());
        for length in 0..bytes.len() {
            let error = parse(&bytes[..length]).unwrap_err();
            assert_eq!(error.kind, FileErrorKind::Truncated, "{length}: {error}");
        }
        let longer = [&bytes[..], b"\0"].concat();
        assert_eq!(parse(&longer).unwrap_err().kind, FileErrorKind::Excess);
    }

    /// The kind of error of a file with one bit flipped.
    fn kind_of_flip(bytes: &mut [u8], bit: usize) -> FileErrorKind {
        bytes[bit / 8] ^= 1 << (bit % 8);
        let kind = parse(bytes).expect_err("a bit was flipped").kind;
        bytes[bit / 8] ^= 1 << (bit % 8);
        kind
    }

    #[test]
    fn every_flipped_bit_is_found() {
        for mut bytes in [small_file(), TRIANGLE.to_vec()] {
            for bit in 0..8 * bytes.len() {
                let kind = kind_of_flip(&mut bytes, bit);
                let expected = match bit / 8 {
                    0..8 => kind == FileErrorKind::Magic,
                    8..12 => kind == FileErrorKind::Version,
                    16..24 => matches!(kind, FileErrorKind::Truncated | FileErrorKind::Excess),
                    _ => kind == FileErrorKind::Checksum,
                };
                assert!(expected, "bit {bit}: {kind:?}");
            }
            assert!(parse(&bytes).is_ok(), "the bytes are unchanged");
        }
    }

    #[test]
    fn flipped_bits_of_a_larger_file_are_found() {
        let sample = sheet(30);
        let mut bytes = to_bytes(&sample.mesh, "", &sample.report, &[]).unwrap();
        assert!(bytes.len() > 200_000, "{}", bytes.len());
        let mut state = 12345_u64;
        for _ in 0..500 {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            let bit = usize::try_from(state >> 33).unwrap() % (8 * bytes.len());
            kind_of_flip(&mut bytes, bit);
        }
    }

    #[test]
    fn a_file_is_read_in_place_and_at_any_address() {
        for sample in samples() {
            let bytes = to_bytes(&sample.mesh, sample.name, &sample.report, &Layout::ALL).unwrap();
            let mut words = vec![0_u64; bytes.len() / 8 + 3];
            let buffer: &mut [u8] = bytemuck::cast_slice_mut(&mut words);
            for start in 0..=8 {
                buffer[start..start + bytes.len()].copy_from_slice(&bytes);
                let stored = parse(&buffer[start..start + bytes.len()]).unwrap();
                assert_eq!(stored.to_mesh(), sample.mesh, "{} at {start}", sample.name);
                assert_eq!(stored, parse(&bytes).unwrap());
                if !sample.mesh.records.is_empty() && cfg!(target_endian = "little") {
                    let is_in_place = matches!(stored.records, Cow::Borrowed(_));
                    assert_eq!(is_in_place, start % 4 == 0, "{} at {start}", sample.name);
                }
            }
        }
    }
}
