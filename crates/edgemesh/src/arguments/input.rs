//! Arguments for reading and building inputs, for both commands.

use std::path::PathBuf;
use std::sync::LazyLock;

use clap::builder::PossibleValue;
use clap::{Args, ValueEnum};

use super::degrees::parse_degrees;
use crate::build::Welding;
use crate::format::read::Format;
use crate::load::{InputFormat, LoadOptions};

/// Arguments for reading and building an input.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Input")]
pub struct InputArguments {
    /// Format of the input; required for standard input (-) [default: detected from the
    /// first bytes]
    #[arg(long, value_name = "FORMAT")]
    pub format: Option<InputFormat>,
    /// Weld vertices at most this far apart, in units of the model [default: 0, only
    /// vertices at the same position]
    #[arg(long, value_name = "TOLERANCE", value_parser = parse_tolerance, allow_hyphen_values = true)]
    pub weld: Option<f64>,
    /// Do not weld vertices
    #[arg(long, conflicts_with = "weld")]
    pub no_weld: bool,
    /// File of marked edges: a pair of vertices on each line, counted from 1 [default:
    /// MODEL.marks, if it exists in the folder of the model]
    #[arg(long, value_name = "FILE")]
    pub marks: Option<PathBuf>,
    /// Treat warnings as errors
    #[arg(long)]
    pub strict: bool,
    /// Crease thresholds
    #[command(flatten)]
    pub creases: CreaseArguments,
}

/// The angles above which edges are creases.
#[derive(Debug, Clone, Copy, Default, Args)]
#[command(next_help_heading = "Creases")]
pub struct CreaseArguments {
    /// Angle between faces above which an edge is a crease, in degrees [default: 30]
    #[arg(long, value_name = "DEG", value_parser = parse_crease, allow_hyphen_values = true, conflicts_with_all = ["ridge", "valley"])]
    pub crease: Option<f64>,
    /// As --crease, for convex edges only
    #[arg(long, value_name = "DEG", value_parser = parse_crease, allow_hyphen_values = true)]
    pub ridge: Option<f64>,
    /// As --crease, for concave edges only
    #[arg(long, value_name = "DEG", value_parser = parse_crease, allow_hyphen_values = true)]
    pub valley: Option<f64>,
}

impl InputArguments {
    /// These arguments as options of the library.
    #[must_use]
    pub fn load_options(&self) -> LoadOptions {
        let CreaseArguments { crease, ridge, valley } = self.creases;
        LoadOptions {
            format: self.format,
            welding: match (self.weld, self.no_weld) {
                (Some(tolerance), _) => Some(Welding::Within(tolerance)),
                (None, true) => Some(Welding::Off),
                (None, false) => None,
            },
            marks: self.marks.clone(),
            is_strict: self.strict,
            ridge_angle_rad: ridge.or(crease).map(f64::to_radians),
            valley_angle_rad: valley.or(crease).map(f64::to_radians),
            ..LoadOptions::default()
        }
    }
}

/// The formats of models, then the edge mesh file.
static INPUT_FORMATS: LazyLock<Vec<InputFormat>> = LazyLock::new(|| {
    let models = Format::ALL.map(InputFormat::Model);
    models.into_iter().chain([InputFormat::EdgeMesh]).collect()
});

impl ValueEnum for InputFormat {
    fn value_variants<'a>() -> &'a [Self] {
        &INPUT_FORMATS
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(match self {
            Self::Model(format) => PossibleValue::new(format.as_str()).help(format.name()),
            Self::EdgeMesh => PossibleValue::new("edgemesh").help("An edge mesh"),
        })
    }
}

fn parse_tolerance(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(tolerance) if tolerance.is_finite() && tolerance >= 0.0 => Ok(tolerance),
        _ => Err("needs a distance of 0 or more".into()),
    }
}

fn parse_crease(text: &str) -> Result<f64, String> {
    parse_degrees(text, 0.0, 180.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tolerances_are_distances() {
        assert_eq!(parse_tolerance("1e-6"), Ok(1e-6));
        for text in ["-1", "nan", "inf", "", "x"] {
            assert!(parse_tolerance(text).is_err(), "{text}");
        }
    }

    #[test]
    fn the_crease_angle_stands_for_both_and_each_can_differ() {
        let creases = CreaseArguments { crease: Some(180.0), ..CreaseArguments::default() };
        let input = InputArguments { creases, ..InputArguments::default() };
        let pi = std::f64::consts::PI;
        assert_eq!(input.load_options().crease_angles_rad(), [pi, pi]);
        let none = InputArguments::default().load_options();
        assert_eq!((none.welding, none.ridge_angle_rad), (None, None));
    }
}
