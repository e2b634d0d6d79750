//! Errors in the words of the window.

use crate::error::Error;

/// The text of an error, with a hint about what helps in the window.
pub(crate) fn error_text(error: &Error) -> String {
    match error {
        Error::OutOfMemory { .. }
        | Error::NoMemoryForPicture { .. }
        | Error::PictureTooLarge { .. } => format!("{error}; a smaller picture needs less"),
        _ => error.to_string(),
    }
}

/// The text of an error in saving, which may have written some files.
pub(crate) fn saving_text(error: &Error) -> String {
    match error {
        Error::Canceled => format!("{error}; files written so far are kept"),
        _ => error_text(error),
    }
}
