//! The table of rules.

use serde_json::Value;

use super::checks;

/// What must hold at a place.
#[derive(Debug, Clone, Copy)]
pub(super) enum Must {
    /// It is the index of an element of this list.
    Name(&'static str),
    /// It has these members.
    Have(&'static [&'static str]),
    /// It is a number from the first to the second.
    Lie(f64, f64),
    /// It is no empty list.
    HoldSome,
    /// It is a list.
    BeList,
    /// It is an object.
    BeObject,
    /// This function, given the root and the value, finds nothing to say.
    Pass(fn(&Value, &Value) -> Option<String>),
}

use Must::{BeList, BeObject, Have, HoldSome, Lie, Name, Pass};

const INFINITY: f64 = f64::INFINITY;

/// Each rule: a pattern of places (see `trail`), and what must hold there.
pub(super) const RULES: &[(&str, Must)] = &[
    // What names something names something that is there.
    ("scene", Name("scenes")),
    ("scenes[].nodes[]", Name("nodes")),
    ("nodes[].children[]", Name("nodes")),
    ("nodes[].mesh", Name("meshes")),
    ("nodes[].skin", Name("skins")),
    ("nodes[].camera", Name("cameras")),
    ("nodes[].extensions.KHR_lights_punctual.light", Name("extensions.KHR_lights_punctual.lights")),
    ("skins[].joints[]", Name("nodes")),
    ("skins[].skeleton", Name("nodes")),
    ("skins[].inverseBindMatrices", Name("accessors")),
    ("meshes[].primitives[].attributes.*", Name("accessors")),
    ("meshes[].primitives[].targets[].*", Name("accessors")),
    ("meshes[].primitives[].indices", Name("accessors")),
    ("meshes[].primitives[].material", Name("materials")),
    (
        "meshes[].primitives[].extensions.KHR_materials_variants.mappings[].material",
        Name("materials"),
    ),
    (
        "meshes[].primitives[].extensions.KHR_materials_variants.mappings[].variants[]",
        Name("extensions.KHR_materials_variants.variants"),
    ),
    ("accessors[].bufferView", Name("bufferViews")),
    ("accessors[].sparse.indices.bufferView", Name("bufferViews")),
    ("accessors[].sparse.values.bufferView", Name("bufferViews")),
    ("bufferViews[].buffer", Name("buffers")),
    ("images[].bufferView", Name("bufferViews")),
    ("textures[].source", Name("images")),
    ("textures[].sampler", Name("samplers")),
    ("textures[].extensions.EXT_texture_webp.source", Name("images")),
    ("materials[].pbrMetallicRoughness.*.index", Name("textures")),
    ("materials[].*.index", Name("textures")),
    ("materials[].extensions.*.*.index", Name("textures")),
    ("animations[].samplers[].input", Name("accessors")),
    ("animations[].samplers[].output", Name("accessors")),
    ("animations[].channels[].target.node", Name("nodes")),
    // What every element has.
    ("buffers[]", Have(&["byteLength"])),
    ("bufferViews[]", Have(&["buffer", "byteLength"])),
    ("accessors[]", Have(&["componentType", "count", "type"])),
    ("accessors[].sparse", Have(&["count", "indices", "values"])),
    ("meshes[]", Have(&["primitives"])),
    ("meshes[].primitives[]", Have(&["attributes"])),
    ("skins[]", Have(&["joints"])),
    ("cameras[]", Have(&["type"])),
    ("animations[]", Have(&["channels", "samplers"])),
    ("animations[].channels[]", Have(&["sampler", "target"])),
    ("animations[].channels[].target", Have(&["path"])),
    ("animations[].samplers[]", Have(&["input", "output"])),
    ("extensions.KHR_lights_punctual", Have(&["lights"])),
    ("extensions.KHR_lights_punctual.lights[]", Have(&["type"])),
    ("nodes[].extensions.KHR_lights_punctual", Have(&["light"])),
    ("extensions.KHR_materials_variants", Have(&["variants"])),
    ("meshes[].primitives[].extensions.KHR_materials_variants", Have(&["mappings"])),
    // Lists that are left away rather than empty.
    ("*", HoldSome),
    ("nodes[].children", HoldSome),
    ("scenes[].nodes", HoldSome),
    ("skins[].joints", HoldSome),
    ("meshes[].primitives", HoldSome),
    // Types of what the reader does not look at.
    ("animations", BeList),
    ("cameras", BeList),
    ("images", BeList),
    ("samplers", BeList),
    ("textures", BeList),
    ("extensions.*", BeObject),
    // Numbers.
    ("buffers[].byteLength", Lie(1.0, INFINITY)),
    ("bufferViews[].byteLength", Lie(1.0, INFINITY)),
    ("bufferViews[].byteStride", Lie(4.0, 252.0)),
    ("accessors[].count", Lie(1.0, INFINITY)),
    ("materials[].pbrMetallicRoughness.baseColorFactor[]", Lie(0.0, 1.0)),
    ("materials[].extensions.KHR_materials_dispersion.dispersion", Lie(0.0, INFINITY)),
    ("materials[].extensions.KHR_materials_ior.ior", Lie(0.0, INFINITY)),
    ("materials[].extensions.KHR_materials_volume.attenuationColor[]", Lie(0.0, 1.0)),
    ("materials[].extensions.KHR_materials_volume.thicknessFactor", Lie(0.0, INFINITY)),
    // What takes more than one value to tell.
    ("nodes[]", Pass(checks::node_has_one_transform)),
    ("nodes[].rotation", Pass(checks::rotation_is_unit)),
    ("nodes[].matrix", Pass(checks::matrix_has_right_angles)),
    ("bufferViews[]", Pass(checks::view_is_in_its_buffer)),
    ("bufferViews[].byteStride", Pass(checks::stride_is_aligned)),
    ("accessors[]", Pass(checks::accessor_is_aligned)),
    ("meshes[]", Pass(checks::weights_are_for_targets)),
    ("meshes[].primitives[]", Pass(checks::counts_are_equal)),
    ("meshes[].primitives[].attributes", Pass(checks::attributes_are_known)),
    ("meshes[].primitives[].attributes.POSITION", Pass(checks::position_has_bounds)),
    ("meshes[].primitives[].targets[].POSITION", Pass(checks::position_has_bounds)),
    ("meshes[].primitives[].indices", Pass(checks::indices_are_unsigned)),
    ("skins[]", Pass(checks::binds_are_for_joints)),
    ("images[]", Pass(checks::image_is_in_one_place)),
    ("cameras[].*", Pass(checks::camera_sees)),
];
