//! Marked and suppressed edges, from two extensions of primitives.
//!
//! Based on: `EXT_mesh_primitive_edge_visibility` (vendor extension, merged
//! 2026-05) and `CESIUM_primitive_outline`.
//!
//! ```text
//! values of triangles (0 1 2) (0 2 3):  01 12 20  02 23 30, 2 bits each,
//!                                        2  0  1   0  2  0   lowest bits first
//!                            bytes       |--- 18 ----|  |- 2
//!   0 suppressed   1 may be a contour   2 marked   3 marked, an edge of a 2 before
//! ```
//!
//! Members of earlier drafts are ignored. So are the normals of silhouettes, which
//! the triangles have themselves.

use serde::Deserialize;
use serde_json::Value;

use super::super::error::{ReadError, ReadErrorKind};
use super::accessor::Accessor;
use super::primitive::Primitive;
use super::stated_edges::{classes_in, states_classes};
use super::topology::polyline;
use crate::edge_mesh::EdgeFlags;
use crate::report::{Place, Report, WarningCode};

const VISIBILITY: &str = "EXT_mesh_primitive_edge_visibility";
const OUTLINE: &str = "CESIUM_primitive_outline";

/// Edges by the indices of their ends in the primitive, the smaller index first; an
/// edge of two triangles may occur twice.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct EdgeMarks {
    /// Edges that are drawn in every view.
    pub(super) marked: Vec<[u32; 2]>,
    /// Edges that are never drawn as creases.
    pub(super) suppressed: Vec<[u32; 2]>,
    /// Whether the file is an export of this program that states the classes of all edges.
    pub(super) states_classes: bool,
    /// These edges with their classes; `marked` has none of them.
    pub(super) stated: Vec<([u32; 2], EdgeFlags)>,
}

/// The members of `EXT_mesh_primitive_edge_visibility`.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct EdgeVisibility {
    visibility: Option<usize>,
    #[serde(default)]
    line_strings: Vec<Indices>,
    #[serde(default)]
    extras: Value,
}

/// The accessor of a list of vertices.
#[derive(Deserialize)]
struct Indices {
    indices: usize,
    #[serde(default)]
    extras: Value,
}

/// The edges that the extensions of a primitive mark and suppress; a malformed
/// extension is left out with a warning.
pub(super) fn edge_marks(
    primitive: Primitive,
    triangles: &[[u32; 3]],
    vertex_count: u32,
    report: &mut Report,
) -> EdgeMarks {
    let mut reader = Reader { primitive, triangles, report };
    let states_classes = states_classes(&primitive.asset.document.asset);
    let mut edges = EdgeMarks { states_classes, ..EdgeMarks::default() };
    if let Some(json) = primitive.extension(VISIBILITY) {
        edges = reader.visibility(json, states_classes).unwrap_or_else(|error| {
            error.warn_left_out(reader.report);
            EdgeMarks::default()
        });
    }
    if let Some(json) = primitive.extension(OUTLINE) {
        match reader.outline(json) {
            Ok(outline) => edges.marked.extend(outline),
            Err(error) => error.warn_left_out(reader.report),
        }
    }
    let marked = edges.marked.len();
    edges.marked.retain(|ends| ends.iter().all(|&end| end < vertex_count));
    report.warn_many(WarningCode::Index, marked - edges.marked.len(), primitive.place(), || {
        format!("an edge names a vertex past the last of {vertex_count}; it was left out")
    });
    let is_known = |ends: &[u32; 2]| ends.iter().all(|&end| end < vertex_count);
    edges.stated.retain(|(ends, _)| is_known(ends));
    edges.suppressed.retain(is_known);
    for ends in edges.marked.iter_mut().chain(&mut edges.suppressed) {
        ends.sort_unstable();
    }
    edges
}

struct Reader<'a> {
    primitive: Primitive<'a>,
    triangles: &'a [[u32; 3]],
    report: &'a mut Report,
}

impl<'a> Reader<'a> {
    fn visibility(&mut self, json: &Value, states_classes: bool) -> Result<EdgeMarks, ReadError> {
        let json: EdgeVisibility = self.parse(VISIBILITY, json)?;
        let mut edges = EdgeMarks { states_classes, ..EdgeMarks::default() };
        let (mut single, mut silhouettes) = (Vec::new(), Vec::new());
        if let Some(accessor) = json.visibility {
            let corners = self.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
            for (edge, value) in corners.zip(self.values(accessor)?) {
                match (value, states_classes) {
                    (1, true) => silhouettes.push(edge),
                    (2, true) => single.push(edge),
                    (0, false) => edges.suppressed.push(edge),
                    (2 | 3, false) => edges.marked.push(edge),
                    _ => {}
                }
            }
        }
        let mut lines = Vec::new();
        for line in json.line_strings {
            let accessor = self.accessor(VISIBILITY, line.indices)?;
            let restart = largest(&accessor);
            let indices = self.indices(VISIBILITY, &accessor)?;
            let strings = indices.split(|&index| index == restart).flat_map(polyline);
            lines.push((strings.collect::<Vec<_>>(), line.extras["edges"].clone()));
        }
        if states_classes {
            lines.push((single, json.extras["edges"].clone()));
            // Without diagonals, silhouettes have no list.
            if let Some(runs) = json.extras.get("silhouettes") {
                lines.push((silhouettes, runs.clone()));
            }
            return self.stated(edges, lines);
        }
        edges.marked.extend(lines.into_iter().flat_map(|(edges, _)| edges));
        Ok(edges)
    }

    /// Adds edges with their classes to `marks`. Only diagonals are suppressed: an edge that is
    /// hidden on one side may be listed on the other, by other vertices.
    fn stated(
        &self,
        mut marks: EdgeMarks,
        lists: Vec<(Vec<[u32; 2]>, Value)>,
    ) -> Result<EdgeMarks, ReadError> {
        for (edges, runs) in lists {
            let classes = classes_in(&runs, edges.len()).ok_or_else(|| {
                self.error(VISIBILITY, "has extras that do not fit its edges".into())
            })?;
            for (edge, classes) in edges.into_iter().zip(classes) {
                if classes.contains(EdgeFlags::DIAGONAL) {
                    marks.suppressed.push(edge);
                } else if classes.intersects(EdgeFlags::ALWAYS_DRAWN) {
                    marks.stated.push((edge, classes));
                }
            }
        }
        Ok(marks)
    }

    /// The value of each edge of each triangle.
    fn values(&self, index: usize) -> Result<impl Iterator<Item = u32>, ReadError> {
        let bytes = self.accessor(VISIBILITY, index)?.unsigned::<1>()?;
        let needed = (6 * self.triangles.len()).div_ceil(8);
        if bytes.len() != needed {
            let count = self.triangles.len();
            let what = format!(
                "has {} bytes of visibility, and {count} triangles need {needed}",
                bytes.len()
            );
            return Err(self.error(VISIBILITY, what));
        }
        Ok(bytes.into_iter().flat_map(|[byte]| [0, 2, 4, 6].map(|shift| (byte >> shift) & 3)))
    }

    fn outline(&mut self, json: &Value) -> Result<Vec<[u32; 2]>, ReadError> {
        let json: Indices = self.parse(OUTLINE, json)?;
        let indices = self.indices(OUTLINE, &self.accessor(OUTLINE, json.indices)?)?;
        match indices.as_chunks() {
            (pairs, []) => Ok(pairs.to_vec()),
            _ => {
                Err(self.error(OUTLINE, format!("has an odd number of indices, {}", indices.len())))
            }
        }
    }

    /// The indices in an accessor of the extension `name`; warns if they are of a signed type.
    fn indices(&mut self, name: &str, accessor: &Accessor) -> Result<Vec<u32>, ReadError> {
        let indices = accessor.indices()?;
        if accessor.component().is_signed_integer() {
            self.report.warn(WarningCode::Syntax, Some(Place::Part(self.part(name))), || {
                "has indices of a signed type; none is negative, so they were taken".into()
            });
        }
        Ok(indices)
    }

    fn parse<'j, T: Deserialize<'j>>(&self, name: &str, json: &'j Value) -> Result<T, ReadError> {
        T::deserialize(json).map_err(|error| self.error(name, error.to_string()))
    }

    fn accessor(&self, name: &str, index: usize) -> Result<Accessor<'a>, ReadError> {
        self.primitive.asset.accessor(index, || self.part(name))
    }

    fn part(&self, name: &str) -> String {
        format!("{}.extensions.{name}", self.primitive.part())
    }

    fn error(&self, name: &str, what: String) -> ReadError {
        self.primitive.asset.error(ReadErrorKind::Syntax, self.part(name), what)
    }
}

/// The largest index of an accessor, which ends a line string.
fn largest(accessor: &Accessor) -> u32 {
    let largest = match accessor.component().size() {
        1 => u8::MAX.into(),
        2 => u16::MAX.into(),
        _ => u32::MAX,
    };
    if accessor.component().is_signed_integer() { largest / 2 } else { largest }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::super::sample::{SQUARE, Sample, TWO_TRIANGLES};
    use super::*;
    use crate::model::Model;

    /// The segments and suppressed edges of a square of two triangles with the
    /// extension that `make` returns.
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
        let Model { segments, suppressed_edges, .. } = model;
        (segments.into_iter().map(|segment| segment.ends).collect(), suppressed_edges, report)
    }

    fn visibility(bytes: &[[u8; 1]]) -> (Vec<[u32; 2]>, Vec<[u32; 2]>, Report) {
        square(VISIBILITY, |sample| json!({"visibility": sample.bytes("SCALAR", bytes)}))
    }

    #[test]
    fn values_of_edges_two_bits_each() {
        // [2, 0, 1, 0, 2, 0]: the diagonal 2-0 may be a contour, so 0-2 is suppressed.
        let (marked, suppressed, report) = visibility(&[[18], [2]]);
        assert_eq!(marked, [[0, 1], [2, 3]]);
        assert_eq!(suppressed, [[0, 2], [0, 3], [1, 2]]);
        assert!(report.warnings().is_empty(), "{report:?}");
        // [2, 0, 2, 3, 2, 0]: the diagonal is marked twice.
        let (marked, suppressed, _) = visibility(&[[226], [2]]);
        assert_eq!(marked, [[0, 1], [0, 2], [2, 3]]);
        assert_eq!(suppressed, [[0, 3], [1, 2]]);
    }

    #[test]
    fn line_strings_end_at_the_largest_index() {
        let (marked, suppressed, report) = square(VISIBILITY, |sample| {
            let lines = [[0], [1], [2], [255], [3], [2], [9]];
            json!({
                "visibility": sample.bytes("SCALAR", &[[0], [0]]),
                "lineStrings": [{"indices": sample.bytes("SCALAR", &lines), "material": 7}],
                "silhouetteMates": 9
            })
        });
        assert_eq!(marked, [[0, 1], [1, 2], [2, 3]]);
        assert_eq!(suppressed, [[0, 2], [0, 3]], "marked edges are not suppressed");
        assert_eq!((report.count(WarningCode::Index), report.count(WarningCode::Syntax)), (1, 0));
    }

    #[test]
    fn malformed_extensions_are_left_out() {
        let (marked, suppressed, report) = visibility(&[[255]]);
        assert!(marked.is_empty() && suppressed.is_empty());
        assert!(report.warnings()[0].message.contains("has 1 bytes of visibility"), "{report:?}");
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
        let (marked, suppressed, report) = outline(&[[1], [0], [2], [4], [0], [1]]);
        assert_eq!((marked, suppressed), (vec![[0, 1]], vec![]));
        assert_eq!(report.count(WarningCode::Index), 1);
        let (marked, _, report) = outline(&[[1], [0], [2]]);
        assert!(marked.is_empty());
        assert_eq!(report.count(WarningCode::Syntax), 1);
    }

    /// The sample of `CESIUM_primitive_outline` itself has signed indices.
    #[test]
    fn indices_of_a_signed_type_are_taken_if_none_is_negative() {
        let outline = |indices: [i16; 4]| {
            square(OUTLINE, |sample| {
                let bytes: Vec<u8> = indices.iter().flat_map(|index| index.to_le_bytes()).collect();
                let view = sample.view(&bytes, &json!({}));
                let indices = sample.accessor(json!({
                    "bufferView": view, "componentType": 5122, "count": 4, "type": "SCALAR"
                }));
                json!({"indices": indices})
            })
        };
        let place = |part: &str| Some(Place::Part(part.into()));
        let (marked, _, report) = outline([1, 0, 2, 3]);
        assert_eq!(marked, [[0, 1], [2, 3]]);
        let [warning] = report.warnings() else { panic!("{report:?}") };
        let part = "meshes[0].primitives[0].extensions.CESIUM_primitive_outline";
        assert_eq!((warning.code, &warning.place), (WarningCode::Syntax, &place(part)));
        let (marked, _, report) = outline([1, 0, 2, -1]);
        assert!(marked.is_empty());
        let [warning] = report.warnings() else { panic!("{report:?}") };
        let found = (warning.code, &warning.place, &*warning.message);
        let message = "has the index -1 at 3; it was left out";
        assert_eq!(found, (WarningCode::Syntax, &place("accessors[2]"), message));
    }
}
