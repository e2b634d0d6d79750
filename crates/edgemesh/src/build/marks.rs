//! Marked edges: lines of the model, and pairs of vertices from a side file. A line that is not an
//! edge of the mesh becomes a record without faces. Classes that the model states come with them.

use std::collections::BTreeSet;

use super::BuildOptions;
use crate::edge_mesh::{EdgeFlags, EdgeRecord, EdgeTable};
use crate::index::{NONE, to_u32};
use crate::model::{Model, StatedClasses};
use crate::report::{Place, Report, WarningCode};

/// The classes that a model can state for edges of two faces.
pub(crate) const STATED_CLASSES: EdgeFlags = EdgeFlags::RIDGE
    .union(EdgeFlags::VALLEY)
    .union(EdgeFlags::MATERIAL)
    .union(EdgeFlags::SMOOTHING);

/// The marked and suppressed edges of a mesh.
#[derive(Debug, Default)]
pub(crate) struct Marks {
    /// Numbers of edges of the table, ascending.
    marked: Vec<u32>,
    /// Edges that are never creases, ascending.
    suppressed: Vec<u32>,
    /// The stated classes of edges, ascending by edge; `None` if the model states none.
    stated: Option<Vec<(u32, EdgeFlags)>>,
    /// Lines that are not edges of the mesh, as welded vertices; ascending.
    loose: Vec<[u32; 2]>,
}

impl Marks {
    /// Finds the edges of the lines of the model and of the marks in `options`, without those that
    /// `options` unmarks.
    pub(crate) fn find(
        model: &Model,
        options: &BuildOptions,
        welded_from_input: &[u32],
        table: &EdgeTable,
        report: &mut Report,
    ) -> Self {
        let welded = |[a, b]: [u32; 2]| {
            let end = |vertex: u32| welded_from_input.get(vertex as usize).copied().unwrap_or(NONE);
            Some([end(a), end(b)]).filter(|[a, b]| *a != NONE && *b != NONE && a != b)
        };
        let mut marks = Self::default();
        for segment in &model.segments {
            let Some([a, b]) = welded(segment.ends) else { continue };
            match table.find(a, b) {
                Some(edge) => marks.marked.push(to_u32(edge)),
                None => marks.loose.push([a.min(b), a.max(b)]),
            }
        }
        for pair in &options.marks {
            match welded(*pair).and_then(|[a, b]| table.find(a, b)) {
                Some(edge) => marks.marked.push(to_u32(edge)),
                None => report.warn(WarningCode::Mark, Some(Place::Vertex(u64::from(pair[0]) + 1)), || {
                    let [a, b] = pair.map(|vertex| u64::from(vertex) + 1);
                    format!("vertices {a} and {b} are marked but share no edge; the mark was left out")
                }),
            }
        }
        let suppressed = model.suppressed_edges.iter().filter_map(|pair| welded(*pair));
        marks.suppressed.extend(suppressed.filter_map(|[a, b]| table.find(a, b)).map(to_u32));
        marks.stated = model.stated_edges.as_ref().map(|stated| {
            let numbered = stated.iter().filter_map(|edge| {
                let [a, b] = welded(edge.ends)?;
                Some((to_u32(table.find(a, b)?), flags_of(edge.classes)))
            });
            numbered.collect()
        });
        marks.sort();
        let unmarked = options.unmarked.iter().filter_map(|pair| welded(*pair));
        let unmarked: BTreeSet<[u32; 2]> = unmarked.map(|[a, b]| [a.min(b), a.max(b)]).collect();
        if !unmarked.is_empty() {
            let edges = unmarked.iter().filter_map(|&[a, b]| table.find(a, b));
            let edges: BTreeSet<u32> = edges.map(to_u32).collect();
            marks.marked.retain(|edge| !edges.contains(edge));
            marks.loose.retain(|line| !unmarked.contains(line));
        }
        marks
    }

    fn sort(&mut self) {
        for list in [&mut self.marked, &mut self.suppressed] {
            list.sort_unstable();
            list.dedup();
        }
        self.loose.sort_unstable();
        self.loose.dedup();
        if let Some(stated) = &mut self.stated {
            stated.sort_unstable_by_key(|(edge, flags)| (*edge, flags.bits()));
            let is_stated = |edge: &u32| stated.binary_search_by_key(edge, |(own, _)| *own).is_ok();
            self.suppressed.retain(|edge| !is_stated(edge));
        }
    }

    /// Whether edge number `edge` is marked.
    pub(crate) fn is_marked(&self, edge: usize) -> bool {
        !self.marked.is_empty() && self.marked.binary_search(&to_u32(edge)).is_ok()
    }

    /// Whether edge number `edge` is never a crease.
    pub(crate) fn is_suppressed(&self, edge: usize) -> bool {
        !self.suppressed.is_empty() && self.suppressed.binary_search(&to_u32(edge)).is_ok()
    }

    /// The classes that the model states for edge number `edge`; `None` if it leaves all edges to
    /// angles, materials and smoothing groups.
    pub(crate) fn stated_classes(&self, edge: usize) -> Option<EdgeFlags> {
        let stated = self.stated.as_ref()?;
        let edge = to_u32(edge);
        let first = stated.partition_point(|(other, _)| *other < edge);
        let own = stated[first..].iter().take_while(|(other, _)| *other == edge);
        Some(own.fold(EdgeFlags::empty(), |all, (_, flags)| all | *flags))
    }

    /// Records of the lines that are not edges of the mesh.
    pub(crate) fn loose_records(&self) -> impl Iterator<Item = EdgeRecord> {
        self.loose.iter().map(|&[v0, v1]| EdgeRecord {
            v0,
            v1,
            face_a: NONE,
            face_b: NONE,
            word: EdgeFlags::MARKED.into(),
        })
    }
}

/// The flags of stated classes.
fn flags_of(classes: StatedClasses) -> EdgeFlags {
    let mut flags = EdgeFlags::empty();
    flags.set(EdgeFlags::RIDGE, classes.ridge);
    flags.set(EdgeFlags::VALLEY, classes.valley);
    flags.set(EdgeFlags::MATERIAL, classes.material);
    flags.set(EdgeFlags::SMOOTHING, classes.smoothing);
    flags.set(EdgeFlags::NON_MANIFOLD, classes.non_manifold);
    flags
}
