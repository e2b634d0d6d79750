//! Walks a VRML 1.0 scene with its state: transform, points, materials and hints, which
//! each node changes for the nodes after it.
//!
//! ```text
//! Separator {          saves the state
//!   Translation { }    moves the shapes after it
//!   Coordinate3 { }    the points of the shapes after it
//!   IndexedFaceSet { } a shape with this state
//! }                    restores the state
//! ```
//!
//! `TransformSeparator` restores only the transform; `Group`, `Switch` and `LOD` restore
//! nothing. A file may have several roots; they share one state, as in most programs.

use std::rc::Rc;

use super::inline_request::InlineRequest;
use super::placement::Placement;
use super::scene_builder::SceneBuilder;
use super::shapes_v1::add_shape;
use super::state_v1::State;
use super::traversal::{Step, Traversal, nth};
use crate::format::read::error::ReadError;
use crate::format::read::vrml::parse::{Document, NodeRef, whole};

/// Nodes that are not drawn and do not affect others.
const NOT_DRAWN: [&str; 7] = [
    "DirectionalLight",
    "FontStyle",
    "Info",
    "OrthographicCamera",
    "PerspectiveCamera",
    "PointLight",
    "SpotLight",
];

/// The `whichChild` of a `Switch` that draws all children.
const ALL_CHILDREN: f64 = -3.0;

/// What is restored at the end of a list of children.
enum SavedState<'d> {
    /// The name of the group.
    Group(Option<Rc<str>>),
    /// The whole placement.
    Placement(Placement),
    /// The whole state.
    State(Box<State<'d>>),
}

/// A walk through a file.
pub(super) struct Walk<'d> {
    traversal: Traversal<'d, SavedState<'d>>,
    state: State<'d>,
}

impl<'d> Walk<'d> {
    /// A walk through `document`, placed at `placement`.
    pub(super) fn new(document: &'d Document, placement: Placement) -> Self {
        let mut traversal = Traversal::new();
        let saved = SavedState::Group(None);
        traversal.enter(document.root().first_child(), usize::MAX, saved);
        Self { traversal, state: State::new(placement) }
    }

    /// Adds nodes up to the next inlined file; `None` at the end of the walk.
    ///
    /// # Errors
    /// Fails if a node has a fault, or the allowance is exceeded.
    pub(super) fn run(
        &mut self,
        builder: &mut SceneBuilder,
    ) -> Result<Option<InlineRequest<'d>>, ReadError> {
        while let Some(step) = self.traversal.step() {
            match step {
                Step::Node(node) if node.kind() == "WWWInline" => {
                    builder.visit(node)?;
                    let placement = self.state.placement.named(node);
                    return Ok(Some(InlineRequest { node, field: "name", placement }));
                }
                Step::Node(node) => self.add_node(builder, node)?,
                Step::Leave(SavedState::Group(group)) => self.state.placement.group = group,
                Step::Leave(SavedState::Placement(placement)) => self.state.placement = placement,
                Step::Leave(SavedState::State(state)) => self.state = *state,
            }
        }
        Ok(None)
    }

    fn add_node(&mut self, builder: &mut SceneBuilder, node: NodeRef<'d>) -> Result<(), ReadError> {
        builder.visit(node)?;
        match node.kind() {
            "Separator" | "WWWAnchor" => {
                let saved = SavedState::State(Box::new(self.state.clone()));
                self.enter(node, node.first_child(), usize::MAX, saved);
            }
            "TransformSeparator" => {
                let saved = SavedState::Placement(self.state.placement.clone());
                self.enter(node, node.first_child(), usize::MAX, saved);
            }
            "Group" => self.enter_some(node, node.first_child(), usize::MAX),
            "LOD" => self.enter_some(node, node.first_child(), 1),
            "Switch" => self.enter_choice(builder, node)?,
            kind => {
                if !self.state.apply(node)
                    && !add_shape(builder, node, &self.state)?
                    && !NOT_DRAWN.contains(&kind)
                {
                    builder.warn_unsupported(node);
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
        saved: SavedState<'d>,
    ) {
        self.traversal.enter(first, count, saved);
        self.state.placement = self.state.placement.named(node);
    }

    /// Enters children that change the state of the nodes after their parent.
    fn enter_some(&mut self, node: NodeRef<'d>, first: Option<NodeRef<'d>>, count: usize) {
        let saved = SavedState::Group(self.state.placement.group.clone());
        self.enter(node, first, count, saved);
    }

    fn enter_choice(
        &mut self,
        builder: &mut SceneBuilder,
        node: NodeRef<'d>,
    ) -> Result<(), ReadError> {
        let choice = node.number("whichChild", -1.0);
        if choice.to_bits() == ALL_CHILDREN.to_bits() {
            self.enter_some(node, node.first_child(), usize::MAX);
        } else if let Some(choice) = whole(choice) {
            let chosen = nth(node.first_child(), Some(choice));
            builder.spend(node, choice)?;
            self.enter_some(node, chosen, 1);
        }
        Ok(())
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

    /// The x coordinates of the centers of the cubes, doubled.
    fn centers(text: &str) -> Vec<f64> {
        let model = scene(text);
        model.positions.chunks(8).map(|corners| corners[7][0] + corners[0][0]).collect()
    }

    const STEP: &str = "Translation { translation 0.5 0 0 }";

    #[test]
    fn separators_restore_the_state_and_groups_do_not() {
        let inside = |group: &str| centers(&format!("{group} {{ {STEP} Cube {{ }} }} Cube {{ }}"));
        assert_eq!(inside("Separator"), [1., 0.]);
        assert_eq!(inside("TransformSeparator"), [1., 0.]);
        assert_eq!(inside("WWWAnchor"), [1., 0.]);
        assert_eq!(inside("Group"), [1., 1.]);
        assert_eq!(inside("Switch { whichChild -3 Info { } } Group"), [1., 1.]);
        let text = "TransformSeparator { Material { } } Cube { }";
        assert_eq!(scene(text).materials.len(), 1, "only the transform is restored");
    }

    #[test]
    fn switches_and_levels_of_detail_draw_one_child() {
        let text = format!("Switch {{ {STEP} }} Cube {{ }}");
        assert_eq!(centers(&text), [0.]);
        let text = format!("Switch {{ whichChild 1 Info {{ }} {STEP} }} Cube {{ }}");
        assert_eq!(centers(&text), [1.]);
        let text = format!("Switch {{ whichChild -3 {STEP} {STEP} }} Cube {{ }}");
        assert_eq!(centers(&text), [2.]);
        assert_eq!(centers(&format!("LOD {{ {STEP} {STEP} }} Cube {{ }}")), [1.]);
    }

    #[test]
    fn transforms_accumulate() {
        let text = "Scale { scaleFactor 2 1 1 } Translation { translation 1 0 0 }
            MatrixTransform { matrix 1 0 0 0 0 1 0 0 0 0 1 0 3 0 0 1 }
            Transform { translation 1 0 0 } DEF C Cube { } USE C";
        assert_eq!(scene(text).positions[7], [12.0, 1.0, 1.0]);
        assert_eq!(scene(text).positions.len(), 16);
    }

    #[test]
    fn shape_hints_set_winding_and_crease_angle() {
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
    fn materials_of_vertices_become_colors_of_corners() {
        let model = scene(
            "Coordinate3 { point [ 0 0 0, 1 0 0, 0 1 0 ] }
             Material { diffuseColor [ 1 0 0, 0 1 0, 0 0 1 ] }
             MaterialBinding { value PER_VERTEX_INDEXED }
             IndexedFaceSet { coordIndex [ 0, 1, 2 ] materialIndex [ 2, 1, 0 ] }",
        );
        let colors = [0, 1, 2].map(|corner| model.corner_color(corner));
        assert_eq!(colors, [[0., 0., 1., 1.], [0., 1., 0., 1.], [1., 0., 0., 1.]]);
        assert_eq!(model.materials[0].diffuse, Some([1.; 3]), "the colors stand for it");
    }

    #[test]
    fn parts_of_solids_can_be_selected() {
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
