//! `edgemesh validate`: checks files.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;
use serde::Serialize;

use super::failure::{ExitStatus, Failure};
use super::info::{RepairInfo, WarningInfo, repairs_of, warnings_of};
use super::loading::load_input;
use super::output::{print_to_stdout, to_json};
use crate::arguments::InputArguments;
use crate::load::LoadedMesh;

/// Checks files and prints their errors, warnings and repairs
///
/// The exit status is 0 if every file can be used, with or without warnings, or else 1.
#[derive(Debug, Clone, Args)]
#[command(after_help = "Examples:\n  \
    edgemesh validate part.obj\n  \
    edgemesh validate models/*.stl --strict\n  \
    edgemesh validate part.glb --json")]
pub struct ValidateCommand {
    /// Files to check; - is standard input
    #[arg(value_name = "IN", required = true)]
    pub inputs: Vec<PathBuf>,
    /// Print JSON: an array with an object for each file
    #[arg(long)]
    pub json: bool,
    /// Arguments for reading the input
    #[command(flatten)]
    pub input: InputArguments,
}

/// The output of `validate --json` for a file.
#[derive(Debug, Clone, Serialize)]
struct Verdict {
    file: String,
    /// `sound`, `warnings` or `error`.
    status: &'static str,
    /// The message of the error.
    error: Option<String>,
    warnings: Vec<WarningInfo>,
    repairs: Vec<RepairInfo>,
}

impl ValidateCommand {
    /// Reads and builds each file and prints what was found.
    ///
    /// # Errors
    /// Fails without a message if a file cannot be used; the results contain the message.
    pub fn run(&self, is_quiet: bool) -> Result<(), Failure> {
        // Strictness is applied below, after all warnings are listed.
        let input = InputArguments { strict: false, ..self.input.clone() };
        let mut status = None;
        let mut verdicts = Vec::new();
        for path in &self.inputs {
            let loaded = load_input(&input, path, false, true, is_quiet).map_err(Failure::from);
            let verdict = match loaded {
                Ok(loaded) => Verdict::of(&loaded),
                Err(failure) if failure.status == ExitStatus::USAGE => return Err(failure),
                Err(failure) => {
                    status = Some(failure.status);
                    Verdict::of_error(path.display().to_string(), failure.message)
                }
            };
            if self.input.strict && verdict.status == "warnings" {
                status = status.or(Some(ExitStatus::FAULT));
            }
            verdicts.push(verdict);
        }
        let text = if self.json {
            to_json(&verdicts)?
        } else {
            verdicts.iter().map(Verdict::to_text).collect()
        };
        print_to_stdout(text.as_bytes())?;
        match status {
            Some(status) => Err(Failure { message: String::new(), status }),
            None => Ok(()),
        }
    }
}

impl Verdict {
    fn of(loaded: &LoadedMesh) -> Self {
        let warnings = warnings_of(&loaded.name, &loaded.report);
        Self {
            file: loaded.name.clone(),
            status: if warnings.is_empty() { "sound" } else { "warnings" },
            error: None,
            warnings,
            repairs: repairs_of(&loaded.name, &loaded.report),
        }
    }

    fn of_error(file: String, message: String) -> Self {
        let (warnings, repairs) = (Vec::new(), Vec::new());
        Self { file, status: "error", error: Some(message), warnings, repairs }
    }

    fn to_text(&self) -> String {
        let mut text = String::new();
        if let Some(error) = &self.error {
            let _ = writeln!(text, "error: {error}");
        }
        for WarningInfo { place, message, count, code } in &self.warnings {
            let more = match count {
                1 => String::new(),
                count => format!(" (and {} more)", count - 1),
            };
            let _ = writeln!(text, "{place}: warning: {message}{more} [{code}]");
        }
        for RepairInfo { place, count, kind } in &self.repairs {
            let _ = writeln!(text, "{place}: repaired: {count} {}", kind.replace('_', " "));
        }
        let _ = match self.status {
            "sound" => writeln!(text, "{}: sound", self.file),
            "warnings" => writeln!(text, "{}: usable, with warnings", self.file),
            _ => writeln!(text, "{}: cannot be used", self.file),
        };
        text
    }
}
