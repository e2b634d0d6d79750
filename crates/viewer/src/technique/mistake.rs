//! Mistakes in text files, underlined in the text, with hints.
//!
//! Checks continue after a mistake, so that one run finds all of them. Mistakes in TOML and
//! WGSL are printed in the same form.

use std::fmt;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use codespan_reporting::diagnostic::{Diagnostic, Label};
use codespan_reporting::files::SimpleFiles;
use codespan_reporting::term;

/// A text with a name for messages.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct SourceText {
    /// The path of the file, or of a built-in one in the repository.
    pub(crate) name: String,
    /// The whole text.
    pub(crate) text: String,
}

impl SourceText {
    /// A text with a name.
    #[must_use]
    pub(crate) fn new(name: impl Into<String>, text: impl Into<String>) -> Arc<Self> {
        Arc::new(Self { name: name.into(), text: text.into() })
    }

    /// Reads a file.
    ///
    /// # Errors
    /// If the file cannot be read, or is not UTF-8.
    pub(crate) fn read(path: &Path) -> Result<Arc<Self>, Mistake> {
        let name = path.display().to_string();
        let failed = |error: &dyn fmt::Display| {
            Mistake::without_place(format!("{name}: cannot be read: {error}"))
        };
        let bytes = std::fs::read(path).map_err(|error| failed(&error))?;
        let text = String::from_utf8(bytes).map_err(|_| failed(&"it is not UTF-8 text"))?;
        Ok(Self::new(name, text))
    }

    /// The byte range of `length` bytes from a line and a column in bytes, both counted
    /// from 1; cut off at the end of the text.
    #[must_use]
    pub(crate) fn span(&self, line: usize, column: usize, length: usize) -> Range<usize> {
        let line_start = match line {
            0 | 1 => 0,
            _ => self.text.match_indices('\n').nth(line - 2).map_or(self.text.len(), |at| at.0 + 1),
        };
        let start = (line_start + column.saturating_sub(1)).min(self.text.len());
        start..(start + length).min(self.text.len())
    }
}

/// A range of a text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Place {
    /// The text.
    pub(crate) source: Arc<SourceText>,
    /// The byte range.
    pub(crate) span: Range<usize>,
}

/// Whether a technique with a mistake can be drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Severity {
    /// It cannot.
    Error,
    /// It can, with a value other than the given one.
    Warning,
}

/// A mistake in a text file or in an assignment.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Mistake {
    /// An error or a warning.
    pub(crate) severity: Severity,
    /// The mistake in one line.
    pub(crate) message: String,
    /// Places with a text for each, which can be empty; the first is that of the mistake.
    pub(crate) labels: Vec<(Place, String)>,
    /// Hints, one line each.
    pub(crate) notes: Vec<String>,
}

impl Mistake {
    /// An error at a place.
    #[must_use]
    pub(crate) fn error(place: &Place, message: impl Into<String>) -> Self {
        Self::new(Severity::Error, Some(place), message)
    }

    /// An error outside of any text.
    #[must_use]
    pub(crate) fn without_place(message: impl Into<String>) -> Self {
        Self::new(Severity::Error, None, message)
    }

    /// A warning.
    #[must_use]
    pub(crate) fn warning(place: Option<&Place>, message: impl Into<String>) -> Self {
        Self::new(Severity::Warning, place, message)
    }

    /// A warning about a value of a variable that is replaced by another one.
    #[must_use]
    pub(crate) fn out_of_range(
        place: Option<&Place>,
        variable: &str,
        value: &impl fmt::Display,
        used: &impl fmt::Display,
    ) -> Self {
        Self::warning(place, format!("{variable} = {value} is out of range; {used} is used"))
    }

    fn new(severity: Severity, place: Option<&Place>, message: impl Into<String>) -> Self {
        let labels = place.map(|place| (place.clone(), String::new())).into_iter().collect();
        Self { severity, message: message.into(), labels, notes: Vec::new() }
    }

    /// Sets the text at the place of the mistake.
    #[must_use]
    pub(crate) fn label(mut self, text: impl Into<String>) -> Self {
        if let Some(first) = self.labels.first_mut() {
            first.1 = text.into();
        }
        self
    }

    /// Adds another place with a text.
    #[must_use]
    pub(crate) fn also(mut self, place: &Place, text: impl Into<String>) -> Self {
        self.labels.push((place.clone(), text.into()));
        self
    }

    /// Adds a hint.
    #[must_use]
    pub(crate) fn note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }

    /// Adds a hint with the names that are possible, and suggests the one that is nearest
    /// to `given`, if any is near.
    #[must_use]
    pub(crate) fn names<'a>(self, given: &str, names: impl IntoIterator<Item = &'a str>) -> Self {
        let names: Vec<&str> = names.into_iter().collect();
        let list = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
        let suggesting = match closest(given, &names) {
            Some(name) => self.label(format!("did you mean '{name}'?")),
            None => self,
        };
        suggesting.note(format!("available: {list}"))
    }
}

/// All mistakes of a check, in the order in which they were found; each once.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Mistakes {
    /// The mistakes.
    pub(crate) list: Vec<Mistake>,
}

impl Mistakes {
    /// One mistake.
    #[must_use]
    pub(crate) fn of(mistake: Mistake) -> Self {
        Self { list: vec![mistake] }
    }

    /// Adds a mistake, unless the same one is there.
    pub(crate) fn add(&mut self, mistake: Mistake) {
        if !self.list.contains(&mistake) {
            self.list.push(mistake);
        }
    }

    /// Adds the mistakes of another check.
    pub(crate) fn append(&mut self, others: Self) {
        for mistake in others.list {
            self.add(mistake);
        }
    }

    /// Whether any of them is an error.
    #[must_use]
    pub(crate) fn has_errors(&self) -> bool {
        self.list.iter().any(|mistake| mistake.severity == Severity::Error)
    }

    /// Removes and returns the warnings.
    pub(crate) fn take_warnings(&mut self) -> Self {
        let (warnings, errors) = std::mem::take(&mut self.list)
            .into_iter()
            .partition(|mistake| mistake.severity == Severity::Warning);
        self.list = errors;
        Self { list: warnings }
    }

    /// The text of all mistakes, without the word `error:` before the first one and without
    /// the last line break.
    #[must_use]
    pub(crate) fn text(&self) -> String {
        let text = self.to_string();
        text.strip_prefix("error: ").unwrap_or(&text).trim_end().to_owned()
    }

    /// Returns `value` and the warnings.
    ///
    /// # Errors
    /// All mistakes, if any of them is an error.
    pub(crate) fn or<T>(self, value: T) -> Result<(T, Self), Self> {
        if self.has_errors() { Err(self) } else { Ok((value, self)) }
    }
}

impl fmt::Display for Mistakes {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (at, mistake) in self.list.iter().enumerate() {
            if at > 0 {
                formatter.write_str("\n")?;
            }
            formatter.write_str(&report(mistake))?;
        }
        Ok(())
    }
}

/// A mistake with its lines of text underlined; ends in a line break.
fn report(mistake: &Mistake) -> String {
    let mut files = SimpleFiles::new();
    let mut known: Vec<(&Arc<SourceText>, usize)> = Vec::new();
    let mut labels = Vec::new();
    for (at, (place, text)) in mistake.labels.iter().enumerate() {
        let found = known.iter().find(|(source, _)| Arc::ptr_eq(source, &place.source));
        let file = found.map_or_else(
            || files.add(place.source.name.as_str(), place.source.text.as_str()),
            |known| known.1,
        );
        known.push((&place.source, file));
        let label = match at {
            0 => Label::primary(file, place.span.clone()),
            _ => Label::secondary(file, place.span.clone()),
        };
        labels.push(label.with_message(text));
    }
    let diagnostic = match mistake.severity {
        Severity::Error => Diagnostic::error(),
        Severity::Warning => Diagnostic::warning(),
    };
    let diagnostic = diagnostic
        .with_message(&mistake.message)
        .with_labels(labels)
        .with_notes(mistake.notes.clone());
    let config = term::Config { chars: term::Chars::ascii(), ..term::Config::default() };
    // The files are those of the labels, so this does not fail.
    term::emit_into_string(&config, &files, &diagnostic)
        .unwrap_or_else(|_| format!("{}\n", mistake.message))
        .trim_end()
        .to_owned()
        + "\n"
}

/// The name with the smallest edit distance to `given`: at most a third of its letters, and
/// none for names of one or two letters.
#[must_use]
pub(crate) fn closest<'a>(given: &str, names: &[&'a str]) -> Option<&'a str> {
    let largest = match given.chars().count() {
        0..3 => 0,
        length => (length / 3).max(1),
    };
    let near = names.iter().map(|name| (edit_distance(given, name), *name));
    near.filter(|(distance, _)| *distance <= largest).min_by_key(|near| near.0).map(|near| near.1)
}

/// The number of letters to insert, delete, replace or swap with the next one to turn one
/// name into the other (optimal string alignment).
fn edit_distance(from: &str, to: &str) -> usize {
    let from: Vec<char> = from.chars().collect();
    let to: Vec<char> = to.chars().collect();
    // The last two complete rows of the table; `row` is the current one.
    let mut earlier = vec![0; to.len() + 1];
    let mut last: Vec<usize> = (0..=to.len()).collect();
    for (at, letter) in from.iter().enumerate() {
        let mut row = vec![at + 1];
        for (column, other) in to.iter().enumerate() {
            let changed = last[column] + usize::from(letter != other);
            let mut least = changed.min(last[column + 1] + 1).min(row[column] + 1);
            let is_swapped =
                at > 0 && column > 0 && *letter == to[column - 1] && from[at - 1] == *other;
            if is_swapped {
                least = least.min(earlier[column - 1] + 1);
            }
            row.push(least);
        }
        earlier = std::mem::replace(&mut last, row);
    }
    last[to.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_names_are_found_and_far_ones_not() {
        let names = ["threshold", "texture", "render"];
        assert_eq!(closest("treshold", &names), Some("threshold"));
        assert_eq!(closest("tex", &names), None);
        assert_eq!(closest("rednre", &names), Some("render"), "two letters swapped, twice");
        assert_eq!(closest("textur", &names), Some("texture"));
    }

    #[test]
    fn a_mistake_is_underlined_in_its_line() {
        let source = SourceText::new("a.toml", "[[pass]]\ncomponent = \"phong\"\n");
        let place = Place { source: source.clone(), span: 21..28 };
        let mistake = Mistake::error(&place, "unknown component 'phong'")
            .names("phong", ["render_phong", "phon"]);
        let text = Mistakes::of(mistake).to_string();
        assert_eq!(
            text,
            "error: unknown component 'phong'\n  --> a.toml:2:13\n  |\n2 | component = \
             \"phong\"\n  |             ^^^^^^^ did you mean 'phon'?\n  |\n  = available: \
             render_phong, phon\n"
        );
        assert_eq!(source.span(2, 13, 7), 21..28);
        assert_eq!(source.span(9, 3, 7), 29..29);
    }

    #[test]
    fn warnings_come_out_and_errors_stay() {
        let mut mistakes = Mistakes::of(Mistake::warning(None, "clamped"));
        assert!(!mistakes.has_errors());
        mistakes.add(Mistake::without_place("wrong"));
        mistakes.add(Mistake::without_place("wrong"));
        assert_eq!(mistakes.take_warnings().list.len(), 1);
        assert_eq!(mistakes.list.len(), 1, "the same mistake is listed once");
        assert!(mistakes.or(3).is_err());
    }
}
