//! Checks the JSON of a file against the rules.

use serde_json::Value;

use super::extensions;
use super::pattern::{Trail, each, member};
use super::rules::{RULES, Rule};
use crate::report::{Place, Report, WarningCode};

/// Warns of each rule that the JSON of a file breaks.
pub(crate) fn check(root: &Value, report: &mut Report) {
    for (pattern, rule) in RULES {
        each(root, pattern, &Trail::ROOT, &mut |trail, value| {
            if let Some(what) = fault(rule, root, value) {
                report.warn(WarningCode::Syntax, Some(Place::Part(trail.to_string())), || what);
            }
        });
    }
    extensions::check(root, report);
}

/// How `value` breaks a rule; `None` if it does not.
fn fault(rule: &Rule, root: &Value, value: &Value) -> Option<String> {
    match *rule {
        Rule::IndexOf(list) => {
            let count = member(root, list).and_then(Value::as_array).map_or(0, Vec::len);
            let is_valid = value.as_u64().is_some_and(|index| index < count as u64);
            (!is_valid).then(|| format!("names {list}[{value}]; there are {count}"))
        }
        Rule::Has(members) => {
            let missing = members.iter().find(|member| value.get(member).is_none());
            missing.map(|member| format!("has no {member}"))
        }
        Rule::InRange(least, most) => {
            let is_inside = value.as_f64().is_some_and(|number| (least..=most).contains(&number));
            (!is_inside).then(|| format!("is {value}, not from {least} to {most}"))
        }
        Rule::NotEmpty => {
            let is_empty = value.as_array().is_some_and(Vec::is_empty);
            is_empty.then(|| "is an empty list".into())
        }
        Rule::IsList => (!value.is_array()).then(|| "is not a list".into()),
        Rule::IsObject => (!value.is_object()).then(|| "is not an object".into()),
        Rule::Relation(check) => check(root, value),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The place and the message of the only warning about a file with this JSON.
    fn warning(json: &str) -> Option<(String, String)> {
        let root = serde_json::from_str(&format!(r#"{{"asset": {{"version": "2.0"}}, {json}}}"#));
        let mut report = Report::default();
        check(&root.unwrap(), &mut report);
        let [one] = report.warnings() else { return None };
        assert_eq!((one.code, one.count), (WarningCode::Syntax, 1), "{one:?}");
        let Some(Place::Part(place)) = &one.place else { panic!("{one:?}") };
        Some((place.clone(), one.message.clone()))
    }

    fn place(json: &str) -> String {
        warning(json).unwrap().0
    }

    #[test]
    fn each_kind_of_rule() {
        let (place, what) =
            warning(r#""scenes": [{"nodes": [0]}], "nodes": [{"mesh": 1}]"#).unwrap();
        assert_eq!(place, "nodes[0].mesh");
        assert_eq!(what, "names meshes[1]; there are 0");
        let (place, what) = warning(r#""buffers": [{"byteLength": 1}, {}]"#).unwrap();
        assert_eq!((place.as_str(), what.as_str()), ("buffers[1]", "has no byteLength"));
        assert_eq!(
            warning(r#""buffers": [{"byteLength": 0}]"#).unwrap().0,
            "buffers[0].byteLength"
        );
        assert_eq!(
            warning(r#""meshes": []"#).unwrap(),
            ("meshes".into(), "is an empty list".into())
        );
        assert_eq!(
            warning(r#""extensions": {"A": 1}, "extensionsUsed": ["A"]"#).unwrap().0,
            "extensions.A"
        );
        assert_eq!(warning(r#""images": {}"#).unwrap().0, "images");
        assert_eq!(warning(r#""nodes": [{"scale": [0, 0, 0]}]"#), None);
    }

    #[test]
    fn transforms_of_nodes() {
        assert_eq!(place(r#""nodes": [{}, {"rotation": [0, 0, 0, 2]}]"#), "nodes[1].rotation");
        let matrix = |skew: f32| {
            format!(r#""nodes": [{{"matrix": [1,0,0,0, {skew},1,0,0, 0,0,1,0, 0,0,0,1]}}]"#)
        };
        assert_eq!(warning(&matrix(0.0)), None);
        assert_eq!(place(&matrix(0.5)), "nodes[0].matrix");
        let both =
            r#""nodes": [{"scale": [1,1,1], "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]}]"#;
        assert_eq!(place(both), "nodes[0]");
    }

    #[test]
    fn bytes_of_accessors() {
        let with = |view: &str, accessor: &str| {
            format!(
                r#""buffers": [{{"byteLength": 64, "uri": "a.bin"}}],
                "bufferViews": [{{"buffer": 0, "byteLength": 32, {view}}}],
                "accessors": [{{"bufferView": 0, "count": 1, "type": "VEC3", {accessor}}}]"#
            )
        };
        let float = r#""componentType": 5126"#;
        assert_eq!(warning(&with(r#""byteOffset": 32"#, float)), None);
        assert_eq!(place(&with(r#""byteOffset": 40"#, float)), "bufferViews[0]");
        assert_eq!(place(&with(r#""byteOffset": 2"#, float)), "accessors[0]");
        assert_eq!(warning(&with(r#""byteOffset": 2"#, r#""componentType": 5123"#)), None);
        assert_eq!(place(&with(r#""byteStride": 18"#, float)), "bufferViews[0].byteStride");
    }

    #[test]
    fn attributes_of_primitives() {
        let with = |primitive: &str| {
            let accessor = |kind: &str, component: u32, count: u32| {
                format!(
                    r#"{{"type": "{kind}", "componentType": {component}, "count": {count},
                    "min": [0, 0, 0], "max": [1, 1, 1]}}"#
                )
            };
            let accessors = [
                accessor("VEC3", 5126, 3),
                accessor("VEC4", 5126, 3),
                accessor("VEC3", 5126, 4),
                accessor("SCALAR", 5123, 3),
            ];
            format!(
                r#""meshes": [{{"primitives": [{primitive}]}}], "accessors": [{}]"#,
                accessors.join(",")
            )
        };
        let attributes = |attributes: &str| with(&format!(r#"{{"attributes": {{{attributes}}}}}"#));
        assert_eq!(warning(&attributes(r#""POSITION": 0, "COLOR_0": 1, "_OWN": 3"#)), None);
        let (place, what) = warning(&attributes(r#""POSITION": 1"#)).unwrap();
        assert_eq!(place, "meshes[0].primitives[0].attributes");
        assert!(what.contains("POSITION"), "{what}");
        assert!(
            warning(&attributes(r#""POSITION": 0, "JOINTS_0": 1"#)).unwrap().1.contains("sets")
        );
        assert!(warning(&attributes(r#""POSITION": 0, "SMELL": 1"#)).unwrap().1.contains("SMELL"));
        assert!(
            warning(&attributes(r#""POSITION": 0, "NORMAL": 2"#)).unwrap().1.contains("3 and of 4")
        );
        let indexed = |accessor: u32| {
            with(&format!(r#"{{"attributes": {{"POSITION": 0}}, "indices": {accessor}}}"#))
        };
        assert_eq!(warning(&indexed(3)), None);
        assert!(warning(&indexed(0)).unwrap().1.contains("unsigned"));
    }
}
