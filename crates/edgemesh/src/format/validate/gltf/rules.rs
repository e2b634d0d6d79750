//! The table of rules.

use serde_json::Value;

use super::relations;

/// A rule for a value.
#[derive(Debug, Clone, Copy)]
pub(super) enum Rule {
    /// The value is an index of this list.
    IndexOf(&'static str),
    /// The value has these members.
    Has(&'static [&'static str]),
    /// The value is a number from the first to the second.
    InRange(f64, f64),
    /// The value is not an empty list.
    NotEmpty,
    /// The value is a list.
    IsList,
    /// The value is an object.
    IsObject,
    /// This function of the root and the value returns no fault.
    Relation(fn(&Value, &Value) -> Option<String>),
}

use Rule::{Has, InRange, IndexOf, IsList, IsObject, NotEmpty, Relation};

const INFINITY: f64 = f64::INFINITY;

/// The rules, each with the pattern of the values that it is for (see `pattern`).
pub(super) const RULES: &[(&str, Rule)] = &[
    // Indices are in range.
    ("scene", IndexOf("scenes")),
    ("scenes[].nodes[]", IndexOf("nodes")),
    ("nodes[].children[]", IndexOf("nodes")),
    ("nodes[].mesh", IndexOf("meshes")),
    ("nodes[].skin", IndexOf("skins")),
    ("nodes[].camera", IndexOf("cameras")),
    (
        "nodes[].extensions.KHR_lights_punctual.light",
        IndexOf("extensions.KHR_lights_punctual.lights"),
    ),
    ("skins[].joints[]", IndexOf("nodes")),
    ("skins[].skeleton", IndexOf("nodes")),
    ("skins[].inverseBindMatrices", IndexOf("accessors")),
    ("meshes[].primitives[].attributes.*", IndexOf("accessors")),
    ("meshes[].primitives[].targets[].*", IndexOf("accessors")),
    ("meshes[].primitives[].indices", IndexOf("accessors")),
    ("meshes[].primitives[].material", IndexOf("materials")),
    (
        "meshes[].primitives[].extensions.KHR_materials_variants.mappings[].material",
        IndexOf("materials"),
    ),
    (
        "meshes[].primitives[].extensions.KHR_materials_variants.mappings[].variants[]",
        IndexOf("extensions.KHR_materials_variants.variants"),
    ),
    ("accessors[].bufferView", IndexOf("bufferViews")),
    ("accessors[].sparse.indices.bufferView", IndexOf("bufferViews")),
    ("accessors[].sparse.values.bufferView", IndexOf("bufferViews")),
    ("bufferViews[].buffer", IndexOf("buffers")),
    ("images[].bufferView", IndexOf("bufferViews")),
    ("textures[].source", IndexOf("images")),
    ("textures[].sampler", IndexOf("samplers")),
    ("textures[].extensions.EXT_texture_webp.source", IndexOf("images")),
    ("materials[].pbrMetallicRoughness.*.index", IndexOf("textures")),
    ("materials[].*.index", IndexOf("textures")),
    ("materials[].extensions.*.*.index", IndexOf("textures")),
    ("animations[].samplers[].input", IndexOf("accessors")),
    ("animations[].samplers[].output", IndexOf("accessors")),
    ("animations[].channels[].target.node", IndexOf("nodes")),
    // Members that every element has.
    ("buffers[]", Has(&["byteLength"])),
    ("bufferViews[]", Has(&["buffer", "byteLength"])),
    ("accessors[]", Has(&["componentType", "count", "type"])),
    ("accessors[].sparse", Has(&["count", "indices", "values"])),
    ("meshes[]", Has(&["primitives"])),
    ("meshes[].primitives[]", Has(&["attributes"])),
    ("skins[]", Has(&["joints"])),
    ("cameras[]", Has(&["type"])),
    ("animations[]", Has(&["channels", "samplers"])),
    ("animations[].channels[]", Has(&["sampler", "target"])),
    ("animations[].channels[].target", Has(&["path"])),
    ("animations[].samplers[]", Has(&["input", "output"])),
    ("extensions.KHR_lights_punctual", Has(&["lights"])),
    ("extensions.KHR_lights_punctual.lights[]", Has(&["type"])),
    ("nodes[].extensions.KHR_lights_punctual", Has(&["light"])),
    ("extensions.KHR_materials_variants", Has(&["variants"])),
    ("meshes[].primitives[].extensions.KHR_materials_variants", Has(&["mappings"])),
    // Lists that are omitted rather than empty.
    ("*", NotEmpty),
    ("nodes[].children", NotEmpty),
    ("scenes[].nodes", NotEmpty),
    ("skins[].joints", NotEmpty),
    ("meshes[].primitives", NotEmpty),
    // Types of members that the reader does not parse.
    ("animations", IsList),
    ("cameras", IsList),
    ("images", IsList),
    ("samplers", IsList),
    ("textures", IsList),
    ("extensions.*", IsObject),
    // Numbers.
    ("buffers[].byteLength", InRange(1.0, INFINITY)),
    ("bufferViews[].byteLength", InRange(1.0, INFINITY)),
    ("bufferViews[].byteStride", InRange(4.0, 252.0)),
    ("accessors[].count", InRange(1.0, INFINITY)),
    ("materials[].pbrMetallicRoughness.baseColorFactor[]", InRange(0.0, 1.0)),
    ("materials[].extensions.KHR_materials_dispersion.dispersion", InRange(0.0, INFINITY)),
    ("materials[].extensions.KHR_materials_ior.ior", InRange(0.0, INFINITY)),
    ("materials[].extensions.KHR_materials_volume.attenuationColor[]", InRange(0.0, 1.0)),
    ("materials[].extensions.KHR_materials_volume.thicknessFactor", InRange(0.0, INFINITY)),
    // Relations between several values.
    ("nodes[]", Relation(relations::node_has_one_transform)),
    ("nodes[].rotation", Relation(relations::rotation_is_unit)),
    ("nodes[].matrix", Relation(relations::matrix_has_right_angles)),
    ("bufferViews[]", Relation(relations::view_is_in_its_buffer)),
    ("bufferViews[].byteStride", Relation(relations::stride_is_aligned)),
    ("accessors[]", Relation(relations::accessor_is_aligned)),
    ("meshes[]", Relation(relations::weights_are_for_targets)),
    ("meshes[].primitives[]", Relation(relations::counts_are_equal)),
    ("meshes[].primitives[].attributes", Relation(relations::attributes_are_known)),
    ("meshes[].primitives[].attributes.POSITION", Relation(relations::position_has_bounds)),
    ("meshes[].primitives[].targets[].POSITION", Relation(relations::position_has_bounds)),
    ("meshes[].primitives[].indices", Relation(relations::indices_are_unsigned)),
    ("skins[]", Relation(relations::binds_are_for_joints)),
    ("images[]", Relation(relations::image_is_in_one_place)),
    ("cameras[].*", Relation(relations::camera_sees_something)),
];
