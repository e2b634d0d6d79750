//! Materials: colors and pictures of surfaces.
//!
//! Colors are *display values*, coded as sRGB, as in MTL and VRML files and in the formulas of
//! Phong and later papers. Readers convert the linear values of other formats.
//!
//! Pictures stay encoded. A picture in a separate file is read when its bytes are needed.

use std::fmt;
use std::fs::File;
use std::io::{self, Read as _};
use std::path::PathBuf;
use std::sync::Arc;

/// The largest picture that is read: 256 MiB.
pub(crate) const MAX_PICTURE_BYTES: u64 = 256 << 20;

/// A material, as the file or its material library describes it. Colors are display values, coded
/// as sRGB.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Material {
    /// The name; may be empty.
    pub name: String,
    /// Ambient color, 0 to 1 (`Ka`).
    pub ambient: Option<[f32; 3]>,
    /// Diffuse or base color, 0 to 1 (`Kd`); it is multiplied by the texture.
    pub diffuse: Option<[f32; 3]>,
    /// Specular color, 0 to 1 (`Ks`).
    pub specular: Option<[f32; 3]>,
    /// Specular exponent (`Ns`).
    pub shininess: Option<f32>,
    /// Opacity, 0 to 1 (`d`, or 1 - `Tr`).
    pub opacity: Option<f32>,
    /// Picture of the diffuse color (`map_Kd`).
    pub diffuse_texture: Option<Texture>,
}

impl Material {
    /// Whether nothing behind the material is seen through it.
    #[must_use]
    pub fn is_opaque(&self) -> bool {
        self.opacity.is_none_or(|opacity| opacity >= 1.0)
    }
}

/// A picture on a surface. Texture coordinate (0, 0) is its lower left corner, (1, 1) its upper
/// right corner; it repeats beyond.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Texture {
    /// The name in messages: the file name as the model has it, or the name of the picture in
    /// the model.
    pub name: String,
    /// The encoded picture.
    pub source: TextureSource,
}

/// The place of an encoded picture, PNG or JPEG as its first bytes say.
#[derive(Clone, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum TextureSource {
    /// A file in the folder of the model or below.
    File(PathBuf),
    /// Bytes in the model.
    Bytes(Arc<[u8]>),
}

impl TextureSource {
    /// Returns the encoded picture; each call reads the file again.
    ///
    /// # Errors
    /// Fails if the file cannot be read, or is larger than 256 MiB.
    pub fn encoded(&self) -> io::Result<Arc<[u8]>> {
        let path = match self {
            Self::Bytes(bytes) => return Ok(Arc::clone(bytes)),
            Self::File(path) => path,
        };
        let mut bytes = Vec::new();
        File::open(path)?.take(MAX_PICTURE_BYTES + 1).read_to_end(&mut bytes)?;
        if bytes.len() as u64 > MAX_PICTURE_BYTES {
            return Err(io::ErrorKind::FileTooLarge.into());
        }
        Ok(bytes.into())
    }
}

impl fmt::Debug for TextureSource {
    /// Prints the number of bytes instead of the bytes.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File(path) => formatter.debug_tuple("File").field(path).finish(),
            Self::Bytes(bytes) => write!(formatter, "Bytes({} bytes)", bytes.len()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_are_read_where_they_are() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        std::fs::write(&path, b"picture").unwrap();
        let file = TextureSource::File(path);
        assert_eq!(*file.encoded().unwrap(), *b"picture");
        let bytes = TextureSource::Bytes(b"picture".as_slice().into());
        assert_eq!(*bytes.encoded().unwrap(), *b"picture");
        assert_eq!(format!("{bytes:?}"), "Bytes(7 bytes)");
        drop(folder);
        assert_eq!(file.encoded().unwrap_err().kind(), io::ErrorKind::NotFound);
    }

    #[test]
    fn a_picture_beyond_the_limit_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("large.png");
        File::create(&path).unwrap().set_len(MAX_PICTURE_BYTES + 1).unwrap();
        let error = TextureSource::File(path).encoded().unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::FileTooLarge);
    }
}
