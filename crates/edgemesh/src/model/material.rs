//! What surfaces look like, as far as a file says so in colours and pictures.
//!
//! Colours are *display values*: coded as sRGB, as MTL and VRML files have
//! them, and as the formulas of Phong and of papers after him are used with
//! them. What a format keeps in linear light is coded where it is read.
//!
//! Pictures stay as they are: nothing here decodes them, and one in a file of
//! its own is read when somebody asks for its bytes.

use std::fmt;
use std::fs::File;
use std::io::{self, Read as _};
use std::path::PathBuf;
use std::sync::Arc;

/// The largest picture that is read: 256 MiB.
pub(crate) const MAX_PICTURE_BYTES: u64 = 256 << 20;

/// A material by name, with the looks that the file or its library gives it.
/// Colours are display values, coded as sRGB.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Material {
    /// Its name; may be empty.
    pub name: String,
    /// Ambient colour, coded as sRGB, 0 to 1 (`Ka`).
    pub ambient: Option<[f32; 3]>,
    /// Diffuse or base colour, coded as sRGB, 0 to 1 (`Kd`); a texture is
    /// multiplied by it.
    pub diffuse: Option<[f32; 3]>,
    /// Specular colour, coded as sRGB, 0 to 1 (`Ks`).
    pub specular: Option<[f32; 3]>,
    /// Specular exponent (`Ns`).
    pub shininess: Option<f32>,
    /// Opacity, 0 to 1 (`d`, or 1 - `Tr`).
    pub opacity: Option<f32>,
    /// The picture of the diffuse colour (`map_Kd`), coded as sRGB as well.
    pub diffuse_texture: Option<Texture>,
}

/// A picture that lies on a surface by its texture coordinates: (0, 0) is its
/// lower left corner, (1, 1) its upper right one, and it repeats beyond.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Texture {
    /// How it is called in messages: the file's name as the model has it, or
    /// the name of the picture in the model.
    pub name: String,
    /// Where it is.
    pub source: TextureSource,
}

/// Where an encoded picture is: a PNG or JPEG file, told by its first bytes.
#[derive(Clone, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum TextureSource {
    /// In a file, which was found in the model's folder or below.
    File(PathBuf),
    /// In the model itself.
    Bytes(Arc<[u8]>),
}

impl TextureSource {
    /// The bytes of the encoded picture; a file is read anew in every call.
    ///
    /// # Errors
    /// Where the file cannot be read, or has more than [`MAX_PICTURE_BYTES`].
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
    /// Without the bytes, of which there may be millions.
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
