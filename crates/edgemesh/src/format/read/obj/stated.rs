//! The classes of lines in our own exports: the words of their group.
//!
//! ```text
//! # Edgemesh edge classes 1
//! g marked ridge
//! l 4 7 9
//! ```

use super::block::{NewState, ParsedBlock};
use crate::edge_mesh::{EdgeFlags, class_of_name};
use crate::format::edge_classes::STATES_CLASSES;
use crate::format::read::stated::add_stated_edge;
use crate::model::Model;

/// The classes of successive segments: the first segment of each group, and its classes.
pub(super) type LineClasses = Vec<(usize, EdgeFlags)>;

/// Whether a file is an export of this program that lists classes as this version does.
pub(super) fn states_classes(text: &[u8]) -> bool {
    let rest =
        text.strip_prefix(b"# ").and_then(|rest| rest.strip_prefix(STATES_CLASSES.as_bytes()));
    rest.is_some_and(|rest| matches!(rest.first(), Some(b'\r' | b'\n')))
}

/// The classes of the groups in all blocks.
pub(super) fn line_classes(blocks: &[ParsedBlock]) -> LineClasses {
    let mut before = 0;
    let mut classes = Vec::new();
    for block in blocks {
        for change in &block.changes {
            if let NewState::Group(name) = &change.state {
                classes.push((before + change.segment, classes_of_group(name)));
            }
        }
        before += block.model.segments.len();
    }
    classes
}

/// The classes that the words of a group name; lines of another group, added by hand, are marked.
fn classes_of_group(name: &str) -> EdgeFlags {
    let words = name.split_whitespace().map(class_of_name);
    words.collect::<Option<EdgeFlags>>().unwrap_or(EdgeFlags::MARKED)
}

/// Gives each segment of `model` the classes of its group.
pub(super) fn state_classes(model: &mut Model, classes: &LineClasses) {
    model.stated_edges = Some(Vec::new());
    for (at, segment) in std::mem::take(&mut model.segments).into_iter().enumerate() {
        let group = classes.partition_point(|(first, _)| *first <= at).checked_sub(1);
        let own = group.map_or(EdgeFlags::MARKED, |group| classes[group].1);
        add_stated_edge(model, segment.ends, own, segment.line);
    }
}
