//! Classes of edges in files that this program exported.
//!
//! Each format has its own way to list them, and says by a version that they are there: the same
//! words or numbers in a file of another program mean nothing. Marks are lines of the model, as in
//! other files; creases and borders are classes that the file states.

use crate::edge_mesh::EdgeFlags;
use crate::model::{Model, Segment, StatedClasses, StatedEdge};

/// Adds an edge with its classes in an export; `line` is its line in the file, or 0.
pub(super) fn add_stated_edge(model: &mut Model, ends: [u32; 2], classes: EdgeFlags, line: u32) {
    if classes.contains(EdgeFlags::MARKED) {
        model.segments.push(Segment { ends, line });
    }
    let classes = StatedClasses {
        ridge: classes.contains(EdgeFlags::RIDGE),
        valley: classes.contains(EdgeFlags::VALLEY),
        material: classes.contains(EdgeFlags::MATERIAL),
        smoothing: classes.contains(EdgeFlags::SMOOTHING),
        non_manifold: classes.contains(EdgeFlags::NON_MANIFOLD),
    };
    model.stated_edges.get_or_insert_default().push(StatedEdge { ends, classes });
}
