//! The formats that edge meshes are exported to.

use std::ffi::OsStr;
use std::path::Path;

/// A format that edge meshes are exported to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ExportFormat {
    /// glTF 2.0 in one binary file.
    Glb,
    /// glTF 2.0 as JSON, with its data in a URI.
    Gltf,
    /// Binary PLY, little-endian.
    Ply,
    /// Wavefront OBJ.
    Obj,
    /// JSON with the whole edge mesh.
    Json,
}

impl ExportFormat {
    /// All formats.
    pub const ALL: [Self; 5] = [Self::Glb, Self::Gltf, Self::Ply, Self::Obj, Self::Json];

    /// The usual file extension.
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Glb => "glb",
            Self::Gltf => "gltf",
            Self::Ply => "ply",
            Self::Obj => "obj",
            Self::Json => "json",
        }
    }

    /// The format that the file extension of `path` stands for; upper and lower case are
    /// the same.
    #[must_use]
    pub fn of_name(path: &Path) -> Option<Self> {
        let extension = path.extension().and_then(OsStr::to_str)?;
        Self::ALL.into_iter().find(|format| extension.eq_ignore_ascii_case(format.as_str()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn file_extensions_stand_for_formats() {
        let format = |name: &str| ExportFormat::of_name(Path::new(name));
        for expected in ExportFormat::ALL {
            assert_eq!(format(&format!("a.b/c.{}", expected.as_str())), Some(expected));
        }
        assert_eq!(format("A.GlTF"), Some(ExportFormat::Gltf));
        for name in ["glb", "a.stl", "a.glb.txt", ""] {
            assert_eq!(format(name), None, "{name}");
        }
    }
}
