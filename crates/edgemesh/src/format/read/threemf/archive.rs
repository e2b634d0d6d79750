//! The parts of a ZIP archive.
//!
//! Source: PKWARE, *APPNOTE.TXT* 6.3.10, sections 4.3 (records) and 4.5.3 (64 bits).
//!
//! ```text
//! | header, data | header, data | ... | directory: a record for each part | end record |
//!       ^------------------------------------'                                  |
//!                                         ^-------------------------------------'
//! ```
//!
//! Only the directory is believed: local headers may lack sizes. Names are compared
//! without case, as the packaging convention of 3MF asks. A name is only looked up, so
//! one that leads out of the archive leads nowhere.

use std::cell::Cell;
use std::collections::HashMap;
use std::io::Read as _;

use flate2::Crc;
use flate2::read::DeflateDecoder;

use super::super::error::{ReadError, ReadErrorKind};
use super::super::source::{MAX_FILE_BYTES, Source};
use crate::report::Place;

/// The largest ratio of all unpacked parts to the archive. XML is typically five to
/// ten times as large, but a hostile archive can expand a thousandfold.
const MAX_RATIO: u64 = 100;

/// Up to this size the ratio is not limited.
const SMALL_BYTES: u64 = 64 << 20;

/// The bytes of an end record without its comment.
const END_BYTES: usize = 22;

/// The longest comment behind an end record.
const MAX_COMMENT: usize = 0xffff;

/// A 32-bit value that stands in another record with 64 bits.
const IN_64_BITS: u64 = 0xffff_ffff;

/// An archive whose directory has been read.
#[derive(Debug)]
pub(super) struct Archive<'a> {
    pub(super) source: &'a Source<'a>,
    /// The parts by their names in lower case.
    entries: HashMap<Vec<u8>, Entry>,
    /// The bytes of all parts that were unpacked.
    unpacked: Cell<u64>,
}

/// A part, as the directory describes it.
#[derive(Debug, Clone, Copy)]
struct Entry {
    is_encrypted: bool,
    method: u16,
    checksum: u32,
    /// Bytes in the archive.
    packed: u64,
    /// The offset of its local header.
    offset: u64,
}

impl<'a> Archive<'a> {
    /// Reads the directory.
    ///
    /// # Errors
    /// Format: not a ZIP archive. Truncated: the directory is missing or incomplete.
    pub(super) fn open(source: &'a Source<'a>) -> Result<Self, ReadError> {
        let fail = |kind, what| Err(source.error(kind, None, what));
        if !source.bytes.starts_with(b"PK") {
            return fail(ReadErrorKind::Format, "is not a ZIP archive, as 3MF files are");
        }
        let Some((count, start)) = find_directory(source.bytes) else {
            let what = "the archive is truncated: it has no directory at its end";
            return fail(ReadErrorKind::Truncated, what);
        };
        let mut entries = HashMap::new();
        let mut at = start;
        for _ in 0..count {
            let Some((name, entry, next)) = entry(source.bytes, at) else {
                let what = "the directory of the archive is damaged or incomplete";
                return fail(ReadErrorKind::Truncated, what);
            };
            entries.entry(name.to_ascii_lowercase()).or_insert(entry);
            at = next;
        }
        Ok(Self { source, entries, unpacked: Cell::new(0) })
    }

    /// Whether there is a part with this name; a slash at its start does not count.
    pub(super) fn has(&self, name: &str) -> bool {
        self.entries.contains_key(&key(name))
    }

    /// The bytes of all parts that were unpacked so far.
    pub(super) const fn unpacked(&self) -> u64 {
        self.unpacked.get()
    }

    /// Unpacks a part.
    ///
    /// # Errors
    /// Format: there is no such part, it is encrypted, packed by another method than
    /// deflate, or damaged. Truncated: its data leave the file. Size: the parts become
    /// too large.
    pub(super) fn read(&self, name: &str) -> Result<Vec<u8>, ReadError> {
        let fail = |kind, what: String| {
            Err(self.source.error(kind, Some(Place::Part(name.to_owned())), what))
        };
        let Some(entry) = self.entries.get(&key(name)) else {
            return fail(ReadErrorKind::Format, "is not a part of the archive".into());
        };
        if entry.is_encrypted {
            return fail(ReadErrorKind::Format, "is encrypted; save it without a password".into());
        }
        let Some(data) = data(self.source.bytes, entry) else {
            return fail(ReadErrorKind::Truncated, "is incomplete: the file is truncated".into());
        };
        let limit = self.limit().saturating_sub(self.unpacked.get());
        let mut bytes = Vec::new();
        // One byte more, to detect an excess.
        let unpacked = match entry.method {
            0 => data.take(limit + 1).read_to_end(&mut bytes),
            8 => DeflateDecoder::new(data).take(limit + 1).read_to_end(&mut bytes),
            other => {
                let what = format!("is packed by method {other}; save it with deflate");
                return fail(ReadErrorKind::Format, what);
            }
        };
        if let Err(error) = unpacked {
            return fail(ReadErrorKind::Format, format!("is damaged: {error}"));
        }
        if bytes.len() as u64 > limit {
            let what = format!("too large: the parts unpack to more than {} bytes", self.limit());
            return fail(ReadErrorKind::Size, what);
        }
        let mut checksum = Crc::new();
        checksum.update(&bytes);
        if checksum.sum() != entry.checksum {
            return fail(ReadErrorKind::Format, "is damaged: its checksum differs".into());
        }
        self.unpacked.set(self.unpacked.get() + bytes.len() as u64);
        Ok(bytes)
    }

    fn limit(&self) -> u64 {
        let packed = self.source.bytes.len() as u64;
        packed.saturating_mul(MAX_RATIO).clamp(SMALL_BYTES, MAX_FILE_BYTES)
    }
}

/// The key of a name in [`Archive::entries`].
fn key(name: &str) -> Vec<u8> {
    name.trim_start_matches('/').as_bytes().to_ascii_lowercase()
}

/// The number of records in the directory, and its offset.
fn find_directory(bytes: &[u8]) -> Option<(u64, u64)> {
    let last = bytes.len().checked_sub(END_BYTES)?;
    let first = last.saturating_sub(MAX_COMMENT);
    let is_end = |&at: &usize| bytes.get(at..).is_some_and(|rest| rest.starts_with(b"PK\x05\x06"));
    let end = (first..=last).rev().find(is_end)? as u64;
    let count = number::<2>(bytes, end + 10)?;
    let start = number::<4>(bytes, end + 16)?;
    if count != 0xffff && start != IN_64_BITS {
        return Some((count, start));
    }
    // A locator before the end record has the offset of an end record of 64 bits.
    let locator = end.checked_sub(20)?;
    if !starts_with(bytes, locator, b"PK\x06\x07") {
        return Some((count, start));
    }
    let end = number::<8>(bytes, locator + 8)?;
    if !starts_with(bytes, end, b"PK\x06\x06") {
        return None;
    }
    Some((number::<8>(bytes, end.checked_add(32)?)?, number::<8>(bytes, end.checked_add(48)?)?))
}

/// The directory's record at an offset, as a name, its entry and the next offset.
fn entry(bytes: &[u8], at: u64) -> Option<(&[u8], Entry, u64)> {
    if !starts_with(bytes, at, b"PK\x01\x02") {
        return None;
    }
    let field = |offset| number::<2>(bytes, at + offset);
    let [flags, method] = [field(8)?, field(10)?];
    let [name_length, extra_length, comment_length] = [field(28)?, field(30)?, field(32)?];
    let name = range(bytes, at + 46, name_length)?;
    let extra = range(bytes, at + 46 + name_length, extra_length)?;
    let [packed, size, offset] = [20, 24, 42].map(|offset| number::<4>(bytes, at + offset));
    let mut wide = wide_fields(extra);
    // The wide fields come in this order, each only if its narrow field has no room.
    let mut widened = |narrow: Option<u64>| match narrow? {
        IN_64_BITS => wide.next().or(Some(IN_64_BITS)),
        narrow => Some(narrow),
    };
    let (_, packed, offset) = (widened(size)?, widened(packed)?, widened(offset)?);
    let entry = Entry {
        is_encrypted: flags & 1 != 0,
        method: u16::try_from(method).ok()?,
        checksum: u32::try_from(number::<4>(bytes, at + 16)?).ok()?,
        packed,
        offset,
    };
    Some((name, entry, at + 46 + name_length + extra_length + comment_length))
}

/// The fields of 64 bits among the extra fields of a record.
fn wide_fields(mut extra: &[u8]) -> impl Iterator<Item = u64> {
    let mut found: &[u8] = &[];
    while let (Some(id), Some(length)) = (number::<2>(extra, 0), number::<2>(extra, 2)) {
        let Some(field) = range(extra, 4, length) else { break };
        if id == 1 {
            found = field;
        }
        extra = extra.get(4 + field.len()..).unwrap_or_default();
    }
    found.as_chunks::<8>().0.iter().map(|&bytes| u64::from_le_bytes(bytes))
}

/// The packed data of a part.
fn data<'a>(bytes: &'a [u8], entry: &Entry) -> Option<&'a [u8]> {
    let at = entry.offset;
    if !starts_with(bytes, at, b"PK\x03\x04") {
        return None;
    }
    let [name, extra] = [number::<2>(bytes, at + 26)?, number::<2>(bytes, at + 28)?];
    range(bytes, at + 30 + name + extra, entry.packed)
}

fn starts_with(bytes: &[u8], at: u64, signature: &[u8; 4]) -> bool {
    range(bytes, at, 4) == Some(signature)
}

/// The little-endian number of `N` bytes at an offset.
fn number<const N: usize>(bytes: &[u8], at: u64) -> Option<u64> {
    let mut wide = [0; 8];
    let found = range(bytes, at, N as u64)?;
    wide.get_mut(..N)?.copy_from_slice(found);
    Some(u64::from_le_bytes(wide))
}

fn range(bytes: &[u8], at: u64, length: u64) -> Option<&[u8]> {
    let end = at.checked_add(length)?;
    bytes.get(usize::try_from(at).ok()?..usize::try_from(end).ok()?)
}

#[cfg(test)]
mod tests {
    use super::super::sample::{Packing, zip};
    use super::*;

    fn source(bytes: &[u8]) -> Source<'_> {
        Source { name: "test.3mf", folder: None, bytes }
    }

    #[test]
    fn parts_are_found_by_name_without_case() {
        for packing in [Packing::Stored, Packing::Deflated, Packing::Wide] {
            let bytes = zip(&[("a.txt", b"first"), ("3D/B.model", &[b'x'; 1000])], packing);
            let source = source(&bytes);
            let archive = Archive::open(&source).unwrap();
            assert_eq!(archive.read("/3d/b.MODEL").unwrap(), [b'x'; 1000], "{packing:?}");
            assert_eq!(archive.read("a.txt").unwrap(), b"first");
            assert!(archive.has("A.TXT") && !archive.has("../a.txt") && !archive.has("b.model"));
            assert_eq!(archive.unpacked(), 1005);
        }
    }

    #[test]
    fn a_comment_may_follow_the_directory() {
        let mut bytes = zip(&[("a", b"first")], Packing::Deflated);
        let length = bytes.len();
        bytes[length - 2] = 9;
        bytes.extend(b"a comment");
        assert_eq!(Archive::open(&source(&bytes)).unwrap().read("a").unwrap(), b"first");
    }

    #[test]
    fn damaged_archives_are_errors() {
        use ReadErrorKind::{Format, Truncated};
        let bytes = zip(&[("a", b"first part"), ("b", b"second")], Packing::Stored);
        let kind = |bytes: &[u8]| Archive::open(&source(bytes)).unwrap_err().kind;
        assert_eq!(kind(b"no archive"), Format);
        for end in 2..bytes.len() {
            assert_eq!(kind(&bytes[..end]), Truncated, "{end}");
        }
        let read = |change: fn(&mut Vec<u8>)| {
            let mut bytes = bytes.clone();
            change(&mut bytes);
            let source = source(&bytes);
            Archive::open(&source).and_then(|archive| archive.read("a")).unwrap_err()
        };
        let error = read(|bytes| bytes[31] = b'F');
        assert!(error.what.contains("checksum differs"), "{error}");
        assert_eq!(error.place, Some(Place::Part("a".into())));
        assert_eq!(read(|bytes| bytes[0] = 0).kind, Format);
        assert_eq!(read(|bytes| bytes[2] = 0).kind, Truncated, "no local header");
    }

    /// The archive of one part `a` with a changed byte in its record of the directory.
    fn changed(offset: usize, value: u8) -> ReadError {
        let mut bytes = zip(&[("a", b"first part")], Packing::Stored);
        let record = bytes.windows(4).position(|four| four == b"PK\x01\x02").unwrap();
        bytes[record + offset] = value;
        let source = source(&bytes);
        Archive::open(&source).and_then(|archive| archive.read("a")).unwrap_err()
    }

    #[test]
    fn what_is_not_supported_is_named() {
        assert!(changed(8, 1).what.contains("encrypted"));
        assert!(changed(10, 12).what.contains("method 12"));
        assert!(changed(10, 8).what.contains("damaged"), "not deflated");
        assert_eq!(changed(20, 200).kind, ReadErrorKind::Truncated, "packed size");
        assert_eq!(changed(45, 200).kind, ReadErrorKind::Truncated, "offset");
        assert!(changed(46, b'b').what.contains("not a part"));
    }

    #[test]
    fn bombs_are_refused() {
        let bytes = zip(&[("a", &vec![0; (64 << 20) + 1])], Packing::Deflated);
        assert!(bytes.len() < 1 << 20);
        let source = source(&bytes);
        let error = Archive::open(&source).unwrap().read("a").unwrap_err();
        assert_eq!(error.kind, ReadErrorKind::Size);
        let half = vec![0; 40 << 20];
        let bytes = zip(&[("a", &half), ("b", &half)], Packing::Deflated);
        let source = self::source(&bytes);
        let archive = Archive::open(&source).unwrap();
        assert!(archive.read("a").is_ok());
        assert_eq!(archive.read("b").unwrap_err().kind, ReadErrorKind::Size, "all parts count");
    }
}
