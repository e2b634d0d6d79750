//! Walks a VRML 1.0 scene with its state: transformation, points, materials and
//! hints, which each node changes for those behind it.
//!
//! ```text
//! Separator {          all of the state is kept here
//!   Translation { }    moves what follows
//!   Coordinate3 { }    the points of what follows
//!   IndexedFaceSet { } a shape, from the state
//! }                    and is as before here
//! ```
//!
//! `Group`, `Switch` and `LOD` let their changes out, `TransformSeparator` all
//! but those of the transformation. A file may have several roots; they share
//! one state, as most programs read it.

use std::rc::Rc;

use glam::{DAffine3, DVec3};

use super::document::{Document, NodeRef, whole};
use super::faces::Binding;
use super::scene::{Placement, Scene};
use super::shapes_v1::add_shape;
use super::transforms::{of_matrix, of_transform, rotation};
use super::traversal::{Step, Traversal, nth};
use crate::format::read::error::ReadError;

/// Nodes that are neither drawn nor change how others are drawn here.
const NOT_DRAWN: [&str; 7] = [
    "DirectionalLight",
    "FontStyle",
    "Info",
    "OrthographicCamera",
    "PerspectiveCamera",
    "PointLight",
    "SpotLight",
];

/// `whichChild` for all children.
const ALL_CHILDREN: f64 = -3.0;

/// What is in force at a node.
#[derive(Debug, Clone)]
pub(super) struct State<'d> {
    /// Where shapes stand, and in which group.
    pub(super) placement: Placement,
    /// The last `Coordinate3`.
    pub(super) coordinates: Option<NodeRef<'d>>,
    /// The last `Normal`.
    pub(super) normals: Option<NodeRef<'d>>,
    /// The last `TextureCoordinate2`.
    pub(super) texcoords: Option<NodeRef<'d>>,
    /// The last `Material`.
    pub(super) material: Option<NodeRef<'d>>,
    /// The last `Texture2`.
    pub(super) texture: Option<NodeRef<'d>>,
    /// What materials are bound to.
    pub(super) material_binding: Binding,
    /// What normals are bound to.
    pub(super) normal_binding: Binding,
    /// Whether faces run clockwise as seen from outside.
    pub(super) is_clockwise: bool,
    /// Up to which angle edges are smooth, in radians.
    pub(super) crease_angle: f64,
}

impl State<'_> {
    /// The crease angle before any `ShapeHints`.
    const CREASE_ANGLE: f64 = 0.5;

    const fn new(placement: Placement) -> Self {
        Self {
            placement,
            coordinates: None,
            normals: None,
            texcoords: None,
            material: None,
            texture: None,
            material_binding: Binding::Overall,
            normal_binding: Binding::CornerIndexed,
            is_clockwise: false,
            crease_angle: Self::CREASE_ANGLE,
        }
    }
}

/// What comes back when a list of children ends.
enum Kept<'d> {
    /// The name of the group around.
    Group(Option<Rc<str>>),
    /// All of the placement.
    Placement(Placement),
    /// All of the state.
    State(Box<State<'d>>),
}

/// Adds what is in a file, at `placement`.
pub(super) fn walk(
    scene: &mut Scene,
    document: &Document,
    placement: Placement,
) -> Result<(), ReadError> {
    let kept = Kept::Group(None);
    let mut walk = Walk { scene, traversal: Traversal::new(), state: State::new(placement) };
    walk.traversal.enter(document.root().first_child(), usize::MAX, kept);
    while let Some(step) = walk.traversal.step() {
        match step {
            Step::Node(node) => walk.visit(node)?,
            Step::Leave(Kept::Group(group)) => walk.state.placement.group = group,
            Step::Leave(Kept::Placement(placement)) => walk.state.placement = placement,
            Step::Leave(Kept::State(state)) => walk.state = *state,
        }
    }
    Ok(())
}

struct Walk<'w, 's, 'd> {
    scene: &'w mut Scene<'s>,
    traversal: Traversal<'d, Kept<'d>>,
    state: State<'d>,
}

impl<'d> Walk<'_, '_, 'd> {
    fn visit(&mut self, node: NodeRef<'d>) -> Result<(), ReadError> {
        self.scene.visit(node)?;
        match node.kind() {
            "Separator" | "WWWAnchor" => {
                let kept = Kept::State(Box::new(self.state.clone()));
                self.enter(node, node.first_child(), usize::MAX, kept);
            }
            "TransformSeparator" => {
                let kept = Kept::Placement(self.state.placement.clone());
                self.enter(node, node.first_child(), usize::MAX, kept);
            }
            "Group" => self.enter_some(node, node.first_child(), usize::MAX),
            "LOD" => self.enter_some(node, node.first_child(), 1),
            "Switch" => self.enter_choice(node)?,
            "WWWInline" => {
                let placement = self.state.placement.named(node);
                self.scene.inline(node, "name", placement)?;
            }
            kind => {
                if !self.change_state(kind, node)
                    && !add_shape(self.scene, node, &self.state)?
                    && !NOT_DRAWN.contains(&kind)
                {
                    self.scene.warn_unread(node);
                }
            }
        }
        Ok(())
    }

    fn enter(
        &mut self,
        node: NodeRef<'d>,
        first: Option<NodeRef<'d>>,
        count: usize,
        kept: Kept<'d>,
    ) {
        self.traversal.enter(first, count, kept);
        self.state.placement = self.state.placement.named(node);
    }

    /// Goes into children whose changes of the state get out.
    fn enter_some(&mut self, node: NodeRef<'d>, first: Option<NodeRef<'d>>, count: usize) {
        let kept = Kept::Group(self.state.placement.group.clone());
        self.enter(node, first, count, kept);
    }

    fn enter_choice(&mut self, node: NodeRef<'d>) -> Result<(), ReadError> {
        let choice = node.number("whichChild", -1.0);
        if choice.to_bits() == ALL_CHILDREN.to_bits() {
            self.enter_some(node, node.first_child(), usize::MAX);
        } else if let Some(choice) = whole(choice) {
            let chosen = nth(node.first_child(), Some(choice));
            self.scene.spend(node, choice)?;
            self.enter_some(node, chosen, 1);
        }
        Ok(())
    }

    /// Does what a property node says; says whether it is one.
    fn change_state(&mut self, kind: &str, node: NodeRef<'d>) -> bool {
        let state = &mut self.state;
        match kind {
            "Coordinate3" => state.coordinates = Some(node),
            "Normal" => state.normals = Some(node),
            "TextureCoordinate2" => state.texcoords = Some(node),
            "Material" => state.material = Some(node),
            "Texture2" => state.texture = Some(node),
            "MaterialBinding" => state.material_binding = binding(node, Binding::Overall),
            "NormalBinding" => state.normal_binding = binding(node, Binding::CornerIndexed),
            "ShapeHints" => {
                state.is_clockwise = node.word("vertexOrdering") == Some("CLOCKWISE");
                state.crease_angle = node.number("creaseAngle", State::CREASE_ANGLE);
            }
            _ => match transformation(kind, node) {
                Some(transform) => state.placement.transform *= transform,
                None => return false,
            },
        }
        true
    }
}

/// The transformation that a node stands for, if it is one.
fn transformation(kind: &str, node: NodeRef) -> Option<DAffine3> {
    Some(match kind {
        "Transform" => of_transform(node, "scaleFactor"),
        "Translation" => {
            DAffine3::from_translation(DVec3::from(node.vector("translation", [0.0; 3])))
        }
        "Rotation" => DAffine3::from_quat(rotation(node.vector("rotation", [0.0, 0.0, 1.0, 0.0]))),
        "Scale" => DAffine3::from_scale(DVec3::from(node.vector("scaleFactor", [1.0; 3]))),
        "MatrixTransform" => of_matrix(node),
        _ => return None,
    })
}

/// What a binding node says. A part of a face set is a face.
fn binding(node: NodeRef, default: Binding) -> Binding {
    match node.word("value") {
        Some("OVERALL") => Binding::Overall,
        Some("PER_PART" | "PER_FACE") => Binding::Face,
        Some("PER_PART_INDEXED" | "PER_FACE_INDEXED") => Binding::FaceIndexed,
        Some("PER_VERTEX") => Binding::Corner,
        Some("PER_VERTEX_INDEXED") => Binding::CornerIndexed,
        _ => default,
    }
}

#[cfg(test)]
mod tests {
    use crate::format::read::vrml::tests::{faces_of, read, sound};
    use crate::model::{Model, Smoothing};
    use crate::report::WarningCode;

    fn scene(text: &str) -> Model {
        sound(&format!("#VRML V1.0 ascii\n{text}"))
    }

    /// Where the cubes stand.
    fn centers(text: &str) -> Vec<f64> {
        let model = scene(text);
        model.positions.chunks(8).map(|corners| corners[7][0] + corners[0][0]).collect()
    }

    const STEP: &str = "Translation { translation 0.5 0 0 }";

    #[test]
    fn separators_keep_the_state_and_groups_let_it_out() {
        let inside = |group: &str| centers(&format!("{group} {{ {STEP} Cube {{ }} }} Cube {{ }}"));
        assert_eq!(inside("Separator"), [1., 0.]);
        assert_eq!(inside("TransformSeparator"), [1., 0.]);
        assert_eq!(inside("WWWAnchor"), [1., 0.]);
        assert_eq!(inside("Group"), [1., 1.]);
        assert_eq!(inside("Switch { whichChild -3 Info { } } Group"), [1., 1.]);
        let text = "TransformSeparator { Material { } } Cube { }";
        assert_eq!(scene(text).materials.len(), 1, "only the transformation is kept");
    }

    #[test]
    fn switches_and_levels_give_one_child() {
        let text = format!("Switch {{ {STEP} }} Cube {{ }}");
        assert_eq!(centers(&text), [0.]);
        let text = format!("Switch {{ whichChild 1 Info {{ }} {STEP} }} Cube {{ }}");
        assert_eq!(centers(&text), [1.]);
        let text = format!("Switch {{ whichChild -3 {STEP} {STEP} }} Cube {{ }}");
        assert_eq!(centers(&text), [2.]);
        assert_eq!(centers(&format!("LOD {{ {STEP} {STEP} }} Cube {{ }}")), [1.]);
    }

    #[test]
    fn transformations_pile_up() {
        let text = "Scale { scaleFactor 2 1 1 } Translation { translation 1 0 0 }
            MatrixTransform { matrix 1 0 0 0 0 1 0 0 0 0 1 0 3 0 0 1 }
            Transform { translation 1 0 0 } DEF C Cube { } USE C";
        assert_eq!(scene(text).positions[7], [12.0, 1.0, 1.0]);
        assert_eq!(scene(text).positions.len(), 16);
    }

    #[test]
    fn hints_say_winding_and_crease_angle() {
        let faces = "Coordinate3 { point [ 0 0 0, 1 0 0, 0 1 0 ] }
            IndexedFaceSet { coordIndex [ 0, 1, 2, -1 ] }";
        let model = scene(faces);
        assert_eq!(model.per_polygon(|run| run.smoothing), [Smoothing::Angle(0.5)]);
        let model =
            scene(&format!("ShapeHints {{ vertexOrdering CLOCKWISE creaseAngle 1 }} {faces}"));
        assert_eq!(model.per_polygon(|run| run.smoothing), [Smoothing::Angle(1.0)]);
        assert_eq!(faces_of(&model), [[0, 2, 1]]);
    }

    #[test]
    fn normals_and_texture_coordinates_follow_their_bindings() {
        let normals = |binding: &str, index: &str| {
            scene(&format!(
                "Coordinate3 {{ point [ 0 0 0, 1 0 0, 0 1 0 ] }} {binding}
                 Normal {{ vector [ 0 0 1, 0 1 0, 1 0 0, 0 0 1, 0 1 0, 1 0 0 ] }}
                 IndexedFaceSet {{ coordIndex [ 0, 1, 2, -1, 2, 1, 0, -1 ] {index} }}"
            ))
            .corner_normals
        };
        let bound = |value: &str, index: &str| {
            normals(&format!("NormalBinding {{ value {value} }}"), index)
        };
        assert_eq!(normals("", "normalIndex -1"), [0, 1, 2, 2, 1, 0]);
        assert_eq!(bound("OVERALL", ""), [0; 6]);
        assert_eq!(bound("PER_FACE", ""), [0, 0, 0, 1, 1, 1]);
        assert_eq!(bound("PER_FACE_INDEXED", "normalIndex [ 2, 0 ]"), [2, 2, 2, 0, 0, 0]);
        assert_eq!(bound("PER_VERTEX", ""), [0, 1, 2, 3, 4, 5]);
        let index = "normalIndex [ 5, 4, 3, -1, 0, 0, 0, -1 ]";
        assert_eq!(bound("PER_VERTEX_INDEXED", index), [5, 4, 3, 0, 0, 0]);
        let model = scene(
            "Coordinate3 { point [ 0 0 0, 1 0 0, 0 1 0 ] }
             TextureCoordinate2 { point [ 0 0, 1 0, 0 1 ] } Normal { }
             IndexedFaceSet { coordIndex [ 0, 1, 2 ] textureCoordIndex [ 2, 1, 0 ] }",
        );
        assert_eq!((model.corner_texcoords, model.corner_normals.len()), (vec![2, 1, 0], 0));
    }

    #[test]
    fn materials_of_vertices_become_their_colors() {
        let model = scene(
            "Coordinate3 { point [ 0 0 0, 1 0 0, 0 1 0 ] }
             Material { diffuseColor [ 1 0 0, 0 1 0, 0 0 1 ] }
             MaterialBinding { value PER_VERTEX_INDEXED }
             IndexedFaceSet { coordIndex [ 0, 1, 2 ] materialIndex [ 2, 1, 0 ] }",
        );
        assert_eq!(model.colors, [[0., 0., 1.], [0., 1., 0.], [1., 0., 0.]]);
    }

    #[test]
    fn parts_of_solids_and_what_they_do_not_have() {
        let count = |text: &str| scene(text).polygon_count();
        assert_eq!(count("Cylinder { parts (SIDES|ALL) }"), 26);
        assert_eq!(count("Cylinder { parts (TOP | BOTTOM) }"), 2);
        assert_eq!(count("Cone { parts BOTTOM }"), 1);
        assert_eq!(count("Cone { } Sphere { radius 2 }"), 25 + 288);
        let text = "#VRML V1.0 ascii\nMaterial { diffuseColor [ 1 0 0, 0 1 0 ] }
            MaterialBinding { value PER_PART } Cylinder { }";
        assert_eq!(read(text).unwrap().1.count(WarningCode::Unsupported), 1);
        let text = "#VRML V1.0 ascii\nCube { } IndexedFaceSet { coordIndex [ 0, 1, 2 ] }";
        assert_eq!(read(text).unwrap().1.count(WarningCode::Syntax), 1);
    }
}
