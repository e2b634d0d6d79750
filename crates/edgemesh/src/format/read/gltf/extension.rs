//! Extensions that a file cannot be read without.

use gltf_json::mesh::{Primitive, Semantic};
use gltf_json::validation::Checked;

use super::super::error::{ReadError, ReadErrorKind};
use super::super::source::Source;
use super::Asset;
use super::document::Document;
use super::vertices::Site;
use crate::report::Place;

/// Extensions that are read, or that leave geometry as it is; a name that ends
/// in `_` stands for all that begin so.
const READ_OR_HARMLESS: [&str; 17] = [
    "KHR_mesh_quantization",
    "KHR_node_visibility",
    "EXT_mesh_primitive_edge_visibility",
    "CESIUM_primitive_outline",
    // Look, light, sound, movement and notes only.
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

/// What to do about extensions that change geometry and are not read.
const ADVICE: [(&str, &str); 4] = [
    ("KHR_draco_mesh_compression", "decompress it with `gltf-transform copy IN OUT`"),
    ("EXT_meshopt_compression", "decompress it with `gltf-transform copy IN OUT`"),
    ("KHR_meshopt_compression", "decompress it with `gltf-transform copy IN OUT`"),
    ("EXT_mesh_gpu_instancing", "export the instances as nodes of their own"),
];

/// Checks that nothing is required that is not read.
///
/// # Errors
/// Names the first such extension and says what to do.
pub(super) fn check_required(source: &Source, document: &Document) -> Result<(), ReadError> {
    let required = &document.extensions_required;
    match required.iter().position(|name| !is_read_or_harmless(name)) {
        None => Ok(()),
        Some(at) => {
            let name = &required[at];
            let advice = ADVICE.iter().find(|(known, _)| known == name);
            let advice = advice.map_or("export it without that", |(_, advice)| advice);
            let what =
                format!("the file requires the extension {name}, which is not read: {advice}");
            let place = Place::Part(format!("extensionsRequired[{at}]"));
            Err(source.error(ReadErrorKind::Extension, Some(place), what))
        }
    }
}

/// Checks that the positions of the primitive at `site` are there as they are,
/// where they are compressed as well.
///
/// # Errors
/// `Extension` where they are not, although nothing is required.
pub(super) fn check_uncompressed(
    asset: &Asset,
    primitive: &Primitive,
    site: Site,
) -> Result<(), ReadError> {
    let (name, advice) = ADVICE[0];
    let extensions = primitive.extensions.as_ref();
    let position = primitive.attributes.get(&Checked::Valid(Semantic::Positions));
    let accessor = position.and_then(|index| asset.document.accessors.get(index.value()));
    let is_elsewhere = accessor.is_some_and(|accessor| accessor.buffer_view.is_none());
    if is_elsewhere && extensions.is_some_and(|all| all.others.contains_key(name)) {
        let what = format!("the positions are compressed by {name}, which is not read: {advice}");
        return Err(asset.error(ReadErrorKind::Extension, site.part(), what));
    }
    Ok(())
}

fn is_read_or_harmless(name: &str) -> bool {
    READ_OR_HARMLESS
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
    fn others_are_named_with_advice() {
        let error = check(&["KHR_materials_unlit", "KHR_draco_mesh_compression"]).unwrap_err();
        assert_eq!(error.kind, ReadErrorKind::Extension);
        assert_eq!(error.place, Some(Place::Part("extensionsRequired[1]".into())));
        assert!(error.what.contains("KHR_draco_mesh_compression"), "{error}");
        assert!(error.what.contains("gltf-transform"), "{error}");
        assert!(check(&["ACME_gizmo"]).unwrap_err().what.contains("ACME_gizmo"));
        assert!(check(&["KHR_mesh_quantization_2"]).is_err(), "no prefix");
    }
}
