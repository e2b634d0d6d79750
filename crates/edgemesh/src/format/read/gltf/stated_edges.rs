//! The classes of edges in the `extras` of our own exports.
//!
//! ```text
//! "edges": [[3, "ridge"], [1, "marked", "valley"]]     three ridges, then a marked valley
//! ```
//!
//! The runs are in the order of the edges that the extension lists, so their counts must agree.
//! Whoever changes a file and keeps its extras gives another generator, and the classes are not
//! taken.

use gltf_json as json;
use serde_json::Value;

use crate::edge_mesh::{EdgeFlags, class_of_name};
use crate::format::edge_classes::{GENERATOR, STATES_CLASSES};

/// Whether a file is an export of this program that lists classes as this version does.
pub(super) fn states_classes(asset: &json::Asset) -> bool {
    let is_ours = asset.generator.as_ref().is_some_and(|name| name.starts_with(GENERATOR));
    let extras = asset.extras.as_ref().filter(|_| is_ours);
    let extras = extras.and_then(|extras| serde_json::from_str::<Value>(extras.get()).ok());
    extras.is_some_and(|extras| extras["edges"] == STATES_CLASSES)
}

/// The classes of `count` edges; `None` if the runs are malformed or have another count.
pub(super) fn classes_in(runs: &Value, count: usize) -> Option<Vec<EdgeFlags>> {
    let mut classes = Vec::with_capacity(count);
    for run in runs.as_array().into_iter().flatten() {
        let (length, words) = run.as_array()?.split_first()?;
        let length = usize::try_from(length.as_u64()?).ok()?;
        if length > count - classes.len() {
            return None;
        }
        let mut flags = EdgeFlags::empty();
        for word in words {
            flags |= class_of_name(word.as_str()?)?;
        }
        classes.resize(classes.len() + length, flags);
    }
    (classes.len() == count).then_some(classes)
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn runs_have_as_many_edges_as_the_file() {
        let runs = json!([[2, "ridge"], [1, "marked", "valley"], [1]]);
        let both = EdgeFlags::MARKED | EdgeFlags::VALLEY;
        let expected = [EdgeFlags::RIDGE, EdgeFlags::RIDGE, both, EdgeFlags::empty()];
        assert_eq!(classes_in(&runs, 4), Some(expected.to_vec()));
        for count in [3, 5] {
            assert_eq!(classes_in(&runs, count), None, "{count}");
        }
        for wrong in [json!([[1, "sharp"]]), json!([1]), json!([[]]), json!([["ridge"]])] {
            assert_eq!(classes_in(&wrong, 1), None, "{wrong}");
        }
        assert_eq!(classes_in(&json!([[u64::MAX, "ridge"]]), 7), None);
        assert_eq!(classes_in(&Value::Null, 0), Some(Vec::new()));
    }

    #[test]
    fn only_this_version_of_this_program_is_believed() {
        let asset = |generator: &str, edges: &str| {
            let json =
                json!({"version": "2.0", "generator": generator, "extras": {"edges": edges}});
            states_classes(&serde_json::from_value(json).unwrap())
        };
        assert!(asset("Edgemesh 9.9.9", STATES_CLASSES));
        assert!(!asset("glTF-Transform v4", STATES_CLASSES));
        assert!(!asset("Edgemesh 9.9.9", "Edgemesh edge classes 2"));
        let bare = serde_json::from_str(r#"{"version": "2.0", "generator": "Edgemesh 0"}"#);
        assert!(!states_classes(&bare.unwrap()));
    }
}
