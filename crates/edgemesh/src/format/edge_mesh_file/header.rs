//! The first 56 bytes of a file.
//!
//! Magic, version, length and checksum are where they are in every version, so
//! that damage is told from novelty. The order of the checks is that of what
//! can be said: whether it is an edge mesh, whether it is one that is read
//! here, whether all of it is there, and whether it is as it was written.

use super::error::{FileError, FileErrorKind};
use super::section::TABLE_START;
use crate::format::read::EDGE_MESH_MAGIC;

/// The version that is written, and the newest that is read.
pub const VERSION: u32 = 1;

/// Bytes before the checksum, all of which it covers.
const BEFORE_CHECKSUM: usize = 24;

/// A version that is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Version {
    V1,
}

/// What a sound header says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Header {
    pub(super) version: Version,
    pub(super) section_count: u32,
}

impl Header {
    /// Reads the header of a file and checks all of the file against it.
    pub(super) fn read(bytes: &[u8]) -> Result<Self, FileError> {
        let has_magic = match bytes.first_chunk() {
            Some(first) => first == EDGE_MESH_MAGIC,
            None => EDGE_MESH_MAGIC.starts_with(bytes),
        };
        if !has_magic {
            let what = "is no edge mesh: 'EDGEMESH' is not at its start; build one of the model";
            return Err(FileError::new(FileErrorKind::Magic, what));
        }
        let cut = || truncated(TABLE_START as u64, bytes.len());
        let header = bytes.first_chunk::<TABLE_START>().ok_or_else(cut)?;
        let version = version_of(u32_at(header, 8).ok_or_else(cut)?)?;
        check_length(u64_at(header, 16).ok_or_else(cut)?, bytes.len())?;
        let stored = header.get(BEFORE_CHECKSUM..).ok_or_else(cut)?;
        if checksum(bytes).is_none_or(|sum| sum.as_bytes() != stored) {
            let what = "the checksum is not that of the content: the file was damaged; \
                        build it again";
            return Err(FileError::at(FileErrorKind::Checksum, BEFORE_CHECKSUM as u64, what));
        }
        Ok(Self { version, section_count: u32_at(header, 12).ok_or_else(cut)? })
    }
}

/// Writes the header of a file that is otherwise whole, with room for it at the
/// start.
pub(super) fn write_header(bytes: &mut [u8], section_count: u32) {
    let length = bytes.len() as u64;
    bytes[..8].copy_from_slice(EDGE_MESH_MAGIC);
    bytes[8..12].copy_from_slice(&VERSION.to_le_bytes());
    bytes[12..16].copy_from_slice(&section_count.to_le_bytes());
    bytes[16..24].copy_from_slice(&length.to_le_bytes());
    if let Some(sum) = checksum(bytes) {
        bytes[BEFORE_CHECKSUM..TABLE_START].copy_from_slice(sum.as_bytes());
    }
}

/// Bytes before the section table.
pub const HEADER_BYTES: u64 = TABLE_START as u64;

/// How long a file that begins with `head` says it is; `None` where it is no edge
/// mesh, or not even its header is there.
#[must_use]
pub fn stated_length(head: &[u8]) -> Option<u64> {
    u64_at(head, 16).filter(|_| is_edge_mesh(head))
}

/// Whether a file that begins with `head` is an edge mesh, of whatever version.
#[must_use]
pub fn is_edge_mesh(head: &[u8]) -> bool {
    head.starts_with(EDGE_MESH_MAGIC)
}

/// The bytes with magic, version, length and checksum made right, at least a
/// header long: what tests and fuzzers need to get past the first checks.
#[must_use]
pub fn with_checksum(bytes: &[u8]) -> Vec<u8> {
    let mut sealed = bytes.to_vec();
    sealed.resize(sealed.len().max(TABLE_START), 0);
    let section_count = u32_at(&sealed, 12).unwrap_or_default();
    write_header(&mut sealed, section_count);
    sealed
}

/// BLAKE3 of all bytes but those of the checksum; `None` where there is not
/// even a header.
fn checksum(bytes: &[u8]) -> Option<blake3::Hash> {
    let before = bytes.get(..BEFORE_CHECKSUM)?;
    let behind = bytes.get(TABLE_START..)?;
    Some(blake3::Hasher::new().update(before).update(behind).finalize())
}

fn version_of(number: u32) -> Result<Version, FileError> {
    let what = match number {
        0 => "version 0 never was: the file was damaged; build it again".into(),
        1 => return Ok(Version::V1),
        newer => format!(
            "written by a newer Edgemesh: version {newer}, this one reads {VERSION}; \
             get the newer one, or build the file again"
        ),
    };
    Err(FileError::at(FileErrorKind::Version, 8, what))
}

fn check_length(stated: u64, found: usize) -> Result<(), FileError> {
    if (found as u64) < stated {
        return Err(truncated(stated, found));
    }
    if found as u64 > stated {
        let what = format!("goes on behind its end at byte {stated}; build it again");
        return Err(FileError::at(FileErrorKind::Excess, stated, what));
    }
    Ok(())
}

fn truncated(needed: u64, found: usize) -> FileError {
    let what = format!("ends here, and should have {needed} bytes; copy it or build it again");
    FileError::at(FileErrorKind::Truncated, found as u64, what)
}

pub(super) fn u32_at(bytes: &[u8], at: usize) -> Option<u32> {
    bytes.get(at..)?.first_chunk().copied().map(u32::from_le_bytes)
}

pub(super) fn u64_at(bytes: &[u8], at: usize) -> Option<u64> {
    bytes.get(at..)?.first_chunk().copied().map(u64::from_le_bytes)
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
        assert_eq!(bytes[..20], *b"EDGEMESH\x01\0\0\0\x03\0\0\0\x50\0\0\0");
        assert_eq!(Header::read(&bytes), Ok(Header { version: Version::V1, section_count: 3 }));
    }

    #[test]
    fn whatever_is_wrong_has_its_kind_and_its_place() {
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
        assert!(what.starts_with("byte 4: ends here, and should have 56 bytes"), "{what}");
        let (kind, what) = error(&|bytes| bytes.truncate(79));
        assert_eq!(kind, FileErrorKind::Truncated, "{what}");
        assert!(what.contains("should have 80 bytes"), "{what}");
        let (kind, what) = error(&|bytes| bytes.push(0));
        assert_eq!(kind, FileErrorKind::Excess, "{what}");
        let (kind, what) = error(&|bytes| bytes[60] ^= 1);
        assert_eq!(kind, FileErrorKind::Checksum, "{what}");
    }

    #[test]
    fn other_versions_are_named_before_anything_else_is_looked_at() {
        let mut bytes = file();
        bytes[8] = 7;
        bytes.truncate(60);
        let error = Header::read(&bytes).unwrap_err();
        assert_eq!(error.kind, FileErrorKind::Version);
        let expected = "byte 8: written by a newer Edgemesh: version 7, this one reads 1; ";
        assert!(error.to_string().starts_with(expected), "{error}");
        bytes[8] = 0;
        assert_eq!(Header::read(&bytes).unwrap_err().kind, FileErrorKind::Version);
    }
}
