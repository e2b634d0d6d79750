//! Splits a pass of strokes so that one line class has a separate pass.
//!
//! The variable `classes` of a pass of `strokes` selects what it draws. Setting a variable of
//! a class, as in `--set ridge.width=4`, splits the pass that draws the class.

use edgemesh::line::LineClass;

use super::core_view::{LineSelection, Visibility, classes_text};
use super::mistake::Mistakes;
use super::pass::Pass;
use super::value::Value;

/// The prefix of the names of passes that draw the hidden part of a class.
const HIDDEN: &str = "hidden_";

/// The class and the visibility of a name such as `ridge` or `hidden_ridge`.
fn class_of(name: &str) -> Option<(LineClass, Visibility)> {
    let (class_name, visibility) = match name.strip_prefix(HIDDEN) {
        Some(class_name) => (class_name, Visibility::Hidden),
        None => (name, Visibility::Visible),
    };
    let class = LineClass::ALL.into_iter().find(|class| class.name() == class_name)?;
    Some((class, visibility))
}

/// Whether a name is a class, visible or hidden.
pub(crate) fn is_class(name: &str) -> bool {
    class_of(name).is_some()
}

/// Splits the class called `name` (`ridge`, or `hidden_ridge` for its hidden part) off the
/// pass of strokes that draws it. The new pass has that name and follows the other one.
/// Returns `None` if the name is not a class or no pass draws it.
pub(crate) fn split(passes: &mut Vec<Pass>, name: &str) -> Option<Vec<usize>> {
    let (class, visibility) = class_of(name)?;
    let lines_of =
        |pass: &Pass| LineSelection::of(pass).filter(|lines| lines.draws(class, visibility));
    let (at, lines) =
        passes.iter().enumerate().find_map(|(at, pass)| Some((at, lines_of(pass)?)))?;
    let (index, _) = passes[at].component.variable(LineSelection::CLASSES)?;
    let rest: Vec<LineClass> = lines.classes.into_iter().filter(|other| *other != class).collect();
    let mut own = passes[at].clone();
    let mut mistakes = Mistakes::default();
    let mut set = |pass: &mut Pass, classes: &[LineClass]| {
        pass.set_value(index, Value::String(classes_text(classes)), None, &mut mistakes);
    };
    set(&mut own, &[class]);
    set(&mut passes[at], &rest);
    own.split_from = own.split_from.or_else(|| Some(own.name.clone()));
    own.name = name.to_owned();
    passes.insert(at + 1, own);
    Some(vec![at + 1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::technique::Technique;
    use crate::technique::core_view::{StrokeWidth, Strokes};
    use crate::technique::library::Library;

    fn ink(settings: &[&str]) -> Technique {
        let mut technique = Library::shipped().technique("ink").unwrap().0;
        for setting in settings {
            technique.set(setting).unwrap();
        }
        technique
    }

    #[test]
    fn a_class_that_is_set_has_a_pass_of_its_own_behind_that_which_drew_it() {
        let technique = ink(&["ridge.width=4", "hidden-valley.render=true"]);
        let names: Vec<&str> = technique.passes.iter().map(|pass| pass.name.as_str()).collect();
        assert_eq!(names, ["fill", "hidden", "hidden_valley", "strokes", "ridge", "silhouette"]);
        let lines = |name: &str| LineSelection::of(technique.pass(name).unwrap()).unwrap();
        assert_eq!(lines("ridge").classes, [LineClass::Ridge]);
        assert_eq!(
            classes_text(&lines("strokes").classes),
            "contour, marked, boundary, material, smoothing, valley"
        );
        assert!(!lines("hidden").classes.contains(&LineClass::Valley));
        assert!(lines("hidden_valley").draws(LineClass::Valley, Visibility::Hidden));
        assert!(technique.pass("hidden_valley").unwrap().is_rendered());
    }

    #[test]
    fn what_is_set_of_a_pass_is_set_of_those_split_from_it() {
        let technique = ink(&["ridge.width=4", "strokes.color=#ff0000", "strokes.width=6"]);
        for name in ["strokes", "ridge"] {
            let view = Strokes::of(technique.pass(name).unwrap()).unwrap();
            assert_eq!(view.color, [1.0, 0.0, 0.0, 1.0], "{name}");
            assert_eq!(view.width, StrokeWidth::Pixels(6.0), "{name}");
        }
    }

    #[test]
    fn classes_that_nobody_draws_cannot_be_set() {
        let mut fur = Library::shipped().technique("fur").unwrap().0;
        let error = fur.set("marked.width=3").unwrap_err();
        assert!(error.what.contains("no pass of fur draws 'marked'"), "{error}");
        assert!(fur.set("contour.width=3").is_ok(), "that is a pass");
    }
}
