//! Walks a VRML 97 scene: groups, transformations, and the shapes in them
//! (ISO/IEC 14772-1, 4.6.5 and clause 6).
//!
//! Billboards stay as they stand, since no viewer turns them. Of levels of
//! detail the first is drawn, which is the finest.

use super::document::{Document, NodeRef, whole};
use super::scene::{Placement, Scene};
use super::shapes_v2::add_shape;
use super::transforms::of_transform;
use super::traversal::{Step, Traversal, nth};
use crate::format::read::error::ReadError;

/// Nodes that are not drawn, besides sensors and interpolators; those of
/// appearance and geometry may stand alone to be named for later.
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

/// Adds what is in a file, at `placement`.
pub(super) fn walk(
    scene: &mut Scene,
    document: &Document,
    placement: Placement,
) -> Result<(), ReadError> {
    let mut walk = Walk { scene, traversal: Traversal::new() };
    walk.traversal.enter(document.root().first_child(), usize::MAX, placement);
    while let Some(step) = walk.traversal.step() {
        if let Step::Node(node) = step {
            let around = walk.traversal.kept().cloned().unwrap_or_default();
            walk.visit(node, around.named(node))?;
        }
    }
    Ok(())
}

/// Each list of nodes has the place that its nodes stand in.
struct Walk<'w, 's, 'd> {
    scene: &'w mut Scene<'s>,
    traversal: Traversal<'d, Placement>,
}

impl<'d> Walk<'_, '_, 'd> {
    fn visit(&mut self, node: NodeRef<'d>, placement: Placement) -> Result<(), ReadError> {
        self.scene.visit(node)?;
        match node.kind() {
            "Shape" => add_shape(self.scene, node, &placement)?,
            "Transform" => {
                let inside = placement.moved(of_transform(node, "scale"));
                self.enter_children(node, &inside);
            }
            "Anchor" | "Billboard" | "Collision" | "Group" => {
                self.enter_children(node, &placement);
            }
            "Switch" => {
                let choice = whole(node.number("whichChoice", -1.0));
                self.enter_one(node, "choice", choice, placement)?;
            }
            "LOD" => self.enter_one(node, "level", Some(0), placement)?,
            "Inline" => self.scene.inline(node, "url", placement)?,
            kind if is_drawn(kind) => self.scene.warn_unread(node),
            _ => {}
        }
        Ok(())
    }

    /// Goes into all children, those outside of a field too, which is wrong but
    /// clear enough.
    fn enter_children(&mut self, node: NodeRef<'d>, placement: &Placement) {
        self.traversal.enter(node.first_child(), usize::MAX, placement.clone());
        for field in node.fields().rev().filter(|field| field.name() == "children") {
            self.traversal.enter(field.first_node(), usize::MAX, placement.clone());
        }
    }

    /// Goes into one of the nodes of a field, or into none.
    fn enter_one(
        &mut self,
        node: NodeRef<'d>,
        field: &str,
        choice: Option<usize>,
        placement: Placement,
    ) -> Result<(), ReadError> {
        let first = node.field(field).and_then(|field| field.first_node());
        let Some(choice) = choice else { return Ok(()) };
        let chosen = nth(first, Some(choice));
        self.scene.spend(node, choice)?;
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

    /// The boxes that are drawn, told by their widths.
    fn widths(text: &str) -> Vec<f64> {
        let model =
            sound(&text.replace('(', "Shape { geometry Box { size ").replace(')', " 1 1 } }"));
        model.positions.chunks(8).map(|corners| corners[7][0] - corners[0][0]).collect()
    }

    #[test]
    fn groups_give_their_children_and_switches_their_choice() {
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
        assert_eq!(widths("Group { (1) children (2) }"), [2., 1.], "told clearly enough");
    }

    #[test]
    fn transforms_multiply_and_scale_by_the_outer_one() {
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
