//! Required extensions, and those that replace geometry.

use gltf_json::mesh::Semantic;
use gltf_json::validation::Checked;

use super::super::error::{ReadError, ReadErrorKind};
use super::super::source::Source;
use super::document::Document;
use super::primitive::Primitive;
use crate::report::Place;

/// Extensions that are supported, or do not affect geometry; a name that ends with
/// `_` stands for all names with this prefix.
const SUPPORTED_OR_HARMLESS: [&str; 20] = [
    "KHR_mesh_quantization",
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "KHR_meshopt_compression",
    "KHR_node_visibility",
    "EXT_mesh_primitive_edge_visibility",
    "CESIUM_primitive_outline",
    // Only materials, lights, animation and metadata.
    "KHR_materials_",
    "EXT_materials_",
    "KHR_texture_",
    "EXT_texture_",
    "MSFT_texture_",
    "KHR_technique_",
    "KHR_techniques_",
    "KHR_lights_",
    "EXT_lights_",
    "KHR_animation_",
    "KHR_xmp_",
    "EXT_mesh_features",
    "EXT_structural_metadata",
];

/// An unsupported extension that replaces geometry, and what to do about it.
const DRACO: (&str, &str) =
    ("KHR_draco_mesh_compression", "decompress it with `gltf-transform copy IN OUT`");

/// Checks that all required extensions are supported or harmless.
///
/// # Errors
/// `Extension` for the first that is not, with what to do.
pub(super) fn check_required(source: &Source, document: &Document) -> Result<(), ReadError> {
    let required = &document.extensions_required;
    match required.iter().position(|name| !is_supported_or_harmless(name)) {
        None => Ok(()),
        Some(at) => {
            let name = &required[at];
            let advice = if name == DRACO.0 { DRACO.1 } else { "export the model without it" };
            let what =
                format!("the file requires the extension {name}, which is not supported: {advice}");
            let place = Place::Part(format!("extensionsRequired[{at}]"));
            Err(source.error(ReadErrorKind::Extension, Some(place), what))
        }
    }
}

/// Checks that a primitive with compressed positions has uncompressed ones too.
///
/// # Errors
/// `Extension` if it has not, even if the file does not require the extension.
pub(super) fn check_uncompressed(primitive: Primitive) -> Result<(), ReadError> {
    let (name, advice) = DRACO;
    let index = primitive.json.attributes.get(&Checked::Valid(Semantic::Positions));
    let accessors = &primitive.asset.document.accessors;
    let accessor = index.and_then(|index| accessors.get(index.value()));
    let has_no_data = accessor.is_some_and(|accessor| accessor.buffer_view.is_none());
    if has_no_data && primitive.extension(name).is_some() {
        let what =
            format!("the positions are compressed by {name}, which is not supported: {advice}");
        return Err(primitive.error(ReadErrorKind::Extension, what));
    }
    Ok(())
}

fn is_supported_or_harmless(name: &str) -> bool {
    SUPPORTED_OR_HARMLESS
        .iter()
        .any(|known| if known.ends_with('_') { name.starts_with(known) } else { name == *known })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(names: &[&str]) -> Result<(), ReadError> {
        let source = Source { name: "test.gltf", folder: None, bytes: b"" };
        let extensions_required = names.iter().map(|&name| name.into()).collect();
        check_required(&source, &Document { extensions_required, ..Document::default() })
    }

    #[test]
    fn extensions_that_leave_geometry_alone_may_be_required() {
        let harmless = ["KHR_materials_unlit", "KHR_texture_transform", "KHR_lights_punctual"];
        assert_eq!(check(&harmless), Ok(()));
        assert_eq!(check(&["KHR_mesh_quantization"]), Ok(()));
    }

    #[test]
    fn other_required_extensions_are_errors_with_advice() {
        let error = check(&["KHR_materials_unlit", "KHR_draco_mesh_compression"]).unwrap_err();
        assert_eq!(error.kind, ReadErrorKind::Extension);
        assert_eq!(error.place, Some(Place::Part("extensionsRequired[1]".into())));
        assert!(error.what.contains("KHR_draco_mesh_compression"), "{error}");
        assert!(error.what.contains("gltf-transform"), "{error}");
        assert!(check(&["ACME_gizmo"]).unwrap_err().what.contains("ACME_gizmo"));
        assert!(check(&["KHR_mesh_quantization_2"]).is_err(), "not a prefix");
    }
}
