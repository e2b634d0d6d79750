//! Extensions must be declared where they are used, used where required, and
//! stand where they mean something.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::Value;

use super::trail::{Trail, each};
use super::warn;
use crate::report::Report;

/// Where extensions stand, as patterns; the first name that an extension begins
/// with counts.
const HOMES: [(&str, &[&str]); 7] = [
    ("KHR_materials_variants", &["", "meshes[].primitives[]."]),
    ("KHR_materials_", &["materials[]."]),
    (
        "KHR_texture_transform",
        &["materials[].*.", "materials[].pbrMetallicRoughness.*.", "materials[].extensions.*.*."],
    ),
    ("EXT_texture_webp", &["textures[]."]),
    ("KHR_lights_punctual", &["", "nodes[]."]),
    ("KHR_mesh_quantization", &[]),
    ("KHR_node_visibility", &["nodes[]."]),
];

/// The places of at most this many extensions are looked at, since each takes a
/// walk through the file.
const MAX_NAMES: usize = 100;

/// Warns of extensions that the file does not declare, or puts where they mean
/// nothing.
pub(super) fn check(root: &Value, report: &mut Report) {
    let list = |name: &str| root.get(name).and_then(Value::as_array).into_iter().flatten();
    let declared: BTreeSet<&str> = list("extensionsUsed").filter_map(Value::as_str).collect();
    for (at, name) in list("extensionsRequired").filter_map(Value::as_str).enumerate() {
        if !declared.contains(name) {
            warn(report, format_args!("extensionsRequired[{at}]"), || {
                format!("requires {name}, which extensionsUsed does not list")
            });
        }
    }
    let uses = count_uses(root);
    for name in uses.keys().filter(|name| !declared.contains(**name)) {
        warn(report, "extensionsUsed", || format!("does not list {name}, which is used"));
    }
    for (name, &count) in uses.iter().take(MAX_NAMES) {
        let home = HOMES.iter().find(|(known, _)| name.starts_with(known));
        if home.is_some_and(|(_, patterns)| count_at(root, patterns, name) < count) {
            warn(report, "extensionsUsed", || format!("{name} stands where it means nothing"));
        }
    }
}

/// How often each extension is used, by name.
fn count_uses(root: &Value) -> BTreeMap<&str, usize> {
    let mut uses = BTreeMap::new();
    let mut waiting = vec![root];
    while let Some(value) = waiting.pop() {
        match value {
            Value::Array(items) => waiting.extend(items),
            Value::Object(members) => {
                let used = members.get("extensions").and_then(Value::as_object);
                for name in used.into_iter().flat_map(|used| used.keys()) {
                    *uses.entry(name.as_str()).or_insert(0) += 1;
                }
                // What programs note for themselves may look like anything.
                let is_ours = |(name, _): &(&String, &Value)| *name != "extras";
                waiting.extend(members.iter().filter(is_ours).map(|(_, value)| value));
            }
            _ => {}
        }
    }
    uses
}

fn count_at(root: &Value, patterns: &[&str], name: &str) -> usize {
    let mut count = 0;
    for pattern in patterns {
        let pattern = format!("{pattern}extensions.{name}");
        each(root, &pattern, &Trail::ROOT, &mut |_, _| count += 1);
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::WarningCode;

    fn count(json: &str) -> usize {
        let mut report = Report::default();
        check(&serde_json::from_str(json).unwrap(), &mut report);
        report.count(WarningCode::Syntax)
    }

    #[test]
    fn what_is_used_or_required_is_declared() {
        let used = r#""nodes": [{"extensions": {"A": {}, "B": {"extensions": {"A": {}}}}}]"#;
        assert_eq!(count(&format!("{{{used}}}")), 2);
        assert_eq!(count(&format!(r#"{{"extensionsUsed": ["A", "B"], {used}}}"#)), 0);
        assert_eq!(count(r#"{"extras": {"extensions": {"A": 1}}}"#), 0, "nobody's business");
        assert_eq!(count(r#"{"extensionsRequired": ["A"]}"#), 1);
    }

    #[test]
    fn what_is_known_stands_at_home() {
        let at = |list: &str| {
            count(&format!(
                r#"{{"extensionsUsed": ["KHR_materials_unlit"],
                    "{list}": [{{"extensions": {{"KHR_materials_unlit": {{}}}}}}]}}"#
            ))
        };
        assert_eq!((at("materials"), at("nodes")), (0, 1));
    }
}
