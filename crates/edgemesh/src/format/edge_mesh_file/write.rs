//! From an [`EdgeMesh`] to the bytes of a file: sections in a fixed order, so
//! that the same mesh gives the same bytes.

use std::borrow::Cow;

use super::Layout;
use super::check::check;
use super::element::{self, Element};
use super::error::{FileError, FileErrorKind};
use super::header::write_header;
use super::looks::{Looks, embedded};
use super::meta::to_json;
use super::numbers::{of_counts, of_frame};
use super::section::{ALIGNMENT, ENTRY_BYTES, Section, TABLE_START, Tag};
use super::stored::StoredMesh;
use crate::edge_mesh::EdgeMesh;
use crate::edge_mesh::replicate::{replicate, replicate_16};
use crate::index::to_u32;
use crate::report::Report;

/// The bytes of a file of `mesh`, made of the model that is called `name`, with
/// the report of its build. The indexed layout is always in it. Pictures that lie
/// in files are read and become part of it.
///
/// # Errors
/// [`FileErrorKind::Inconsistent`] where an index of the mesh leads nowhere,
/// which none does that [`crate::build`] made; [`FileErrorKind::Texture`] where a
/// picture cannot be read; [`FileErrorKind::Size`] where there is no memory for
/// the file.
pub fn to_bytes(
    mesh: &EdgeMesh,
    name: &str,
    report: &Report,
    layouts: &[Layout],
) -> Result<Vec<u8>, FileError> {
    let mut stored = StoredMesh::of(mesh, name, report);
    check(&stored).map_err(|flaw| flaw.at(None))?;
    stored.materials = embedded(&mesh.fill.materials)?;
    let looks = Looks::of(&stored.materials);
    stored.replicated_f32 =
        layouts.contains(&Layout::ReplicatedF32).then(|| replicate(mesh).into());
    stored.replicated_i16 =
        layouts.contains(&Layout::ReplicatedI16).then(|| replicate_16(mesh).into());
    let (frame, counts) = (of_frame(&stored.frame), of_counts(&stored.counts));
    let bounds = [stored.bounds.min, stored.bounds.max];
    let json = to_json(&stored)?;
    let mut parts = parts_of(&stored);
    parts.extend(parts_of_looks(&looks));
    parts.push(Part::new(Tag::FRAME, &frame));
    parts.push(Part::new(Tag::BOUNDS, &bounds));
    parts.push(Part::new(Tag::COUNTS, &counts));
    parts.push(Part::new(Tag::META, &json));
    assemble(&parts)
}

/// A section, before it has a place.
struct Part<'a> {
    tag: Tag,
    element_bytes: usize,
    bytes: Cow<'a, [u8]>,
}

impl<'a> Part<'a> {
    fn new<T: Element>(tag: Tag, items: &'a [T]) -> Self {
        Self { tag, element_bytes: size_of::<T>(), bytes: element::to_bytes(items) }
    }
}

fn parts_of<'a>(mesh: &'a StoredMesh<'_>) -> Vec<Part<'a>> {
    let mut parts = vec![
        Part::new(Tag::POSITIONS, &mesh.positions),
        Part::new(Tag::VERTEX_NORMALS, &mesh.vertex_normals),
        Part::new(Tag::SPLIT_FROM, &mesh.split_from),
        Part::new(Tag::TRIANGLES, &mesh.triangles),
        Part::new(Tag::FACE_PLANES, &mesh.face_planes),
        Part::new(Tag::RECORDS, &mesh.records),
        Part::new(Tag::CHAINS, &mesh.chains),
        Part::new(Tag::LINKS, &mesh.links),
    ];
    if !mesh.fill_vertices.is_empty() {
        parts.push(Part::new(Tag::FILL_VERTICES, &mesh.fill_vertices));
        parts.push(Part::new(Tag::FILL_INDICES, &mesh.fill_indices));
    }
    if !mesh.fill_runs.is_empty() {
        parts.push(Part::new(Tag::FILL_RUNS, &mesh.fill_runs));
    }
    if let Some(vertices) = &mesh.replicated_f32 {
        parts.push(Part::new(Tag::REPLICATED_F32, vertices));
    }
    if let Some(vertices) = &mesh.replicated_i16 {
        parts.push(Part::new(Tag::REPLICATED_I16, vertices));
    }
    parts
}

/// Those sections of materials that have anything in them.
fn parts_of_looks(looks: &Looks) -> impl Iterator<Item = Part<'_>> {
    let parts = [
        Part::new(Tag::MATERIALS, &looks.materials),
        Part::new(Tag::PICTURE_ENDS, &looks.picture_ends),
        Part::new(Tag::PICTURES, &looks.pictures),
    ];
    parts.into_iter().filter(|part| !part.bytes.is_empty())
}

/// Puts header, table and sections in a row.
fn assemble(parts: &[Part<'_>]) -> Result<Vec<u8>, FileError> {
    let mut end = TABLE_START + parts.len() * ENTRY_BYTES;
    let mut table = Vec::with_capacity(parts.len());
    for part in parts {
        let offset = end.next_multiple_of(ALIGNMENT);
        end = offset + part.bytes.len();
        table.push(Section {
            tag: part.tag,
            element_bytes: to_u32(part.element_bytes),
            offset: offset as u64,
            count: (part.bytes.len() / part.element_bytes) as u64,
        });
    }
    let mut bytes = Vec::new();
    bytes.try_reserve_exact(end).map_err(|_| {
        FileError::new(FileErrorKind::Size, format!("no memory for a file of {end} bytes"))
    })?;
    bytes.resize(TABLE_START, 0);
    for section in &table {
        bytes.extend_from_slice(&section.to_bytes());
    }
    for part in parts {
        bytes.resize(bytes.len().next_multiple_of(ALIGNMENT), 0);
        bytes.extend_from_slice(&part.bytes);
    }
    write_header(&mut bytes, to_u32(table.len()));
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::edge_mesh::record::EdgeFlags;
    use crate::format::edge_mesh_file::parse;
    use crate::format::edge_mesh_file::samples::{Sample, looks, samples, sheet, triangle};
    use crate::model::{Texture, TextureSource};
    use crate::report::{RepairKind, WarningCode};

    fn written(sample: &Sample, layouts: &[Layout]) -> Vec<u8> {
        to_bytes(&sample.mesh, sample.name, &sample.report, layouts).unwrap()
    }

    #[test]
    fn whatever_is_written_is_read_again() {
        for sample in samples() {
            let Sample { name, mesh, report } = &sample;
            let bytes = written(&sample, &[]);
            let stored = parse(&bytes).unwrap();
            assert_eq!(stored, StoredMesh::of(mesh, name, report));
            assert_eq!(stored.to_mesh(), *mesh, "{name}");
            assert_eq!((&*stored.name, stored.report()), (*name, report));
            assert!(stored.layouts().eq([Layout::Indexed]));
        }
    }

    #[test]
    fn the_replicated_layouts_are_added_where_they_are_asked_for() {
        for sample in samples() {
            let bytes = written(&sample, &Layout::ALL);
            let stored = parse(&bytes).unwrap();
            assert!(stored.layouts().eq(Layout::ALL));
            assert_eq!(stored.replicated_f32.as_deref(), Some(&*replicate(&sample.mesh)));
            assert_eq!(stored.replicated_i16.as_deref(), Some(&*replicate_16(&sample.mesh)));
            assert_eq!(stored.to_mesh(), sample.mesh);
            let bytes = written(&sample, &[Layout::ReplicatedI16]);
            let stored = parse(&bytes).unwrap();
            assert!(stored.layouts().eq([Layout::Indexed, Layout::ReplicatedI16]));
        }
    }

    /// The picture of the file is the only difference.
    #[test]
    fn pictures_of_files_become_part_of_the_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("bark.png");
        std::fs::write(&path, b"\x89PNG\r\n\x1a\nbark").unwrap();
        let embedded = looks();
        let mut beside = looks();
        for material in &mut beside.mesh.fill.materials {
            if let Some(Texture { name, source }) = &mut material.diffuse_texture
                && name == "bark.png"
            {
                *source = TextureSource::File(path.clone());
            }
        }
        assert_ne!(beside.mesh, embedded.mesh);
        assert!(written(&beside, &[]) == written(&embedded, &[]), "the same bytes");
        drop(folder);
        let error = to_bytes(&beside.mesh, "", &beside.report, &[]).unwrap_err();
        assert_eq!(error.kind, FileErrorKind::Texture);
    }

    /// The samples are what they are meant to be.
    #[test]
    fn between_them_the_samples_fill_every_field() {
        let samples = samples();
        let some = |has: &dyn Fn(&Sample) -> bool| samples.iter().any(has);
        let has_flag = |flag| some(&|s| s.mesh.records.iter().any(|r| r.flags.contains(flag)));
        for flag in EdgeFlags::all().iter() {
            assert!(has_flag(flag), "{flag:?}");
        }
        assert!(some(&|s| !s.mesh.split_from.is_empty()));
        assert!(some(&|s| !s.mesh.frame.is_identity()));
        assert!(some(&|s| s.mesh.triangles.is_empty() && !s.mesh.records.is_empty()));
        assert!(some(&|s| !s.mesh.fill.indices.is_empty()));
        assert!(some(&|s| s.mesh.fill.runs.len() > 2 && s.mesh.fill.groups.len() > 1));
        assert!(some(&|s| s.mesh.fill.materials.iter().any(|m| m.diffuse_texture.is_some())));
        for code in [WarningCode::NonFinite, WarningCode::Material, WarningCode::Orientation] {
            assert!(some(&|s| s.report.count(code) > 0), "{code}");
        }
        for kind in [RepairKind::FlippedFaces, RepairKind::SplitEdges, RepairKind::Recentred] {
            assert!(some(&|s| s.report.repair_count(kind) > 0), "{kind:?}");
        }
    }

    #[test]
    fn sections_lie_one_behind_the_other_with_zeros_between() {
        for sample in samples() {
            let bytes = written(&sample, &Layout::ALL);
            let count = bytes[12] as usize;
            let mut end = 56 + 24 * count;
            for entry in bytes[56..end].chunks_exact(24) {
                let number = |at: usize| u32::from_le_bytes(*entry[at..].first_chunk().unwrap());
                let start = number(8) as usize;
                assert!(start.is_multiple_of(16) && start - end < 16, "{start} behind {end}");
                assert!(bytes[end..start].iter().all(|&byte| byte == 0));
                end = start + (number(4) * number(16)) as usize;
            }
            assert_eq!(end, bytes.len());
        }
    }

    #[test]
    fn the_bytes_do_not_depend_on_threads_or_the_order_of_layouts() {
        let with_threads = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| written(&sheet(160), &Layout::ALL))
        };
        let one = with_threads(1);
        assert!(one == with_threads(2) && one == with_threads(4), "the same bytes");
        let triangle = triangle();
        let [a, b, c] = Layout::ALL;
        assert!(written(&triangle, &[c, a, b, c]) == written(&triangle, &Layout::ALL));
    }

    #[test]
    fn a_mesh_whose_indices_lead_nowhere_is_not_written() {
        let mut sample = triangle();
        sample.mesh.records[2].v1 = 3;
        let error = to_bytes(&sample.mesh, "", &sample.report, &Layout::ALL).unwrap_err();
        assert_eq!((error.kind, error.place), (FileErrorKind::Inconsistent, None));
        let expected = "section EDGE, element 2: names vertex 3, and there are 3";
        assert!(error.what.starts_with(expected), "{}", error.what);
        let mut sample = looks();
        sample.mesh.fill.runs[1].material = 4;
        let error = to_bytes(&sample.mesh, "", &sample.report, &[]).unwrap_err();
        let expected = "section FRUN, element 1: names material 4, and there are 4";
        assert!(error.what.starts_with(expected), "{}", error.what);
    }
}
