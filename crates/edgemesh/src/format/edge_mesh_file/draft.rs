//! Files built by hand, for tests with content that the writer never writes.
//!
//! This code shares nothing with the reader and the writer, so that it does not repeat
//! their mistakes in the layout.

/// A version 1 file of one triangle, written by another program; its model has lost two
/// degenerate triangles, and its frame has a moved origin.
pub(super) const TRIANGLE: &[u8] = include_bytes!("../../../tests/data/triangle-v1.edgemesh");

/// A file as a list of sections.
#[derive(Debug, Clone)]
pub(super) struct Draft {
    pub(super) version: u32,
    pub(super) sections: Vec<DraftSection>,
}

#[derive(Debug, Clone)]
pub(super) struct DraftSection {
    pub(super) tag: [u8; 4],
    pub(super) element_bytes: u32,
    pub(super) bytes: Vec<u8>,
}

impl Draft {
    /// The sections of [`TRIANGLE`].
    pub(super) fn triangle() -> Self {
        let number = |at: usize| u32::from_le_bytes(*TRIANGLE[at..].first_chunk().unwrap());
        let section = |entry: usize| {
            let [size, start, count] = [4, 8, 16].map(|field| number(entry + field));
            let bytes = &TRIANGLE[start as usize..(start + size * count) as usize];
            let tag = *TRIANGLE[entry..].first_chunk().unwrap();
            DraftSection { tag, element_bytes: size, bytes: bytes.to_vec() }
        };
        let sections = (0..number(12) as usize).map(|index| section(56 + 24 * index)).collect();
        Self { version: number(8), sections }
    }

    /// The triangle with a group and two materials, of which the second has a picture.
    pub(super) fn with_materials() -> Self {
        let mut draft = Self::triangle();
        let numbers = |numbers: &[u32]| -> Vec<u8> {
            numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
        };
        draft.push("FRUN", 16, &numbers(&[0, 1, 0, 1]));
        let mut materials = [0; 26];
        materials[12] = u32::MAX;
        // A diffuse color of 1, 0.5, 0 and an opacity of 0.25.
        materials[13 + 3..13 + 5].copy_from_slice(&[0x3f80_0000, 0x3f00_0000]);
        materials[13 + 10] = 0x3e80_0000;
        materials[13 + 11..].copy_from_slice(&[0b1_0010, 1]);
        draft.push("MTRL", 52, &numbers(&materials));
        draft.push("PEND", 8, &numbers(&[3, 0, 10, 0]));
        draft.push("PICT", 1, b"onepicture");
        draft.section("META").bytes = br#"{"name": "textured", "groups": ["g"], "materials":
            [{"name": "plain"}, {"name": "m", "texture": "m.png"}]}"#
            .to_vec();
        draft
    }

    /// The bytes of the file, with a correct checksum.
    pub(super) fn to_bytes(&self) -> Vec<u8> {
        let count = u32::try_from(self.sections.len()).unwrap();
        let mut table = Vec::new();
        let mut content = Vec::new();
        let table_end = 56 + 24 * self.sections.len();
        content.resize((16 - table_end % 16) % 16, 0);
        for DraftSection { tag, element_bytes, bytes } in &self.sections {
            let elements = bytes.len() / *element_bytes as usize;
            table.extend(tag);
            table.extend(element_bytes.to_le_bytes());
            table.extend(((table_end + content.len()) as u64).to_le_bytes());
            table.extend((elements as u64).to_le_bytes());
            content.extend(bytes);
            content.resize(content.len() + (16 - bytes.len() % 16) % 16, 0);
        }
        let mut head = b"EDGEMESH".to_vec();
        head.extend(self.version.to_le_bytes());
        head.extend(count.to_le_bytes());
        head.extend(((table_end + content.len()) as u64).to_le_bytes());
        let mut bytes = [head, vec![0; 32], table, content].concat();
        seal(&mut bytes);
        bytes
    }

    pub(super) fn section(&mut self, tag: &str) -> &mut DraftSection {
        let mut sections = self.sections.iter_mut();
        sections.find(|section| section.tag == tag.as_bytes()).unwrap()
    }

    /// Sets the 32-bit number with this index in a section.
    pub(super) fn set(&mut self, tag: &str, index: usize, number: u32) {
        let bytes = &mut self.section(tag).bytes;
        bytes[4 * index..4 * index + 4].copy_from_slice(&number.to_le_bytes());
    }

    /// Resizes a section to `count` elements; new ones are zero.
    pub(super) fn resize(&mut self, tag: &str, count: usize) {
        let section = self.section(tag);
        section.bytes.resize(count * section.element_bytes as usize, 0);
    }

    pub(super) fn remove(&mut self, tag: &str) {
        self.sections.retain(|section| section.tag != tag.as_bytes());
    }

    pub(super) fn push(&mut self, tag: &str, element_bytes: u32, bytes: &[u8]) {
        let tag = *tag.as_bytes().first_chunk().unwrap();
        self.sections.push(DraftSection { tag, element_bytes, bytes: bytes.to_vec() });
    }
}

/// Updates the checksum of a changed file.
pub(super) fn seal(bytes: &mut [u8]) {
    let sum = blake3::hash(&[&bytes[..24], &bytes[56..]].concat());
    bytes[24..56].copy_from_slice(sum.as_bytes());
}
