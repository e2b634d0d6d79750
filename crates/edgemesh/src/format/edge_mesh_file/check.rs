//! Checks that the lists of a file agree with each other.
//!
//! A correct checksum shows only that a file is unchanged. These checks show that all
//! its indices are in range. The writer runs them too, so that every file that is
//! written can be read. They take linear time. Floats may have any value: they can
//! spoil a picture, but not the program.

use super::error::{FileError, FileErrorKind};
use super::materials::StoredMaterial;
use super::numbers::of_counts;
use super::section::Tag;
use super::stored::StoredMesh;
use crate::edge_mesh::{Chain, EdgeRecord};
use crate::index::NONE;
use crate::report::Place;

/// A fault in an element of a section.
#[derive(Debug)]
pub(super) struct Flaw {
    pub(super) tag: Tag,
    pub(super) element: usize,
    what: String,
}

impl Flaw {
    /// The error for this flaw, at a place in the file.
    pub(super) fn at(self, place: Option<Place>) -> FileError {
        let Self { tag, element, what } = self;
        let what = format!("section {tag}, element {element}: {what}; build the file again");
        FileError { kind: FileErrorKind::Inconsistent, place, what }
    }
}

/// Checks that the lengths of lists agree, and that all indices are in range.
pub(super) fn check(mesh: &StoredMesh<'_>) -> Result<(), Flaw> {
    check_lengths(mesh)?;
    check_counts(mesh)?;
    check_runs(mesh)?;
    let vertices = ("vertex", mesh.positions.len());
    let welded = ("welded vertex", mesh.positions.len() - mesh.split_from.len());
    let fill_vertices = ("fill vertex", mesh.fill_vertices.len());
    all_below(Tag::SPLIT_FROM, &mesh.split_from, welded, |&vertex| [vertex])?;
    all_below(Tag::TRIANGLES, &mesh.triangles, vertices, |&triangle| triangle)?;
    all_below(Tag::RECORDS, &mesh.records, vertices, |record| [record.v0, record.v1])?;
    all_below(Tag::FILL_INDICES, &mesh.fill_indices, fill_vertices, |&vertex| [vertex])?;
    none_has_a_fault(Tag::RECORDS, &mesh.records, |record| face_fault(record, &mesh.triangles))?;
    none_has_a_fault(Tag::CHAINS, &mesh.chains, |chain| chain_fault(chain, mesh.links.len()))?;
    all_below(Tag::LINKS, &mesh.links, ("record", mesh.records.len()), |link| [link.record])?;
    all_below(Tag::LINKS, &mesh.links, ("chain", mesh.chains.len()), |link| [link.chain])
}

fn check_lengths(mesh: &StoredMesh<'_>) -> Result<(), Flaw> {
    let vertices = mesh.positions.len();
    let faces = mesh.triangles.len();
    let replicated = 4 * mesh.records.len();
    let has_fill = !mesh.fill_indices.is_empty() || !mesh.fill_vertices.is_empty();
    let indices = if has_fill { 3 * faces } else { 0 };
    let colors = if mesh.fill_colors.is_empty() { 0 } else { mesh.fill_vertices.len() };
    let floats = mesh.replicated_f32.as_ref().map_or(replicated, |list| list.len());
    let steps = mesh.replicated_i16.as_ref().map_or(replicated, |list| list.len());
    for (tag, found, needed) in [
        (Tag::VERTEX_NORMALS, mesh.vertex_normals.len(), vertices),
        (Tag::FACE_PLANES, mesh.face_planes.len(), faces),
        (Tag::FILL_INDICES, mesh.fill_indices.len(), indices),
        (Tag::FILL_COLORS, mesh.fill_colors.len(), colors),
        (Tag::REPLICATED_F32, floats, replicated),
        (Tag::REPLICATED_I16, steps, replicated),
        (Tag::SPLIT_FROM, mesh.split_from.len(), mesh.split_from.len().min(vertices)),
    ] {
        if found != needed {
            let what = format!("there are {found}, and the other sections need {needed}");
            return Err(Flaw { tag, element: 0, what });
        }
    }
    Ok(())
}

/// Checks that material ranges ascend from triangle 0, with valid indices.
fn check_runs(mesh: &StoredMesh<'_>) -> Result<(), Flaw> {
    let runs = &*mesh.fill_runs;
    let flaw = |element: usize, what: String| Flaw { tag: Tag::FILL_RUNS, element, what };
    if runs.is_empty() != mesh.fill_indices.is_empty() {
        let what =
            format!("there are {} for a fill of {} indices", runs.len(), mesh.fill_indices.len());
        return Err(flaw(0, what));
    }
    let mut least = 0;
    for (element, run) in runs.iter().enumerate() {
        let first = run.first_triangle;
        if first < least || element == 0 && first > 0 {
            return Err(flaw(element, format!("begins at triangle {first}, out of order")));
        }
        least = first.saturating_add(1);
    }
    let names = |list: &str, index: u32, count: usize| {
        let is_wrong = index != NONE && index as usize >= count;
        is_wrong.then(|| format!("names {list} {index}; there are {count}"))
    };
    let triangles = ("triangle", mesh.triangles.len());
    all_below(Tag::FILL_RUNS, runs, triangles, |run| [run.first_triangle])?;
    none_has_a_fault(Tag::FILL_RUNS, runs, |run| {
        names("material", run.material, mesh.materials.len())
            .or_else(|| names("group", run.group, mesh.groups.len()))
            .or_else(|| {
                let flag = run.has_texcoords;
                (flag > 1).then(|| format!("has the flag {flag} instead of 0 or 1"))
            })
    })
}

/// Checks materials and pictures, given the bytes of all pictures and the number of
/// names.
pub(super) fn check_materials(
    materials: &[StoredMaterial],
    picture_ends: &[u64],
    picture_bytes: usize,
    names: usize,
) -> Result<(), Flaw> {
    if materials.len() != names {
        let what = format!("there are {}, and META has names for {names}", materials.len());
        return Err(Flaw { tag: Tag::MATERIALS, element: 0, what });
    }
    let mut start = 0;
    for (element, &end) in picture_ends.iter().enumerate() {
        if end < start || end > picture_bytes as u64 {
            let what = format!("has bytes {start} to {end} of {picture_bytes}");
            return Err(Flaw { tag: Tag::PICTURE_ENDS, element, what });
        }
        start = end;
    }
    let pictures = picture_ends.len();
    none_has_a_fault(Tag::MATERIALS, materials, |&StoredMaterial { picture, .. }| {
        let is_wrong = picture != NONE && picture as usize >= pictures;
        is_wrong.then(|| format!("names picture {picture}; there are {pictures}"))
    })
}

/// Checks that counts fit into 32 bits, so that sums cannot overflow. The reader uses
/// the largest value for a count that does not fit into the address space.
fn check_counts(mesh: &StoredMesh<'_>) -> Result<(), Flaw> {
    none_has_a_fault(Tag::COUNTS, &of_counts(&mesh.counts), |count| {
        (*count >= u64::from(NONE)).then(|| format!("counts {count}, more than any index"))
    })
}

/// Checks that the `indices` of all elements are below `limit`; `name` is what they
/// refer to.
fn all_below<T, const N: usize>(
    tag: Tag,
    elements: &[T],
    (name, limit): (&str, usize),
    indices: impl Fn(&T) -> [u32; N],
) -> Result<(), Flaw> {
    none_has_a_fault(tag, elements, |element| {
        let outside = indices(element).into_iter().find(|&index| index as usize >= limit)?;
        Some(format!("names {name} {outside}; there are {limit}"))
    })
}

/// Fails with the first element that has a fault.
fn none_has_a_fault<T>(
    tag: Tag,
    elements: &[T],
    fault: impl Fn(&T) -> Option<String>,
) -> Result<(), Flaw> {
    let faults = elements.iter().enumerate();
    let first = faults.filter_map(|(element, item)| Some((element, fault(item)?))).next();
    first.map_or(Ok(()), |(element, what)| Err(Flaw { tag, element, what }))
}

/// The fault of a record's faces, if any.
fn face_fault(record: &EdgeRecord, triangles: &[[u32; 3]]) -> Option<String> {
    let &EdgeRecord { v0, v1, face_a, face_b, .. } = record;
    if face_a == NONE && face_b != NONE {
        return Some("has a face B but no face A".into());
    }
    let fault = |face: u32| match triangles.get(face as usize) {
        None => Some(format!("names face {face}; there are {}", triangles.len())),
        Some(triangle) if triangle.iter().all(|&vertex| vertex == v0 || vertex == v1) => {
            Some(format!("has face {face}, which has no vertex off the edge"))
        }
        Some(_) => None,
    };
    [face_a, face_b].into_iter().filter(|&face| face != NONE).find_map(fault)
}

/// The fault of a chain's range of links, if any.
fn chain_fault(chain: &Chain, links: usize) -> Option<String> {
    let &Chain { first_link, link_count, .. } = chain;
    let is_within = first_link.checked_add(link_count).is_some_and(|end| end as usize <= links);
    let what = || format!("has {link_count} links from {first_link} on; there are {links}");
    (!is_within).then(what)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::{BuildOptions, reclassify};
    use crate::edge_mesh::{replicate, replicate_16};
    use crate::format::edge_mesh_file::draft::{Draft, seal};
    use crate::format::edge_mesh_file::samples::samples;
    use crate::format::edge_mesh_file::{Layout, parse, to_bytes};
    use crate::index::to_u32;
    use crate::view::count_features;

    /// The error of the file of one triangle after a change, with a correct checksum.
    fn error(change: impl FnOnce(&mut Draft)) -> String {
        error_of(Draft::triangle(), change)
    }

    fn error_of(mut draft: Draft, change: impl FnOnce(&mut Draft)) -> String {
        change(&mut draft);
        let bytes = draft.to_bytes();
        let error = parse(&bytes).unwrap_err();
        assert_eq!(error.kind, FileErrorKind::Inconsistent, "{error}");
        assert!(matches!(error.place, Some(Place::Byte(byte)) if byte <= bytes.len() as u64));
        let what = error.what.strip_prefix("section ").unwrap();
        what.strip_suffix("; build the file again").unwrap().into()
    }

    #[test]
    fn lists_of_different_lengths_are_refused() {
        for (tag, count, needed) in [
            ("NORM", 2, 3),
            ("NORM", 4, 3),
            ("PLAN", 0, 1),
            ("PLAN", 2, 1),
            ("FIDX", 0, 3),
            ("FIDX", 2, 3),
            ("FIDX", 6, 3),
            ("SPLT", 4, 3),
        ] {
            let expected = format!(
                "{tag}, element 0: there are {count}, and the other sections need {needed}"
            );
            assert_eq!(error(|draft| draft.resize(tag, count)), expected);
        }
        for (tag, element_bytes) in [("RF32", 80), ("RI16", 40)] {
            for count in [0, 1, 11, 13] {
                let list = vec![0; count * element_bytes as usize];
                let what = error(|draft| draft.push(tag, element_bytes, &list));
                let expected = format!("there are {count}, and the other sections need 12");
                assert_eq!(what, format!("{tag}, element 0: {expected}"));
            }
        }
        for count in [1, 2, 4] {
            let what = error(|draft| draft.push("FCOL", 4, &vec![9; 4 * count]));
            let expected = format!("there are {count}, and the other sections need 3");
            assert_eq!(what, format!("FCOL, element 0: {expected}"));
        }
        let what = error(|draft| draft.resize("POSI", 4));
        assert_eq!(what, "NORM, element 0: there are 3, and the other sections need 4");
        let what = error(|draft| draft.resize("TRIS", 0));
        assert_eq!(what, "PLAN, element 0: there are 1, and the other sections need 0");
    }

    #[test]
    fn indices_out_of_range_are_refused() {
        for (tag, number, element, name, count) in [
            ("TRIS", 2, 0, "vertex", 3),
            ("EDGE", 0, 0, "vertex", 3),
            ("EDGE", 11, 2, "vertex", 3),
            ("EDGE", 7, 1, "face", 1),
            ("EDGE", 13, 2, "face", 1),
            ("LNKS", 8, 2, "record", 3),
            ("LNKS", 5, 1, "chain", 3),
            ("FIDX", 1, 1, "fill vertex", 3),
        ] {
            for index in [count, count + 1, NONE - 1] {
                let what = error(|draft| draft.set(tag, number, index));
                let expected = format!("names {name} {index}; there are {count}");
                assert_eq!(what, format!("{tag}, element {element}: {expected}"));
            }
        }
        for (tag, number) in [("TRIS", 1), ("EDGE", 1), ("LNKS", 0), ("LNKS", 1), ("FIDX", 2)] {
            let what = error(|draft| draft.set(tag, number, NONE));
            assert!(what.contains("names"), "only a face may be missing: {what}");
        }
    }

    #[test]
    fn material_ranges_ascend_and_have_valid_indices() {
        for (number, value, what) in [
            (0, 1, "begins at triangle 1, out of order"),
            (1, 2, "names material 2; there are 2"),
            (1, NONE - 1, "names material 4294967294; there are 2"),
            (2, 1, "names group 1; there are 1"),
            (3, 2, "has the flag 2 instead of 0 or 1"),
        ] {
            let found = error_of(Draft::with_materials(), |draft| draft.set("FRUN", number, value));
            assert_eq!(found, format!("FRUN, element 0: {what}"));
        }
        let with_second = |first: u32| {
            error_of(Draft::with_materials(), |draft| {
                draft.resize("FRUN", 2);
                draft.set("FRUN", 4, first);
            })
        };
        assert_eq!(with_second(0), "FRUN, element 1: begins at triangle 0, out of order");
        assert_eq!(with_second(1), "FRUN, element 1: names triangle 1; there are 1");
        assert_eq!(with_second(NONE), "FRUN, element 1: names triangle 4294967295; there are 1");
        let what = error_of(Draft::with_materials(), |draft| draft.resize("FRUN", 0));
        assert_eq!(what, "FRUN, element 0: there are 0 for a fill of 3 indices");
        let what = error_of(Draft::with_materials(), |draft| {
            draft.remove("FVTX");
            draft.remove("FIDX");
        });
        assert_eq!(what, "FRUN, element 0: there are 1 for a fill of 0 indices");
        let mut plain = Draft::with_materials();
        plain.set("FRUN", 1, NONE);
        plain.set("FRUN", 2, NONE);
        assert!(parse(&plain.to_bytes()).is_ok(), "material and group may be missing");
    }

    #[test]
    fn pictures_are_consecutive_within_their_section() {
        for (number, value, element, what) in [
            (0, 11, 0, "has bytes 0 to 11 of 10"),
            (1, 1, 0, "has bytes 0 to 4294967299 of 10"),
            (2, 2, 1, "has bytes 3 to 2 of 10"),
            (2, 11, 1, "has bytes 3 to 11 of 10"),
            (3, NONE, 1, "has bytes 3 to 18446744069414584330 of 10"),
        ] {
            let found = error_of(Draft::with_materials(), |draft| draft.set("PEND", number, value));
            assert_eq!(found, format!("PEND, element {element}: {what}"));
        }
        let what = error_of(Draft::with_materials(), |draft| draft.resize("PICT", 9));
        assert_eq!(what, "PEND, element 1: has bytes 3 to 10 of 9");
        let what = error_of(Draft::with_materials(), |draft| draft.resize("PEND", 1));
        assert_eq!(what, "MTRL, element 1: names picture 1; there are 1");
        for wrong in [2, NONE - 1] {
            let what = error_of(Draft::with_materials(), |draft| draft.set("MTRL", 25, wrong));
            assert_eq!(what, format!("MTRL, element 1: names picture {wrong}; there are 2"));
        }
        let mut longer = Draft::with_materials();
        longer.resize("PICT", 20);
        assert!(parse(&longer.to_bytes()).is_ok(), "surplus bytes are not a fault");
    }

    #[test]
    fn materials_have_their_names() {
        for count in [1, 3] {
            let what = error_of(Draft::with_materials(), |draft| draft.resize("MTRL", count));
            let expected = format!("there are {count}, and META has names for 2");
            assert_eq!(what, format!("MTRL, element 0: {expected}"));
        }
        let names = error(|draft| {
            draft.section("META").bytes = br#"{"name": "", "materials": [{"name": ""}]}"#.to_vec();
            draft.push("MTRL", 52, &[]);
        });
        assert_eq!(names, "MTRL, element 0: there are 0, and META has names for 1");
    }

    #[test]
    fn splits_are_of_welded_vertices() {
        let what = error(|draft| {
            draft.resize("SPLT", 1);
            draft.set("SPLT", 0, 2);
        });
        assert_eq!(what, "SPLT, element 0: names welded vertex 2; there are 2");
        let what = error(|draft| draft.resize("SPLT", 3));
        assert_eq!(what, "SPLT, element 0: names welded vertex 0; there are 0");
    }

    #[test]
    fn faces_fit_their_edges() {
        let what = error(|draft| {
            draft.set("EDGE", 2, NONE);
            draft.set("EDGE", 3, 0);
        });
        assert_eq!(what, "EDGE, element 0: has a face B but no face A");
        let what = error(|draft| draft.set("TRIS", 2, 1));
        assert_eq!(what, "EDGE, element 0: has face 0, which has no vertex off the edge");
        let mut line = Draft::triangle();
        line.set("EDGE", 2, NONE);
        assert!(parse(&line.to_bytes()).is_ok(), "a line has no face");
    }

    #[test]
    fn chains_stay_within_the_links() {
        for (first, count) in [(0, 4), (3, 1), (2, 2), (NONE, 1), (1, NONE), (NONE, NONE)] {
            let what = error(|draft| {
                draft.set("CHNS", 5, first);
                draft.set("CHNS", 6, count);
            });
            let expected = format!("has {count} links from {first} on; there are 3");
            assert_eq!(what, format!("CHNS, element 1: {expected}"));
        }
        assert!(error(|draft| draft.resize("LNKS", 2)).starts_with("CHNS, element 2: has 1"));
        assert!(error(|draft| draft.resize("CHNS", 2)).starts_with("LNKS, element 2: names"));
        let mut empty = Draft::triangle();
        empty.set("CHNS", 5, 3);
        empty.set("CHNS", 6, 0);
        assert!(parse(&empty.to_bytes()).is_ok(), "an empty chain at the end is within");
    }

    #[test]
    fn counts_can_be_added_up() {
        let what = error(|draft| draft.set("CNTS", 3, 1));
        assert_eq!(what, "CNTS, element 1: counts 4294967299, more than any index");
        let what = error(|draft| draft.set("CNTS", 8, NONE));
        assert!(what.starts_with("CNTS, element 4: counts 4294967295"), "{what}");
        let mut large = Draft::triangle();
        large.set("CNTS", 8, NONE - 1);
        assert_eq!(parse(&large.to_bytes()).unwrap().counts.duplicate_triangles, 4_294_967_294);
        let what = error(|draft| draft.section("CNTS").bytes[136..].fill(255));
        assert!(what.starts_with("CNTS, element 17: counts 18446744073709551615"), "{what}");
    }

    #[test]
    fn the_place_is_that_of_the_element() {
        let mut draft = Draft::triangle();
        draft.set("EDGE", 10, 77);
        let bytes = draft.to_bytes();
        let Some(Place::Byte(byte)) = parse(&bytes).unwrap_err().place else { panic!("no place") };
        let record = &bytes[usize::try_from(byte).unwrap()..][..8];
        assert_eq!(record, [77, 0, 0, 0, 2, 0, 0, 0]);
    }

    #[test]
    fn floats_may_be_anything() {
        let mut draft = Draft::with_materials();
        draft.push("FCOL", 4, &[7; 12]);
        for tag in ["POSI", "NORM", "PLAN", "FVTX", "FCOL", "FRAM", "BNDS"] {
            draft.section(tag).bytes.fill(255);
        }
        draft.section("MTRL").bytes[..48].fill(255);
        assert!(parse(&draft.to_bytes()).is_ok());
    }

    /// Uses the indices of a mesh in all ways in which later code does.
    fn use_all(mesh: &StoredMesh<'_>) {
        let mut mesh = mesh.to_mesh();
        assert_eq!(replicate(&mesh).len(), replicate_16(&mesh).len());
        let _ = count_features(&mesh, [1.0, 2.0, 3.0, 1.0].into());
        for chain in &mesh.chains.chains {
            assert_eq!(mesh.chains.links[chain.link_range()].len(), chain.link_count as usize);
        }
        let vertices = to_u32(mesh.positions.len());
        assert!((0..vertices).all(|vertex| mesh.welded_vertex(vertex) < vertices));
        let runs = mesh.fill.runs.iter();
        let is_valid = |index: u32, count| index == NONE || (index as usize) < count;
        assert!(runs.clone().all(|run| is_valid(run.material, mesh.fill.materials.len())));
        assert!(runs.clone().all(|run| is_valid(run.group, mesh.fill.groups.len())));
        reclassify(&mut mesh, &BuildOptions::default());
    }

    #[test]
    fn every_accepted_file_can_be_used() {
        let small = ["triangle", "bow tie", "lines.obj", "textured"];
        let (mut accepted, mut refused) = (0, 0);
        for sample in samples().iter().filter(|sample| small.contains(&sample.name)) {
            let whole = to_bytes(&sample.mesh, "", &sample.report, &Layout::ALL).unwrap();
            for at in (8..whole.len() - 3).step_by(4) {
                for number in [0, 1, 2, 3, 5, 6, 16, 1 << 31, NONE - 1, NONE] {
                    let mut bytes = whole.clone();
                    bytes[at..at + 4].copy_from_slice(&u32::to_le_bytes(number));
                    seal(&mut bytes);
                    match parse(&bytes) {
                        Ok(mesh) => use_all(&mesh),
                        Err(_) => refused += 1,
                    }
                    accepted += 1;
                }
            }
        }
        accepted -= refused;
        assert!(accepted > 1000 && refused > 1000, "{accepted} accepted, {refused} refused");
    }
}
