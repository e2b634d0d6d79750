//! Edges that the artist chose, from two extensions of primitives.
//!
//! Based on: `EXT_mesh_primitive_edge_visibility` (vendor extension, merged
//! 2026-05) and `CESIUM_primitive_outline`.
//!
//! ```text
//! values of triangles (0 1 2) (0 2 3):  01 12 20  02 23 30, each in 2 bits,
//!                                        2  0  1   0  2  0   the least first
//!                            bytes       |--- 18 ----|  |- 2
//!   0 hidden   1 may be a contour   2 drawn   3 drawn, the same edge once more
//! ```
//!
//! Drafts of the first one had more members; those are not looked at. The
//! normals of its silhouettes are not needed, since they are the triangles' own.

use serde::Deserialize;
use serde_json::Value;

use super::super::error::{ReadError, ReadErrorKind};
use super::accessor::Accessor;
use super::topology::polyline;
use super::vertices::Site;
use super::{Asset, or_left_out};
use crate::report::{Report, WarningCode};

const VISIBILITY: &str = "EXT_mesh_primitive_edge_visibility";
const OUTLINE: &str = "CESIUM_primitive_outline";

/// Edges by the indices of their ends in the primitive, the smaller one first;
/// those of two triangles may be there twice.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct Edges {
    /// Drawn in any view.
    pub(super) marked: Vec<[u32; 2]>,
    /// Never drawn as creases.
    pub(super) hidden: Vec<[u32; 2]>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct EdgeVisibility {
    visibility: Option<usize>,
    #[serde(default)]
    line_strings: Vec<Indices>,
}

/// A list of vertices, as its accessor.
#[derive(Deserialize)]
struct Indices {
    indices: usize,
}

/// The edges that the extensions of the primitive at `site` mark and hide among
/// those of its triangles; an extension that makes no sense is left out with a
/// warning.
pub(super) fn edges(
    asset: &Asset,
    extensions: &serde_json::Map<String, Value>,
    triangles: &[[u32; 3]],
    vertex_count: u32,
    site: Site,
    report: &mut Report,
) -> Edges {
    let reader = Reader { asset, triangles, site };
    let mut edges = Edges::default();
    if let Some(json) = extensions.get(VISIBILITY) {
        edges = or_left_out(reader.visibility(json), report).unwrap_or_default();
    }
    if let Some(json) = extensions.get(OUTLINE) {
        let outline = or_left_out(reader.outline(json), report);
        edges.marked.extend(outline.into_iter().flatten());
    }
    let marked = edges.marked.len();
    edges.marked.retain(|ends| ends.iter().all(|&end| end < vertex_count));
    report.warn_many(WarningCode::Index, marked - edges.marked.len(), site.place(), || {
        format!("an edge names a vertex that is none of the {vertex_count}; it was left out")
    });
    for ends in edges.marked.iter_mut().chain(&mut edges.hidden) {
        ends.sort_unstable();
    }
    edges
}

struct Reader<'a> {
    asset: &'a Asset<'a>,
    triangles: &'a [[u32; 3]],
    site: Site,
}

impl Reader<'_> {
    fn visibility(&self, json: &Value) -> Result<Edges, ReadError> {
        let json: EdgeVisibility = self.parse(VISIBILITY, json)?;
        let mut edges = Edges::default();
        if let Some(accessor) = json.visibility {
            let values = self.values(accessor)?;
            let corners = self.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
            for (edge, value) in corners.zip(values) {
                match value {
                    0 => edges.hidden.push(edge),
                    2 | 3 => edges.marked.push(edge),
                    _ => {}
                }
            }
        }
        for line in json.line_strings {
            let accessor = self.accessor(VISIBILITY, line.indices)?;
            let restart = largest(&accessor);
            let indices = accessor.unsigned::<1>()?.into_flattened();
            edges.marked.extend(indices.split(|&index| index == restart).flat_map(polyline));
        }
        Ok(edges)
    }

    /// The value of each edge of each triangle.
    fn values(&self, index: usize) -> Result<impl Iterator<Item = u32>, ReadError> {
        let bytes = self.accessor(VISIBILITY, index)?.unsigned::<1>()?;
        let needed = (6 * self.triangles.len()).div_ceil(8);
        if bytes.len() != needed {
            let count = self.triangles.len();
            let what =
                format!("{} bytes of visibility for {count} triangles, not {needed}", bytes.len());
            return Err(self.wrong(VISIBILITY, what));
        }
        Ok(bytes.into_iter().flat_map(|[byte]| [0, 2, 4, 6].map(|shift| (byte >> shift) & 3)))
    }

    fn outline(&self, json: &Value) -> Result<Vec<[u32; 2]>, ReadError> {
        let json: Indices = self.parse(OUTLINE, json)?;
        let indices = self.accessor(OUTLINE, json.indices)?.unsigned::<1>()?.into_flattened();
        match indices.as_chunks() {
            (pairs, []) => Ok(pairs.to_vec()),
            _ => Err(self.wrong(OUTLINE, format!("{} indices are no pairs", indices.len()))),
        }
    }

    fn parse<'j, T: Deserialize<'j>>(&self, name: &str, json: &'j Value) -> Result<T, ReadError> {
        T::deserialize(json).map_err(|error| self.wrong(name, error.to_string()))
    }

    fn accessor(&self, name: &str, index: usize) -> Result<Accessor<'_>, ReadError> {
        self.asset.accessor(index, || self.part(name))
    }

    fn part(&self, name: &str) -> String {
        format!("{}.extensions.{name}", self.site.part())
    }

    fn wrong(&self, name: &str, what: String) -> ReadError {
        self.asset.error(ReadErrorKind::Syntax, self.part(name), what)
    }
}

/// The largest index that an accessor can name, which ends a line string.
fn largest(accessor: &Accessor) -> u32 {
    match accessor.component().size() {
        1 => u8::MAX.into(),
        2 => u16::MAX.into(),
        _ => u32::MAX,
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::super::sample::{SQUARE, Sample, TWO_TRIANGLES};
    use super::*;
    use crate::model::Model;

    /// The segments and hidden edges of a square of two triangles with an
    /// extension that `make` fills.
    fn square(
        name: &str,
        make: impl FnOnce(&mut Sample) -> Value,
    ) -> (Vec<[u32; 2]>, Vec<[u32; 2]>, Report) {
        let mut sample = Sample::default();
        let primitive = json!({
            "attributes": {"POSITION": sample.floats("VEC3", &SQUARE)},
            "indices": sample.bytes("SCALAR", &TWO_TRIANGLES),
            "extensions": {name: make(&mut sample)}
        });
        let mut rest = super::super::sample::one_mesh(&primitive);
        rest["extensionsUsed"] = json!([name]);
        let (model, report) = sample.read(&rest).unwrap();
        let Model { segments, hidden_edges, .. } = model;
        (segments.into_iter().map(|segment| segment.ends).collect(), hidden_edges, report)
    }

    fn visibility(bytes: &[[u8; 1]]) -> (Vec<[u32; 2]>, Vec<[u32; 2]>, Report) {
        square(VISIBILITY, |sample| json!({"visibility": sample.bytes("SCALAR", bytes)}))
    }

    #[test]
    fn values_of_edges_two_bits_each() {
        // [2, 0, 1, 0, 2, 0]: the diagonal 2-0 may be a contour, so 0-2 is hidden.
        let (marked, hidden, report) = visibility(&[[18], [2]]);
        assert_eq!(marked, [[0, 1], [2, 3]]);
        assert_eq!(hidden, [[0, 2], [0, 3], [1, 2]]);
        assert!(report.warnings().is_empty(), "{report:?}");
        // [2, 0, 2, 3, 2, 0]: the diagonal is hard, and named twice.
        let (marked, hidden, _) = visibility(&[[226], [2]]);
        assert_eq!(marked, [[0, 1], [0, 2], [2, 3]]);
        assert_eq!(hidden, [[0, 3], [1, 2]]);
    }

    #[test]
    fn line_strings_end_at_the_largest_index() {
        let (marked, hidden, report) = square(VISIBILITY, |sample| {
            let lines = [[0], [1], [2], [255], [3], [2], [9]];
            json!({
                "visibility": sample.bytes("SCALAR", &[[0], [0]]),
                "lineStrings": [{"indices": sample.bytes("SCALAR", &lines), "material": 7}],
                "silhouetteMates": 9
            })
        });
        assert_eq!(marked, [[0, 1], [1, 2], [2, 3]]);
        assert_eq!(hidden, [[0, 2], [0, 3]], "what is drawn is not hidden");
        assert_eq!((report.count(WarningCode::Index), report.count(WarningCode::Syntax)), (1, 0));
    }

    #[test]
    fn what_makes_no_sense_is_left_out() {
        let (marked, hidden, report) = visibility(&[[255]]);
        assert!(marked.is_empty() && hidden.is_empty());
        assert!(report.warnings()[0].message.contains("1 bytes of visibility"), "{report:?}");
        for json in [json!({"visibility": "all"}), json!([]), json!({"visibility": 99})] {
            let (marked, _, report) = square(VISIBILITY, |_| json);
            assert!(marked.is_empty());
            assert_eq!(report.count(WarningCode::Syntax), 1);
        }
    }

    #[test]
    fn outlines_are_pairs() {
        let outline = |indices: &[[u8; 1]]| {
            square(OUTLINE, |sample| json!({"indices": sample.bytes("SCALAR", indices)}))
        };
        let (marked, hidden, report) = outline(&[[1], [0], [2], [4], [0], [1]]);
        assert_eq!((marked, hidden), (vec![[0, 1]], vec![]));
        assert_eq!(report.count(WarningCode::Index), 1);
        let (marked, _, report) = outline(&[[1], [0], [2]]);
        assert!(marked.is_empty());
        assert_eq!(report.count(WarningCode::Syntax), 1);
    }
}
