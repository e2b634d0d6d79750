//! The binary container GLB.
//!
//! Based on: glTF 2.0, section 4.4 (binary glTF layout).
//!
//! ```text
//! 0    4        8       12      16      20
//! glTF version  length  length  "JSON"  text, blanks  length  "BIN\0"  bytes  ...
//! |---- header -------| |------ chunk 0 ------------| |------ chunk 1 ------| others
//! ```
//!
//! Some programs (Blender 2.80, older exporters of three.js) do not pad a chunk to a multiple
//! of 4 bytes, or pad it and state its length without the padding. Nothing is lost by that, so
//! such files are read, with a warning.

use super::super::byte_order_mark::without_mark;
use super::super::error::{ReadError, ReadErrorKind};
use super::super::source::Source;
use crate::format::little_endian::u32_at;
use crate::report::{Place, Report, WarningCode};

const MAGIC: &[u8] = b"glTF";
const HEADER_BYTES: usize = 12;
const CHUNK_HEADER_BYTES: usize = 8;
const JSON: u32 = u32::from_le_bytes(*b"JSON");
const BINARY: u32 = u32::from_le_bytes(*b"BIN\0");

/// What to do about glTF 1.0.
pub(super) const CONVERT_VERSION_1: &str =
    "convert it to glTF 2.0, with `gltf-pipeline -i IN -o OUT`";

/// The JSON and the binary data of a file in either form.
#[derive(Debug)]
pub(super) struct Container<'a> {
    /// The JSON text.
    pub(super) json: &'a [u8],
    /// Its offset in a binary file; `None` for a text file, whose places are lines.
    pub(super) json_offset: Option<usize>,
    /// The binary chunk, if the file has one.
    pub(super) binary: Option<&'a [u8]>,
}

/// Finds the JSON and the binary chunk of a file.
///
/// # Errors
/// Fails if the file breaks a rule of the container, with the offset in bytes.
pub(super) fn open<'a>(
    source: &Source<'a>,
    report: &mut Report,
) -> Result<Container<'a>, ReadError> {
    if source.bytes.starts_with(MAGIC) {
        let bytes = check_header(source, report)?;
        return open_chunks(source, bytes, report);
    }
    let json = without_mark(source.bytes);
    if json.len() < source.bytes.len() {
        report.warn(WarningCode::Syntax, Some(Place::Byte(0)), || {
            "a byte order mark, which glTF forbids, was skipped".into()
        });
    }
    Ok(Container { json, json_offset: None, binary: None })
}

/// The bytes of the file up to the length that the header states.
fn check_header<'a>(source: &Source<'a>, report: &mut Report) -> Result<&'a [u8], ReadError> {
    let bytes = source.bytes;
    let fail =
        |kind, offset, what: String| Err(source.error(kind, Some(Place::Byte(offset)), what));
    let (Some(version), Some(length)) = (u32_at(bytes, 4), u32_at(bytes, 8)) else {
        let what = format!("the file ends within its header, after {} of 12 bytes", bytes.len());
        return fail(ReadErrorKind::Truncated, bytes.len() as u64, what);
    };
    if version != 2 {
        let what = format!(
            "binary glTF version {version} is not supported; {}",
            match version {
                1 => CONVERT_VERSION_1,
                _ => "export it as version 2",
            }
        );
        return fail(ReadErrorKind::Format, 4, what);
    }
    let Some(whole) = bytes.get(..length as usize) else {
        let what = format!("the header states {length} bytes, and the file has {}", bytes.len());
        return fail(ReadErrorKind::Truncated, bytes.len() as u64, what);
    };
    if whole.len() < HEADER_BYTES + CHUNK_HEADER_BYTES {
        let what = format!("the header states {length} bytes, too few for a chunk");
        return fail(ReadErrorKind::Format, 8, what);
    }
    if whole.len() < bytes.len() {
        report.warn(WarningCode::Truncated, Some(Place::Byte(whole.len() as u64)), || {
            format!("{} bytes after the stated end were skipped", bytes.len() - whole.len())
        });
    }
    Ok(whole)
}

fn open_chunks<'a>(
    source: &Source<'a>,
    bytes: &'a [u8],
    report: &mut Report,
) -> Result<Container<'a>, ReadError> {
    let first = chunk_at(source, bytes, HEADER_BYTES, report)?;
    let at = |offset: usize| Some(Place::Byte(offset as u64));
    if first.kind != JSON {
        let what = format!("the first chunk has type {:#010x} instead of JSON", first.kind);
        return Err(source.error(ReadErrorKind::Syntax, at(HEADER_BYTES), what));
    }
    let mut binary = None;
    let second = first.end;
    let mut offset = second;
    while offset < bytes.len() {
        let chunk = chunk_at(source, bytes, offset, report)?;
        match chunk.kind {
            BINARY if offset == second => binary = Some(chunk.bytes),
            BINARY | JSON => {
                let what = "a JSON chunk must be the first, and a BIN chunk the second";
                return Err(source.error(ReadErrorKind::Syntax, at(offset), what));
            }
            // Chunks of other types belong to extensions.
            _ => {}
        }
        offset = chunk.end;
    }
    let json_offset = Some(HEADER_BYTES + CHUNK_HEADER_BYTES);
    Ok(Container { json: first.bytes, json_offset, binary })
}

struct Chunk<'a> {
    kind: u32,
    bytes: &'a [u8],
    /// The offset of the next chunk, or of the end of the file.
    end: usize,
}

fn chunk_at<'a>(
    source: &Source,
    bytes: &'a [u8],
    offset: usize,
    report: &mut Report,
) -> Result<Chunk<'a>, ReadError> {
    let place = Place::Byte(offset as u64);
    let fail =
        |what: String| Err(source.error(ReadErrorKind::Truncated, Some(place.clone()), what));
    let (Some(length), Some(kind)) = (u32_at(bytes, offset), u32_at(bytes, offset + 4)) else {
        return fail("the file ends within the header of a chunk".into());
    };
    let start = offset + CHUNK_HEADER_BYTES;
    let rest = bytes.get(start..).unwrap_or_default();
    let Some(inside) = rest.get(..length as usize) else {
        return fail(format!(
            "a chunk states {length} bytes, and the file has {} more",
            rest.len()
        ));
    };
    if !length.is_multiple_of(4) {
        report.warn(WarningCode::Syntax, Some(place), || {
            format!(
                "a chunk has {length} bytes, which is not a multiple of 4; it was read as it is"
            )
        });
    }
    Ok(Chunk { kind, bytes: inside, end: end_of_chunk(bytes, start + inside.len()) })
}

/// The offset of what follows a chunk whose bytes end at `end`: there, or at the next multiple
/// of 4 if the padding is not part of the stated length.
///
/// The type of a chunk cannot be read at both offsets, because they are fewer than 4 bytes
/// apart.
fn end_of_chunk(bytes: &[u8], end: usize) -> usize {
    let padded = end.next_multiple_of(4).min(bytes.len());
    let is_padding = bytes[end..padded].iter().all(|byte| matches!(byte, 0 | b' '));
    let is_last = padded == bytes.len();
    let has_chunk = u32_at(bytes, padded + 4).is_some_and(|kind| matches!(kind, JSON | BINARY));
    if is_padding && (is_last || has_chunk) { padded } else { end }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn header(version: u32, length: u32) -> Vec<u8> {
        [MAGIC, &version.to_le_bytes(), &length.to_le_bytes()].concat()
    }

    fn chunk(kind: u32, bytes: &[u8]) -> Vec<u8> {
        let length = u32::try_from(bytes.len()).unwrap();
        [&length.to_le_bytes(), &kind.to_le_bytes(), bytes].concat()
    }

    fn file(chunks: &[Vec<u8>]) -> Vec<u8> {
        let body = chunks.concat();
        let length = u32::try_from(HEADER_BYTES + body.len()).unwrap();
        [header(2, length), body].concat()
    }

    fn opened(bytes: &[u8], report: &mut Report) -> Result<(Vec<u8>, Option<Vec<u8>>), ReadError> {
        let source = Source { name: "test.glb", folder: None, bytes };
        let container = open(&source, report)?;
        Ok((container.json.to_vec(), container.binary.map(<[u8]>::to_vec)))
    }

    fn refusal(bytes: &[u8]) -> (ReadErrorKind, Option<Place>) {
        let error = opened(bytes, &mut Report::default()).unwrap_err();
        (error.kind, error.place)
    }

    #[test]
    fn chunks_are_found_and_others_skipped() {
        let other = u32::from_le_bytes(*b"ACME");
        let chunks = [chunk(JSON, b"{}  "), chunk(BINARY, b"1234"), chunk(other, b"5678")];
        let found = opened(&file(&chunks), &mut Report::default()).unwrap();
        assert_eq!(found, (b"{}  ".to_vec(), Some(b"1234".to_vec())));
        let found = opened(&file(&chunks[..1]), &mut Report::default()).unwrap();
        assert_eq!(found.1, None);
    }

    #[test]
    fn each_rule_of_the_header() {
        let at = |byte| Some(Place::Byte(byte));
        assert_eq!(refusal(b"glTF\x02\0\0"), (ReadErrorKind::Truncated, at(7)));
        assert_eq!(refusal(&header(1, 12)), (ReadErrorKind::Format, at(4)));
        assert_eq!(refusal(&header(2, 0)), (ReadErrorKind::Format, at(8)));
        assert_eq!(refusal(&header(2, 12)), (ReadErrorKind::Format, at(8)));
        assert_eq!(refusal(&header(2, 13)), (ReadErrorKind::Truncated, at(12)));
    }

    #[test]
    fn each_rule_of_the_chunks() {
        let at = |byte| Some(Place::Byte(byte));
        let json = chunk(JSON, b"{}  ");
        let refused = |chunks: &[Vec<u8>]| refusal(&file(chunks));
        assert_eq!(refused(&[chunk(BINARY, b"")]), (ReadErrorKind::Syntax, at(12)));
        assert_eq!(
            refused(&[chunk(JSON, b"{}"), vec![b'x'; 3]]),
            (ReadErrorKind::Truncated, at(22))
        );
        assert_eq!(refused(&[json.clone(), json.clone()]), (ReadErrorKind::Syntax, at(24)));
        let binary = chunk(BINARY, b"");
        let twice = [json.clone(), binary.clone(), binary];
        assert_eq!(refused(&twice), (ReadErrorKind::Syntax, at(32)));
        assert_eq!(refused(&[json.clone(), vec![0; 7]]), (ReadErrorKind::Truncated, at(24)));
        let cut = [json, chunk(BINARY, b"1234")[..10].to_vec()];
        assert_eq!(refused(&cut), (ReadErrorKind::Truncated, at(24)));
    }

    #[test]
    fn chunks_need_no_padding() {
        let [json, binary] = [chunk(JSON, b"{}"), chunk(BINARY, b"12345")];
        let padding = |bytes: &[u8]| bytes.to_vec();
        for (chunks, warnings) in [
            (vec![json.clone(), binary.clone()], 2),
            (vec![json.clone(), chunk(BINARY, b"12345\0\0\0")], 1),
            (vec![json.clone(), padding(b"  "), binary.clone()], 2),
            (vec![json.clone(), padding(b"  "), binary.clone(), padding(b"\0\0\0")], 2),
            (vec![chunk(JSON, b"{}  "), binary], 1),
        ] {
            let mut report = Report::default();
            let (text, data) = opened(&file(&chunks), &mut report).unwrap();
            assert_eq!((text.trim_ascii(), &data.unwrap()[..5]), (&b"{}"[..], &b"12345"[..]));
            assert_eq!(report.count(WarningCode::Syntax), warnings, "{report:?}");
        }
        let mut report = Report::default();
        assert_eq!(opened(&file(&[json]), &mut report).unwrap(), (b"{}".to_vec(), None));
        assert_eq!(report.warnings()[0].place, Some(Place::Byte(12)));
    }

    #[test]
    fn bytes_after_the_stated_end_are_skipped_with_a_warning() {
        let mut report = Report::default();
        let bytes = [file(&[chunk(JSON, b"{}  ")]), b"more".to_vec()].concat();
        assert!(opened(&bytes, &mut report).is_ok());
        assert_eq!(report.warnings()[0].place, Some(Place::Byte(24)));
    }

    #[test]
    fn text_files_are_json() {
        let mut report = Report::default();
        assert_eq!(opened(b"{}", &mut report).unwrap(), (b"{}".to_vec(), None));
        assert!(report.warnings().is_empty());
        assert_eq!(opened(b"\xef\xbb\xbf{}", &mut report).unwrap(), (b"{}".to_vec(), None));
        assert_eq!(report.count(WarningCode::Syntax), 1);
    }
}
