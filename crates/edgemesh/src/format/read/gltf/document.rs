//! The JSON of a file: the parts that geometry and materials need.
//!
//! Cameras and animations are not parsed. Textures and images are parsed one by one
//! when a material uses them, so that a fault in them does not stop the model. The
//! elements are those of `gltf-json`, except where it is stricter than the
//! specification.

use gltf_json as json;
use json::validation::Checked;
use serde::Deserialize;
use serde_json::Value;
use serde_json::error::Category;

use super::super::error::{ReadError, ReadErrorKind};
use super::super::source::Source;
use super::glb::{CONVERT_VERSION_1, Container};
use crate::report::{Place, Report};

/// The most objects in the JSON: a node of two bytes takes about 300 bytes of memory.
const MAX_OBJECTS: usize = 1 << 23;

/// Checks the JSON against rules that do not stop the reader, and adds warnings.
pub(in crate::format::read) type RuleCheck = fn(&Value, &mut Report);

/// The parts of the JSON that are read.
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
    pub(super) accessors: Vec<Accessor>,
    #[serde(default)]
    pub(super) materials: Vec<json::Material>,
    /// A list, unless the file is broken.
    #[serde(default)]
    pub(super) textures: Value,
    /// A list, unless the file is broken.
    #[serde(default)]
    pub(super) images: Value,
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

/// An accessor. In `gltf-json` it cannot have signed 32-bit integers.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Accessor {
    pub(super) buffer_view: Option<json::Index<json::buffer::View>>,
    pub(super) byte_offset: Option<json::validation::USize64>,
    pub(super) component_type: u32,
    pub(super) count: json::validation::USize64,
    #[serde(rename = "type")]
    pub(super) type_: Checked<json::accessor::Type>,
    pub(super) min: Option<Value>,
    pub(super) max: Option<Value>,
    #[serde(default)]
    pub(super) normalized: bool,
    pub(super) sparse: Option<json::accessor::sparse::Sparse>,
}

/// Nodes that are drawn together.
#[derive(Debug, Default, Deserialize)]
pub(super) struct Scene {
    /// Its roots; may be empty, which `gltf-json` refuses.
    #[serde(default)]
    pub(super) nodes: Vec<usize>,
}

/// Parses the JSON, after `check_rules` has warned of the rules that it breaks.
///
/// # Errors
/// Fails if it is not JSON, not glTF 2.0, or too large.
pub(super) fn parse(
    source: &Source,
    container: &Container,
    check_rules: RuleCheck,
    report: &mut Report,
) -> Result<Document, ReadError> {
    let json = container.json;
    if json.trim_ascii().is_empty() {
        return Err(source.error(ReadErrorKind::Empty, None, "the JSON is empty"));
    }
    let objects = json.iter().filter(|&&byte| byte == b'{').count();
    if objects > MAX_OBJECTS {
        let what = format!("too large: {objects} objects; the limit is {MAX_OBJECTS}");
        return Err(source.error(ReadErrorKind::Size, None, what));
    }
    let fail = |error| json_error(source, container, &error);
    let value = serde_json::from_slice(json).map_err(fail)?;
    check_not_version_1(source, &value)?;
    check_rules(&value, report);
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
    source.error(kind, Some(place), format!("the JSON is not glTF: {error}"))
}

/// The offset of a line and column, both counted from 1.
fn json_position(text: &[u8], line: usize, column: usize) -> usize {
    let lines_before = text.split_inclusive(|&byte| byte == b'\n').take(line.saturating_sub(1));
    let start: usize = lines_before.map(<[u8]>::len).sum();
    (start + column.saturating_sub(1)).min(text.len())
}

/// Fails for glTF 1.0, whose lists are objects, so that it cannot be parsed further. Its
/// version need not be stated.
fn check_not_version_1(source: &Source, json: &Value) -> Result<(), ReadError> {
    let stated = json.pointer("/asset/version").and_then(Value::as_str);
    let is_object = |name: &&str| json.get(name).is_some_and(Value::is_object);
    let list = ["accessors", "meshes", "nodes", "buffers"].into_iter().find(is_object);
    let part = match (stated, list) {
        (Some(version), _) if version.starts_with("1.") => "asset.version",
        (None, Some(list)) => list,
        _ => return Ok(()),
    };
    let what = format!("is of glTF 1.0, which is not supported; {CONVERT_VERSION_1}");
    Err(source.error(ReadErrorKind::Format, Some(Place::Part(part.into())), what))
}

fn check_version(source: &Source, document: &Document) -> Result<(), ReadError> {
    let asset = &document.asset;
    let fail = |part: &str, what: String| {
        Err(source.error(ReadErrorKind::Format, Some(Place::Part(part.into())), what))
    };
    if version(&asset.version).is_none_or(|(major, _)| major != 2) {
        let what = format!("glTF version '{}' is not supported; convert it to 2.0", asset.version);
        return fail("asset.version", what);
    }
    match &asset.min_version {
        Some(least) if version(least).is_none_or(|least| least > (2, 0)) => fail(
            "asset.minVersion",
            format!("requires a reader of glTF '{least}'; this one reads 2.0"),
        ),
        _ => Ok(()),
    }
}

/// The major and minor number of a version such as `2.0`.
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
        parse(&source, &container, |_, _| (), &mut Report::default()).unwrap_err()
    }

    #[test]
    fn errors_in_the_text_have_their_place() {
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
    fn the_first_version_is_named_with_what_converts_it() {
        for (json, part) in [
            (r#"{"asset": {"version": "1.0"}, "accessors": {"a": {}}}"#, "asset.version"),
            (r#"{"asset": {"version": "1.1"}, "meshes": []}"#, "asset.version"),
            (r#"{"meshes": {"m": {"primitives": []}}}"#, "meshes"),
            (r#"{"asset": {"generator": "old"}, "nodes": {"n": {}}}"#, "nodes"),
        ] {
            let error = refusal(json, None);
            let place = Some(Place::Part(part.into()));
            assert_eq!((error.kind, &error.place), (ReadErrorKind::Format, &place), "{error}");
            assert!(error.what.contains("glTF 1.0") && error.what.contains("gltf-pipeline"));
        }
        let error = refusal(r#"{"asset": {"version": "2.0"}, "nodes": {}}"#, None);
        assert_eq!(error.kind, ReadErrorKind::Syntax, "a fault of glTF 2.0");
    }

    #[test]
    fn too_many_objects_are_refused() {
        let error = refusal(&format!("[{}", "{},".repeat(MAX_OBJECTS + 1)), None);
        assert_eq!(error.kind, ReadErrorKind::Size);
    }

    #[test]
    fn faults_that_do_not_affect_geometry_are_ignored() {
        let json = br#"{"asset": {"version": "2.1", "minVersion": "2.0"}, "images": 7,
            "animations": [{"channels": [{"target": {"path": "pointer"}}]}], "scenes": [{}]}"#;
        let source = Source { name: "test.gltf", folder: None, bytes: json };
        let container = Container { json, json_offset: None, binary: None };
        let document = parse(&source, &container, |_, _| (), &mut Report::default()).unwrap();
        assert!(document.scenes[0].nodes.is_empty());
    }
}
