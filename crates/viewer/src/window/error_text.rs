//! Errors as the window words them.

use crate::error::Error;

/// The text of an error, with what can be done about it in the window.
pub(crate) fn error_text(error: &Error) -> String {
    match error {
        Error::OutOfMemory { .. }
        | Error::NoMemoryForPicture { .. }
        | Error::PictureTooLarge { .. } => format!("{error}; a smaller picture needs less"),
        _ => error.to_string(),
    }
}

/// The text of an error in saving pictures, which may have begun.
pub(crate) fn saving_text(error: &Error) -> String {
    match error {
        Error::Canceled => format!("{error}; what was written stays"),
        _ => error_text(error),
    }
}
