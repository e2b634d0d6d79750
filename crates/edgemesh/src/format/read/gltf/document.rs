//! The JSON of a file, as far as geometry and its looks need it.
//!
//! Cameras and animations are not even looked at, textures and pictures only one
//! by one where a material shows them, so that no fault of theirs stops a model;
//! `lint` tells of them. The elements are
//! those of `gltf-json`, except where it demands more than the specification
//! does.

use gltf_json as json;
use serde::Deserialize;
use serde_json::error::Category;

use super::super::error::{ReadError, ReadErrorKind};
use super::super::source::Source;
use super::glb::Container;
use super::lint;
use crate::report::{Place, Report};

/// At most this many objects: a node takes two bytes of text and some 300 of
/// memory, and so would an endless list of them.
const MAX_OBJECTS: usize = 1 << 23;

/// The parts of a file that geometry is made of.
#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Document {
    pub(super) asset: json::Asset,
    #[serde(default)]
    pub(super) extensions_required: Vec<String>,
    #[serde(default)]
    pub(super) buffers: Vec<json::Buffer>,
    #[serde(default)]
    pub(super) buffer_views: Vec<json::buffer::View>,
    #[serde(default)]
    pub(super) accessors: Vec<json::Accessor>,
    #[serde(default)]
    pub(super) materials: Vec<json::Material>,
    /// A list, if anybody looks into it.
    #[serde(default)]
    pub(super) textures: serde_json::Value,
    /// A list, if anybody looks into it.
    #[serde(default)]
    pub(super) images: serde_json::Value,
    #[serde(default)]
    pub(super) meshes: Vec<json::Mesh>,
    #[serde(default)]
    pub(super) skins: Vec<json::Skin>,
    #[serde(default)]
    pub(super) nodes: Vec<json::Node>,
    #[serde(default)]
    pub(super) scenes: Vec<Scene>,
    pub(super) scene: Option<usize>,
}

/// Nodes that are drawn together.
#[derive(Debug, Default, Deserialize)]
pub(super) struct Scene {
    /// Its roots; a scene may be empty, which `gltf-json` refuses.
    #[serde(default)]
    pub(super) nodes: Vec<usize>,
}

/// Reads the JSON, after telling of what is odd in it.
///
/// # Errors
/// Where it is no JSON, no glTF, not of version 2, or too large.
pub(super) fn parse(
    source: &Source,
    container: &Container,
    report: &mut Report,
) -> Result<Document, ReadError> {
    let json = container.json;
    if json.trim_ascii().is_empty() {
        return Err(source.error(ReadErrorKind::Empty, None, "no JSON: the file is empty"));
    }
    let objects = json.iter().filter(|&&byte| byte == b'{').count();
    if objects > MAX_OBJECTS {
        let what = format!("too large: {objects} objects, at most {MAX_OBJECTS} are read");
        return Err(source.error(ReadErrorKind::Size, None, what));
    }
    let fail = |error| json_error(source, container, &error);
    lint::check(&serde_json::from_slice(json).map_err(fail)?, report);
    let document = serde_json::from_slice(json).map_err(fail)?;
    check_version(source, &document)?;
    Ok(document)
}

fn json_error(source: &Source, container: &Container, error: &serde_json::Error) -> ReadError {
    let kind = match error.classify() {
        Category::Eof => ReadErrorKind::Truncated,
        _ => ReadErrorKind::Syntax,
    };
    let place = match container.json_offset {
        None => Place::Line(u32::try_from(error.line()).unwrap_or(u32::MAX)),
        Some(offset) => {
            let before = json_position(container.json, error.line(), error.column());
            Place::Byte((offset + before) as u64)
        }
    };
    source.error(kind, Some(place), format!("the JSON is no glTF: {error}"))
}

/// Where a line and column, both counted from 1, are in a text.
fn json_position(text: &[u8], line: usize, column: usize) -> usize {
    let lines_before = text.split_inclusive(|&byte| byte == b'\n').take(line.saturating_sub(1));
    let start: usize = lines_before.map(<[u8]>::len).sum();
    (start + column.saturating_sub(1)).min(text.len())
}

fn check_version(source: &Source, document: &Document) -> Result<(), ReadError> {
    let asset = &document.asset;
    let fail = |part: &str, what: String| {
        Err(source.error(ReadErrorKind::Format, Some(Place::Part(part.into())), what))
    };
    if version(&asset.version).is_none_or(|(major, _)| major != 2) {
        let what = format!("glTF of version '{}'; convert it to 2.0", asset.version);
        return fail("asset.version", what);
    }
    match &asset.min_version {
        Some(least) if version(least).is_none_or(|least| least > (2, 0)) => fail(
            "asset.minVersion",
            format!("needs a reader of glTF '{least}', this one reads 2.0"),
        ),
        _ => Ok(()),
    }
}

/// The two numbers of a version such as 2.0.
fn version(text: &str) -> Option<(u32, u32)> {
    let (major, minor) = text.split_once('.')?;
    Some((major.parse().ok()?, minor.parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(json: &str, json_offset: Option<usize>) -> ReadError {
        let source = Source { name: "test.gltf", folder: None, bytes: json.as_bytes() };
        let container = Container { json: json.as_bytes(), json_offset, binary: None };
        parse(&source, &container, &mut Report::default()).unwrap_err()
    }

    #[test]
    fn faults_of_the_text_have_their_place() {
        let error = refusal("{\n\"asset\": }", None);
        assert_eq!((error.kind, error.place), (ReadErrorKind::Syntax, Some(Place::Line(2))));
        let error = refusal("{\n\"asset\": }", Some(20));
        assert_eq!(error.place, Some(Place::Byte(31)), "the brace");
        let error = refusal("{\n\"asset\": {", None);
        assert_eq!((error.kind, error.place), (ReadErrorKind::Truncated, Some(Place::Line(2))));
        let error = refusal(r#"{"asset": {"version": "2.0"}, "nodes": 7}"#, None);
        assert_eq!(error.kind, ReadErrorKind::Syntax);
        assert!(error.what.contains("expected a sequence"), "{error}");
        assert_eq!(refusal("  \n", None).kind, ReadErrorKind::Empty);
        assert!(refusal(&"[".repeat(100_000), None).what.contains("recursion"));
    }

    #[test]
    fn only_version_two_is_read() {
        let kind = |version: &str| refusal(&format!(r#"{{"asset": {{{version}}}}}"#), None).kind;
        assert_eq!(kind(r#""version": "1.0""#), ReadErrorKind::Format);
        assert_eq!(kind(r#""version": "two""#), ReadErrorKind::Format);
        assert_eq!(kind(r#""version": "2.1", "minVersion": "2.1""#), ReadErrorKind::Format);
        assert_eq!(kind(r#""minVersion": "2.0""#), ReadErrorKind::Syntax, "no version");
    }

    #[test]
    fn endless_lists_are_refused() {
        let error = refusal(&format!("[{}", "{},".repeat(MAX_OBJECTS + 1)), None);
        assert_eq!(error.kind, ReadErrorKind::Size);
    }

    #[test]
    fn what_geometry_does_not_need_is_not_looked_at() {
        let json = br#"{"asset": {"version": "2.1", "minVersion": "2.0"}, "images": 7,
            "animations": [{"channels": [{"target": {"path": "pointer"}}]}], "scenes": [{}]}"#;
        let source = Source { name: "test.gltf", folder: None, bytes: json };
        let container = Container { json, json_offset: None, binary: None };
        let document = parse(&source, &container, &mut Report::default()).unwrap();
        assert!(document.scenes[0].nodes.is_empty());
    }
}
