//! Rules about relations between several values.
//!
//! Each function takes the root and a value, and returns the value's fault, if any.
//! Missing members and wrong types are left to other rules.

use serde_json::Value;

/// What is wrong with a value; `None` if nothing is.
type Fault = Option<String>;

fn number(value: &Value, member: &str) -> Option<u64> {
    value.get(member)?.as_u64()
}

/// The element of a list of the root with this index.
fn element<'v>(root: &'v Value, list: &str, index: &Value) -> Option<&'v Value> {
    root.get(list)?.get(usize::try_from(index.as_u64()?).ok()?)
}

fn floats(value: &Value) -> Option<Vec<f64>> {
    value.as_array()?.iter().map(Value::as_f64).collect()
}

/// The size of a component in bytes.
fn component_size(accessor: &Value) -> Option<u64> {
    match number(accessor, "componentType")? {
        5120 | 5121 => Some(1),
        5122 | 5123 => Some(2),
        5125 | 5126 => Some(4),
        _ => None,
    }
}

pub(super) fn node_has_one_transform(_: &Value, node: &Value) -> Fault {
    let has = |member: &&str| node.get(member).is_some();
    let part = ["translation", "rotation", "scale"].into_iter().find(has);
    part.filter(|_| node.get("matrix").is_some())
        .map(|part| format!("has a matrix and a {part}; the matrix was used"))
}

pub(super) fn rotation_is_unit(_: &Value, rotation: &Value) -> Fault {
    let length = floats(rotation)?.iter().map(|part| part * part).sum::<f64>().sqrt();
    ((length - 1.0).abs() > 1e-3).then(|| format!("is a quaternion of length {length}, not 1"))
}

pub(super) fn matrix_has_right_angles(_: &Value, matrix: &Value) -> Fault {
    let axes = floats(matrix)?;
    let (columns, []) = axes.as_chunks::<4>() else { return None };
    let [x, y, z, _] = columns else { return None };
    let dot = |a: &[f64; 4], b: &[f64; 4]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let is_skew = |a, b| dot(a, b).abs() > 1e-3 * (dot(a, a) * dot(b, b)).sqrt();
    let is_broken = is_skew(x, y) || is_skew(y, z) || is_skew(z, x);
    is_broken.then(|| {
        "is not a product of translation, rotation and scale; it was used nevertheless".into()
    })
}

pub(super) fn view_is_in_its_buffer(root: &Value, view: &Value) -> Fault {
    let buffer = element(root, "buffers", view.get("buffer")?)?;
    let end = number(view, "byteOffset").unwrap_or(0).checked_add(number(view, "byteLength")?);
    let length = number(buffer, "byteLength")?;
    end.is_none_or(|end| end > length).then(|| format!("leaves its buffer of {length} bytes"))
}

pub(super) fn stride_is_aligned(_: &Value, stride: &Value) -> Fault {
    (!stride.as_u64()?.is_multiple_of(4)).then(|| format!("is {stride}, not a multiple of 4"))
}

pub(super) fn accessor_is_aligned(root: &Value, accessor: &Value) -> Fault {
    let view = element(root, "bufferViews", accessor.get("bufferView")?)?;
    let is_matrix = accessor.get("type")?.as_str()?.starts_with("MAT");
    let unit = if is_matrix { 4 } else { component_size(accessor)? };
    let [outer, inner] = [view, accessor].map(|value| number(value, "byteOffset").unwrap_or(0));
    let is_aligned = inner.is_multiple_of(unit) && outer.checked_add(inner)?.is_multiple_of(unit);
    (!is_aligned).then(|| format!("begins at a byte that is not a multiple of {unit}"))
}

pub(super) fn weights_are_for_targets(_: &Value, mesh: &Value) -> Fault {
    let weights = mesh.get("weights")?.as_array()?.len();
    let targets = mesh.get("primitives")?.get(0)?.get("targets");
    let targets = targets.and_then(Value::as_array).map_or(0, Vec::len);
    (weights != targets).then(|| format!("has {weights} weights for {targets} morph targets"))
}

/// All attributes and morph targets of a primitive have the same count.
pub(super) fn counts_are_equal(root: &Value, primitive: &Value) -> Fault {
    let targets = primitive.get("targets").and_then(Value::as_array).into_iter().flatten();
    let lists = primitive.get("attributes").into_iter().chain(targets);
    let accessors = lists.filter_map(Value::as_object).flat_map(|list| list.values());
    let mut counts =
        accessors.filter_map(|index| number(element(root, "accessors", index)?, "count"));
    let first = counts.next()?;
    let other = counts.find(|&count| count != first)?;
    Some(format!("has attributes of {first} and of {other} vertices"))
}

/// The names of attributes, with the allowed types and component types.
const ATTRIBUTES: [(&str, &[&str], &[u64]); 7] = [
    ("POSITION", &["VEC3"], &[5120, 5121, 5122, 5123, 5126]),
    ("NORMAL", &["VEC3"], &[5120, 5122, 5126]),
    ("TANGENT", &["VEC4"], &[5120, 5122, 5126]),
    ("TEXCOORD", &["VEC2"], &[5120, 5121, 5122, 5123, 5126]),
    ("COLOR", &["VEC3", "VEC4"], &[5121, 5123, 5126]),
    ("JOINTS", &["VEC4"], &[5121, 5123]),
    ("WEIGHTS", &["VEC4"], &[5121, 5123, 5126]),
];

pub(super) fn attributes_are_known(root: &Value, attributes: &Value) -> Fault {
    let sets = |name: &str| {
        let keys = attributes.as_object().into_iter().flat_map(|members| members.keys());
        keys.filter(|key| key.starts_with(name)).count()
    };
    if sets("JOINTS_") != sets("WEIGHTS_") {
        return Some("has different numbers of joint sets and weight sets".into());
    }
    let wrong = |(name, index): (&String, &Value)| attribute_fault(root, name, index);
    attributes.as_object()?.iter().find_map(wrong)
}

fn attribute_fault(root: &Value, name: &str, index: &Value) -> Fault {
    // Custom attributes begin with an underscore.
    if name.starts_with('_') {
        return None;
    }
    let kind = name.rsplit_once('_').map_or(name, |(kind, _)| kind);
    let Some((_, types, components)) = ATTRIBUTES.iter().find(|(known, ..)| *known == kind) else {
        return Some(format!("has an unknown attribute {name}"));
    };
    let accessor = element(root, "accessors", index)?;
    let is_known = types.contains(&accessor.get("type")?.as_str()?)
        && components.contains(&number(accessor, "componentType")?);
    if !is_known {
        return Some(format!("has a {name} of a type that is not allowed"));
    }
    let offset = number(accessor, "byteOffset").unwrap_or(0);
    (!offset.is_multiple_of(4))
        .then(|| format!("has a {name} that begins at byte {offset}, not a multiple of 4"))
}

pub(super) fn position_has_bounds(root: &Value, index: &Value) -> Fault {
    let accessor = element(root, "accessors", index)?;
    let has_bounds = accessor.get("min").is_some() && accessor.get("max").is_some();
    (!has_bounds).then(|| format!("is accessors[{index}], which states no min and max"))
}

pub(super) fn indices_are_unsigned(root: &Value, index: &Value) -> Fault {
    let accessor = element(root, "accessors", index)?;
    let is_unsigned = matches!(number(accessor, "componentType")?, 5121 | 5123 | 5125);
    let is_sound = is_unsigned && accessor.get("type")?.as_str()? == "SCALAR";
    (!is_sound).then(|| format!("is accessors[{index}], which does not have unsigned integers"))
}

pub(super) fn binds_are_for_joints(root: &Value, skin: &Value) -> Fault {
    let joints = skin.get("joints")?.as_array()?.len() as u64;
    let matrices = number(element(root, "accessors", skin.get("inverseBindMatrices")?)?, "count")?;
    (matrices < joints).then(|| format!("has {matrices} matrices for {joints} joints"))
}

pub(super) fn image_is_in_one_place(_: &Value, image: &Value) -> Fault {
    let has = |member| image.get(member).is_some();
    (has("uri") == has("bufferView")).then(|| "must have either a URI or a buffer view".into())
}

pub(super) fn camera_sees_something(_: &Value, projection: &Value) -> Fault {
    let number = |member: &str| projection.get(member).and_then(Value::as_f64);
    let is_flat = number("xmag") == Some(0.0) || number("ymag") == Some(0.0);
    let is_behind = number("zfar").zip(number("znear")).is_some_and(|(far, near)| far <= near);
    (is_flat || is_behind).then(|| "sees nothing: its width, height or depth is 0".into())
}
