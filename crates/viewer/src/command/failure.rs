//! Errors as messages with hints about options, and their exit statuses.

use edgemesh::command::{ExitStatus, Failure};

use crate::error::Error;

/// 3: no suitable adapter.
pub(super) const NO_ADAPTER: ExitStatus = ExitStatus::new(3);

/// 4: a mistake in a shader or technique.
pub(super) const SHADER: ExitStatus = ExitStatus::new(4);

/// 5: the picture differs from the reference.
pub(super) const DIFFERS: ExitStatus = ExitStatus::new(5);

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        let status = status_of(&error);
        let message = match error {
            Error::Load(error) => return error.into(),
            Error::Camera(error) => return error.into(),
            Error::Setting(_) => format!("--set {error}"),
            Error::NoSuchBrush { .. } => format!("--brush {error}"),
            Error::TooManyClipPlanes => format!("--clip: {error}"),
            Error::NoMemoryForPicture { .. } => format!("--size {error}"),
            Error::PictureTooLarge { .. } => format!("{error}; give a smaller --size"),
            Error::OutOfMemory { .. } => {
                format!("{error}; a smaller picture, or --samples 1, needs less")
            }
            Error::AdapterLost { .. } => {
                format!("{error}; choose another adapter with --adapter, or install a newer driver")
            }
            Error::NoDisplay => format!("{error}; viewer render draws without one"),
            Error::NoWindow { .. } => format!("{error} viewer render draws without one"),
            error => error.to_string(),
        };
        Self { message, status }
    }
}

fn status_of(error: &Error) -> ExitStatus {
    match error {
        Error::Technique(_) => SHADER,
        Error::Adapter(_) | Error::AdapterLost { .. } | Error::WindowAdapter(_) => NO_ADAPTER,
        Error::Setting(_)
        | Error::ObjectSetting { .. }
        | Error::Camera(_)
        | Error::TooManyClipPlanes
        | Error::CommandLine(_) => ExitStatus::USAGE,
        Error::AdapterFault(_) | Error::Internal(_) => ExitStatus::INTERNAL,
        Error::Load(_)
        | Error::SceneFile(_)
        | Error::WriteTechnique(_)
        | Error::NoSuchBrush { .. }
        | Error::BrushNotFound { .. }
        | Error::Brush(_)
        | Error::Image { .. }
        | Error::Encode { .. }
        | Error::Write(_)
        | Error::DeviceLost { .. }
        | Error::Readback(_)
        | Error::OutOfMemory { .. }
        | Error::MeshTooLarge { .. }
        | Error::TooManyObjects { .. }
        | Error::PictureTooLarge { .. }
        | Error::NoMemoryForPicture { .. }
        | Error::MarksWithoutFile { .. }
        | Error::NoModel
        | Error::Watch(_)
        | Error::NoDisplay
        | Error::NoWindow { .. }
        | Error::Window(_)
        | Error::Canceled => ExitStatus::FAULT,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::technique::error::SettingError;

    #[test]
    fn hints_name_options_and_errors_do_not() {
        let setting = SettingError { assignment: "a.b=c".into(), what: "no pass".into() };
        let size = [9, 9];
        let cases = [
            (Error::Setting(setting), "--set a.b=c: no pass", ExitStatus::USAGE),
            (Error::NoSuchBrush { path: "oil".into() }, "--brush oil: ", ExitStatus::FAULT),
            (Error::TooManyClipPlanes, "--clip", ExitStatus::USAGE),
            (Error::NoMemoryForPicture { size }, "--size 9x9: ", ExitStatus::FAULT),
            (Error::PictureTooLarge { size, limit: 8 }, "--size", ExitStatus::FAULT),
            (
                Error::OutOfMemory { size, samples: 4, bytes: 3 << 20 },
                "9x9 with 4 samples, needs 3 MiB; a smaller picture, or --samples 1, needs less",
                ExitStatus::FAULT,
            ),
            (Error::AdapterLost { times: 4, seconds: 10 }, "--adapter", NO_ADAPTER),
            (Error::NoDisplay, "viewer render draws without one", ExitStatus::FAULT),
        ];
        for (error, hint, status) in cases {
            assert!(!error.to_string().contains("--"), "{error}");
            let failure = Failure::from(error);
            assert!(failure.message.contains(hint), "{}", failure.message);
            assert_eq!(failure.status, status, "{}", failure.message);
        }
    }
}
