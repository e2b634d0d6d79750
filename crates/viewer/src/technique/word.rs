//! Words of string variables as values of Rust types.

/// A type whose values are the words of a variable with `one_of`.
pub(crate) trait Word: Copy + PartialEq + 'static {
    /// Each word with its value, in the order of the descriptor.
    const WORDS: &'static [(&'static str, Self)];

    /// The value of a word.
    #[must_use]
    fn of_word(word: &str) -> Option<Self> {
        Self::WORDS.iter().find(|(known, _)| *known == word).map(|(_, value)| *value)
    }

    /// The word of the value.
    #[must_use]
    fn word(self) -> &'static str {
        Self::WORDS.iter().find(|(_, value)| *value == self).map_or("", |(word, _)| word)
    }
}
