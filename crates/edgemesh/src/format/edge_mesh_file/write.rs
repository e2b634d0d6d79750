//! Writes an [`EdgeMesh`] as the bytes of a file. The sections have a fixed order, so that
//! equal meshes give equal bytes.

use std::borrow::Cow;

use super::check::check;
use super::element::{self, Element};
use super::error::{FileError, FileErrorKind};
use super::header::{TABLE_START, write_header};
use super::instances::InstanceSections;
use super::layout::Layout;
use super::materials::{MaterialSections, with_pictures};
use super::meta::to_json;
use super::numbers::{of_counts, of_frame};
use super::section::{ALIGNMENT, ENTRY_BYTES, Section, Tag};
use super::stored::StoredMesh;
use crate::edge_mesh::{EdgeMesh, InstancedMesh, replicate, replicate_16};
use crate::index::{MAX_PLACEMENTS, to_u32};
use crate::report::Report;

/// The bytes of a file with `mesh`, the name of its model and the report of its build. The
/// indexed layout is always included. Pictures in files are read and stored.
///
/// # Errors
/// [`FileErrorKind::Inconsistent`] if an index of the mesh is out of range, which does not
/// happen with meshes of [`crate::build`]; [`FileErrorKind::Texture`] if a picture cannot
/// be read; [`FileErrorKind::Size`] if there is not enough memory.
pub fn to_bytes(
    mesh: &EdgeMesh,
    name: &str,
    report: &Report,
    layouts: &[Layout],
) -> Result<Vec<u8>, FileError> {
    to_bytes_with_instances(mesh, &[], name, report, layouts)
}

/// As [`to_bytes`], with meshes in several places, which must be in the frame of `mesh`. Their files
/// have the same layouts.
///
/// # Errors
/// As [`to_bytes`]; [`FileErrorKind::Size`] for more than [`MAX_PLACEMENTS`] places.
pub fn to_bytes_with_instances(
    mesh: &EdgeMesh,
    instanced: &[InstancedMesh],
    name: &str,
    report: &Report,
    layouts: &[Layout],
) -> Result<Vec<u8>, FileError> {
    let instances = instance_sections(instanced, name, layouts)?;
    let mut stored = StoredMesh::of(mesh, name, report);
    check(&stored).map_err(|flaw| flaw.at(None))?;
    stored.materials = with_pictures(&mesh.fill.materials)?;
    let materials = MaterialSections::new(&stored.materials);
    stored.replicated_f32 =
        layouts.contains(&Layout::ReplicatedF32).then(|| replicate(mesh).into());
    stored.replicated_i16 =
        layouts.contains(&Layout::ReplicatedI16).then(|| replicate_16(mesh).into());
    let (frame, counts) = (of_frame(&stored.frame), of_counts(&stored.counts));
    let bounds = [stored.bounds.min, stored.bounds.max];
    let json = to_json(&stored)?;
    let mut contents = mesh_contents(&stored);
    contents.extend(material_contents(&materials));
    contents.extend(instance_contents(&instances));
    contents.push(SectionContent::new(Tag::FRAME, &frame));
    contents.push(SectionContent::new(Tag::BOUNDS, &bounds));
    contents.push(SectionContent::new(Tag::COUNTS, &counts));
    contents.push(SectionContent::new(Tag::META, &json));
    assemble(&contents)
}

fn instance_sections(
    instanced: &[InstancedMesh],
    name: &str,
    layouts: &[Layout],
) -> Result<InstanceSections, FileError> {
    let places: usize = instanced.iter().map(|own| own.placements.len()).sum();
    if places > MAX_PLACEMENTS {
        let what = format!("{places} placements; the limit is {MAX_PLACEMENTS}: split the scene");
        return Err(FileError::new(FileErrorKind::Size, what));
    }
    let mut files = Vec::new();
    for own in instanced {
        files.push((own, to_bytes(&own.mesh, name, &Report::default(), layouts)?));
    }
    Ok(InstanceSections::new(files))
}

/// The sections of instances that are not empty.
fn instance_contents(instances: &InstanceSections) -> impl Iterator<Item = SectionContent<'_>> {
    let contents = [
        SectionContent::new(Tag::INSTANCES, &instances.ends),
        SectionContent::new(Tag::INSTANCED_MESHES, &instances.files),
        SectionContent::new(Tag::PLACEMENTS, &instances.placements),
    ];
    contents.into_iter().filter(|content| !content.bytes.is_empty())
}

/// The content of a section, before its place in the file is known.
struct SectionContent<'a> {
    tag: Tag,
    element_bytes: usize,
    bytes: Cow<'a, [u8]>,
}

impl<'a> SectionContent<'a> {
    fn new<T: Element>(tag: Tag, items: &'a [T]) -> Self {
        Self { tag, element_bytes: size_of::<T>(), bytes: element::to_bytes(items) }
    }
}

/// The sections of a mesh, without its materials.
fn mesh_contents<'a>(mesh: &'a StoredMesh<'_>) -> Vec<SectionContent<'a>> {
    let mut contents = vec![
        SectionContent::new(Tag::POSITIONS, &mesh.positions),
        SectionContent::new(Tag::VERTEX_NORMALS, &mesh.vertex_normals),
        SectionContent::new(Tag::SPLIT_FROM, &mesh.split_from),
        SectionContent::new(Tag::TRIANGLES, &mesh.triangles),
        SectionContent::new(Tag::FACE_PLANES, &mesh.face_planes),
        SectionContent::new(Tag::RECORDS, &mesh.records),
        SectionContent::new(Tag::CHAINS, &mesh.chains),
        SectionContent::new(Tag::LINKS, &mesh.links),
    ];
    if !mesh.fill_vertices.is_empty() {
        contents.push(SectionContent::new(Tag::FILL_VERTICES, &mesh.fill_vertices));
        contents.push(SectionContent::new(Tag::FILL_INDICES, &mesh.fill_indices));
    }
    if !mesh.fill_colors.is_empty() {
        contents.push(SectionContent::new(Tag::FILL_COLORS, &mesh.fill_colors));
    }
    if !mesh.fill_runs.is_empty() {
        contents.push(SectionContent::new(Tag::FILL_RUNS, &mesh.fill_runs));
    }
    if let Some(vertices) = &mesh.replicated_f32 {
        contents.push(SectionContent::new(Tag::REPLICATED_F32, vertices));
    }
    if let Some(vertices) = &mesh.replicated_i16 {
        contents.push(SectionContent::new(Tag::REPLICATED_I16, vertices));
    }
    contents
}

/// The sections of materials that are not empty.
fn material_contents(materials: &MaterialSections) -> impl Iterator<Item = SectionContent<'_>> {
    let contents = [
        SectionContent::new(Tag::MATERIALS, &materials.materials),
        SectionContent::new(Tag::PICTURE_ENDS, &materials.picture_ends),
        SectionContent::new(Tag::PICTURES, &materials.pictures),
    ];
    contents.into_iter().filter(|content| !content.bytes.is_empty())
}

/// Joins header, table and sections.
fn assemble(contents: &[SectionContent<'_>]) -> Result<Vec<u8>, FileError> {
    let mut end = TABLE_START + contents.len() * ENTRY_BYTES;
    let mut table = Vec::with_capacity(contents.len());
    for content in contents {
        let offset = end.next_multiple_of(ALIGNMENT);
        end = offset + content.bytes.len();
        table.push(Section {
            tag: content.tag,
            element_bytes: to_u32(content.element_bytes),
            offset: offset as u64,
            count: (content.bytes.len() / content.element_bytes) as u64,
        });
    }
    let mut bytes = Vec::new();
    bytes.try_reserve_exact(end).map_err(|_| {
        FileError::new(FileErrorKind::Size, format!("not enough memory for a file of {end} bytes"))
    })?;
    bytes.resize(TABLE_START, 0);
    for section in &table {
        bytes.extend_from_slice(&section.to_bytes());
    }
    for content in contents {
        bytes.resize(bytes.len().next_multiple_of(ALIGNMENT), 0);
        bytes.extend_from_slice(&content.bytes);
    }
    write_header(&mut bytes, to_u32(table.len()));
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::edge_mesh::EdgeFlags;
    use crate::format::edge_mesh_file::parse;
    use crate::format::edge_mesh_file::samples::{Sample, samples, sheet, textured, triangle};
    use crate::model::{Texture, TextureSource};
    use crate::report::{RepairKind, WarningCode};

    fn written(sample: &Sample, layouts: &[Layout]) -> Vec<u8> {
        to_bytes(&sample.mesh, sample.name, &sample.report, layouts).unwrap()
    }

    #[test]
    fn every_written_file_is_read_back() {
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
    fn the_replicated_layouts_are_added_on_request() {
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

    /// The meshes differ only in the place of a picture.
    #[test]
    fn pictures_in_files_are_stored() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("bark.png");
        std::fs::write(&path, b"\x89PNG\r\n\x1a\nbark").unwrap();
        let embedded = textured();
        let mut beside = textured();
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

    /// The samples have what they are meant to have.
    #[test]
    fn together_the_samples_fill_every_field() {
        let samples = samples();
        let some = |has: &dyn Fn(&Sample) -> bool| samples.iter().any(has);
        let has_flag = |flag| some(&|s| s.mesh.records.iter().any(|r| r.flags().contains(flag)));
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
        for kind in [RepairKind::FlippedFaces, RepairKind::SplitEdges, RepairKind::Recentered] {
            assert!(some(&|s| s.report.repair_count(kind) > 0), "{kind:?}");
        }
    }

    #[test]
    fn sections_are_consecutive_with_zeros_between() {
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
    fn a_mesh_with_an_index_out_of_range_is_not_written() {
        let mut sample = triangle();
        sample.mesh.records[2].v1 = 3;
        let error = to_bytes(&sample.mesh, "", &sample.report, &Layout::ALL).unwrap_err();
        assert_eq!((error.kind, error.place), (FileErrorKind::Inconsistent, None));
        let expected = "section EDGE, element 2: names vertex 3; there are 3";
        assert!(error.what.starts_with(expected), "{}", error.what);
        let mut sample = textured();
        sample.mesh.fill.runs[1].material = 4;
        let error = to_bytes(&sample.mesh, "", &sample.report, &[]).unwrap_err();
        let expected = "section FRUN, element 1: names material 4; there are 4";
        assert!(error.what.starts_with(expected), "{}", error.what);
    }
}
