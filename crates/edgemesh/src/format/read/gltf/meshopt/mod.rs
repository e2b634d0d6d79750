//! Buffer views compressed by `EXT_meshopt_compression` or `KHR_meshopt_compression`.
//!
//! Based on: the texts of both extensions, appendices A (bitstream) and B (filters).
//! KHR adds a second version of the attribute codec and the filter for colors; it is
//! read in both, because the stream says which version it is.
//!
//! ```text
//! bytes of another buffer --attributes, filters--> the bytes of the view
//!                         --triangles, indices-->
//! ```
//!
//! A view is decoded once, when an accessor first needs it. The buffer that the view
//! itself names is only for other readers and need not have data.

mod attributes;
mod filters;
mod indices;
mod triangles;
mod varint;

use gltf_json as json;
use serde::Deserialize;

use self::attributes::decode_attributes;
use self::filters::Filter;
use self::indices::decode_indices;
use self::triangles::decode_triangles;
use super::super::error::{ReadError, ReadErrorKind};
use super::asset::Asset;
use super::buffer::slice;

const NAMES: [&str; 2] = ["KHR_meshopt_compression", "EXT_meshopt_compression"];

/// The bytes that count as one element of the budget.
const ELEMENT_BYTES: u64 = 16;

/// The members of the extensions.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
struct Compression {
    /// The index of the buffer with compressed data.
    buffer: usize,
    #[serde(default)]
    byte_offset: u64,
    byte_length: u64,
    /// The bytes of an element.
    byte_stride: u64,
    /// The number of elements.
    count: u64,
    mode: Mode,
    #[serde(default)]
    filter: Filter,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
enum Mode {
    Attributes,
    Triangles,
    Indices,
}

/// The decoded bytes of a view; `None` if it is not compressed.
///
/// # Errors
/// Syntax: the extension or the stream is malformed. Size: the decoded bytes are too
/// many. Bounds and Uri: those of the buffer.
pub(super) fn decode(
    asset: &Asset,
    index: usize,
    view: &json::buffer::View,
) -> Result<Option<Vec<u8>>, ReadError> {
    let extensions = view.extensions.as_ref().map(|all| &all.others);
    let found = NAMES.iter().find_map(|&name| Some((name, extensions?.get(name)?)));
    let Some((name, members)) = found else { return Ok(None) };
    let part = || format!("bufferViews[{index}].extensions.{name}");
    let fail = |what: String| asset.error(ReadErrorKind::Syntax, part(), what);
    let compression = Compression::deserialize(members).map_err(|error| fail(error.to_string()))?;
    let Compression { buffer, byte_offset, byte_length, count, byte_stride, .. } = compression;
    compression.check(view.byte_length.0).map_err(fail)?;
    let size = count.saturating_mul(byte_stride).div_ceil(ELEMENT_BYTES);
    asset.spend(usize::try_from(size).unwrap_or(usize::MAX), part)?;
    let bytes = asset.buffer(buffer, part)?;
    let stream = slice(bytes, byte_offset, byte_length).ok_or_else(|| {
        let what = format!(
            "needs {byte_length} bytes from byte {byte_offset} of a buffer with {}",
            bytes.len()
        );
        asset.error(ReadErrorKind::Bounds, part(), what)
    })?;
    compression
        .decode(stream)
        .map(Some)
        .map_err(|what| fail(format!("the stream is invalid: {what}")))
}

impl Compression {
    /// Checks the members against each other and the length of the view.
    fn check(&self, view_length: u64) -> Result<(), String> {
        let Self { byte_stride: stride, count, mode, filter, .. } = *self;
        if count.checked_mul(stride) != Some(view_length) {
            return Err(format!(
                "has {count} elements of {stride} bytes for a view of {view_length} bytes"
            ));
        }
        let is_stride = match mode {
            Mode::Attributes => stride.is_multiple_of(4) && (4..=256).contains(&stride),
            Mode::Triangles | Mode::Indices => stride == 2 || stride == 4,
        };
        if !is_stride || !filter.takes(stride) {
            return Err(format!(
                "has elements of {stride} bytes, which its mode or filter forbids"
            ));
        }
        if mode != Mode::Attributes && filter != Filter::None {
            return Err("has a filter, which its mode forbids".into());
        }
        if mode == Mode::Triangles && !count.is_multiple_of(3) {
            return Err(format!("has {count} indices, which are not whole triangles"));
        }
        Ok(())
    }

    fn decode(&self, stream: &[u8]) -> Result<Vec<u8>, String> {
        let size = |number| usize::try_from(number).map_err(|_| "too large".to_owned());
        let (count, stride) = (size(self.count)?, size(self.byte_stride)?);
        match self.mode {
            Mode::Attributes => {
                let mut bytes = decode_attributes(stream, stride, count)?;
                self.filter.apply(&mut bytes, stride);
                Ok(bytes)
            }
            Mode::Triangles => Ok(to_bytes(&decode_triangles(stream, count / 3)?, stride)),
            Mode::Indices => Ok(to_bytes(&decode_indices(stream, count)?, stride)),
        }
    }
}

/// The indices as little-endian numbers of 2 or 4 bytes; those of 2 bytes wrap around.
fn to_bytes(indices: &[u32], stride: usize) -> Vec<u8> {
    let low = |index: &u32| {
        let [a, b, c, d] = index.to_le_bytes();
        [a, b, c, d].into_iter().take(stride)
    };
    indices.iter().flat_map(low).collect()
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::super::super::source::Source;
    use super::super::sample::{SQUARE, Sample, one_mesh, read};
    use super::*;
    use crate::report::Place;

    /// A triangle whose positions are compressed; `more` replaces members of the
    /// extension.
    fn triangle(name: &str, stream: &[u8], more: &Value) -> Value {
        let mut sample = Sample::default();
        let data = sample.view(stream, &json!({}));
        let compression = super::super::sample::joined(
            json!({
                "buffer": 0, "byteLength": stream.len(), "byteStride": 12, "mode": "ATTRIBUTES",
                "count": 3
            }),
            more,
        );
        let positions = sample.accessor(json!({
            "bufferView": data + 1, "componentType": 5126, "count": 3, "type": "VEC3",
            "min": [0, 0, 0], "max": [1, 1, 0]
        }));
        let mut file = sample.json(&one_mesh(&json!({"attributes": {"POSITION": positions}})));
        file["extensionsUsed"] = json!([name]);
        file["extensionsRequired"] = json!([name]);
        file["buffers"].as_array_mut().unwrap().push(json!({
            "byteLength": 36, "extensions": {name: {"fallback": true}}
        }));
        file["bufferViews"].as_array_mut().unwrap().push(json!({
            "buffer": 1, "byteLength": 36, "extensions": {name: compression}
        }));
        file
    }

    /// The positions of the triangle as version 0, with the bytes of each delta whole.
    fn stream() -> Vec<u8> {
        let elements: Vec<Vec<u8>> = SQUARE[..3]
            .iter()
            .map(|position| position.iter().flat_map(|x| x.to_le_bytes()).collect())
            .collect();
        super::attributes::whole_bytes_stream(&elements)
    }

    #[test]
    fn compressed_positions_are_read_without_their_fallback() {
        for name in NAMES {
            let (model, report) = read(&triangle(name, &stream(), &json!({}))).unwrap();
            let corners = SQUARE.map(|position| position.map(f64::from));
            assert_eq!(model.positions, corners[..3], "{name}");
            assert!(report.warnings().is_empty(), "{report:?}");
        }
    }

    #[test]
    fn wrong_members_and_streams_are_errors_at_their_view() {
        use ReadErrorKind::{Bounds, Syntax};
        let name = NAMES[1];
        let long = stream().len() + 9;
        let cut = stream().len() - 1;
        for (more, kind, what) in [
            (json!({"count": 4}), Syntax, "4 elements of 12 bytes for a view of 36"),
            (json!({"byteStride": 6, "count": 6}), Syntax, "6 bytes, which its mode"),
            (json!({"mode": "POINTS"}), Syntax, "POINTS"),
            (json!({"mode": "TRIANGLES"}), Syntax, "12 bytes, which its mode"),
            (
                json!({"mode": "TRIANGLES", "byteStride": 4, "count": 9, "filter": "COLOR"}),
                Syntax,
                "has a filter",
            ),
            (
                json!({"mode": "TRIANGLES", "byteStride": 4, "count": 9}),
                Syntax,
                "the stream is invalid",
            ),
            (
                json!({"mode": "TRIANGLES", "byteStride": 2, "count": 18, "byteLength": 0}),
                Syntax,
                "the stream is invalid",
            ),
            (json!({"filter": "QUATERNION"}), Syntax, "12 bytes, which its mode or filter"),
            (json!({"byteLength": long}), Bounds, "from byte 0 of a buffer"),
            (json!({"byteOffset": u64::MAX}), Bounds, "from byte 18446744073709551615"),
            (json!({"byteLength": cut}), Syntax, "the stream is invalid"),
            (json!({"buffer": 7}), Syntax, "buffers[7]"),
            (json!({"buffer": null}), Syntax, "invalid type"),
        ] {
            let error = read(&triangle(name, &stream(), &more)).unwrap_err();
            let place = Place::Part(format!("bufferViews[1].extensions.{name}"));
            assert_eq!((error.kind, &error.place), (kind, &Some(place)), "{more}: {error}");
            assert!(error.what.contains(what), "{error}");
        }
    }

    #[test]
    fn decoded_bytes_count() {
        // A stream of zeros is a thousand times as long as its control bytes.
        let count = (1_u64 << 32) / 4 + 1;
        let more = json!({"byteStride": 4, "count": count});
        let mut file = triangle(NAMES[0], &stream(), &more);
        file["bufferViews"][1]["byteLength"] = (count * 4).into();
        assert_eq!(read(&file).unwrap_err().kind, ReadErrorKind::Size);
    }

    #[test]
    fn damaged_streams_never_panic() {
        let stream = stream();
        for at in 0..stream.len() {
            for value in [0, 1, 0x7f, 0xff] {
                let mut changed = stream.clone();
                changed[at] = value;
                let text = triangle(NAMES[0], &changed, &json!({})).to_string();
                let source = Source { name: "test.gltf", folder: None, bytes: text.as_bytes() };
                let _ = super::super::sample::read_source(&source);
            }
        }
    }
}
