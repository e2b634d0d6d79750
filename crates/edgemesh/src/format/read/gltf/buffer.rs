//! The bytes of buffers: in the binary chunk, in the JSON itself, or in a file
//! beside it.
//!
//! Based on: glTF 2.0, section 3.6.1 (buffers); RFC 2397 (data URIs) and RFC
//! 3986 (schemes and percent signs).
//!
//! A buffer is read when an accessor first asks for it, and once: a missing
//! file of normals costs normals only. Nothing with a scheme is ever opened.

use std::cell::OnceCell;

use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};

use super::super::error::{ReadError, ReadErrorKind};
use super::Asset;

/// Padded or not: RFC 2397 wants the padding, writers forget it.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// The buffers of a file, each read when it is first needed.
#[derive(Debug)]
pub(super) struct Buffers<'a> {
    binary: Option<&'a [u8]>,
    /// What the URI of each came to.
    loaded: Vec<OnceCell<Result<Vec<u8>, ReadError>>>,
}

impl<'a> Buffers<'a> {
    pub(super) fn new(count: usize, binary: Option<&'a [u8]>) -> Self {
        Self { binary, loaded: (0..count).map(|_| OnceCell::new()).collect() }
    }
}

impl Asset<'_> {
    /// The bytes of a buffer, just as many as it states; `part` names it.
    ///
    /// # Errors
    /// `Uri` where they are elsewhere and cannot be had, `Bounds` where there
    /// are fewer, `Syntax` where there is no such buffer.
    pub(super) fn buffer(
        &self,
        index: usize,
        part: impl FnOnce() -> String,
    ) -> Result<&[u8], ReadError> {
        let buffer = self.get(&self.document.buffers, index, "buffers", part)?;
        let bytes = match (&buffer.uri, self.buffers.binary, self.buffers.loaded.get(index)) {
            (None, Some(binary), _) if index == 0 => binary,
            (Some(uri), _, Some(cell)) => {
                let loaded = cell.get_or_init(|| self.load(uri, index));
                loaded.as_deref().map_err(Clone::clone)?
            }
            _ => {
                let what = "has no URI, and there is no binary chunk for it";
                return Err(self.error(ReadErrorKind::Uri, format!("buffers[{index}]"), what));
            }
        };
        let length = usize::try_from(buffer.byte_length.0).ok();
        length.and_then(|length| bytes.get(..length)).ok_or_else(|| {
            let [stated, found] = [buffer.byte_length.0, bytes.len() as u64];
            let what = format!("states {stated} bytes and has {found}; the file is cut short");
            self.error(ReadErrorKind::Bounds, format!("buffers[{index}]"), what)
        })
    }

    fn load(&self, uri: &str, index: usize) -> Result<Vec<u8>, ReadError> {
        let bytes = target(uri).and_then(|target| match target {
            Target::Bytes(bytes) => Ok(bytes),
            Target::Path(path) => {
                self.source.sidecar(&path).map_err(|why| format!("names '{path}', which {why}"))
            }
        });
        bytes
            .inspect(|bytes| self.budget.add_bytes(bytes.len()))
            .map_err(|what| self.error(ReadErrorKind::Uri, format!("buffers[{index}].uri"), what))
    }
}

/// Where a URI leads.
pub(super) enum Target {
    /// Nowhere: the bytes are in the URI itself.
    Bytes(Vec<u8>),
    /// To a file, by a path from the model's folder on.
    Path(String),
}

/// Finds out where a URI leads, without a look at any file.
///
/// # Errors
/// Why it leads nowhere, to go behind the name of the URI.
pub(super) fn target(uri: &str) -> Result<Target, String> {
    match scheme(uri) {
        Some(name) if name.eq_ignore_ascii_case("data") => data_uri(uri).map(Target::Bytes),
        Some(_) => Err("is elsewhere and was not opened; put the file beside the model and name \
                        it alone"
            .into()),
        None => unescape(uri).map(Target::Path),
    }
}

/// The scheme before the colon of a URI; `None` where it is relative.
fn scheme(uri: &str) -> Option<&str> {
    let (scheme, _) = uri.split_once(':')?;
    let is_allowed = |letter: char| letter.is_ascii_alphanumeric() || "+-.".contains(letter);
    scheme.chars().all(is_allowed).then_some(scheme)
}

/// The bytes in a URI such as `data:application/octet-stream;base64,AAAA`.
///
/// # Errors
/// Why there are none, to go behind the name of the URI.
fn data_uri(uri: &str) -> Result<Vec<u8>, String> {
    let Some((kind, data)) = uri.split_once(',') else {
        return Err("is a data URI without a comma".into());
    };
    if !kind.to_ascii_lowercase().ends_with(";base64") {
        return unescape_bytes(data.as_bytes());
    }
    let decoded = match data.contains('%') {
        true => BASE64.decode(unescape_bytes(data.as_bytes())?),
        false => BASE64.decode(data),
    };
    decoded.map_err(|error| format!("is no sound base64 ({error}); export the model again"))
}

/// A relative URI as a path.
fn unescape(uri: &str) -> Result<String, String> {
    let bytes = unescape_bytes(uri.as_bytes())?;
    String::from_utf8(bytes).map_err(|_| "is not UTF-8 behind its percent signs".into())
}

/// Replaces each `%41` by the byte that it stands for.
fn unescape_bytes(text: &[u8]) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text;
    while let Some((&byte, after)) = rest.split_first() {
        rest = after;
        if byte != b'%' {
            bytes.push(byte);
            continue;
        }
        let Some((&[high, low], after)) = rest.split_first_chunk() else {
            return Err("ends in a percent sign".into());
        };
        let digit = |letter: u8| char::from(letter).to_digit(16).and_then(|d| u8::try_from(d).ok());
        let (Some(high), Some(low)) = (digit(high), digit(low)) else {
            return Err("has a percent sign without two hexadecimal digits".into());
        };
        bytes.push(16 * high + low);
        rest = after;
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::super::super::source::Source;
    use super::super::document::Document;
    use super::*;

    /// Reads buffer 0 of `length` bytes at `uri`, with a folder that has a file.
    fn read(uri: Option<&str>, length: u64, binary: Option<&[u8]>) -> Result<Vec<u8>, ReadError> {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("two words.bin"), b"beside").unwrap();
        let json = serde_json::json!({
            "asset": {"version": "2.0"},
            "buffers": [{"uri": uri, "byteLength": length}]
        });
        let document: Document = serde_json::from_value(json).unwrap();
        let source = Source { name: "test.gltf", folder: Some(folder.path()), bytes: b"" };
        let asset = Asset::new(&source, &document, binary);
        asset.buffer(0, String::new).map(<[u8]>::to_vec)
    }

    #[test]
    fn bytes_come_from_three_places() {
        assert_eq!(read(None, 3, Some(b"chunk")).unwrap(), b"chu", "padding is left out");
        assert_eq!(read(Some("two%20words.bin"), 6, None).unwrap(), b"beside");
        assert_eq!(read(Some("./two words.bin"), 6, Some(b"chunk")).unwrap(), b"beside");
        let data = "data:application/octet-stream;base64,AAEC";
        assert_eq!(read(Some(data), 3, None).unwrap(), [0, 1, 2]);
        assert_eq!(read(Some("DATA:;BASE64,AA%3D%3D"), 1, None).unwrap(), [0]);
        assert_eq!(read(Some("data:;base64,AA"), 1, None).unwrap(), [0], "no padding");
        assert_eq!(read(Some("data:,a%00b"), 3, None).unwrap(), b"a\0b");
    }

    #[test]
    fn what_is_not_opened_says_why() {
        let what = |uri| {
            let error = read(Some(uri), 1, None).unwrap_err();
            assert_eq!(error.kind, ReadErrorKind::Uri, "{uri}");
            error.what
        };
        for uri in ["http://example.org/a.bin", "file:///etc/hostname", "C:\\a.bin", "x-y.z+1:a"] {
            assert!(what(uri).contains("not opened"), "{uri}");
        }
        for uri in ["../a.bin", "%2e%2e/a.bin", "//host/a.bin", "/etc/hostname"] {
            assert!(what(uri).contains("outside"), "{uri}");
        }
        assert!(what("none.bin").contains("not found"));
        assert!(what("data:;base64,A*A=").contains("base64"));
        assert!(what("data:;base64").contains("comma"));
        assert!(what("a%2").contains("percent"));
        assert!(what("a%zz").contains("percent"));
        assert!(what("%ff").contains("UTF-8"));
    }

    #[test]
    fn buffers_must_be_whole() {
        let error = read(None, 6, Some(b"chunk")).unwrap_err();
        assert_eq!(error.kind, ReadErrorKind::Bounds);
        assert!(error.what.contains("6 bytes and has 5"), "{error}");
        assert_eq!(read(None, 6, None).unwrap_err().kind, ReadErrorKind::Uri);
        assert_eq!(read(None, u64::MAX, Some(b"")).unwrap_err().kind, ReadErrorKind::Bounds);
    }
}
