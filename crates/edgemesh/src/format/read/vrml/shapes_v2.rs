//! The shapes of VRML 97 as face sets (ISO/IEC 14772-1, clause 6).
//!
//! Colours of vertices become colours of vertices. Colours of faces become
//! materials that differ in nothing but their diffuse colour, as a border
//! between two of them is a line of the drawing.

use super::document::{NodeRef, Numbers};
use super::elevation_grid::elevation_grid;
use super::extrusion::Extrusion;
use super::faces::{Binding, Bound, FaceMaterials, FaceSet};
use super::lists::{List, to_f32};
use super::materials::of_appearance;
use super::scene::{Placement, Scene};
use super::solids::{Parts, Surface, cone, cuboid, cylinder, sphere};
use crate::format::read::error::ReadError;
use crate::model::{Material, Smoothing};
use crate::report::WarningCode;

/// Adds a `Shape`.
pub(super) fn add_shape(
    scene: &mut Scene,
    node: NodeRef,
    placement: &Placement,
) -> Result<(), ReadError> {
    let Some(geometry) = node.node_of("geometry") else { return Ok(()) };
    scene.visit(geometry)?;
    let material = node.node_of("appearance").and_then(|looks| of_appearance(scene, looks));
    let shape = Shape { node: geometry, material };
    match geometry.kind() {
        "IndexedFaceSet" => shape.add_face_set(scene, placement),
        "IndexedLineSet" => shape.add_line_set(scene, placement),
        "ElevationGrid" => shape.add_grid(scene, placement),
        "Extrusion" => shape.add_extrusion(scene, placement),
        "Box" => shape.add_solid(scene, placement, &cuboid(geometry.vector("size", [2.0; 3]))),
        "Sphere" => shape.add_solid(scene, placement, &sphere(geometry.number("radius", 1.0))),
        "Cone" => shape.add_solid(scene, placement, &shape.cone()),
        "Cylinder" => shape.add_solid(scene, placement, &shape.cylinder()),
        _ => {
            scene.warn_unread(geometry);
            Ok(())
        }
    }
}

/// The smoothing of a node that has a `creaseAngle`.
pub(super) fn crease(node: NodeRef) -> Smoothing {
    Smoothing::Angle(to_f32(node.number("creaseAngle", 0.0)))
}

/// A geometry and what it is painted with.
struct Shape<'a> {
    node: NodeRef<'a>,
    material: Option<Material>,
}

impl<'a> Shape<'a> {
    fn add_face_set(&self, scene: &mut Scene, placement: &Placement) -> Result<(), ReadError> {
        let Some(points) = self.points(scene) else { return Ok(()) };
        let indices = self.node.numbers("coordIndex");
        let set = self.face_set(points, indices, crease(self.node));
        scene.add_faces(&set, placement)
    }

    /// The list of points; `None` where there is none, which is said where it
    /// costs anything.
    fn points(&self, scene: &mut Scene) -> Option<List<'a>> {
        let points = self.node.node_of("coord").map(|coord| List::of(coord, "point"));
        if points.is_none() && !self.node.numbers("coordIndex").values.is_empty() {
            scene.warn(self.node, WarningCode::Syntax, || {
                format!("{} without points was left out", self.node.kind())
            });
        }
        points
    }

    /// Faces with all that the fields of the node say of them.
    fn face_set(
        &self,
        points: List<'a>,
        indices: Numbers<'a>,
        smoothing: Smoothing,
    ) -> FaceSet<'a> {
        let material = self.material.clone();
        let mut set = FaceSet::bare(self.node, points, indices, material, smoothing);
        set.is_clockwise = !self.node.flag("ccw", true);
        let normals = List::if_any(self.node.node_of("normal"), "vector");
        set.normals = normals.map(|list| (self.bound("normalIndex", "normalPerVertex"), list));
        let texcoords = List::if_any(self.node.node_of("texCoord"), "point");
        set.texcoords = texcoords.map(|list| (self.bound("texCoordIndex", ""), list));
        if let Some(colors) = List::if_any(self.node.node_of("color"), "color") {
            let bound = self.bound("colorIndex", "colorPerVertex");
            if bound.binding == Binding::CornerIndexed {
                set.colors = Some((bound, colors));
            } else {
                let base = self.material.clone().unwrap_or_default();
                let material = Box::new(move |at| tinted(&base, &colors, at));
                set.face_materials = Some(FaceMaterials { bound, material });
            }
        }
        set
    }

    /// How a list is bound to corners, by the fields for its indices and for
    /// whether it has one element a vertex or one a face.
    fn bound(&self, indices: &str, per_vertex: &str) -> Bound<'a> {
        let indices = self.node.numbers(indices);
        let binding = match (self.node.flag(per_vertex, true), indices.values.is_empty()) {
            (true, _) => Binding::CornerIndexed,
            (false, true) => Binding::Face,
            (false, false) => Binding::FaceIndexed,
        };
        Bound { binding, indices }
    }

    fn add_line_set(&self, scene: &mut Scene, placement: &Placement) -> Result<(), ReadError> {
        let Some(points) = self.points(scene) else { return Ok(()) };
        scene.add_lines(self.node, &points, &self.node.numbers("coordIndex"), placement)
    }

    fn add_grid(&self, scene: &mut Scene, placement: &Placement) -> Result<(), ReadError> {
        match elevation_grid(self.node, crease(self.node)) {
            Ok(grid) => {
                let line = self.node.line();
                let points = List::made(self.node, Numbers::made(&grid.points, line));
                let indices = Numbers::made(&grid.indices, line);
                let set = self.face_set(points, indices, grid.smoothing);
                scene.add_faces(&set, placement)
            }
            Err(why) => {
                scene.warn(self.node, WarningCode::Syntax, || why);
                Ok(())
            }
        }
    }

    fn add_extrusion(&self, scene: &mut Scene, placement: &Placement) -> Result<(), ReadError> {
        let extrusion = Extrusion::of(self.node);
        // Before it is made: a long spine and a large cross section multiply.
        scene.spend(self.node, extrusion.element_count())?;
        self.add_solid(scene, placement, &extrusion.surface())
    }

    fn cone(&self) -> Surface {
        let radius = self.node.number("bottomRadius", 1.0);
        cone(radius, self.node.number("height", 2.0), self.parts())
    }

    fn cylinder(&self) -> Surface {
        let radius = self.node.number("radius", 1.0);
        cylinder(radius, self.node.number("height", 2.0), self.parts())
    }

    fn parts(&self) -> Parts {
        Parts {
            side: self.node.flag("side", true),
            bottom: self.node.flag("bottom", true),
            top: self.node.flag("top", true),
        }
    }

    fn add_solid(
        &self,
        scene: &mut Scene,
        placement: &Placement,
        surface: &Surface,
    ) -> Result<(), ReadError> {
        let line = self.node.line();
        let points = List::made(self.node, Numbers::made(&surface.points, line));
        let indices = Numbers::made(&surface.indices, line);
        let material = self.material.clone();
        let mut set = FaceSet::bare(self.node, points, indices, material, surface.smoothing);
        set.is_clockwise = !self.node.flag("ccw", true);
        scene.add_faces(&set, placement)
    }
}

/// A material with another diffuse colour out of a list.
fn tinted(base: &Material, colors: &List, at: usize) -> Option<Material> {
    let diffuse = colors.numbers.chunks::<3>().get(at)?.map(to_f32);
    Some(Material { diffuse: Some(diffuse), ..base.clone() })
}
