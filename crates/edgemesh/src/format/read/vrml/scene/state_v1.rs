//! The state of VRML 1.0, which property nodes change for the nodes after them.

use glam::{DAffine3, DVec3};

use super::face_set::Binding;
use super::placement::Placement;
use super::transforms::{of_matrix, of_transform, rotation};
use crate::format::read::vrml::parse::NodeRef;

/// The state at a node.
#[derive(Debug, Clone)]
pub(super) struct State<'d> {
    /// The placement of shapes.
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
    /// The binding of materials.
    pub(super) material_binding: Binding,
    /// The binding of normals.
    pub(super) normal_binding: Binding,
    /// Whether faces are clockwise, seen from outside.
    pub(super) is_clockwise: bool,
    /// The largest angle of a smooth edge, in radians.
    pub(super) crease_angle: f64,
}

/// The crease angle before a `ShapeHints` node, in radians.
const DEFAULT_CREASE_ANGLE: f64 = 0.5;

impl<'d> State<'d> {
    /// The state at the start of a file.
    pub(super) const fn new(placement: Placement) -> Self {
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
            crease_angle: DEFAULT_CREASE_ANGLE,
        }
    }

    /// Applies a property node; returns whether `node` is one.
    pub(super) fn apply(&mut self, node: NodeRef<'d>) -> bool {
        match node.kind() {
            "Coordinate3" => self.coordinates = Some(node),
            "Normal" => self.normals = Some(node),
            "TextureCoordinate2" => self.texcoords = Some(node),
            "Material" => self.material = Some(node),
            "Texture2" => self.texture = Some(node),
            "MaterialBinding" => self.material_binding = binding(node, Binding::Overall),
            "NormalBinding" => self.normal_binding = binding(node, Binding::CornerIndexed),
            "ShapeHints" => {
                self.is_clockwise = node.word("vertexOrdering") == Some("CLOCKWISE");
                self.crease_angle = node.number("creaseAngle", DEFAULT_CREASE_ANGLE);
            }
            _ => match transform(node) {
                Some(transform) => self.placement.transform *= transform,
                None => return false,
            },
        }
        true
    }
}

/// The transform of a node, if it is one of the transform nodes.
fn transform(node: NodeRef) -> Option<DAffine3> {
    Some(match node.kind() {
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

/// The value of a binding node. A part of a face set is a face.
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
