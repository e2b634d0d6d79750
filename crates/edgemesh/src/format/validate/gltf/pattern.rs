//! Patterns of places in JSON, such as `meshes[].primitives[].attributes.*`.

use std::fmt::{Display, Formatter, Result};

use serde_json::Value;

/// The way from the root to a value, displayed as `meshes[0].primitives[2]`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Trail<'t> {
    /// `None` for the root.
    parent: Option<&'t Self>,
    step: Step<'t>,
}

#[derive(Debug, Clone, Copy)]
enum Step<'t> {
    Member(&'t str),
    Item(usize),
}

impl Trail<'_> {
    /// The root itself.
    pub(super) const ROOT: Self = Self { parent: None, step: Step::Member("") };

    fn then<'t>(&'t self, step: Step<'t>) -> Trail<'t> {
        Trail { parent: Some(self), step }
    }
}

impl Display for Trail<'_> {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> Result {
        let Some(parent) = self.parent else { return Ok(()) };
        parent.fmt(formatter)?;
        match self.step {
            Step::Item(index) => write!(formatter, "[{index}]"),
            Step::Member(name) if parent.parent.is_none() => formatter.write_str(name),
            Step::Member(name) => write!(formatter, ".{name}"),
        }
    }
}

/// Calls `visit` for each value that matches `pattern` below `value`. In a pattern,
/// dots separate members, `[]` matches each item of a list, and `*` each member of
/// an object. The recursion is as deep as the pattern.
pub(super) fn each<'v>(
    value: &'v Value,
    pattern: &str,
    trail: &Trail,
    visit: &mut dyn FnMut(&Trail, &'v Value),
) {
    if pattern.is_empty() {
        return visit(trail, value);
    }
    let (member, rest) = pattern.split_once('.').unwrap_or((pattern, ""));
    if member == "*" {
        for (name, value) in value.as_object().into_iter().flatten() {
            each(value, rest, &trail.then(Step::Member(name)), visit);
        }
        return;
    }
    let items = member.strip_suffix("[]");
    let name = items.unwrap_or(member);
    let Some(value) = value.get(name) else { return };
    let trail = trail.then(Step::Member(name));
    if items.is_none() {
        return each(value, rest, &trail, visit);
    }
    for (at, value) in value.as_array().into_iter().flatten().enumerate() {
        each(value, rest, &trail.then(Step::Item(at)), visit);
    }
}

/// The value of a member such as `extensions.KHR_lights_punctual.lights`.
pub(super) fn member<'v>(value: &'v Value, names: &str) -> Option<&'v Value> {
    names.split('.').try_fold(value, |value, name| value.get(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_match_all_such_values() {
        let root = serde_json::json!({
            "meshes": [{"primitives": [{"attributes": {"A": 1, "B": 2}}, {}]}, 7],
            "scene": 3
        });
        let found = |pattern: &str| {
            let mut found = Vec::new();
            each(&root, pattern, &Trail::ROOT, &mut |trail, value| {
                found.push(format!("{trail} = {value}"));
            });
            found
        };
        let attributes = "meshes[].primitives[].attributes";
        assert_eq!(
            found(&format!("{attributes}.*")),
            [
                "meshes[0].primitives[0].attributes.A = 1",
                "meshes[0].primitives[0].attributes.B = 2"
            ]
        );
        assert_eq!(found(&format!("{attributes}.B")).len(), 1);
        assert_eq!(found("scene"), ["scene = 3"]);
        assert_eq!(found("scene[]"), [""; 0]);
        assert_eq!(found("").len(), 1);
        assert_eq!(member(&root, "scene"), Some(&3.into()));
        assert_eq!(member(&root, "scene.nodes"), None);
    }
}
