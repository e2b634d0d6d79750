//! Failures of commands: a message and an exit status.

use std::process::ExitCode;

use crate::format::read::{ReadError, ReadErrorKind};
use crate::format::whole_file::WriteError;
use crate::load::LoadError;
use crate::view::CameraError;

/// An exit status of a command; scripts rely on the numbers. A program may add further ones.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ExitStatus(u8);

impl ExitStatus {
    /// 1: the input or the output is at fault.
    pub const FAULT: Self = Self(1);
    /// 2: the command line is wrong.
    pub const USAGE: Self = Self(2);
    /// 70: an internal error.
    pub const INTERNAL: Self = Self(70);

    /// The status `number`.
    #[must_use]
    pub const fn new(number: u8) -> Self {
        Self(number)
    }
}

impl From<ExitStatus> for ExitCode {
    fn from(ExitStatus(number): ExitStatus) -> Self {
        Self::from(number)
    }
}

/// The failure of a command.
#[derive(Debug)]
pub struct Failure {
    /// The message, without a leading "error:"; empty if it was printed before.
    pub message: String,
    /// The exit status of the process.
    pub status: ExitStatus,
}

impl Failure {
    /// A failure with [`ExitStatus::FAULT`].
    #[must_use]
    pub fn fault(message: impl Into<String>) -> Self {
        Self { message: message.into(), status: ExitStatus::FAULT }
    }

    /// A failure with [`ExitStatus::USAGE`].
    #[must_use]
    pub fn usage(message: impl Into<String>) -> Self {
        Self { message: message.into(), status: ExitStatus::USAGE }
    }
}

impl From<LoadError> for Failure {
    fn from(error: LoadError) -> Self {
        match error {
            LoadError::FormatNeeded => {
                Self::usage("standard input (-) needs --format, such as --format obj")
            }
            LoadError::ModelsOnly { file } => Self::usage(format!(
                "{file}: --weld, --no-weld and --marks apply to models only; an edge mesh is \
                 already welded"
            )),
            // Each line is an error; `run` adds "error:" to the first one.
            LoadError::Warnings { file, report } => {
                Self::fault(report.warning_lines(&file, "").join("\nerror: "))
            }
            LoadError::Read(ReadError { kind: ReadErrorKind::Internal, .. }) => {
                Self { message: error.to_string(), status: ExitStatus::INTERNAL }
            }
            LoadError::Read(_)
            | LoadError::EdgeMeshFile { .. }
            | LoadError::Io { .. }
            | LoadError::Marks(_)
            | LoadError::TooManyCopies { .. }
            | LoadError::Canceled => Self::fault(error.to_string()),
        }
    }
}

impl From<WriteError> for Failure {
    fn from(error: WriteError) -> Self {
        Self::fault(error.to_string())
    }
}

impl From<CameraError> for Failure {
    fn from(error: CameraError) -> Self {
        Self::usage(match error {
            CameraError::EyeOnTarget => "--eye and --target are the same point; move one of them",
            CameraError::UpAlongSight => "--up points along the line of sight; give another",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::{Place, Report, WarningCode};

    #[test]
    fn every_line_of_strict_warnings_is_an_error() {
        let mut report = Report::default();
        report.warn(WarningCode::Mark, Some(Place::Line(3)), || "no edge".into());
        report.warn_many(WarningCode::Index, 4, None, || "left out".into());
        let error = LoadError::Warnings { file: "a.obj".into(), report };
        assert_eq!(
            error.to_string(),
            "a.obj: left out (and 3 more) [index]\na.obj:3: no edge [mark]"
        );
        let failure = Failure::from(error);
        let text = "a.obj: left out (and 3 more) [index]\nerror: a.obj:3: no edge [mark]";
        assert_eq!((failure.message.as_str(), failure.status), (text, ExitStatus::FAULT));
    }
}
