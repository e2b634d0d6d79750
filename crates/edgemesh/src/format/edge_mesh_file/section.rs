//! The section table, with the place of each list in the file.

use std::borrow::Cow;
use std::fmt;

use super::element::{Element, from_bytes};
use super::error::{FileError, FileErrorKind};
use super::header::TABLE_START;
use crate::format::little_endian::{u32_at, u64_at};
use crate::report::Place;

/// Bytes of an entry of the table.
pub(super) const ENTRY_BYTES: usize = 24;

/// Sections begin at multiples of this many bytes.
pub(super) const ALIGNMENT: usize = 16;

/// The name of a section.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct Tag(pub(super) [u8; 4]);

impl Tag {
    pub(super) const POSITIONS: Self = Self(*b"POSI");
    pub(super) const VERTEX_NORMALS: Self = Self(*b"NORM");
    pub(super) const SPLIT_FROM: Self = Self(*b"SPLT");
    pub(super) const TRIANGLES: Self = Self(*b"TRIS");
    pub(super) const FACE_PLANES: Self = Self(*b"PLAN");
    pub(super) const RECORDS: Self = Self(*b"EDGE");
    pub(super) const CHAINS: Self = Self(*b"CHNS");
    pub(super) const LINKS: Self = Self(*b"LNKS");
    pub(super) const FILL_VERTICES: Self = Self(*b"FVTX");
    pub(super) const FILL_COLORS: Self = Self(*b"FCOL");
    pub(super) const FILL_INDICES: Self = Self(*b"FIDX");
    pub(super) const FILL_RUNS: Self = Self(*b"FRUN");
    pub(super) const MATERIALS: Self = Self(*b"MTRL");
    pub(super) const PICTURE_ENDS: Self = Self(*b"PEND");
    pub(super) const PICTURES: Self = Self(*b"PICT");
    pub(super) const REPLICATED_F32: Self = Self(*b"RF32");
    pub(super) const REPLICATED_I16: Self = Self(*b"RI16");
    pub(super) const INSTANCES: Self = Self(*b"INST");
    pub(super) const INSTANCED_MESHES: Self = Self(*b"IMSH");
    pub(super) const PLACEMENTS: Self = Self(*b"IPLC");
    pub(super) const FRAME: Self = Self(*b"FRAM");
    pub(super) const BOUNDS: Self = Self(*b"BNDS");
    pub(super) const COUNTS: Self = Self(*b"CNTS");
    pub(super) const META: Self = Self(*b"META");
}

impl fmt::Display for Tag {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}", self.0.escape_ascii())
    }
}

impl fmt::Debug for Tag {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, formatter)
    }
}

/// An entry of the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Section {
    pub(super) tag: Tag,
    /// Bytes of an element.
    pub(super) element_bytes: u32,
    /// The offset of its first byte in the file.
    pub(super) offset: u64,
    /// The number of elements.
    pub(super) count: u64,
}

impl Section {
    /// An error in this entry, which has this index in the table.
    fn error(&self, index: usize, what: &str) -> FileError {
        let byte = (TABLE_START + index * ENTRY_BYTES) as u64;
        let what = format!("section {} {what}; build the file again", self.tag);
        FileError::at(FileErrorKind::Section, byte, what)
    }

    fn read(entry: &[u8]) -> Option<Self> {
        Some(Self {
            tag: Tag(*entry.first_chunk()?),
            element_bytes: u32_at(entry, 4)?,
            offset: u64_at(entry, 8)?,
            count: u64_at(entry, 16)?,
        })
    }

    /// The entry as bytes, the inverse of [`Self::read`].
    pub(super) fn to_bytes(self) -> [u8; ENTRY_BYTES] {
        let mut bytes = [0; ENTRY_BYTES];
        bytes[..4].copy_from_slice(&self.tag.0);
        bytes[4..8].copy_from_slice(&self.element_bytes.to_le_bytes());
        bytes[8..16].copy_from_slice(&self.offset.to_le_bytes());
        bytes[16..].copy_from_slice(&self.count.to_le_bytes());
        bytes
    }

    /// Its bytes in the file; `None` if it leaves the file.
    fn of<'a>(&self, file: &'a [u8]) -> Option<&'a [u8]> {
        let length = self.count.checked_mul(u64::from(self.element_bytes))?;
        let end = self.offset.checked_add(length)?;
        file.get(usize::try_from(self.offset).ok()?..usize::try_from(end).ok()?)
    }
}

/// The sections of a file, all within the file.
#[derive(Debug)]
pub(super) struct Sections<'a> {
    file: &'a [u8],
    table: Vec<Section>,
}

impl<'a> Sections<'a> {
    /// Reads the table of `count` sections of a file with a valid header.
    pub(super) fn read(file: &'a [u8], count: u32) -> Result<Self, FileError> {
        let end = u64::from(count) * ENTRY_BYTES as u64 + TABLE_START as u64;
        let entries = usize::try_from(end).ok().and_then(|end| file.get(TABLE_START..end));
        let Some(entries) = entries else {
            let what = format!("a table of {count} sections leaves the file; build it again");
            return Err(FileError::at(FileErrorKind::Section, 12, what));
        };
        let table: Vec<Section> =
            entries.chunks_exact(ENTRY_BYTES).filter_map(Section::read).collect();
        for (index, section) in table.iter().enumerate() {
            let begin = section.offset;
            if begin < end || begin % ALIGNMENT as u64 != 0 {
                let what =
                    format!("begins at byte {begin}, not at a multiple of 16 after the table");
                return Err(section.error(index, &what));
            }
            if section.of(file).is_none() {
                return Err(section.error(index, "leaves the file"));
            }
        }
        Ok(Self { file, table })
    }

    /// The list of an optional section.
    pub(super) fn optional<T: Element>(&self, tag: Tag) -> Result<Option<Cow<'a, [T]>>, FileError> {
        let mut found = self.table.iter().enumerate().filter(|(_, section)| section.tag == tag);
        let Some((index, section)) = found.next() else { return Ok(None) };
        if let Some((again, section)) = found.next() {
            return Err(section.error(again, "occurs twice"));
        }
        let size = size_of::<T>();
        if section.element_bytes as usize != size {
            let what = format!("has elements of {} bytes instead of {size}", section.element_bytes);
            return Err(section.error(index, &what));
        }
        let list = section.of(self.file).and_then(from_bytes);
        list.map(Some).ok_or_else(|| section.error(index, "leaves the file"))
    }

    /// The list of a required section.
    pub(super) fn list<T: Element>(&self, tag: Tag) -> Result<Cow<'a, [T]>, FileError> {
        let missing = || {
            let what = format!("section {tag} is missing; build the file again");
            FileError::at(FileErrorKind::Section, TABLE_START as u64, what)
        };
        self.optional(tag)?.ok_or_else(missing)
    }

    /// The list of a required section with `N` elements.
    pub(super) fn array<T: Element, const N: usize>(&self, tag: Tag) -> Result<[T; N], FileError> {
        let list = self.list(tag)?;
        <[T; N]>::try_from(&*list).map_err(|_| {
            let what = format!("section {tag} has {} elements instead of {N}", list.len());
            FileError {
                kind: FileErrorKind::Section,
                place: self.place(tag, 0),
                what: what + "; build the file again",
            }
        })
    }

    /// The place of an element in the file.
    pub(super) fn place(&self, tag: Tag, element: usize) -> Option<Place> {
        let section = self.table.iter().find(|section| section.tag == tag)?;
        let before = (element as u64).checked_mul(u64::from(section.element_bytes))?;
        section.offset.checked_add(before).map(Place::Byte)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WHERE: u64 = 112;

    /// A file without a valid header, with two sections of the numbers 0 to 3.
    fn file(change: impl FnOnce(&mut [Section; 2])) -> Vec<u8> {
        let section = Section { tag: Tag(*b"NUMS"), element_bytes: 4, offset: WHERE, count: 4 };
        let mut table = [section, Section { tag: Tag(*b"OTHR"), ..section }];
        change(&mut table);
        let mut bytes = vec![0; TABLE_START];
        bytes.extend(table.iter().flat_map(|section| section.to_bytes()));
        bytes.resize(112, 0);
        bytes.extend([0_u32, 1, 2, 3].iter().flat_map(|number| number.to_le_bytes()));
        bytes
    }

    fn numbers(change: impl FnOnce(&mut [Section; 2])) -> Result<Vec<u32>, String> {
        let file = file(change);
        let sections = Sections::read(&file, 2).map_err(|error| error.to_string())?;
        let list = sections.list::<u32>(Tag(*b"NUMS")).map_err(|error| error.to_string())?;
        Ok(list.into_owned())
    }

    #[test]
    fn lists_are_found_by_their_tags() {
        assert_eq!(numbers(|_| ()), Ok(vec![0, 1, 2, 3]));
        assert_eq!(numbers(|table| table.reverse()), Ok(vec![0, 1, 2, 3]));
        let file = file(|_| ());
        let sections = Sections::read(&file, 2).unwrap();
        assert_eq!(sections.array::<u32, 4>(Tag(*b"NUMS")), Ok([0, 1, 2, 3]));
        assert_eq!(
            sections.array::<u64, 2>(Tag(*b"OTHR")).unwrap_err().place,
            Some(Place::Byte(80))
        );
        assert_eq!(sections.optional::<u32>(Tag(*b"NONE")), Ok(None));
        assert_eq!(sections.place(Tag(*b"OTHR"), 3), Some(Place::Byte(WHERE + 12)));
        let error = sections.array::<u32, 5>(Tag(*b"NUMS")).unwrap_err();
        assert!(error.to_string().contains("byte 112: section NUMS has 4 elements instead of 5"));
    }

    #[test]
    fn faults_are_reported_with_the_entry_of_the_table() {
        let error = |change: fn(&mut [Section; 2])| numbers(change).unwrap_err();
        assert!(error(|table| table[0].tag.0 = *b"A\nB\xff").contains("section NUMS is missing"));
        let twice = error(|table| table[1].tag = table[0].tag);
        assert!(twice.starts_with("byte 80: section NUMS occurs twice"), "{twice}");
        let size = error(|table| (table[0].element_bytes, table[0].count) = (2, 8));
        assert!(
            size.starts_with("byte 56: section NUMS has elements of 2 bytes instead of 4"),
            "{size}"
        );
        for offset in [WHERE + 4, 96, 0] {
            let file = file(|table| (table[1].offset, table[1].count) = (offset, 0));
            let error = Sections::read(&file, 2).unwrap_err().to_string();
            let expected =
                format!("byte 80: section OTHR begins at byte {offset}, not at a multiple");
            assert!(error.starts_with(&expected), "{error}");
        }
    }

    #[test]
    fn sections_cannot_leave_the_file_by_large_numbers() {
        for (element_bytes, offset, count) in [
            (4, WHERE, 5),
            (4, WHERE + 16, 1),
            (4, 1 << 40, 0),
            (1, u64::MAX - 15, 16),
            (4, WHERE, 1 << 62),
            (u32::MAX, WHERE, u64::MAX),
        ] {
            let bytes = file(|table| {
                table[1] = Section { element_bytes, offset, count, ..table[1] };
            });
            let error = Sections::read(&bytes, 2).unwrap_err().to_string();
            assert!(error.starts_with("byte 80: section OTHR leaves the file"), "{error}");
        }
        let behind = file(|table| (table[1].offset, table[1].count) = (WHERE + 16, 0));
        assert!(Sections::read(&behind, 2).is_ok(), "an empty section at the end is within");
        for count in [4, u32::MAX] {
            let error = Sections::read(&behind, count).unwrap_err().to_string();
            assert!(error.starts_with("byte 12: a table of"), "{error}");
        }
    }
}
