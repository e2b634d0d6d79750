//! Merges the parsed blocks of an OBJ file into one model.

use indexmap::IndexSet;
use rayon::prelude::*;
use rustc_hash::FxBuildHasher;

use super::block::{BlockError, NewState, ParsedBlock};
use super::materials::read_materials;
use super::statement::BlockIndex;
use crate::format::read::error::{ReadError, ReadErrorKind};
use crate::format::read::source::Source;
use crate::index::{MAX_INDEX, NONE, to_u32};
use crate::model::{Attributes, Material, Model, Segment, Smoothing, WHITE};
use crate::report::{Place, Report, WarningCode};

/// How many elements of each kind precede a block.
#[derive(Debug, Clone, Copy, Default)]
struct Offsets {
    lines: u32,
    positions: usize,
    texcoords: usize,
    normals: usize,
    corners: usize,
    polygons: usize,
}

/// Merges the blocks in their order.
///
/// # Errors
/// Fails if a block has an error, a face or line names a vertex that does not exist,
/// or there are more than [`MAX_INDEX`] elements. An unreadable statement is reported
/// before any wrong index, because the vertices after it were not read.
pub(super) fn merge(
    source: &Source,
    mut blocks: Vec<ParsedBlock>,
    report: &mut Report,
) -> Result<Model, ReadError> {
    let (offsets, totals) = offsets_of(&blocks);
    let unreadable = blocks.iter_mut().map(|block| block.error.take());
    check(source, unreadable, &offsets)?;
    if totals.positions.max(totals.corners) > MAX_INDEX {
        let what = format!("too large: more than {MAX_INDEX} vertices or face corners");
        return Err(source.error(ReadErrorKind::Size, None, what));
    }
    let wrong =
        blocks.par_iter_mut().zip(&offsets).map(|(block, base)| resolve(block, base, &totals));
    let wrong: Vec<Option<BlockError>> = wrong.collect();
    check(source, wrong, &offsets)?;
    let mut model = Model::default();
    replay_changes(&mut model, &mut blocks, &offsets);
    let libraries = gather(&mut model, blocks, &offsets, &totals, report);
    read_materials(source, &libraries, &mut model.materials, report);
    Ok(model)
}

/// Fails with the first of the blocks' errors, at its line in the file.
fn check(
    source: &Source,
    errors: impl IntoIterator<Item = Option<BlockError>>,
    offsets: &[Offsets],
) -> Result<(), ReadError> {
    let mut errors = errors.into_iter().zip(offsets);
    match errors.find_map(|(error, base)| error.map(|error| (error, base.lines))) {
        Some((BlockError { kind, line, what }, before)) => {
            Err(source.error(kind, Some(Place::Line(before + line)), what))
        }
        None => Ok(()),
    }
}

fn offsets_of(blocks: &[ParsedBlock]) -> (Vec<Offsets>, Offsets) {
    let mut next = Offsets::default();
    let offsets = blocks
        .iter()
        .map(|block| {
            let base = next;
            next.lines = next.lines.saturating_add(block.line_count);
            next.positions += block.model.positions.len();
            next.texcoords += block.model.texcoords.len();
            next.normals += block.model.normals.len();
            next.corners += block.model.corner_positions.len();
            next.polygons += block.model.polygon_count();
            base
        })
        .collect();
    (offsets, next)
}

/// Makes the indices and line numbers of a block absolute; returns its first wrong
/// index.
fn resolve(block: &mut ParsedBlock, base: &Offsets, totals: &Offsets) -> Option<BlockError> {
    let mut error = resolve_positions(&mut block.model, base, totals);
    resolve_segments(&mut block.model, base, totals, &mut error);
    let report = &mut block.report;
    let model = &mut block.model;
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

fn resolve_positions(model: &mut Model, base: &Offsets, totals: &Offsets) -> Option<BlockError> {
    let mut first_wrong = None;
    for (corner, index) in model.corner_positions.iter_mut().enumerate() {
        let absolute = BlockIndex(*index).resolve(base.positions);
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

fn wrong_index(what: &str, index: i64, line: u32, totals: &Offsets) -> BlockError {
    let count = totals.positions;
    let what = if index < 0 {
        format!("a {what} index reaches before the first of {count} vertices")
    } else if index >= MAX_INDEX as i64 {
        format!("a {what} index is far past {count} vertices")
    } else {
        format!("{what} index {} past {count} vertices", index + 1)
    };
    BlockError { kind: ReadErrorKind::Index, line, what }
}

fn resolve_segments(
    model: &mut Model,
    base: &Offsets,
    totals: &Offsets,
    error: &mut Option<BlockError>,
) {
    for Segment { ends, line } in &mut model.segments {
        for end in ends {
            let absolute = BlockIndex(*end).resolve(base.positions);
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

/// Makes indices of texture coordinates or normals absolute; replaces those out of
/// range by [`NONE`].
fn resolve_attributes(
    indices: &mut [u32],
    (base, total): (usize, usize),
    model: &Model,
    report: &mut Report,
) {
    for (corner, index) in indices.iter_mut().enumerate().filter(|(_, index)| **index != NONE) {
        let absolute = BlockIndex(*index).resolve(base);
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

/// Names in the order of their first use.
type Names = IndexSet<String, FxBuildHasher>;

/// The index of `name`, which is added if it is new.
fn index_of(names: &mut Names, name: String) -> u32 {
    to_u32(names.insert_full(name).0)
}

/// Turns the state changes of all blocks into runs of attributes.
fn replay_changes(model: &mut Model, blocks: &mut [ParsedBlock], offsets: &[Offsets]) {
    let (mut materials, mut groups) = (Names::default(), Names::default());
    // In a file with smoothing groups, the faces before the first `s` have none.
    let has_smoothing = blocks
        .iter()
        .flat_map(|block| &block.changes)
        .any(|change| matches!(change.state, NewState::Smoothing(_)));
    let mut attributes = Attributes {
        smoothing: if has_smoothing { Smoothing::Group(0) } else { Smoothing::Unstated },
        ..Attributes::default()
    };
    model.set_attributes_from(0, attributes);
    for (block, base) in blocks.iter_mut().zip(offsets) {
        for change in block.changes.drain(..) {
            match change.state {
                NewState::Material(name) => attributes.material = index_of(&mut materials, name),
                NewState::Group(name) => attributes.group = index_of(&mut groups, name),
                NewState::Smoothing(group) => attributes.smoothing = Smoothing::Group(group),
            }
            model.set_attributes_from(to_u32(base.polygons) + change.polygon, attributes);
        }
    }
    model.groups = groups.into_iter().collect();
    let named = |name| Material { name, ..Material::default() };
    model.materials = materials.into_iter().map(named).collect();
}

/// Moves the lists of all blocks into the model; returns the `mtllib` statements with
/// their lines.
fn gather(
    model: &mut Model,
    mut blocks: Vec<ParsedBlock>,
    offsets: &[Offsets],
    totals: &Offsets,
    report: &mut Report,
) -> Vec<(String, u32)> {
    let mut libraries = Vec::new();
    for (block, base) in blocks.iter_mut().zip(offsets) {
        report.append(std::mem::take(&mut block.report), base.lines);
        let statements = block.libraries.drain(..);
        libraries.extend(statements.map(|(name, line)| (name, base.lines + line)));
        model.segments.append(&mut block.model.segments);
    }
    if blocks.iter().any(|block| !block.model.colors.is_empty()) {
        for block in &mut blocks {
            block.model.colors.resize(block.model.positions.len(), WHITE);
        }
    }
    gather_polygon_ends(model, &mut blocks, offsets);
    for block in &mut blocks {
        let count = block.model.corner_positions.len();
        let lists = [
            (&mut block.model.corner_texcoords, totals.texcoords),
            (&mut block.model.corner_normals, totals.normals),
        ];
        for (list, _) in lists.into_iter().filter(|(list, total)| *total > 0 && list.is_empty()) {
            list.resize(count, NONE);
        }
    }
    let take = |blocks: &mut [ParsedBlock], list: fn(&mut Model) -> &mut Vec<u32>| {
        concatenate(blocks.iter_mut().map(|block| std::mem::take(list(&mut block.model))).collect())
    };
    model.corner_positions = take(&mut blocks, |block| &mut block.corner_positions);
    model.corner_texcoords =
        empty_if_unused(take(&mut blocks, |block| &mut block.corner_texcoords));
    model.corner_normals = empty_if_unused(take(&mut blocks, |block| &mut block.corner_normals));
    model.polygon_lines = take(&mut blocks, |block| &mut block.polygon_lines);
    gather_elements(model, blocks);
    libraries
}

fn gather_elements(model: &mut Model, mut blocks: Vec<ParsedBlock>) {
    let (mut positions, mut colors, mut texcoords, mut normals) = (vec![], vec![], vec![], vec![]);
    for block in &mut blocks {
        let block = &mut block.model;
        positions.push(std::mem::take(&mut block.positions));
        colors.push(std::mem::take(&mut block.colors));
        texcoords.push(std::mem::take(&mut block.texcoords));
        normals.push(std::mem::take(&mut block.normals));
    }
    model.positions = concatenate(positions);
    model.colors = concatenate(colors);
    model.texcoords = concatenate(texcoords);
    model.normals = concatenate(normals);
}

fn gather_polygon_ends(model: &mut Model, blocks: &mut [ParsedBlock], offsets: &[Offsets]) {
    if blocks.iter().all(|block| block.model.is_triangles()) {
        return;
    }
    for (block, base) in blocks.iter().zip(offsets) {
        let base = to_u32(base.corners);
        let ends = |polygon| to_u32(block.model.corner_range(polygon).end) + base;
        model.polygon_ends.extend((0..block.model.polygon_count()).map(ends));
    }
}

/// `list`, or an empty list if no corner has an index.
fn empty_if_unused(list: Vec<u32>) -> Vec<u32> {
    if list.iter().all(|&index| index == NONE) { Vec::new() } else { list }
}

/// Concatenates lists in parallel; a single one is returned as it is.
fn concatenate<T: Copy + Default + Send + Sync>(mut lists: Vec<Vec<T>>) -> Vec<T> {
    if lists.len() == 1 {
        return lists.pop().unwrap_or_default();
    }
    let mut joined = vec![T::default(); lists.iter().map(Vec::len).sum()];
    let mut rest = joined.as_mut_slice();
    let mut targets = Vec::with_capacity(lists.len());
    for list in lists {
        let (target, after) = rest.split_at_mut(list.len());
        targets.push((target, list));
        rest = after;
    }
    targets.into_par_iter().for_each(|(target, list)| target.copy_from_slice(&list));
    joined
}
