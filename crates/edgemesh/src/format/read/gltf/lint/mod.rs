//! Rules of the format that a file may break and still be drawn.
//!
//! Based on: glTF 2.0, sections 3 and 5 (properties); the codes of the Khronos
//! validator are what to compare with.
//!
//! A reader that only takes what it needs says nothing of a broken rule beside
//! it, and the file fails in the next program. So the whole JSON is looked
//! through once, by a table of rules, each a pattern of places and what must
//! hold there. Nothing is refused here.

mod checks;
mod declared;
mod rules;
mod trail;
#[cfg(test)]
mod validator;

use std::fmt::Display;

use rules::{Must, RULES};
use serde_json::Value;
use trail::{Trail, each};

use crate::report::{Place, Report, WarningCode};

/// Warns of what breaks the rules in the JSON of a file.
pub(super) fn check(root: &Value, report: &mut Report) {
    for (pattern, must) in RULES {
        each(root, pattern, &Trail::ROOT, &mut |trail, value| {
            if let Some(what) = broken(must, root, value) {
                warn(report, trail, || what);
            }
        });
    }
    declared::check(root, report);
}

fn warn(report: &mut Report, place: impl Display, what: impl FnOnce() -> String) {
    report.warn(WarningCode::Syntax, Some(Place::Part(place.to_string())), what);
}

/// How `value` breaks a rule; `None` where it does not.
fn broken(must: &Must, root: &Value, value: &Value) -> Option<String> {
    match *must {
        Must::Name(list) => {
            let count = trail::at(root, list).and_then(Value::as_array).map_or(0, Vec::len);
            let is_there = value.as_u64().is_some_and(|index| index < count as u64);
            (!is_there).then(|| format!("names {list}[{value}], of which there are {count}"))
        }
        Must::Have(members) => {
            let missing = members.iter().find(|member| value.get(member).is_none());
            missing.map(|member| format!("has no {member}"))
        }
        Must::Lie(least, most) => {
            let number = value.as_f64();
            let is_inside = number.is_some_and(|number| (least..=most).contains(&number));
            (!is_inside).then(|| format!("is {value}, not from {least} to {most}"))
        }
        Must::HoldSome => {
            let is_empty = value.as_array().is_some_and(Vec::is_empty);
            is_empty.then(|| "is an empty list".into())
        }
        Must::BeList => (!value.is_array()).then(|| "is no list".into()),
        Must::BeObject => (!value.is_object()).then(|| "is no object".into()),
        Must::Pass(check) => check(root, value),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The places and words of what is said of a file with this JSON, none of
    /// its own extensions, and a version.
    fn told(json: &str) -> Option<(String, String)> {
        let root = serde_json::from_str(&format!(r#"{{"asset": {{"version": "2.0"}}, {json}}}"#));
        let mut report = Report::default();
        check(&root.unwrap(), &mut report);
        let [warning] = report.warnings() else { return None };
        assert_eq!((warning.code, warning.count), (WarningCode::Syntax, 1), "{warning:?}");
        let Some(Place::Part(place)) = &warning.place else { panic!("{warning:?}") };
        Some((place.clone(), warning.message.clone()))
    }

    fn place(json: &str) -> String {
        told(json).unwrap().0
    }

    #[test]
    fn each_kind_of_rule() {
        let (place, what) = told(r#""scenes": [{"nodes": [0]}], "nodes": [{"mesh": 1}]"#).unwrap();
        assert_eq!(place, "nodes[0].mesh");
        assert_eq!(what, "names meshes[1], of which there are 0");
        let (place, what) = told(r#""buffers": [{"byteLength": 1}, {}]"#).unwrap();
        assert_eq!((place.as_str(), what.as_str()), ("buffers[1]", "has no byteLength"));
        assert_eq!(told(r#""buffers": [{"byteLength": 0}]"#).unwrap().0, "buffers[0].byteLength");
        assert_eq!(told(r#""meshes": []"#).unwrap(), ("meshes".into(), "is an empty list".into()));
        assert_eq!(
            told(r#""extensions": {"A": 1}, "extensionsUsed": ["A"]"#).unwrap().0,
            "extensions.A"
        );
        assert_eq!(told(r#""images": {}"#).unwrap().0, "images");
        assert_eq!(told(r#""nodes": [{"scale": [0, 0, 0]}]"#), None);
    }

    #[test]
    fn transforms_of_nodes() {
        assert_eq!(place(r#""nodes": [{}, {"rotation": [0, 0, 0, 2]}]"#), "nodes[1].rotation");
        let matrix = |skew: f32| {
            format!(r#""nodes": [{{"matrix": [1,0,0,0, {skew},1,0,0, 0,0,1,0, 0,0,0,1]}}]"#)
        };
        assert_eq!(told(&matrix(0.0)), None);
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
        assert_eq!(told(&with(r#""byteOffset": 32"#, float)), None);
        assert_eq!(place(&with(r#""byteOffset": 40"#, float)), "bufferViews[0]");
        assert_eq!(place(&with(r#""byteOffset": 2"#, float)), "accessors[0]");
        assert_eq!(told(&with(r#""byteOffset": 2"#, r#""componentType": 5123"#)), None);
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
        assert_eq!(told(&attributes(r#""POSITION": 0, "COLOR_0": 1, "_OWN": 3"#)), None);
        let (place, what) = told(&attributes(r#""POSITION": 1"#)).unwrap();
        assert_eq!(place, "meshes[0].primitives[0].attributes");
        assert!(what.contains("POSITION"), "{what}");
        assert!(told(&attributes(r#""POSITION": 0, "JOINTS_0": 1"#)).unwrap().1.contains("sets"));
        assert!(told(&attributes(r#""POSITION": 0, "SMELL": 1"#)).unwrap().1.contains("SMELL"));
        assert!(
            told(&attributes(r#""POSITION": 0, "NORMAL": 2"#)).unwrap().1.contains("3 and of 4")
        );
        let indexed = |accessor: u32| {
            with(&format!(r#"{{"attributes": {{"POSITION": 0}}, "indices": {accessor}}}"#))
        };
        assert_eq!(told(&indexed(3)), None);
        assert!(told(&indexed(0)).unwrap().1.contains("unsigned"));
    }
}
