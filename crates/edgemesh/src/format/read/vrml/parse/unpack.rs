//! Unpacks scenes that are packed with gzip.

use std::borrow::Cow;
use std::io::{ErrorKind, Read};

use flate2::read::MultiGzDecoder;

use super::origin::Origin;
use crate::format::read::error::{ReadError, ReadErrorKind};
use crate::format::read::source::MAX_FILE_BYTES;

/// The largest ratio of a scene to its packed form. Text is typically five to ten times as
/// large, but gzip can expand a thousandfold.
const MAX_RATIO: u64 = 100;

/// Up to this size the ratio is not limited.
const SMALL_BYTES: u64 = 64 << 20;

/// The text of a file, unpacked if necessary.
///
/// # Errors
/// [`ReadErrorKind::Size`] if the text is too large, [`ReadErrorKind::Truncated`] and
/// [`ReadErrorKind::Format`] for damaged data.
pub(crate) fn unpack<'a>(origin: &Origin, bytes: &'a [u8]) -> Result<Cow<'a, [u8]>, ReadError> {
    if !bytes.starts_with(b"\x1f\x8b") {
        return Ok(Cow::Borrowed(bytes));
    }
    let limit = (bytes.len() as u64).saturating_mul(MAX_RATIO).clamp(SMALL_BYTES, MAX_FILE_BYTES);
    let mut text = Vec::new();
    // One byte more, to detect an excess.
    MultiGzDecoder::new(bytes).take(limit + 1).read_to_end(&mut text).map_err(|error| {
        let kind = match error.kind() {
            ErrorKind::UnexpectedEof => ReadErrorKind::Truncated,
            _ => ReadErrorKind::Format,
        };
        origin.source().error(kind, None, format!("the gzip data is damaged: {error}"))
    })?;
    if text.len() as u64 > limit {
        let what = format!("unpacks to more than {limit} bytes; unpack it first (gunzip)");
        return Err(origin.source().error(ReadErrorKind::Size, None, what));
    }
    Ok(Cow::Owned(text))
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use flate2::Compression;
    use flate2::write::GzEncoder;

    use super::*;
    use crate::format::read::source::Source;

    fn packed(text: &[u8]) -> Vec<u8> {
        let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
        encoder.write_all(text).unwrap();
        encoder.finish().unwrap()
    }

    fn unpack_alone(bytes: &[u8]) -> Result<Vec<u8>, ReadErrorKind> {
        let origin = Origin::of_model(&Source { name: "a.wrz", folder: None, bytes });
        unpack(&origin, bytes).map(Cow::into_owned).map_err(|error| error.kind)
    }

    #[test]
    fn packed_and_plain_files_give_their_text() {
        assert_eq!(unpack_alone(b"#VRML"), Ok(b"#VRML".to_vec()));
        assert_eq!(unpack_alone(&packed(b"#VRML")), Ok(b"#VRML".to_vec()));
    }

    #[test]
    fn damaged_and_expanding_data_is_refused() {
        let whole = packed(&[b' '; 1 << 16]);
        assert_eq!(unpack_alone(&whole[..whole.len() / 2]), Err(ReadErrorKind::Truncated));
        assert_eq!(unpack_alone(b"\x1f\x8b\x07nothing"), Err(ReadErrorKind::Format));
        let expanding = packed(&vec![b' '; (64 << 20) + 1]);
        assert_eq!(unpack_alone(&expanding), Err(ReadErrorKind::Size));
    }
}
