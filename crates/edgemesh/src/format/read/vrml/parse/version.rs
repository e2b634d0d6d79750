//! The versions of the language.

/// A version of the language.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Version {
    /// VRML 1.0.
    One,
    /// VRML 2.0, which became VRML 97.
    Two,
}

impl Version {
    /// The version that the first line of a file states; `None` for others.
    pub(super) fn of_header(text: &[u8]) -> Option<Self> {
        let stated = text.strip_prefix(b"#VRML")?.trim_ascii_start();
        match stated.get(..3)? {
            b"V1." => Some(Self::One),
            b"V2." => Some(Self::Two),
            _ => None,
        }
    }
}
