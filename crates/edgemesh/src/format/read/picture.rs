//! Finds the pictures that a model names and checks that they are PNG or JPEG and whole
//! (`picture_structure`). They are decoded later, when they are drawn.
//!
//! Errors follow the picture's name in a sentence and reveal nothing of the file's
//! content. A missing picture is a warning; the geometry is read all the same.

use std::io::Cursor;
use std::sync::Arc;

#[cfg(test)]
pub(super) use super::picture_structure::SAMPLES;
use super::picture_structure::check_picture;
use super::source::Source;
use crate::format::regular_file::open_regular;
use crate::model::{MAX_PICTURE_BYTES, Texture, TextureSource};

/// The picture in a file that the model names, of at most [`MAX_PICTURE_BYTES`].
///
/// # Errors
/// As [`Source::sidecar_file`]; also if the file is not PNG or JPEG, or cut short.
pub(super) fn picture_beside(source: &Source, name: &str) -> Result<Texture, String> {
    let path = source.sidecar_file(name, MAX_PICTURE_BYTES)?;
    let opened = open_regular(&path).and_then(|file| Ok((file.metadata()?.len(), file)));
    let (size, file) = opened.map_err(|error| error.to_string())?;
    check_picture(file, size)?;
    Ok(Texture { name: name.into(), source: TextureSource::File(path) })
}

/// The picture that `bytes` of the model file hold.
///
/// # Errors
/// Fails if they are not PNG or JPEG, or cut short.
pub(super) fn picture_of_bytes(name: &str, bytes: impl Into<Arc<[u8]>>) -> Result<Texture, String> {
    let bytes = bytes.into();
    check_picture(Cursor::new(&*bytes), bytes.len() as u64)?;
    Ok(Texture { name: name.into(), source: TextureSource::Bytes(bytes) })
}

#[cfg(test)]
mod tests {
    use std::fs::{self, File};

    use super::*;

    #[test]
    fn pictures_are_recognized_by_their_content() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).unwrap();
        fs::create_dir(folder.path().join("maps")).unwrap();
        write("maps/a.png", SAMPLES[0]);
        write("b.png", SAMPLES[1]);
        write("c.png", b"GIF89a");
        write("empty.png", b"");
        write("cut.png", &SAMPLES[0][..40]);
        let source = Source { name: "model", folder: Some(folder.path()), bytes: b"" };
        let found = picture_beside(&source, "maps\\a.png").unwrap();
        let path = folder.path().canonicalize().unwrap().join("maps/a.png");
        assert_eq!((found.name.as_str(), found.source), ("maps\\a.png", TextureSource::File(path)));
        assert!(picture_beside(&source, "b.png").is_ok(), "the file extension does not matter");
        let why = |name| picture_beside(&source, name).unwrap_err();
        assert_eq!(why("c.png"), "is not a PNG or JPEG picture");
        assert_eq!(why("empty.png"), "is not a PNG or JPEG picture");
        assert_eq!(why("cut.png"), "is cut short");
        assert_eq!(why("d.png"), "was not found");
        assert!(why("../d.png").contains("outside"));
        assert!(why("maps").contains("is not a regular file"));
        assert!(picture_of_bytes("x", SAMPLES[1]).is_ok());
        assert!(picture_of_bytes("x", b"RIFF\0\0\0\0WEBP".as_slice()).is_err());
    }

    #[test]
    fn a_picture_over_the_limit_is_not_opened() {
        let folder = tempfile::tempdir().unwrap();
        let file = File::create(folder.path().join("large.png")).unwrap();
        file.set_len(MAX_PICTURE_BYTES + 1).unwrap();
        let source = Source { name: "model", folder: Some(folder.path()), bytes: b"" };
        assert!(
            picture_beside(&source, "large.png").unwrap_err().contains("is larger than 256 MiB")
        );
    }
}
