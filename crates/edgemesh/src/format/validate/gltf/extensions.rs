//! Rules about extensions: those that are used are declared, those that are required
//! are used, and each stands where it has a meaning.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::Value;

use super::pattern::{Trail, each};
use crate::report::{Place, Report, WarningCode};

/// The list of all extensions of a file.
const USED: &str = "extensionsUsed";

/// Prefixes of extensions, and the patterns of the places where they have a meaning; the
/// first prefix that fits counts.
const ALLOWED_PLACES: [(&str, &[&str]); 7] = [
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

/// The places of at most this many extensions are checked, because each takes a pass
/// over the JSON.
const MAX_NAMES: usize = 100;

/// Warns of extensions that are not declared, or have no meaning at their place.
pub(super) fn check(root: &Value, report: &mut Report) {
    let list = |name: &str| root.get(name).and_then(Value::as_array).into_iter().flatten();
    let declared: BTreeSet<&str> = list(USED).filter_map(Value::as_str).collect();
    for (at, name) in list("extensionsRequired").filter_map(Value::as_str).enumerate() {
        if !declared.contains(name) {
            let place = format!("extensionsRequired[{at}]");
            warn(report, place, format!("requires {name}, which extensionsUsed does not list"));
        }
    }
    let uses = count_uses(root);
    for name in uses.keys().filter(|name| !declared.contains(**name)) {
        warn(report, USED.into(), format!("does not list {name}, which is used"));
    }
    for (name, &count) in uses.iter().take(MAX_NAMES) {
        let allowed = ALLOWED_PLACES.iter().find(|(known, _)| name.starts_with(known));
        if allowed.is_some_and(|(_, patterns)| count_at(root, patterns, name) < count) {
            warn(report, USED.into(), format!("lists {name}, which has no meaning at its place"));
        }
    }
}

fn warn(report: &mut Report, place: String, what: String) {
    report.warn(WarningCode::Syntax, Some(Place::Part(place)), || what);
}

/// The number of uses of each extension, by name.
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
                // `extras` may hold anything.
                let is_standard = |(name, _): &(&String, &Value)| *name != "extras";
                waiting.extend(members.iter().filter(is_standard).map(|(_, value)| value));
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
    fn extensions_in_use_or_required_are_declared() {
        let used = r#""nodes": [{"extensions": {"A": {}, "B": {"extensions": {"A": {}}}}}]"#;
        assert_eq!(count(&format!("{{{used}}}")), 2);
        assert_eq!(count(&format!(r#"{{"extensionsUsed": ["A", "B"], {used}}}"#)), 0);
        assert_eq!(count(r#"{"extras": {"extensions": {"A": 1}}}"#), 0, "extras are ignored");
        assert_eq!(count(r#"{"extensionsRequired": ["A"]}"#), 1);
    }

    #[test]
    fn known_extensions_stand_at_their_places() {
        let at = |list: &str| {
            count(&format!(
                r#"{{"extensionsUsed": ["KHR_materials_unlit"],
                    "{list}": [{{"extensions": {{"KHR_materials_unlit": {{}}}}}}]}}"#
            ))
        };
        assert_eq!((at("materials"), at("nodes")), (0, 1));
    }
}
