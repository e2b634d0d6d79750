//! The types and values of component variables (NPRView thesis, section 2.2.2).
//!
//! Values come from TOML, which has types, and as text from command lines; both lead to
//! the same checks.

use std::fmt;

use super::texture_name::TextureName;

/// The type of a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VariableType {
    /// True or false; in files also 1 or 0.
    Bool,
    /// An integer of 32 bits.
    Int,
    /// A floating-point number of 32 bits.
    Number,
    /// A string: a word, or the name of a program or render target.
    String,
    /// Two numbers.
    Vector2,
    /// Three numbers.
    Vector3,
    /// Four numbers.
    Vector4,
    /// A color: red, green, blue, 0 to 1.
    Rgb,
    /// A color and alpha, not premultiplied, 0 to 1.
    Rgba,
    /// An image or a generated texture.
    Texture,
}

/// A value of a variable.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// Of [`VariableType::Bool`].
    Bool(bool),
    /// Of [`VariableType::Int`].
    Int(i32),
    /// Of numbers, vectors and colors: 1 to 4 numbers.
    Numbers(Vec<f32>),
    /// Of [`VariableType::String`].
    String(String),
    /// Of [`VariableType::Texture`].
    Texture(TextureName),
}

impl VariableType {
    /// All types.
    pub(crate) const ALL: [Self; 10] = [
        Self::Bool,
        Self::Int,
        Self::Number,
        Self::String,
        Self::Vector2,
        Self::Vector3,
        Self::Vector4,
        Self::Rgb,
        Self::Rgba,
        Self::Texture,
    ];

    /// The name of the type in files.
    #[must_use]
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Bool => "bool",
            Self::Int => "int",
            Self::Number => "number",
            Self::String => "string",
            Self::Vector2 => "vector2",
            Self::Vector3 => "vector3",
            Self::Vector4 => "vector4",
            Self::Rgb => "rgb",
            Self::Rgba => "rgba",
            Self::Texture => "texture",
        }
    }

    /// The count of its floating-point numbers, 1 to 4; 0 for types of other values.
    #[must_use]
    pub(crate) const fn number_count(self) -> usize {
        match self {
            Self::Number => 1,
            Self::Vector2 => 2,
            Self::Vector3 | Self::Rgb => 3,
            Self::Vector4 | Self::Rgba => 4,
            _ => 0,
        }
    }

    /// Whether it is a color.
    #[must_use]
    pub(crate) const fn is_color(self) -> bool {
        matches!(self, Self::Rgb | Self::Rgba)
    }

    /// Whether it can have a minimum and a maximum: all but bool, string and texture.
    #[must_use]
    pub(crate) const fn has_extremes(self) -> bool {
        matches!(self, Self::Int) || self.number_count() > 0
    }

    /// A value in a file, for messages.
    #[must_use]
    pub(crate) const fn expected(self) -> &'static str {
        match self {
            Self::Bool => "true or false",
            Self::Int => "an integer",
            Self::Number => "a number",
            Self::String => "a string in quotes",
            Self::Vector2 => "two numbers, such as [1, 2]",
            Self::Vector3 => "three numbers, such as [1, 2, 3]",
            Self::Vector4 => "four numbers, such as [1, 2, 3, 4]",
            Self::Rgb => "a color, such as \"#204060\" or [0.1, 0.2, 0.4]",
            Self::Rgba => "a color, such as \"#204060\", \"#20406080\" or [0.1, 0.2, 0.4, 0.5]",
            Self::Texture => "a texture, such as \"papers:rough\" or \"<generated>:scene_color\"",
        }
    }

    /// Makes a value of one number per component, or of one number for all components of
    /// a vector; the alpha of a color can be omitted. Returns none for any other count and
    /// for numbers that are not finite.
    #[must_use]
    pub(crate) fn of_numbers(self, numbers: &[f64]) -> Option<Value> {
        let count = self.number_count();
        #[expect(clippy::cast_possible_truncation, reason = "variables have 32 bits")]
        let mut given: Vec<f32> = numbers.iter().map(|&number| number as f32).collect();
        if self == Self::Rgba && given.len() == 3 {
            given.push(1.0);
        }
        if given.len() == 1 && !self.is_color() {
            given.resize(count, given[0]);
        }
        let is_sound = count > 0 && given.len() == count && given.iter().all(|n| n.is_finite());
        is_sound.then_some(Value::Numbers(given))
    }

    /// Reads a value from text, as on a command line.
    ///
    /// # Errors
    /// The expected form, if the text does not have it.
    pub(crate) fn parse(self, text: &str) -> Result<Value, String> {
        let text = text.trim();
        let wrong = || format!("expected {}", self.expected_text());
        Ok(match self {
            Self::Bool => match text {
                "true" | "1" => Value::Bool(true),
                "false" | "0" => Value::Bool(false),
                _ => return Err(wrong()),
            },
            Self::Int => Value::Int(text.parse().map_err(|_| wrong())?),
            Self::String => Value::String(text.to_owned()),
            Self::Texture => Value::Texture(TextureName::parse(text)?),
            _ if text.starts_with('#') => {
                let color = parse_color(text, self).ok_or_else(wrong)?;
                Value::Numbers(color)
            }
            _ => {
                let numbers: Option<Vec<f64>> =
                    text.split(',').map(|number| number.trim().parse().ok()).collect();
                numbers.and_then(|numbers| self.of_numbers(&numbers)).ok_or_else(wrong)?
            }
        })
    }

    /// A value on a command line, for messages.
    #[must_use]
    const fn expected_text(self) -> &'static str {
        match self {
            Self::String => "a string",
            Self::Vector2 => "two numbers, such as 1,2",
            Self::Vector3 => "three numbers, such as 1,2,3",
            Self::Vector4 => "four numbers, such as 1,2,3,4",
            Self::Rgb => "a color, such as #204060 or 0.1,0.2,0.4",
            Self::Rgba => "a color, such as #204060, #20406080 or 0.1,0.2,0.4,0.5",
            Self::Texture => "a texture, such as papers:rough or <generated>:scene_color",
            _ => self.expected(),
        }
    }
}

/// Reads `#rrggbb`, or `#rrggbbaa` for [`VariableType::Rgba`], as numbers from 0 to 1.
#[must_use]
pub(crate) fn parse_color(text: &str, of: VariableType) -> Option<Vec<f32>> {
    let digits = text.strip_prefix('#')?;
    let fits = match of {
        VariableType::Rgb => digits.len() == 6,
        VariableType::Rgba => matches!(digits.len(), 6 | 8),
        _ => false,
    };
    if !fits || !digits.bytes().all(|byte| byte.is_ascii_hexdigit()) {
        return None;
    }
    let channel = |at: usize| {
        let byte = digits.get(at..at + 2).and_then(|pair| u8::from_str_radix(pair, 16).ok());
        byte.map_or(1.0, |byte| f32::from(byte) / 255.0)
    };
    Some((0..of.number_count()).map(|channel_at| channel(2 * channel_at)).collect())
}

/// A color as `#rrggbb` or `#rrggbbaa`; none if [`parse_color`] would not read exactly the
/// same numbers again.
#[must_use]
pub(crate) fn color_text(numbers: &[f32]) -> Option<String> {
    let of = match numbers.len() {
        3 => VariableType::Rgb,
        4 => VariableType::Rgba,
        _ => return None,
    };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
    let byte = |number: &f32| (number * 255.0).round().clamp(0.0, 255.0) as u8;
    let is_opaque = numbers.get(3).is_none_or(|alpha| byte(alpha) == 255);
    let shown = if is_opaque { &numbers[..3] } else { numbers };
    let digits: String = shown.iter().map(|number| format!("{:02x}", byte(number))).collect();
    let text = format!("#{digits}");
    (parse_color(&text, of).as_deref() == Some(numbers)).then_some(text)
}

impl Value {
    /// The value between two limits of its type, per component.
    #[must_use]
    pub(crate) fn clamped(&self, minimum: Option<&Self>, maximum: Option<&Self>) -> Self {
        match self {
            Self::Int(value) => {
                let mut value = *value;
                if let Some(Self::Int(least)) = minimum {
                    value = value.max(*least);
                }
                if let Some(Self::Int(most)) = maximum {
                    value = value.min(*most);
                }
                Self::Int(value)
            }
            Self::Numbers(numbers) => {
                let mut numbers = numbers.clone();
                if let Some(Self::Numbers(least)) = minimum {
                    numbers.iter_mut().zip(least).for_each(|(n, least)| *n = n.max(*least));
                }
                if let Some(Self::Numbers(most)) = maximum {
                    numbers.iter_mut().zip(most).for_each(|(n, most)| *n = n.min(*most));
                }
                Self::Numbers(numbers)
            }
            _ => self.clone(),
        }
    }
}

/// As in files.
impl fmt::Display for Value {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Bool(value) => write!(formatter, "{value}"),
            Self::Int(value) => write!(formatter, "{value}"),
            Self::Numbers(numbers) if numbers.len() == 1 => write!(formatter, "{}", numbers[0]),
            Self::Numbers(numbers) => {
                let numbers: Vec<String> = numbers.iter().map(ToString::to_string).collect();
                write!(formatter, "[{}]", numbers.join(", "))
            }
            Self::String(text) => write!(formatter, "{text:?}"),
            Self::Texture(name) => write!(formatter, "\"{name}\""),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_of_every_type_are_read() {
        let read = |of: VariableType, text: &str| of.parse(text).unwrap();
        assert_eq!(read(VariableType::Bool, "1"), Value::Bool(true));
        assert_eq!(read(VariableType::Int, "-3"), Value::Int(-3));
        assert_eq!(read(VariableType::Number, "0.25"), Value::Numbers(vec![0.25]));
        assert_eq!(read(VariableType::Vector2, "10, 20"), Value::Numbers(vec![10.0, 20.0]));
        assert_eq!(read(VariableType::Vector2, "30"), Value::Numbers(vec![30.0, 30.0]));
        assert_eq!(read(VariableType::Rgb, "#ff0000"), Value::Numbers(vec![1.0, 0.0, 0.0]));
        assert_eq!(read(VariableType::Rgba, "0,1,0"), Value::Numbers(vec![0.0, 1.0, 0.0, 1.0]));
        let half = read(VariableType::Rgba, "#00ff0080");
        assert_eq!(half, Value::Numbers(vec![0.0, 1.0, 0.0, 128.0 / 255.0]));
        for (of, text) in [
            (VariableType::Bool, "yes"),
            (VariableType::Int, "1.5"),
            (VariableType::Number, "nan"),
            (VariableType::Number, "1,2"),
            (VariableType::Vector3, "1,2"),
            (VariableType::Rgb, "#ff000080"),
            (VariableType::Rgb, "0.5"),
            (VariableType::Number, "#ff0000"),
            (VariableType::Texture, "a:b:c:d"),
        ] {
            assert!(of.parse(text).is_err(), "{text} as {}", of.name());
        }
    }

    #[test]
    fn extremes_hold_component_by_component() {
        let value = Value::Numbers(vec![-1.0, 0.5, 9.0]);
        let (least, most) = (Value::Numbers(vec![0.0; 3]), Value::Numbers(vec![1.0, 1.0, 2.0]));
        let clamped = value.clamped(Some(&least), Some(&most));
        assert_eq!(clamped, Value::Numbers(vec![0.0, 0.5, 2.0]));
        assert_eq!(Value::Int(7).clamped(None, Some(&Value::Int(3))), Value::Int(3));
        assert_eq!(value.clamped(None, None), value);
    }

    #[test]
    fn values_are_written_as_files_have_them() {
        for (value, text) in [
            (Value::Bool(true), "true"),
            (Value::Numbers(vec![0.5]), "0.5"),
            (Value::Numbers(vec![1.0, 2.5]), "[1, 2.5]"),
            (Value::String("a \"b\"".into()), r#""a \"b\"""#),
        ] {
            assert_eq!(value.to_string(), text);
        }
    }
}
