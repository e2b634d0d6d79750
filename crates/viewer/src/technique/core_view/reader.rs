//! Reads the variables of a pass by name and type.

use crate::technique::mistake::{Mistake, Mistakes, Place};
use crate::technique::pass::Pass;
use crate::technique::texture_name::TextureName;
use crate::technique::value::{Value, VariableType};
use crate::technique::word::Word;

/// Reads the variables of a pass. A value that cannot be read adds a mistake and becomes a
/// placeholder, so that one reading finds all mistakes.
pub(crate) struct Reader<'a> {
    pass: &'a Pass,
    mistakes: &'a mut Mistakes,
    /// Every variable that was read.
    #[cfg(test)]
    pub(super) log: Vec<LogEntry>,
}

/// A variable that was read.
#[cfg(test)]
#[derive(Debug, PartialEq, Eq)]
pub(super) struct LogEntry {
    pub(super) name: &'static str,
    pub(super) kind: VariableType,
    /// The words of its type, if it is read as a word.
    pub(super) words: Vec<&'static str>,
}

impl<'a> Reader<'a> {
    pub(super) const fn new(pass: &'a Pass, mistakes: &'a mut Mistakes) -> Self {
        Self {
            pass,
            mistakes,
            #[cfg(test)]
            log: Vec::new(),
        }
    }

    /// The value of a variable; a mistake if the component has no such variable.
    fn value(&mut self, name: &'static str, kind: VariableType) -> Option<&'a Value> {
        #[cfg(test)]
        self.log.push(LogEntry { name, kind, words: Vec::new() });
        let pass = self.pass;
        let found = pass.component.variable(name).filter(|(_, variable)| variable.kind == kind);
        if found.is_none() {
            let component = &pass.component.name;
            let message = format!("{component} has no variable '{name}' of type {}", kind.name());
            self.mistakes.add(Mistake::error(&pass.place, message));
        }
        found.map(|(index, _)| &pass.values()[index])
    }

    /// The place where a variable was set, or else the pass.
    pub(super) fn place(&self, name: &'static str) -> &'a Place {
        self.pass.place_of(name)
    }

    pub(super) fn add(&mut self, mistake: Mistake) {
        self.mistakes.add(mistake);
    }

    pub(super) fn bool(&mut self, name: &'static str) -> bool {
        matches!(self.value(name, VariableType::Bool), Some(Value::Bool(true)))
    }

    pub(super) fn int(&mut self, name: &'static str) -> i32 {
        match self.value(name, VariableType::Int) {
            Some(Value::Int(value)) => *value,
            _ => 0,
        }
    }

    /// An integer in the range of `T`; a mistake outside of it.
    pub(super) fn integer<T: TryFrom<i32> + Default>(&mut self, name: &'static str) -> T {
        let value = self.int(name);
        T::try_from(value).unwrap_or_else(|_| {
            let message = format!("{name} = {value} is out of range");
            self.add(Mistake::error(self.place(name), message));
            T::default()
        })
    }

    fn numbers<const N: usize>(&mut self, name: &'static str, kind: VariableType) -> [f32; N] {
        let mut numbers = [0.0; N];
        if let Some(Value::Numbers(values)) = self.value(name, kind) {
            numbers.iter_mut().zip(values).for_each(|(number, value)| *number = *value);
        }
        numbers
    }

    pub(super) fn number(&mut self, name: &'static str) -> f32 {
        let [number] = self.numbers(name, VariableType::Number);
        number
    }

    pub(super) fn vector2(&mut self, name: &'static str) -> [f32; 2] {
        self.numbers(name, VariableType::Vector2)
    }

    pub(super) fn rgba(&mut self, name: &'static str) -> [f32; 4] {
        self.numbers(name, VariableType::Rgba)
    }

    pub(super) fn string(&mut self, name: &'static str) -> &'a str {
        match self.value(name, VariableType::String) {
            Some(Value::String(text)) => text,
            _ => "",
        }
    }

    /// A string, or none if it is empty.
    pub(super) fn optional_string(&mut self, name: &'static str) -> Option<String> {
        Some(self.string(name)).filter(|text| !text.is_empty()).map(str::to_owned)
    }

    /// The value of a word; a mistake if `W` does not have the word.
    pub(super) fn word<W: Word>(&mut self, name: &'static str) -> W {
        let word = self.string(name);
        #[cfg(test)]
        if let Some(entry) = self.log.last_mut() {
            entry.words = W::WORDS.iter().map(|(_, value)| value.word()).collect();
        }
        W::of_word(word).unwrap_or_else(|| {
            let mistake =
                Mistake::error(self.place(name), format!("'{word}' is not a value of '{name}'"));
            self.add(mistake.names(word, W::WORDS.iter().map(|(word, _)| *word)));
            W::WORDS[0].1
        })
    }

    pub(super) fn texture(&mut self, name: &'static str) -> TextureName {
        match self.value(name, VariableType::Texture) {
            Some(Value::Texture(texture)) => texture.clone(),
            _ => TextureName::NONE,
        }
    }
}
