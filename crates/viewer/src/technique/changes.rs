//! The difference between two techniques as settings of a command line.
//!
//! The window changes values in place. A copied command, and the text in a saved picture,
//! must give the same values; so settings are computed from the original and the changed
//! technique.

use super::Technique;
use super::pass::Pass;
use super::value::{Value, VariableType, color_text};

/// The settings for `--set` that lead from `before` to `after`, which has the passes of
/// `before` and passes split from them for line classes; `None` if no settings do.
///
/// [`Technique::set`] changes a pass and all passes split from it. So splits come first, then
/// values of the other passes, then values of the split ones.
#[must_use]
pub(crate) fn changes(before: &Technique, after: &Technique) -> Option<Vec<String>> {
    let mut settings = Vec::new();
    let mut reached = before.clone();
    let is_new = |pass: &&Pass| before.pass(&pass.name).is_none();
    // A new pass is inserted right after its origin, so the last one is made first.
    for pass in after.passes.iter().rev().filter(is_new) {
        let (index, _) = pass.component.variable("render")?;
        add_setting(&mut settings, &mut reached, pass, index)?;
    }
    for is_split in [false, true] {
        for pass in after.passes.iter().filter(|pass| is_new(pass) == is_split) {
            for (index, value) in pass.values().iter().enumerate() {
                if reached.pass(&pass.name)?.values().get(index) != Some(value) {
                    add_setting(&mut settings, &mut reached, pass, index)?;
                }
            }
        }
    }
    (reached.passes == after.passes).then_some(settings)
}

/// Adds the setting of a variable, and sets it in `reached`.
fn add_setting(
    settings: &mut Vec<String>,
    reached: &mut Technique,
    pass: &Pass,
    index: usize,
) -> Option<()> {
    let (variable, value) = (pass.component.variables.get(index)?, pass.values().get(index)?);
    let setting = format!("{}.{}={}", pass.name, variable.name, argument(variable.kind, value));
    reached.set(&setting).ok()?;
    settings.push(setting);
    Some(())
}

/// The text of a value for [`VariableType::parse`].
#[must_use]
pub(crate) fn argument(kind: VariableType, value: &Value) -> String {
    match value {
        Value::Numbers(numbers) => match color_text(numbers).filter(|_| kind.is_color()) {
            Some(color) => color,
            None => {
                let numbers: Vec<String> = numbers.iter().map(ToString::to_string).collect();
                numbers.join(",")
            }
        },
        Value::String(text) => text.clone(),
        Value::Texture(name) => name.to_string(),
        Value::Bool(_) | Value::Int(_) => value.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::technique::library::Library;

    fn shipped(name: &str) -> Technique {
        Library::shipped().technique(name).unwrap().0
    }

    #[test]
    fn what_was_not_changed_needs_no_settings() {
        for name in ["ink", "hatching", "outline_combined"] {
            assert_eq!(changes(&shipped(name), &shipped(name)), Some(Vec::new()));
        }
    }

    #[test]
    fn settings_lead_to_the_same_technique_however_it_came_about() {
        let before = shipped("ink");
        let mut after = before.clone();
        for setting in [
            "valley.width=4",
            "strokes.color=0.1,0.2,0.3",
            "strokes.width=2.7182817",
            "strokes.brush=charcoal",
            "strokes.fade=3,8",
            "hidden-contour.render=true",
            "ridge.color=#00ff0080",
        ] {
            after.set(setting).unwrap();
        }
        let settings = changes(&before, &after).unwrap();
        assert!(settings.contains(&"strokes.width=2.7182817".to_owned()), "{settings:?}");
        assert!(settings.contains(&"ridge.color=#00ff0080".to_owned()), "{settings:?}");
        let mut again = before;
        for setting in &settings {
            again.set(setting).unwrap();
        }
        let names = |technique: &Technique| -> Vec<String> {
            technique.passes.iter().map(|pass| pass.name.clone()).collect()
        };
        assert_eq!(names(&again), names(&after));
        for (one, other) in again.passes.iter().zip(&after.passes) {
            assert_eq!(one.values(), other.values(), "{}", one.name);
        }
    }

    #[test]
    fn another_technique_cannot_be_reached() {
        assert_eq!(changes(&shipped("ink"), &shipped("phong")), None);
    }
}
