//! The byte order mark that some programs write before UTF-8 text.

/// U+FEFF in UTF-8.
pub(super) const UTF8_MARK: &[u8] = b"\xef\xbb\xbf";

/// `bytes` without a UTF-8 byte order mark at the start.
pub(super) fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(UTF8_MARK).unwrap_or(bytes)
}
