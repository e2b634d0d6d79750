//! The shapes of VRML 1.0, from their own fields and the state around them.

use super::document::{NodeRef, Numbers};
use super::faces::{Binding, Bound, FaceMaterials, FaceSet};
use super::lists::{List, to_f32};
use super::materials::of_lists;
use super::scene::Scene;
use super::solids::{Parts, Surface, cone, cuboid, cylinder, sphere};
use super::walk_v1::State;
use crate::format::read::error::ReadError;
use crate::model::{Material, Smoothing, Texture};
use crate::report::WarningCode;

/// Adds a shape; says whether `node` is one.
pub(super) fn add_shape(
    scene: &mut Scene,
    node: NodeRef,
    state: &State,
) -> Result<bool, ReadError> {
    let surface = match node.kind() {
        "IndexedFaceSet" => {
            add_face_set(scene, node, state)?;
            return Ok(true);
        }
        "IndexedLineSet" => {
            add_line_set(scene, node, state)?;
            return Ok(true);
        }
        "Cube" => cuboid(["width", "height", "depth"].map(|field| node.number(field, 2.0))),
        "Sphere" => sphere(node.number("radius", 1.0)),
        "Cone" => cone(node.number("bottomRadius", 1.0), node.number("height", 2.0), parts(node)),
        "Cylinder" => cylinder(node.number("radius", 1.0), node.number("height", 2.0), parts(node)),
        _ => return Ok(false),
    };
    add_solid(scene, node, state, &surface)?;
    Ok(true)
}

/// The parts that a solid lists; all where it lists none.
fn parts(node: NodeRef) -> Parts {
    let has = |part: &str| {
        let mut words = node.words("parts").peekable();
        words.peek().is_none() || words.any(|word| word == part || word == "ALL")
    };
    Parts { side: has("SIDES"), bottom: has("BOTTOM"), top: has("TOP") }
}

fn add_solid(
    scene: &mut Scene,
    node: NodeRef,
    state: &State,
    surface: &Surface,
) -> Result<(), ReadError> {
    if state.material_binding != Binding::Overall && material_count(state) > 1 {
        scene.warn(node, WarningCode::Unsupported, || {
            format!("materials for parts of a {} are not read; the first is kept", node.kind())
        });
    }
    let line = node.line();
    let points = List::made(node, Numbers::made(&surface.points, line));
    let indices = Numbers::made(&surface.indices, line);
    let material = first_material(state, texture(scene, state).as_ref());
    let set = FaceSet::bare(node, points, indices, material, surface.smoothing);
    scene.add_faces(&set, &state.placement.named(node))
}

/// How many materials are in force, which the diffuse colours say.
fn material_count(state: &State) -> usize {
    state.material.map_or(0, |node| node.numbers("diffuseColor").chunks::<3>().len())
}

/// The texture in force.
fn texture(scene: &mut Scene, state: &State) -> Option<Texture> {
    state.texture.and_then(|node| scene.texture(node, "filename"))
}

/// The material for all faces.
fn first_material(state: &State, texture: Option<&Texture>) -> Option<Material> {
    match (state.material, texture) {
        (None, None) => None,
        (material, texture) => Some(of_lists(material, texture, 0)),
    }
}

/// The points in force; `None` where there are none, which is said where it
/// costs anything.
fn points<'d>(scene: &mut Scene, node: NodeRef, state: &State<'d>) -> Option<List<'d>> {
    let points = state.coordinates.map(|node| List::of(node, "point"));
    if points.is_none() && !node.numbers("coordIndex").values.is_empty() {
        scene.warn(node, WarningCode::Syntax, || {
            format!("{} without Coordinate3 before it was left out", node.kind())
        });
    }
    points
}

fn add_face_set(scene: &mut Scene, node: NodeRef, state: &State) -> Result<(), ReadError> {
    let Some(points) = points(scene, node, state) else { return Ok(()) };
    let texture = texture(scene, state);
    let material = first_material(state, texture.as_ref());
    let smoothing = Smoothing::Angle(to_f32(state.crease_angle));
    let indices = node.numbers("coordIndex");
    let mut set = FaceSet::bare(node, points, indices, material, smoothing);
    set.is_clockwise = state.is_clockwise;
    let bound = |binding, field| Bound { binding, indices: stated(node.numbers(field)) };
    set.normals = List::if_any(state.normals, "vector")
        .map(|list| (bound(state.normal_binding, "normalIndex"), list));
    set.texcoords = List::if_any(state.texcoords, "point")
        .map(|list| (bound(Binding::CornerIndexed, "textureCoordIndex"), list));
    let materials = bound(state.material_binding, "materialIndex");
    match state.material_binding {
        Binding::Corner | Binding::CornerIndexed => {
            set.colors = List::if_any(state.material, "diffuseColor").map(|list| (materials, list));
        }
        Binding::Face | Binding::FaceIndexed if state.material.is_some() => {
            let texture = texture.as_ref();
            let material = Box::new(move |at| Some(of_lists(state.material, texture, at)));
            set.face_materials = Some(FaceMaterials { bound: materials, material });
        }
        _ => {}
    }
    scene.add_faces(&set, &state.placement.named(node))
}

/// The indices of a field, whose default -1 stands for those of the corners.
fn stated(indices: Numbers) -> Numbers {
    match indices.values {
        [index] if *index < 0.0 => Numbers::default(),
        _ => indices,
    }
}

fn add_line_set(scene: &mut Scene, node: NodeRef, state: &State) -> Result<(), ReadError> {
    let Some(points) = points(scene, node, state) else { return Ok(()) };
    scene.add_lines(node, &points, &node.numbers("coordIndex"), &state.placement)
}
