//! The variables `classes` and `visibility` of `strokes`: which lines a pass draws.

use edgemesh::line::LineClass;

use super::reader::Reader;
use crate::technique::core::CoreComponent;
use crate::technique::mistake::{Mistake, Mistakes};
use crate::technique::pass::Pass;
use crate::technique::word::Word;

/// The word for all classes.
const ALL_CLASSES: &str = "all";

/// Which lines a pass of strokes draws.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct LineSelection {
    /// Their classes.
    pub(crate) classes: Vec<LineClass>,
    /// The part of them that is drawn.
    pub(crate) visibility: Visibility,
}

/// The variable `visibility`: which part of the lines is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Visibility {
    /// What no surface hides.
    Visible,
    /// What a surface hides.
    Hidden,
    /// Contours against the background or another object.
    Silhouette,
}

impl Word for Visibility {
    const WORDS: &'static [(&'static str, Self)] =
        &[("visible", Self::Visible), ("hidden", Self::Hidden), ("silhouette", Self::Silhouette)];
}

impl LineSelection {
    /// The variable with the classes.
    pub(crate) const CLASSES: &str = "classes";

    /// The lines that a pass draws; `None` if it is not a pass of strokes, or if the values
    /// cannot be read.
    #[must_use]
    pub(crate) fn of(pass: &Pass) -> Option<Self> {
        if pass.component.core != CoreComponent::Strokes {
            return None;
        }
        let mut mistakes = Mistakes::default();
        let lines = Self::read(&mut Reader::new(pass, &mut mistakes));
        (!mistakes.has_errors()).then_some(lines)
    }

    pub(super) fn read(reader: &mut Reader) -> Self {
        let classes = parse_classes(reader.string(Self::CLASSES)).unwrap_or_else(|word| {
            let place = reader.place(Self::CLASSES);
            let words = LineClass::ALL.map(LineClass::name).into_iter().chain([ALL_CLASSES]);
            let mistake = Mistake::error(place, format!("unknown class '{word}'"));
            reader.add(mistake.names(word, words));
            Vec::new()
        });
        Self { classes, visibility: reader.word("visibility") }
    }

    /// Whether the pass draws a class with a visibility.
    #[must_use]
    pub(crate) fn draws(&self, class: LineClass, visibility: Visibility) -> bool {
        self.visibility == visibility && self.classes.contains(&class)
    }
}

/// The classes in a text, separated by commas or spaces; the error is the first unknown word.
fn parse_classes(text: &str) -> Result<Vec<LineClass>, &str> {
    if text.trim() == ALL_CLASSES {
        return Ok(LineClass::ALL.to_vec());
    }
    let words = text.split([',', ' ']).filter(|word| !word.is_empty());
    let class_of = |word| {
        let found = LineClass::ALL.into_iter().find(|class| class.name() == word);
        found.ok_or(word)
    };
    words.map(class_of).collect()
}

/// The text of classes, as the variable `classes` takes it.
#[must_use]
pub(crate) fn classes_text(classes: &[LineClass]) -> String {
    if classes.len() == LineClass::ALL.len() {
        return ALL_CLASSES.to_owned();
    }
    let names: Vec<&str> = classes.iter().map(|class| class.name()).collect();
    names.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_are_read_as_they_are_written() {
        assert_eq!(parse_classes("ridge, edge"), Err("edge"));
        for classes in [&LineClass::ALL[..], &[LineClass::Ridge, LineClass::Valley], &[]] {
            assert_eq!(parse_classes(&classes_text(classes)).as_deref(), Ok(classes));
        }
    }
}
