//! Marked edges: lines of the model, and pairs of vertices from a side file. A line that is not an
//! edge of the mesh becomes a record without faces.

use std::collections::BTreeSet;

use super::BuildOptions;
use crate::edge_mesh::{EdgeFlags, EdgeRecord, EdgeTable};
use crate::index::{NONE, to_u32};
use crate::model::Model;
use crate::report::{Place, Report, WarningCode};

/// The marked and suppressed edges of a mesh.
#[derive(Debug, Default)]
pub(crate) struct Marks {
    /// Numbers of edges of the table, ascending.
    marked: Vec<u32>,
    /// Edges that are never creases, ascending.
    suppressed: Vec<u32>,
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
    }

    /// Whether edge number `edge` is marked.
    pub(crate) fn is_marked(&self, edge: usize) -> bool {
        !self.marked.is_empty() && self.marked.binary_search(&to_u32(edge)).is_ok()
    }

    /// Whether edge number `edge` is never a crease.
    pub(crate) fn is_suppressed(&self, edge: usize) -> bool {
        !self.suppressed.is_empty() && self.suppressed.binary_search(&to_u32(edge)).is_ok()
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
