//! What was repaired, dropped or not understood, as data beside the result.
//!
//! Input that can be repaired is neither an error nor a log line: the loader
//! and the builder count it here, with the first place in the file, and the
//! commands print each kind once.

use std::fmt;

/// The kind of a [`Warning`]; its text form is the `code` of `--json`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum WarningCode {
    /// A vertex is NaN or infinite; faces that use it were dropped.
    NonFinite,
    /// A texture coordinate or normal index is wrong; it was left out.
    Index,
    /// A face has fewer than three different corners; it was dropped.
    Degenerate,
    /// A face repeats another, same vertices in the same order; it was dropped.
    Duplicate,
    /// More than two faces share an edge.
    NonManifold,
    /// A surface cannot be oriented, as a Möbius strip; it was cut.
    Orientation,
    /// A material library is missing, unreadable, or outside the folder.
    Material,
    /// A statement of the file is not read.
    Unsupported,
    /// Coordinates are so far from the origin that 32 bits lose detail.
    Precision,
}

impl WarningCode {
    /// The word that scripts see.
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::NonFinite => "nonfinite",
            Self::Index => "index",
            Self::Degenerate => "degenerate",
            Self::Duplicate => "duplicate",
            Self::NonManifold => "nonmanifold",
            Self::Orientation => "orientation",
            Self::Material => "material",
            Self::Unsupported => "unsupported",
            Self::Precision => "precision",
        }
    }
}

impl fmt::Display for WarningCode {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.as_str())
    }
}

/// One kind of trouble, with how often it came and where it came first.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Warning {
    /// The kind.
    pub code: WarningCode,
    /// How many elements it concerns.
    pub count: usize,
    /// The line of the first one, counted from 1; `None` where the file as a
    /// whole is meant.
    pub line: Option<u32>,
    /// What was found at the first place, and what was done.
    pub message: String,
}

/// Everything that was repaired or dropped on the way to an edge mesh.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Report {
    /// One entry a code, ordered by code.
    warnings: Vec<Warning>,
    /// Faces that were turned around so that their component winds one way.
    pub flipped_faces: usize,
    /// Polygons cut by ear clipping, because a fan would overlap itself.
    pub ear_clipped_polygons: usize,
    /// Triangles without area that were kept; they take their facing from the
    /// face across their longest edge.
    pub zero_area_triangles: usize,
}

impl Report {
    /// Counts one more `code`; the first call of a code gives line and message.
    pub fn warn(&mut self, code: WarningCode, line: Option<u32>, message: impl FnOnce() -> String) {
        self.warn_many(code, 1, line, message);
    }

    /// Counts `count` more of `code`; the first call of a code gives line and
    /// message.
    pub fn warn_many(
        &mut self,
        code: WarningCode,
        count: usize,
        line: Option<u32>,
        message: impl FnOnce() -> String,
    ) {
        if count == 0 {
            return;
        }
        match self.warnings.binary_search_by_key(&code, |warning| warning.code) {
            Ok(found) => self.warnings[found].count += count,
            Err(place) => {
                self.warnings.insert(place, Warning { code, count, line, message: message() });
            }
        }
    }

    /// The warnings, one a code, ordered by code.
    #[must_use]
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }

    /// How many elements `code` concerns.
    #[must_use]
    pub fn count(&self, code: WarningCode) -> usize {
        self.warnings.iter().find(|warning| warning.code == code).map_or(0, |warning| warning.count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn first_place_is_kept_and_all_are_counted() {
        let mut report = Report::default();
        report.warn(WarningCode::Unsupported, Some(9), || "curve".into());
        report.warn(WarningCode::Degenerate, Some(3), || "first".into());
        report.warn(WarningCode::Degenerate, Some(5), || "second".into());
        assert_eq!(report.count(WarningCode::Degenerate), 2);
        assert_eq!(report.warnings()[0].line, Some(3), "ordered by code, first place kept");
        assert_eq!(report.warnings()[0].message, "first");
        assert_eq!(report.count(WarningCode::Material), 0);
    }
}
