//! The bytes of buffers: in the binary chunk, in a data URI, or in a file beside the
//! model.
//!
//! Based on: glTF 2.0, section 3.6.1 (buffers).
//!
//! A buffer is read once, when an accessor first needs it. So a missing file of
//! normals costs only the normals.

use std::ops::Range;

use super::super::error::{ReadError, ReadErrorKind};
use super::asset::Asset;
use super::uri::{UriTarget, resolve};

impl Asset<'_> {
    /// The bytes of a buffer, as many as it states; `part` refers to it.
    ///
    /// # Errors
    /// `Uri` if its file cannot be read, `Bounds` if it has too few bytes, `Syntax`
    /// if the buffer does not exist.
    pub(super) fn buffer(
        &self,
        index: usize,
        part: impl FnOnce() -> String,
    ) -> Result<&[u8], ReadError> {
        let buffer = self.get(&self.document.buffers, index, "buffers", part)?;
        let bytes = match (&buffer.uri, self.binary, self.loaded_buffers.get(index)) {
            (None, Some(binary), _) if index == 0 => binary,
            (Some(uri), _, Some(cell)) => {
                let loaded = cell.get_or_init(|| self.load(uri, index));
                loaded.as_deref().map_err(Clone::clone)?
            }
            _ => {
                let what = "has no URI, and the file has no binary chunk for it";
                return Err(self.error(ReadErrorKind::Uri, format!("buffers[{index}]"), what));
            }
        };
        let length = usize::try_from(buffer.byte_length.0).ok();
        length.and_then(|length| bytes.get(..length)).ok_or_else(|| {
            let [stated, found] = [buffer.byte_length.0, bytes.len() as u64];
            let what = format!("states {stated} bytes and has {found}; the file is truncated");
            self.error(ReadErrorKind::Bounds, format!("buffers[{index}]"), what)
        })
    }

    fn load(&self, uri: &str, index: usize) -> Result<Vec<u8>, ReadError> {
        let bytes = resolve(uri).and_then(|target| match target {
            UriTarget::Bytes(bytes) => Ok(bytes),
            UriTarget::Path(path) => {
                self.source.sidecar(&path).map_err(|why| format!("names '{path}', which {why}"))
            }
        });
        bytes
            .inspect(|bytes| self.budget.add_bytes(bytes.len()))
            .map_err(|what| self.error(ReadErrorKind::Uri, format!("buffers[{index}].uri"), what))
    }
}

/// A range of `bytes`; `None` if it leaves them.
pub(super) fn slice(bytes: &[u8], start: u64, length: u64) -> Option<&[u8]> {
    let end = start.checked_add(length)?;
    bytes.get(Range { start: usize::try_from(start).ok()?, end: usize::try_from(end).ok()? })
}

#[cfg(test)]
mod tests {
    use super::super::super::source::Source;
    use super::super::document::Document;
    use super::*;

    /// Reads a buffer of `length` bytes at `uri`; the folder holds `two words.bin`.
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
        assert_eq!(read(None, 3, Some(b"chunk")).unwrap(), b"chu", "without the padding");
        assert_eq!(read(Some("two%20words.bin"), 6, None).unwrap(), b"beside");
        assert_eq!(read(Some("./two words.bin"), 6, Some(b"chunk")).unwrap(), b"beside");
        let data = "data:application/octet-stream;base64,AAEC";
        assert_eq!(read(Some(data), 3, None).unwrap(), [0, 1, 2]);
        assert_eq!(read(Some("DATA:;BASE64,AA%3D%3D"), 1, None).unwrap(), [0]);
        assert_eq!(read(Some("data:;base64,AA"), 1, None).unwrap(), [0], "no padding");
        assert_eq!(read(Some("data:,a%00b"), 3, None).unwrap(), b"a\0b");
    }

    #[test]
    fn buffers_that_are_not_opened_are_errors() {
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
    fn buffers_must_be_complete() {
        let error = read(None, 6, Some(b"chunk")).unwrap_err();
        assert_eq!(error.kind, ReadErrorKind::Bounds);
        assert!(error.what.contains("6 bytes and has 5"), "{error}");
        assert_eq!(read(None, 6, None).unwrap_err().kind, ReadErrorKind::Uri);
        assert_eq!(read(None, u64::MAX, Some(b"")).unwrap_err().kind, ReadErrorKind::Bounds);
    }
}
