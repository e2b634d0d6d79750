//! Puts the parts of an OBJ file together in their order.

use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::chunk::{ChangeKind, Part, PartError};
use super::statement::ChunkIndex;
use crate::format::read::error::{ReadError, ReadErrorKind};
use crate::format::read::mtl::read_materials;
use crate::format::read::source::Source;
use crate::index::{MAX_INDEX, NONE, to_u32};
use crate::model::{Attributes, Material, Model, Segment, Smoothing};
use crate::report::{Place, Report, WarningCode};

/// How many elements stand before a part.
#[derive(Debug, Clone, Copy, Default)]
struct Bases {
    lines: u32,
    positions: usize,
    texcoords: usize,
    normals: usize,
    corners: usize,
    polygons: usize,
}

/// Merges the parts; the first error in the file ends it.
///
/// A statement that cannot be read goes before any index: what stands behind it
/// is not known, and an index may well have meant that.
pub(super) fn merge(
    source: &Source,
    mut parts: Vec<Part>,
    report: &mut Report,
) -> Result<Model, ReadError> {
    let (bases, totals) = bases_of(&parts);
    let unread = parts.iter_mut().map(|part| part.error.take());
    check(source, unread, &bases)?;
    if totals.positions.max(totals.corners) > MAX_INDEX {
        let what = format!("too large: more than {MAX_INDEX} vertices or face corners");
        return Err(source.error(ReadErrorKind::Size, None, what));
    }
    let wrong = parts.par_iter_mut().zip(&bases).map(|(part, base)| resolve(part, base, &totals));
    let wrong: Vec<Option<PartError>> = wrong.collect();
    check(source, wrong, &bases)?;
    let mut model = Model::default();
    replay_changes(&mut model, &mut parts, &bases);
    let libraries = gather(&mut model, parts, &bases, &totals, report);
    read_materials(source, &libraries, &mut model.materials, report);
    Ok(model)
}

/// The first of the parts' errors, with its line in the file.
fn check(
    source: &Source,
    errors: impl IntoIterator<Item = Option<PartError>>,
    bases: &[Bases],
) -> Result<(), ReadError> {
    let mut errors = errors.into_iter().zip(bases);
    match errors.find_map(|(error, base)| error.map(|error| (error, base.lines))) {
        Some((PartError { kind, line, what }, before)) => {
            Err(source.error(kind, Some(Place::Line(before + line)), what))
        }
        None => Ok(()),
    }
}

fn bases_of(parts: &[Part]) -> (Vec<Bases>, Bases) {
    let mut next = Bases::default();
    let bases = parts
        .iter()
        .map(|part| {
            let base = next;
            next.lines = next.lines.saturating_add(part.line_count);
            next.positions += part.model.positions.len();
            next.texcoords += part.model.texcoords.len();
            next.normals += part.model.normals.len();
            next.corners += part.model.corner_positions.len();
            next.polygons += part.model.polygon_count();
            base
        })
        .collect();
    (bases, next)
}

/// Makes the indices of a part absolute and its places those of the file;
/// gives the part's first wrong index.
fn resolve(part: &mut Part, base: &Bases, totals: &Bases) -> Option<PartError> {
    let mut error = resolve_positions(&mut part.model, base, totals);
    resolve_segments(&mut part.model, base, totals, &mut error);
    let report = &mut part.report;
    let model = &mut part.model;
    let mut texcoords = std::mem::take(&mut model.corner_texcoords);
    resolve_attributes(&mut texcoords, (base.texcoords, totals.texcoords), model, report);
    model.corner_texcoords = texcoords;
    let mut normals = std::mem::take(&mut model.corner_normals);
    resolve_attributes(&mut normals, (base.normals, totals.normals), model, report);
    model.corner_normals = normals;
    for line in &mut model.polygon_lines {
        *line += base.lines;
    }
    error
}

fn resolve_positions(model: &mut Model, base: &Bases, totals: &Bases) -> Option<PartError> {
    let mut first_wrong = None;
    for (corner, index) in model.corner_positions.iter_mut().enumerate() {
        let absolute = ChunkIndex(*index).resolve(base.positions);
        match u32::try_from(absolute) {
            Ok(absolute) if (absolute as usize) < totals.positions => *index = absolute,
            _ if first_wrong.is_none() => first_wrong = Some((corner, absolute)),
            _ => {}
        }
    }
    let (corner, index) = first_wrong?;
    let line = model.polygon_lines.get(model.polygon_of(corner)).copied().unwrap_or_default();
    Some(wrong_index("face", index, line, totals))
}

fn wrong_index(what: &str, index: i64, line: u32, totals: &Bases) -> PartError {
    let count = totals.positions;
    let what = if index < 0 {
        format!("a {what} index reaches before the first of {count} vertices")
    } else if index >= MAX_INDEX as i64 {
        format!("a {what} index is past {count} vertices, by far")
    } else {
        format!("{what} index {} past {count} vertices", index + 1)
    };
    PartError { kind: ReadErrorKind::Index, line, what }
}

fn resolve_segments(
    model: &mut Model,
    base: &Bases,
    totals: &Bases,
    error: &mut Option<PartError>,
) {
    for Segment { ends, line } in &mut model.segments {
        for end in ends {
            let absolute = ChunkIndex(*end).resolve(base.positions);
            match u32::try_from(absolute) {
                Ok(absolute) if (absolute as usize) < totals.positions => *end = absolute,
                _ if error.as_ref().is_none_or(|error| *line < error.line) => {
                    *error = Some(wrong_index("line", absolute, *line, totals));
                }
                _ => {}
            }
        }
        *line += base.lines;
    }
}

/// Makes indices of texture coordinates or normals absolute; wrong ones are
/// left out.
fn resolve_attributes(
    indices: &mut [u32],
    (base, total): (usize, usize),
    model: &Model,
    report: &mut Report,
) {
    for (corner, index) in indices.iter_mut().enumerate().filter(|(_, index)| **index != NONE) {
        let absolute = ChunkIndex(*index).resolve(base);
        *index = match u32::try_from(absolute) {
            Ok(absolute) if (absolute as usize) < total => absolute,
            _ => {
                let place = Some(model.polygon_place(model.polygon_of(corner)));
                report.warn(WarningCode::Index, place, || {
                    format!(
                        "attribute {} of {total} was left out; the face is kept",
                        absolute.saturating_add(1)
                    )
                });
                NONE
            }
        };
    }
}

/// Names with their numbers, in the order of their first use.
#[derive(Default)]
struct Names {
    numbers: FxHashMap<String, u32>,
    names: Vec<String>,
}

impl Names {
    fn number(&mut self, name: &str) -> u32 {
        if let Some(&number) = self.numbers.get(name) {
            return number;
        }
        let number = to_u32(self.names.len());
        self.numbers.insert(name.to_owned(), number);
        self.names.push(name.to_owned());
        number
    }
}

/// Turns the changes of all parts into runs of attributes.
fn replay_changes(model: &mut Model, parts: &mut [Part], bases: &[Bases]) {
    let (mut materials, mut groups) = (Names::default(), Names::default());
    // A file that states smoothing groups anywhere begins with none.
    let has_smoothing = parts
        .iter()
        .flat_map(|part| &part.changes)
        .any(|change| matches!(change.what, ChangeKind::Smoothing(_)));
    let mut attributes = Attributes {
        smoothing: if has_smoothing { Smoothing::Group(0) } else { Smoothing::Unstated },
        ..Attributes::default()
    };
    model.set_attributes_from(0, attributes);
    for (part, base) in parts.iter_mut().zip(bases) {
        for change in part.changes.drain(..) {
            match change.what {
                ChangeKind::Material(name) => attributes.material = materials.number(&name),
                ChangeKind::Group(name) => attributes.group = groups.number(&name),
                ChangeKind::Smoothing(group) => attributes.smoothing = Smoothing::Group(group),
            }
            model.set_attributes_from(to_u32(base.polygons) + change.polygon, attributes);
        }
    }
    model.groups = groups.names;
    let named = |name| Material { name, ..Material::default() };
    model.materials = materials.names.into_iter().map(named).collect();
}

/// Moves the lists of all parts into the model; gives the names of libraries
/// with their lines.
fn gather(
    model: &mut Model,
    mut parts: Vec<Part>,
    bases: &[Bases],
    totals: &Bases,
    report: &mut Report,
) -> Vec<(String, u32)> {
    let mut libraries = Vec::new();
    for (part, base) in parts.iter_mut().zip(bases) {
        report.append(std::mem::take(&mut part.report), base.lines);
        let named = part.libraries.drain(..);
        libraries.extend(named.map(|(name, line)| (name, base.lines + line)));
        model.segments.append(&mut part.model.segments);
    }
    if parts.iter().any(|part| !part.model.colors.is_empty()) {
        for part in &mut parts {
            part.model.colors.resize(part.model.positions.len(), [1.0; 3]);
        }
    }
    gather_polygon_ends(model, &mut parts, bases);
    for part in &mut parts {
        let count = part.model.corner_positions.len();
        let lists = [
            (&mut part.model.corner_texcoords, totals.texcoords),
            (&mut part.model.corner_normals, totals.normals),
        ];
        for (list, _) in lists.into_iter().filter(|(list, total)| *total > 0 && list.is_empty()) {
            list.resize(count, NONE);
        }
    }
    let take = |parts: &mut [Part], list: fn(&mut Model) -> &mut Vec<u32>| {
        concatenate(parts.iter_mut().map(|part| std::mem::take(list(&mut part.model))).collect())
    };
    model.corner_positions = take(&mut parts, |part| &mut part.corner_positions);
    model.corner_texcoords = none_is_empty(take(&mut parts, |part| &mut part.corner_texcoords));
    model.corner_normals = none_is_empty(take(&mut parts, |part| &mut part.corner_normals));
    model.polygon_lines = take(&mut parts, |part| &mut part.polygon_lines);
    gather_elements(model, parts);
    libraries
}

fn gather_elements(model: &mut Model, mut parts: Vec<Part>) {
    let (mut positions, mut colors, mut texcoords, mut normals) = (vec![], vec![], vec![], vec![]);
    for part in &mut parts {
        let part = &mut part.model;
        positions.push(std::mem::take(&mut part.positions));
        colors.push(std::mem::take(&mut part.colors));
        texcoords.push(std::mem::take(&mut part.texcoords));
        normals.push(std::mem::take(&mut part.normals));
    }
    model.positions = concatenate(positions);
    model.colors = concatenate(colors);
    model.texcoords = concatenate(texcoords);
    model.normals = concatenate(normals);
}

fn gather_polygon_ends(model: &mut Model, parts: &mut [Part], bases: &[Bases]) {
    if parts.iter().all(|part| part.model.is_triangles()) {
        return;
    }
    for (part, base) in parts.iter().zip(bases) {
        let base = to_u32(base.corners);
        let ends = |polygon| to_u32(part.model.corner_range(polygon).end) + base;
        model.polygon_ends.extend((0..part.model.polygon_count()).map(ends));
    }
}

/// The list itself, or an empty one where no corner has anything.
fn none_is_empty(list: Vec<u32>) -> Vec<u32> {
    if list.iter().all(|&index| index == NONE) { Vec::new() } else { list }
}

/// Joins lists side by side; a single one is handed through.
fn concatenate<T: Copy + Default + Send + Sync>(mut lists: Vec<Vec<T>>) -> Vec<T> {
    if lists.len() == 1 {
        return lists.pop().unwrap_or_default();
    }
    let mut joined = vec![T::default(); lists.iter().map(Vec::len).sum()];
    let mut rest = joined.as_mut_slice();
    let mut targets = Vec::with_capacity(lists.len());
    for list in lists {
        let (target, behind) = rest.split_at_mut(list.len());
        targets.push((target, list));
        rest = behind;
    }
    targets.into_par_iter().for_each(|(target, list)| target.copy_from_slice(&list));
    joined
}
