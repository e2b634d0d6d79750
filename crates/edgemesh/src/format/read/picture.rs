//! Finds the pictures that a model names and checks that they are PNG or JPEG, from
//! their first bytes. They are decoded later, when they are drawn.
//!
//! Errors follow the picture's name in a sentence and reveal nothing of the file's
//! content. A missing picture is a warning; the geometry is read all the same.

use std::fs::File;
use std::io::Read as _;
use std::sync::Arc;

use super::source::Source;
use crate::model::{MAX_PICTURE_BYTES, Texture, TextureSource};

const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";
const JPEG: &[u8] = b"\xff\xd8\xff";

/// The picture in a file that the model names, of at most [`MAX_PICTURE_BYTES`].
///
/// # Errors
/// As [`Source::sidecar_file`]; also if the file is not PNG or JPEG.
pub(super) fn picture_beside(source: &Source, name: &str) -> Result<Texture, String> {
    let path = source.sidecar_file(name, MAX_PICTURE_BYTES)?;
    let mut head = Vec::new();
    let read =
        File::open(&path).and_then(|file| file.take(PNG.len() as u64).read_to_end(&mut head));
    read.map_err(|error| error.to_string())?;
    check_kind(&head)?;
    Ok(Texture { name: name.into(), source: TextureSource::File(path) })
}

/// The picture that `bytes` of the model file hold.
///
/// # Errors
/// Fails if they are not PNG or JPEG.
pub(super) fn picture_of_bytes(name: &str, bytes: impl Into<Arc<[u8]>>) -> Result<Texture, String> {
    let bytes = bytes.into();
    check_kind(&bytes)?;
    Ok(Texture { name: name.into(), source: TextureSource::Bytes(bytes) })
}

fn check_kind(head: &[u8]) -> Result<(), String> {
    match head.starts_with(PNG) || head.starts_with(JPEG) {
        true => Ok(()),
        false => Err("is not a PNG or JPEG picture".into()),
    }
}

/// The first bytes of a PNG and of a JPEG picture.
#[cfg(test)]
pub(super) const SAMPLES: [&[u8]; 2] =
    [b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR", b"\xff\xd8\xff\xe0\0\x10JFIF"];

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn pictures_are_recognized_by_their_first_bytes() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).unwrap();
        fs::create_dir(folder.path().join("maps")).unwrap();
        write("maps/a.png", SAMPLES[0]);
        write("b.png", SAMPLES[1]);
        write("c.png", b"GIF89a");
        write("empty.png", b"");
        let source = Source { name: "model", folder: Some(folder.path()), bytes: b"" };
        let found = picture_beside(&source, "maps\\a.png").unwrap();
        let path = folder.path().canonicalize().unwrap().join("maps/a.png");
        assert_eq!((found.name.as_str(), found.source), ("maps\\a.png", TextureSource::File(path)));
        assert!(picture_beside(&source, "b.png").is_ok(), "the file extension does not matter");
        let why = |name| picture_beside(&source, name).unwrap_err();
        assert_eq!(why("c.png"), "is not a PNG or JPEG picture");
        assert_eq!(why("empty.png"), "is not a PNG or JPEG picture");
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
