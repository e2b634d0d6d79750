//! The variable `blend`.

use crate::technique::word::Word;

/// How a pass combines its colors, with premultiplied alpha, with those of its target.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Blend {
    /// Replaces the target.
    Replace,
    /// Over the target, by alpha.
    Over,
    /// Source times target.
    Multiply,
    /// Source plus target.
    Add,
    /// The complement of the product of the complements.
    Screen,
    /// The smaller value of each channel.
    Darken,
    /// The larger value of each channel.
    Lighten,
}

impl Blend {
    /// The name of the variable.
    pub(crate) const VARIABLE: &str = "blend";
}

impl Word for Blend {
    const WORDS: &'static [(&'static str, Self)] = &[
        ("replace", Self::Replace),
        ("over", Self::Over),
        ("multiply", Self::Multiply),
        ("add", Self::Add),
        ("screen", Self::Screen),
        ("darken", Self::Darken),
        ("lighten", Self::Lighten),
    ];
}
