//! The model formats that are read.

use std::ffi::OsStr;
use std::path::Path;

/// A model format that is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Format {
    /// Wavefront OBJ, with materials from MTL files beside it.
    Obj,
    /// PLY, text or binary.
    Ply,
    /// STL, text or binary.
    Stl,
    /// glTF 2.0 as JSON.
    Gltf,
    /// glTF 2.0 in one binary file.
    Glb,
    /// VRML 1.0 and VRML 97.
    Wrl,
    /// OFF, text or binary.
    Off,
    /// 3MF.
    ThreeMf,
}

impl Format {
    /// All formats.
    pub const ALL: [Self; 8] = [
        Self::Obj,
        Self::Ply,
        Self::Stl,
        Self::Gltf,
        Self::Glb,
        Self::Wrl,
        Self::Off,
        Self::ThreeMf,
    ];

    /// The usual file extension, in lower case; `--format` takes the same word.
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Obj => "obj",
            Self::Ply => "ply",
            Self::Stl => "stl",
            Self::Gltf => "gltf",
            Self::Glb => "glb",
            Self::Wrl => "wrl",
            Self::Off => "off",
            Self::ThreeMf => "3mf",
        }
    }

    /// The name in messages, such as `binary glTF`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Obj => "OBJ",
            Self::Ply => "PLY",
            Self::Stl => "STL",
            Self::Gltf => "glTF",
            Self::Glb => "binary glTF",
            Self::Wrl => "VRML",
            Self::Off => "OFF",
            Self::ThreeMf => "3MF",
        }
    }

    /// The format that the file extension of `path` stands for; upper and lower
    /// case are the same.
    #[must_use]
    pub fn of_name(path: &Path) -> Option<Self> {
        let extension = path.extension().and_then(OsStr::to_str)?;
        match extension.to_ascii_lowercase().as_str() {
            "obj" => Some(Self::Obj),
            "ply" => Some(Self::Ply),
            "stl" => Some(Self::Stl),
            "gltf" => Some(Self::Gltf),
            "glb" => Some(Self::Glb),
            "wrl" | "vrml" | "wrz" => Some(Self::Wrl),
            "off" => Some(Self::Off),
            "3mf" => Some(Self::ThreeMf),
            "gz" => Self::of_name(Path::new(path.file_stem()?)).filter(|&f| f == Self::Wrl),
            _ => None,
        }
    }
}
