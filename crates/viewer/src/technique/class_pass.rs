//! A pass of its own for one class of edges.
//!
//! Passes of the component `strokes` say which classes they draw. Who wants ridges to
//! look different gives them a pass of their own; command lines do it by the name of
//! the class, as in `--set ridge.width=4`.

use edgemesh::line::class::LineClass;

use super::core::CoreComponent;
use super::mistake::Mistakes;
use super::pass::Pass;
use super::value::Value;

/// The word for all classes.
pub(crate) const ALL_CLASSES: &str = "all";

/// The classes that a pass of strokes draws, from the text of its variable.
///
/// # Errors
/// The first word that is no class.
pub(crate) fn classes_of(text: &str) -> Result<Vec<LineClass>, String> {
    if text.trim() == ALL_CLASSES {
        return Ok(LineClass::ALL.to_vec());
    }
    let words = text.split([',', ' ']).filter(|word| !word.is_empty());
    words
        .map(|word| {
            let found = LineClass::ALL.into_iter().find(|class| class.name() == word);
            found.ok_or_else(|| word.to_owned())
        })
        .collect()
}

/// Whether a name of a pass is that of a class, visible or hidden.
pub(crate) fn is_class(name: &str) -> bool {
    let class = name.strip_prefix("hidden_").unwrap_or(name);
    LineClass::ALL.iter().any(|known| known.name() == class)
}

/// The text of a list of classes.
fn text_of(classes: &[LineClass]) -> String {
    let names: Vec<&str> = classes.iter().map(|class| class.name()).collect();
    names.join(", ")
}

/// Splits the class called `name` (`ridge`, or `hidden_ridge` for what is hidden of it)
/// off the pass of strokes that draws it; the new pass has that name and comes right
/// behind. `None` where the name is no class or no pass draws it.
pub(crate) fn split(passes: &mut Vec<Pass>, name: &str) -> Option<Vec<usize>> {
    let (visibility, class_name) = match name.strip_prefix("hidden_") {
        Some(class) => ("hidden", class),
        None => ("visible", name),
    };
    let class = LineClass::ALL.into_iter().find(|class| class.name() == class_name)?;
    let draws = |pass: &Pass| {
        pass.component.core == CoreComponent::Strokes
            && pass.string("visibility") == visibility
            && classes_of(pass.string("classes")).is_ok_and(|classes| classes.contains(&class))
    };
    let at = passes.iter().position(draws)?;
    let (index, _) = passes[at].component.variable("classes")?;
    let mut own = passes[at].clone();
    let rest: Vec<LineClass> = classes_of(own.string("classes"))
        .unwrap_or_default()
        .into_iter()
        .filter(|other| *other != class)
        .collect();
    let mut mistakes = Mistakes::default();
    let mut set = |pass: &mut Pass, classes: &[LineClass]| {
        pass.set_value(index, Value::String(text_of(classes)), None, &mut mistakes);
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
        let classes = |name: &str| technique.pass(name).unwrap().string("classes").to_owned();
        assert_eq!(classes("ridge"), "ridge");
        assert_eq!(classes("strokes"), "contour, marked, boundary, material, smoothing, valley");
        assert!(!classes("hidden").contains("valley"));
        let valley = technique.pass("hidden_valley").unwrap();
        assert!(valley.is_rendered() && valley.string("visibility") == "hidden");
    }

    #[test]
    fn what_is_set_of_a_pass_is_set_of_those_split_from_it() {
        let technique = ink(&["ridge.width=4", "strokes.color=#ff0000", "strokes.width=6"]);
        for name in ["strokes", "ridge"] {
            let pass = technique.pass(name).unwrap();
            assert_eq!(pass.numbers::<4>("color"), [1.0, 0.0, 0.0, 1.0], "{name}");
            assert_eq!(pass.number("width").to_bits(), 6_f32.to_bits(), "{name}");
        }
    }

    #[test]
    fn classes_that_nobody_draws_cannot_be_set() {
        let mut fur = Library::shipped().technique("fur").unwrap().0;
        let error = fur.set("marked.width=3").unwrap_err();
        assert!(error.what.contains("no pass of fur draws 'marked'"), "{error}");
        assert!(fur.set("contour.width=3").is_ok(), "that is a pass");
        assert_eq!(classes_of("ridge, edge"), Err("edge".to_owned()));
        assert_eq!(classes_of("all").unwrap().len(), LineClass::ALL.len());
    }
}
