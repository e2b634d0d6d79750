//! What a picture looks like: a technique by name, with variables that can be
//! set.
//!
//! This is the small beginning of techniques, two of them and in code; text
//! files that describe passes of components are to replace it, so nothing else
//! in the crate knows more of a technique than its [`Look`].

use edgemesh::command::{ExitStatus, Failure};
use strokes::brush::Brush;
use strokes::renderer::Look;
use strokes::stroke::StrokeStyle;

/// The techniques, by name, with what each shows.
pub const TECHNIQUES: [(&str, &str); 2] = [
    ("ink", "plain solid strokes over a flat white fill"),
    ("pen", "the strokes of a pen, textured along each edge"),
];

/// The variables of every technique.
pub const VARIABLES: [(&str, &str); 4] = [
    ("background.color", "the paper, #rrggbb or #rrggbbaa"),
    ("fill.color", "the surface, #rrggbb"),
    ("strokes.color", "the ink, #rrggbb or #rrggbbaa"),
    ("strokes.width", "width in pixels, 0.1 to 100"),
];

/// The widest stroke: the guard band around the picture hides the cut ends of
/// strokes up to this width on pictures of 67 pixels and more.
const MAX_WIDTH_PX: f32 = 100.0;

/// A technique with its variables.
#[derive(Debug, Clone)]
pub struct Technique {
    background: [f32; 4],
    fill_color: [f32; 4],
    stroke_color: [f32; 4],
    stroke_width_px: f32,
    brush: Option<Brush>,
}

impl Technique {
    /// The technique called `name`.
    ///
    /// # Errors
    /// Exit status 4, with the names there are.
    pub fn by_name(name: &str) -> Result<Self, Failure> {
        let brush = match name {
            "ink" => None,
            "pen" => Some(Brush::pen().map_err(|error| Failure::fault(error.to_string()))?),
            _ => {
                let names: Vec<&str> = TECHNIQUES.iter().map(|(name, _)| *name).collect();
                let message = format!(
                    "there is no technique '{name}'; there are: {} (technique files are not read yet)",
                    names.join(", ")
                );
                return Err(Failure { message, status: ExitStatus::Shader });
            }
        };
        Ok(Self {
            background: [1.0; 4],
            fill_color: [1.0; 4],
            stroke_color: [0.0, 0.0, 0.0, 1.0],
            // A pen's ragged rim takes ink away; a little more width gives it back.
            stroke_width_px: if brush.is_some() { 3.0 } else { 2.0 },
            brush,
        })
    }

    /// Sets a variable from `PASS.VARIABLE=VALUE`.
    ///
    /// # Errors
    /// Exit status 2, with the variables there are or the values allowed.
    pub fn set(&mut self, assignment: &str) -> Result<(), Failure> {
        let Some((variable, value)) = assignment.split_once('=') else {
            let message = format!("--set {assignment}: needs the form PASS.VARIABLE=VALUE");
            return Err(Failure::usage(message));
        };
        let wrong = |what: &str| Failure::usage(format!("--set {assignment}: {what}"));
        match variable.trim() {
            "background.color" => self.background = parse_color(value).map_err(wrong)?,
            "fill.color" => self.fill_color = parse_color(value).map_err(wrong)?,
            "strokes.color" => self.stroke_color = parse_color(value).map_err(wrong)?,
            "strokes.width" => {
                self.stroke_width_px = value
                    .trim()
                    .parse()
                    .ok()
                    .filter(|width| (0.1..=MAX_WIDTH_PX).contains(width))
                    .ok_or_else(|| wrong("needs a number of pixels from 0.1 to 100"))?;
            }
            _ => {
                let names: Vec<&str> = VARIABLES.iter().map(|(name, _)| *name).collect();
                let what = format!("there is no such variable; there are: {}", names.join(", "));
                return Err(wrong(&what));
            }
        }
        Ok(())
    }

    /// Leaves the paper out, so that the picture is transparent behind the model.
    pub const fn make_transparent(&mut self) {
        self.background = [0.0; 4];
    }

    /// What the renderer draws.
    #[must_use]
    pub fn look(&self) -> Look {
        Look {
            background: premultiplied(self.background).map(f64::from),
            fill_color: premultiplied(self.fill_color),
            strokes: Some(StrokeStyle {
                color: premultiplied(self.stroke_color),
                width_px: self.stroke_width_px,
                brush: self.brush.clone(),
            }),
        }
    }
}

fn premultiplied([r, g, b, a]: [f32; 4]) -> [f32; 4] {
    [r * a, g * a, b * a, a]
}

/// Reads `#rrggbb` or `#rrggbbaa` as sRGB values from 0 to 1.
fn parse_color(text: &str) -> Result<[f32; 4], &'static str> {
    const WHAT: &str = "needs a colour as #rrggbb or #rrggbbaa";
    let digits = text.trim().strip_prefix('#').ok_or(WHAT)?;
    if !matches!(digits.len(), 6 | 8) || !digits.bytes().all(|byte| byte.is_ascii_hexdigit()) {
        return Err(WHAT);
    }
    let channel = |at: usize| {
        let byte = digits.get(at..at + 2).and_then(|pair| u8::from_str_radix(pair, 16).ok());
        byte.map_or(1.0, |byte| f32::from(byte) / 255.0)
    };
    Ok([channel(0), channel(2), channel(4), channel(6)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_listed_technique_and_variable_is_there() {
        for (name, _) in TECHNIQUES {
            let mut technique = Technique::by_name(name).unwrap();
            for (variable, _) in VARIABLES {
                let value = if variable.ends_with("color") { "#10203040" } else { "5" };
                technique.set(&format!("{variable}={value}")).unwrap();
            }
        }
        let failure = Technique::by_name("oil").unwrap_err();
        assert_eq!(failure.status, ExitStatus::Shader);
        assert!(failure.message.contains("ink, pen"));
    }

    #[test]
    fn wrong_assignments_say_what_is_right() {
        let mut technique = Technique::by_name("ink").unwrap();
        for (assignment, word) in [
            ("strokes.width", "PASS.VARIABLE=VALUE"),
            ("strokes.width=wide", "number of pixels"),
            ("strokes.width=nan", "number of pixels"),
            ("strokes.widht=2", "strokes.width"),
            ("fill.color=white", "#rrggbb"),
            ("fill.color=#ffé0", "#rrggbb"),
        ] {
            let message = technique.set(assignment).unwrap_err().message;
            assert!(message.contains(word), "{assignment}: {message}");
        }
    }

    #[test]
    fn colors_are_read_as_written() {
        assert_eq!(parse_color("#ff0000"), Ok([1.0, 0.0, 0.0, 1.0]));
        assert_eq!(parse_color("#00000000"), Ok([0.0; 4]));
    }
}
