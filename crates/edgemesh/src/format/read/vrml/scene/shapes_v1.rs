//! The shapes of VRML 1.0, from their fields and the current state.

use super::face_set::{Binding, ElementLookup, FaceMaterials, FaceSet};
use super::materials::of_lists;
use super::number_list::{NumberList, to_f32};
use super::scene_builder::SceneBuilder;
use super::solids::{SolidParts, Surface, cone, cuboid, cylinder, sphere};
use super::state_v1::State;
use crate::format::read::error::ReadError;
use crate::format::read::vrml::parse::{NodeRef, Numbers};
use crate::model::{Material, Smoothing, Texture};
use crate::report::WarningCode;

/// Adds the shape of `node`; returns whether it is one.
pub(super) fn add_shape(
    builder: &mut SceneBuilder,
    node: NodeRef,
    state: &State,
) -> Result<bool, ReadError> {
    let surface = match node.kind() {
        "IndexedFaceSet" => {
            add_face_set(builder, node, state)?;
            return Ok(true);
        }
        "IndexedLineSet" => {
            add_line_set(builder, node, state)?;
            return Ok(true);
        }
        "Cube" => cuboid(["width", "height", "depth"].map(|field| node.number(field, 2.0))),
        "Sphere" => sphere(node.number("radius", 1.0)),
        "Cone" => cone(node.number("bottomRadius", 1.0), node.number("height", 2.0), parts(node)),
        "Cylinder" => cylinder(node.number("radius", 1.0), node.number("height", 2.0), parts(node)),
        _ => return Ok(false),
    };
    add_solid(builder, node, state, &surface)?;
    Ok(true)
}

/// The parts that a solid lists; all if it lists none.
fn parts(node: NodeRef) -> SolidParts {
    let has = |part: &str| {
        let mut words = node.words("parts").peekable();
        words.peek().is_none() || words.any(|word| word == part || word == "ALL")
    };
    SolidParts { side: has("SIDES"), bottom: has("BOTTOM"), top: has("TOP") }
}

fn add_solid(
    builder: &mut SceneBuilder,
    node: NodeRef,
    state: &State,
    surface: &Surface,
) -> Result<(), ReadError> {
    if state.material_binding != Binding::Overall && material_count(state) > 1 {
        builder.warn(node, WarningCode::Unsupported, || {
            format!(
                "materials for parts of a {} are not supported; the first was used",
                node.kind()
            )
        });
    }
    let line = node.line();
    let points = NumberList::generated(node, Numbers::generated(&surface.points, line));
    let indices = Numbers::generated(&surface.indices, line);
    let material = first_material(state, texture(builder, state).as_ref());
    let set = FaceSet::new(node, points, indices, material, surface.smoothing);
    builder.add_faces(&set, &state.placement.named(node))
}

/// The number of materials in force, which is that of diffuse colors.
fn material_count(state: &State) -> usize {
    state.material.map_or(0, |node| node.numbers("diffuseColor").chunks::<3>().len())
}

/// The texture in force.
fn texture(builder: &mut SceneBuilder, state: &State) -> Option<Texture> {
    state.texture.and_then(|node| builder.texture(node, "filename"))
}

/// The material for all faces.
fn first_material(state: &State, texture: Option<&Texture>) -> Option<Material> {
    match (state.material, texture) {
        (None, None) => None,
        (material, texture) => Some(of_lists(material, texture, 0)),
    }
}

/// The points in force; `None` if there are none, with a warning if the shape needs them.
fn points<'d>(
    builder: &mut SceneBuilder,
    node: NodeRef,
    state: &State<'d>,
) -> Option<NumberList<'d>> {
    let points = state.coordinates.map(|node| NumberList::of(node, "point"));
    if points.is_none() && !node.numbers("coordIndex").values.is_empty() {
        builder.warn(node, WarningCode::Syntax, || {
            format!("{} without a Coordinate3 before it was left out", node.kind())
        });
    }
    points
}

fn add_face_set(builder: &mut SceneBuilder, node: NodeRef, state: &State) -> Result<(), ReadError> {
    let Some(points) = points(builder, node, state) else { return Ok(()) };
    let texture = texture(builder, state);
    let material = first_material(state, texture.as_ref());
    let smoothing = Smoothing::Angle(to_f32(state.crease_angle));
    let indices = node.numbers("coordIndex");
    let mut set = FaceSet::new(node, points, indices, material, smoothing);
    set.is_clockwise = state.is_clockwise;
    let lookup = |binding, field| ElementLookup { binding, indices: explicit(node.numbers(field)) };
    set.normals = NumberList::if_any(state.normals, "vector")
        .map(|list| (lookup(state.normal_binding, "normalIndex"), list));
    set.texcoords = NumberList::if_any(state.texcoords, "point")
        .map(|list| (lookup(Binding::CornerIndexed, "textureCoordIndex"), list));
    let materials = lookup(state.material_binding, "materialIndex");
    match state.material_binding {
        Binding::Corner | Binding::CornerIndexed => {
            if let Some(colors) = NumberList::if_any(state.material, "diffuseColor") {
                set.set_colors(materials, colors);
            }
        }
        Binding::Face | Binding::FaceIndexed if state.material.is_some() => {
            let texture = texture.as_ref();
            let material = Box::new(move |at| Some(of_lists(state.material, texture, at)));
            set.face_materials = Some(FaceMaterials { lookup: materials, material });
        }
        _ => {}
    }
    builder.add_faces(&set, &state.placement.named(node))
}

/// The indices of a field; empty for the default -1, which stands for those of the corners.
fn explicit(indices: Numbers) -> Numbers {
    match indices.values {
        [index] if *index < 0.0 => Numbers::default(),
        _ => indices,
    }
}

fn add_line_set(builder: &mut SceneBuilder, node: NodeRef, state: &State) -> Result<(), ReadError> {
    let Some(points) = points(builder, node, state) else { return Ok(()) };
    builder.add_lines(node, &points, &node.numbers("coordIndex"), &state.placement)
}
