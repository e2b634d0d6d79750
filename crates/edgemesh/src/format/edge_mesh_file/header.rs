//! The first 56 bytes of a file.
//!
//! Magic, version, length and checksum have the same place in every version, so that
//! a damaged file and a newer one can be distinguished. The checks are in the order
//! of what can be reported: not an edge mesh, an unsupported version, an incomplete
//! file, a damaged file.

use super::error::{FileError, FileErrorKind};
use crate::format::little_endian::{u32_at, u64_at};

/// The first bytes of a file.
const MAGIC: &[u8; 8] = b"EDGEMESH";

/// The version that is written, and the newest that is read.
const VERSION: u32 = 2;

/// The offset of the section table: the length of the header.
pub(super) const TABLE_START: usize = 56;

/// The length of the header in bytes.
pub(crate) const HEADER_BYTES: u64 = TABLE_START as u64;

/// The offset of the checksum, which covers all bytes before it.
const BEFORE_CHECKSUM: usize = 24;

/// A version that is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Version {
    V1,
    V2,
}

/// The content of a valid header.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Header {
    pub(super) version: Version,
    pub(super) section_count: u32,
}

impl Header {
    /// Reads the header of a file and checks the whole file against it.
    pub(super) fn read(bytes: &[u8]) -> Result<Self, FileError> {
        let has_magic = match bytes.first_chunk() {
            Some(first) => first == MAGIC,
            None => MAGIC.starts_with(bytes),
        };
        if !has_magic {
            let what =
                "is not an edge mesh: it does not begin with 'EDGEMESH'; build one from the model";
            return Err(FileError::new(FileErrorKind::Magic, what));
        }
        let cut = || truncated(TABLE_START as u64, bytes.len());
        let header = bytes.first_chunk::<TABLE_START>().ok_or_else(cut)?;
        let version = version_of(u32_at(header, 8).ok_or_else(cut)?)?;
        check_length(u64_at(header, 16).ok_or_else(cut)?, bytes.len())?;
        let stored = header.get(BEFORE_CHECKSUM..).ok_or_else(cut)?;
        if checksum(bytes).is_none_or(|sum| sum.as_bytes() != stored) {
            let what = "the checksum does not match the content: the file is damaged; \
                        build it again";
            return Err(FileError::at(FileErrorKind::Checksum, BEFORE_CHECKSUM as u64, what));
        }
        Ok(Self { version, section_count: u32_at(header, 12).ok_or_else(cut)? })
    }
}

/// Writes the header of a file, over the first bytes of an otherwise complete file.
pub(super) fn write_header(bytes: &mut [u8], section_count: u32) {
    let length = bytes.len() as u64;
    bytes[..8].copy_from_slice(MAGIC);
    bytes[8..12].copy_from_slice(&VERSION.to_le_bytes());
    bytes[12..16].copy_from_slice(&section_count.to_le_bytes());
    bytes[16..24].copy_from_slice(&length.to_le_bytes());
    if let Some(sum) = checksum(bytes) {
        bytes[BEFORE_CHECKSUM..TABLE_START].copy_from_slice(sum.as_bytes());
    }
}

/// The length that the header of an edge mesh file states; `None` if `head` is too
/// short or not the start of one.
pub(crate) fn stated_length(head: &[u8]) -> Option<u64> {
    u64_at(head, 16).filter(|_| is_edge_mesh(head))
}

/// Whether a file that begins with `head` is an edge mesh of any version.
pub(crate) fn is_edge_mesh(head: &[u8]) -> bool {
    head.starts_with(MAGIC)
}

/// The bytes of a file with correct magic, version, length and checksum, padded to at
/// least a header. Tests and fuzzers need this to pass the first checks.
#[must_use]
#[doc(hidden)]
pub fn with_checksum(bytes: &[u8]) -> Vec<u8> {
    let mut sealed = bytes.to_vec();
    sealed.resize(sealed.len().max(TABLE_START), 0);
    let section_count = u32_at(&sealed, 12).unwrap_or_default();
    write_header(&mut sealed, section_count);
    sealed
}

/// The BLAKE3 hash of all bytes except the checksum; `None` if the header is incomplete.
fn checksum(bytes: &[u8]) -> Option<blake3::Hash> {
    let before = bytes.get(..BEFORE_CHECKSUM)?;
    let after = bytes.get(TABLE_START..)?;
    Some(blake3::Hasher::new().update(before).update(after).finalize())
}

fn version_of(number: u32) -> Result<Version, FileError> {
    let what = match number {
        0 => "version 0 does not exist: the file is damaged; build it again".into(),
        1 => return Ok(Version::V1),
        2 => return Ok(Version::V2),
        newer => format!(
            "written by a newer Edgemesh: version {newer}, this one reads {VERSION}; \
             update Edgemesh, or build the file again"
        ),
    };
    Err(FileError::at(FileErrorKind::Version, 8, what))
}

fn check_length(stated: u64, found: usize) -> Result<(), FileError> {
    if (found as u64) < stated {
        return Err(truncated(stated, found));
    }
    if found as u64 > stated {
        let what = format!("has bytes after its stated end at byte {stated}; build it again");
        return Err(FileError::at(FileErrorKind::Excess, stated, what));
    }
    Ok(())
}

fn truncated(needed: u64, found: usize) -> FileError {
    let what = format!("ends here, but should have {needed} bytes; copy it or build it again");
    FileError::at(FileErrorKind::Truncated, found as u64, what)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file() -> Vec<u8> {
        let mut bytes = vec![7; 80];
        write_header(&mut bytes, 3);
        bytes
    }

    #[test]
    fn a_header_is_read_as_it_was_written() {
        let bytes = file();
        assert_eq!(bytes[..20], *b"EDGEMESH\x02\0\0\0\x03\0\0\0\x50\0\0\0");
        assert_eq!(Header::read(&bytes), Ok(Header { version: Version::V2, section_count: 3 }));
    }

    #[test]
    fn every_fault_has_its_kind_and_place() {
        let error = |change: &dyn Fn(&mut Vec<u8>)| {
            let mut bytes = file();
            change(&mut bytes);
            let error = Header::read(&bytes).unwrap_err();
            (error.kind, error.to_string())
        };
        let (kind, what) = error(&|bytes| bytes[0] = b'e');
        assert_eq!(kind, FileErrorKind::Magic, "{what}");
        let (kind, what) = error(&|bytes| *bytes = b"v 0".to_vec());
        assert_eq!(kind, FileErrorKind::Magic, "{what}");
        let (kind, what) = error(&|bytes| bytes.truncate(4));
        assert_eq!(kind, FileErrorKind::Truncated, "{what}");
        assert!(what.starts_with("byte 4: ends here, but should have 56 bytes"), "{what}");
        let (kind, what) = error(&|bytes| bytes.truncate(79));
        assert_eq!(kind, FileErrorKind::Truncated, "{what}");
        assert!(what.contains("should have 80 bytes"), "{what}");
        let (kind, what) = error(&|bytes| bytes.push(0));
        assert_eq!(kind, FileErrorKind::Excess, "{what}");
        let (kind, what) = error(&|bytes| bytes[60] ^= 1);
        assert_eq!(kind, FileErrorKind::Checksum, "{what}");
    }

    #[test]
    fn the_version_is_checked_first() {
        let mut bytes = file();
        bytes[8] = 7;
        bytes.truncate(60);
        let error = Header::read(&bytes).unwrap_err();
        assert_eq!(error.kind, FileErrorKind::Version);
        let expected = "byte 8: written by a newer Edgemesh: version 7, this one reads 2; ";
        assert!(error.to_string().starts_with(expected), "{error}");
        bytes[8] = 0;
        assert_eq!(Header::read(&bytes).unwrap_err().kind, FileErrorKind::Version);
    }
}
