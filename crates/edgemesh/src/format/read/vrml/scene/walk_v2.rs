//! Walks a VRML 97 scene: groups, transforms and shapes (ISO/IEC 14772-1, 4.6.5 and
//! clause 6).
//!
//! Billboards are not rotated, because there is no viewer. Of levels of detail the first
//! is drawn, which is the finest.

use super::inline_request::InlineRequest;
use super::placement::Placement;
use super::scene_builder::SceneBuilder;
use super::shapes_v2::add_shape;
use super::transforms::of_transform;
use super::traversal::{Step, Traversal, nth};
use crate::format::read::error::ReadError;
use crate::format::read::vrml::parse::{Document, NodeRef, whole};

/// Nodes that are not drawn, besides sensors and interpolators; nodes of appearances and
/// geometries may stand alone to be named by `DEF`.
const NOT_DRAWN: [&str; 22] = [
    "Appearance",
    "AudioClip",
    "Background",
    "Color",
    "Coordinate",
    "DirectionalLight",
    "Fog",
    "FontStyle",
    "ImageTexture",
    "Material",
    "MovieTexture",
    "NavigationInfo",
    "Normal",
    "PixelTexture",
    "PointLight",
    "Script",
    "Sound",
    "SpotLight",
    "TextureCoordinate",
    "TextureTransform",
    "Viewpoint",
    "WorldInfo",
];

/// A walk through a file; each list of nodes has a placement.
pub(super) struct Walk<'d> {
    traversal: Traversal<'d, Placement>,
}

impl<'d> Walk<'d> {
    /// A walk through `document`, placed at `placement`.
    pub(super) fn new(document: &'d Document, placement: Placement) -> Self {
        let mut traversal = Traversal::new();
        traversal.enter(document.root().first_child(), usize::MAX, placement);
        Self { traversal }
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
            let Step::Node(node) = step else { continue };
            let outer = self.traversal.saved().cloned().unwrap_or_default();
            let placement = outer.named(node);
            if node.kind() == "Inline" {
                builder.visit(node)?;
                return Ok(Some(InlineRequest { node, field: "url", placement }));
            }
            self.add_node(builder, node, placement)?;
        }
        Ok(None)
    }

    fn add_node(
        &mut self,
        builder: &mut SceneBuilder,
        node: NodeRef<'d>,
        placement: Placement,
    ) -> Result<(), ReadError> {
        builder.visit(node)?;
        match node.kind() {
            "Shape" => add_shape(builder, node, &placement)?,
            "Transform" => {
                let inside = placement.moved(of_transform(node, "scale"));
                self.enter_children(node, &inside);
            }
            "Anchor" | "Billboard" | "Collision" | "Group" => {
                self.enter_children(node, &placement);
            }
            "Switch" => {
                let choice = whole(node.number("whichChoice", -1.0));
                self.enter_one(builder, node, "choice", choice, placement)?;
            }
            "LOD" => self.enter_one(builder, node, "level", Some(0), placement)?,
            kind if is_drawn(kind) => builder.warn_unsupported(node),
            _ => {}
        }
        Ok(())
    }

    /// Enters all children, also those outside a field, which is malformed but clear.
    fn enter_children(&mut self, node: NodeRef<'d>, placement: &Placement) {
        self.traversal.enter(node.first_child(), usize::MAX, placement.clone());
        for field in node.fields().rev().filter(|field| field.name() == "children") {
            self.traversal.enter(field.first_node(), usize::MAX, placement.clone());
        }
    }

    /// Enters one of the nodes of a field; none if there is no such `choice`.
    fn enter_one(
        &mut self,
        builder: &mut SceneBuilder,
        node: NodeRef<'d>,
        field: &str,
        choice: Option<usize>,
        placement: Placement,
    ) -> Result<(), ReadError> {
        let first = node.field(field).and_then(|field| field.first_node());
        let Some(choice) = choice else { return Ok(()) };
        let chosen = nth(first, Some(choice));
        builder.spend(node, choice)?;
        self.traversal.enter(chosen, 1, placement);
        Ok(())
    }
}

fn is_drawn(kind: &str) -> bool {
    let is_silent = kind.ends_with("Sensor") || kind.ends_with("Interpolator");
    !is_silent && !NOT_DRAWN.contains(&kind)
}

#[cfg(test)]
mod tests {
    use crate::format::read::vrml::tests::{read, sound};

    /// The widths of the boxes that are drawn.
    fn widths(text: &str) -> Vec<f64> {
        let model =
            sound(&text.replace('(', "Shape { geometry Box { size ").replace(')', " 1 1 } }"));
        model.positions.chunks(8).map(|corners| corners[7][0] - corners[0][0]).collect()
    }

    #[test]
    fn groups_draw_their_children_and_switches_their_choice() {
        assert_eq!(
            widths(
                "Anchor { children (1) } Collision { children [(2) (3)] proxy (9) }
            Billboard { children (4) }"
            ),
            [1., 2., 3., 4.]
        );
        assert_eq!(widths("Switch { whichChoice 1 choice [(1) (2) (3)] } (4)"), [2., 4.]);
        assert_eq!(widths("Switch { choice [(1)] } Switch { whichChoice 7 choice (2) } (3)"), [3.]);
        assert_eq!(widths("LOD { level [(1) (2)] range [ 5 ] } LOD { } (3)"), [1., 3.]);
        assert_eq!(widths("Group { (1) children (2) }"), [2., 1.], "both are drawn");
    }

    #[test]
    fn transforms_multiply() {
        let text = "Transform { scale 2 1 1 translation 1 0 0 children
            Transform { translation 3 0 0 children DEF B (2) } } USE B";
        assert_eq!(widths(text), [4., 2.]);
        let shape = "Shape { geometry Box { } }";
        let model = sound(&format!(
            "Transform {{ scale 2 1 1 translation 1 0 0 children
             Transform {{ translation 3 0 0 children {shape} }} }}"
        ));
        assert_eq!(model.positions[7], [9.0, 1.0, 1.0]);
    }

    #[test]
    fn grids_are_face_sets_with_colors_and_normals() {
        let grid = |fields: &str| {
            format!("Shape {{ geometry ElevationGrid {{ xDimension 3 zDimension 2 {fields} }} }}")
        };
        let heights = "height [ 0 1 0, 0 1 0 ]";
        let model = sound(&grid(&format!(
            "{heights} creaseAngle 1 color Color {{ color [ 1 0 0, 0 1 0 ] }}
             colorPerVertex FALSE normal Normal {{ vector [ 0 1 0, 1 1 0 ] }} normalPerVertex FALSE"
        )));
        assert_eq!(
            (model.positions.len(), model.polygon_count(), model.materials.len()),
            (6, 2, 2)
        );
        assert_eq!(model.corner_normals, [0, 0, 0, 0, 1, 1, 1, 1]);
        for wrong in
            ["height [ 0 1 ]", "height [ 0 ] xDimension 1e9 zDimension 1e9", "zDimension -1"]
        {
            let (_, report) = read(&(grid(wrong) + "Shape { geometry Box { } }")).unwrap();
            assert!(report.warnings()[0].message.contains("grid"), "{wrong}: {report:?}");
        }
    }
}
