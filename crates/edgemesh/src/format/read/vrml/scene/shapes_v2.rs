//! The shapes of VRML 97 as face sets (ISO/IEC 14772-1, clause 6).
//!
//! Colors of vertices become colors of corners. Colors of faces become materials that differ
//! only in their diffuse color, because a boundary between two of them is drawn.

use super::appearance::appearance;
use super::elevation_grid::elevation_grid;
use super::extrusion::Extrusion;
use super::face_set::{Binding, ElementLookup, FaceMaterials, FaceSet};
use super::number_list::{NumberList, to_f32};
use super::placement::Placement;
use super::scene_builder::SceneBuilder;
use super::solids::{SolidParts, Surface, cone, cuboid, cylinder, sphere};
use crate::format::read::error::ReadError;
use crate::format::read::vrml::parse::{NodeRef, Numbers};
use crate::model::{Material, Smoothing};
use crate::report::WarningCode;

/// Adds the geometry of a `Shape` node.
pub(super) fn add_shape(
    builder: &mut SceneBuilder,
    node: NodeRef,
    placement: &Placement,
) -> Result<(), ReadError> {
    let Some(geometry) = node.node_of("geometry") else { return Ok(()) };
    builder.visit(geometry)?;
    let material = node.node_of("appearance").and_then(|node| appearance(builder, node));
    let shape = Shape { node: geometry, material };
    match geometry.kind() {
        "IndexedFaceSet" => shape.add_face_set(builder, placement),
        "IndexedLineSet" => shape.add_line_set(builder, placement),
        "ElevationGrid" => shape.add_grid(builder, placement),
        "Extrusion" => shape.add_extrusion(builder, placement),
        "Box" => shape.add_solid(builder, placement, &cuboid(geometry.vector("size", [2.0; 3]))),
        "Sphere" => shape.add_solid(builder, placement, &sphere(geometry.number("radius", 1.0))),
        "Cone" => shape.add_solid(builder, placement, &shape.cone()),
        "Cylinder" => shape.add_solid(builder, placement, &shape.cylinder()),
        _ => {
            builder.warn_unsupported(geometry);
            Ok(())
        }
    }
}

/// The smoothing of a node with a `creaseAngle`.
fn crease(node: NodeRef) -> Smoothing {
    Smoothing::Angle(to_f32(node.number("creaseAngle", 0.0)))
}

/// A geometry node and its material.
struct Shape<'a> {
    node: NodeRef<'a>,
    material: Option<Material>,
}

impl<'a> Shape<'a> {
    fn add_face_set(
        &self,
        builder: &mut SceneBuilder,
        placement: &Placement,
    ) -> Result<(), ReadError> {
        let Some(points) = self.points(builder) else { return Ok(()) };
        let indices = self.node.numbers("coordIndex");
        let set = self.face_set(points, indices, crease(self.node));
        builder.add_faces(&set, placement)
    }

    /// The list of points; `None` if there is none, with a warning if the shape needs it.
    fn points(&self, builder: &mut SceneBuilder) -> Option<NumberList<'a>> {
        let points = self.node.node_of("coord").map(|coord| NumberList::of(coord, "point"));
        if points.is_none() && !self.node.numbers("coordIndex").values.is_empty() {
            builder.warn(self.node, WarningCode::Syntax, || {
                format!("{} without points was left out", self.node.kind())
            });
        }
        points
    }

    /// Faces with the attributes in the fields of the node.
    fn face_set(
        &self,
        points: NumberList<'a>,
        indices: Numbers<'a>,
        smoothing: Smoothing,
    ) -> FaceSet<'a> {
        let material = self.material.clone();
        let mut set = FaceSet::new(self.node, points, indices, material, smoothing);
        set.is_clockwise = !self.node.flag("ccw", true);
        let normals = NumberList::if_any(self.node.node_of("normal"), "vector");
        set.normals = normals.map(|list| (self.lookup("normalIndex", "normalPerVertex"), list));
        let texcoords = NumberList::if_any(self.node.node_of("texCoord"), "point");
        set.texcoords = texcoords.map(|list| (self.lookup("texCoordIndex", ""), list));
        if let Some(colors) = NumberList::if_any(self.node.node_of("color"), "color") {
            let lookup = self.lookup("colorIndex", "colorPerVertex");
            if lookup.binding == Binding::CornerIndexed {
                set.set_colors(lookup, colors);
            } else {
                let base = self.material.clone().unwrap_or_default();
                let material = Box::new(move |at| tinted(&base, &colors, at));
                set.face_materials = Some(FaceMaterials { lookup, material });
            }
        }
        set
    }

    /// The lookup of a list, from the name of the field of its indices, and of the field
    /// that distinguishes elements for vertices and for faces.
    fn lookup(&self, indices: &str, per_vertex: &str) -> ElementLookup<'a> {
        let indices = self.node.numbers(indices);
        let binding = match (self.node.flag(per_vertex, true), indices.values.is_empty()) {
            (true, _) => Binding::CornerIndexed,
            (false, true) => Binding::Face,
            (false, false) => Binding::FaceIndexed,
        };
        ElementLookup { binding, indices }
    }

    fn add_line_set(
        &self,
        builder: &mut SceneBuilder,
        placement: &Placement,
    ) -> Result<(), ReadError> {
        let Some(points) = self.points(builder) else { return Ok(()) };
        builder.add_lines(self.node, &points, &self.node.numbers("coordIndex"), placement)
    }

    fn add_grid(&self, builder: &mut SceneBuilder, placement: &Placement) -> Result<(), ReadError> {
        match elevation_grid(self.node, crease(self.node)) {
            Ok(grid) => {
                let line = self.node.line();
                let points =
                    NumberList::generated(self.node, Numbers::generated(&grid.points, line));
                let indices = Numbers::generated(&grid.indices, line);
                let set = self.face_set(points, indices, grid.smoothing);
                builder.add_faces(&set, placement)
            }
            Err(why) => {
                builder.warn(self.node, WarningCode::Syntax, || why);
                Ok(())
            }
        }
    }

    fn add_extrusion(
        &self,
        builder: &mut SceneBuilder,
        placement: &Placement,
    ) -> Result<(), ReadError> {
        let extrusion = Extrusion::of(self.node, crease(self.node));
        // Before it is generated: a long spine and a large cross section multiply.
        builder.spend(self.node, extrusion.element_count())?;
        self.add_solid(builder, placement, &extrusion.surface())
    }

    fn cone(&self) -> Surface {
        let radius = self.node.number("bottomRadius", 1.0);
        cone(radius, self.node.number("height", 2.0), self.parts())
    }

    fn cylinder(&self) -> Surface {
        let radius = self.node.number("radius", 1.0);
        cylinder(radius, self.node.number("height", 2.0), self.parts())
    }

    fn parts(&self) -> SolidParts {
        SolidParts {
            side: self.node.flag("side", true),
            bottom: self.node.flag("bottom", true),
            top: self.node.flag("top", true),
        }
    }

    fn add_solid(
        &self,
        builder: &mut SceneBuilder,
        placement: &Placement,
        surface: &Surface,
    ) -> Result<(), ReadError> {
        let line = self.node.line();
        let points = NumberList::generated(self.node, Numbers::generated(&surface.points, line));
        let indices = Numbers::generated(&surface.indices, line);
        let material = self.material.clone();
        let mut set = FaceSet::new(self.node, points, indices, material, surface.smoothing);
        set.is_clockwise = !self.node.flag("ccw", true);
        builder.add_faces(&set, placement)
    }
}

/// A material with a diffuse color from a list.
fn tinted(base: &Material, colors: &NumberList, at: usize) -> Option<Material> {
    let diffuse = colors.numbers.chunks::<3>().get(at)?.map(to_f32);
    Some(Material { diffuse: Some(diffuse), ..base.clone() })
}
