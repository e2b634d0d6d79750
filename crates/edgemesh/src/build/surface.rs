//! The surface of repaired faces: planes, edge records and components, with closed parts outward.

use glam::Vec3;

use super::components::{Components, Measures};
use super::creases::CreaseNormals;
use super::marks::Marks;
use super::outside::{Outsides, Surfaces};
use super::planes::Planes;
use super::records::{RecordInput, RecordTable, build_records};
use super::repair::Faces;
use super::rounding::Rounding;
use super::{BuildOptions, FaceAttributes};
use crate::report::Report;

/// Planes, records and components of faces.
#[derive(Debug)]
pub(crate) struct Surface {
    pub(crate) planes: Planes,
    pub(crate) built: RecordTable,
    pub(crate) components: Components,
    measures: Vec<Measures>,
}

/// The welded positions, their rounding, and what the file says of faces and edges.
#[derive(Debug)]
pub(crate) struct SurfaceInput<'a> {
    pub(crate) positions: &'a [[f32; 3]],
    pub(crate) rounding: Rounding,
    pub(crate) attributes: &'a FaceAttributes,
    pub(crate) marks: &'a Marks,
    pub(crate) options: &'a BuildOptions,
    pub(crate) has_split_edges: bool,
}

impl SurfaceInput<'_> {
    fn surface(&self, faces: &Faces) -> Surface {
        let Faces { model, triangles, sources, table, clashes, .. } = faces;
        let planes = Planes::of(self.positions, triangles, table, &self.rounding);
        let normals = CreaseNormals::of(model, &planes, sources, &self.rounding, |corner| {
            let vertex = faces.welded_from_input[model.corner_positions[corner] as usize];
            Vec3::from(self.positions[vertex as usize]).as_dvec3()
        });
        let input = RecordInput {
            positions: self.positions,
            triangles,
            normals: &normals,
            sources,
            attributes: self.attributes,
            marks: self.marks,
            clashes,
            has_split_edges: self.has_split_edges,
            crease_steps: self.options.crease_steps(),
        };
        let built = build_records(&input, table);
        let components = Components::of_records(triangles.len(), &built.records);
        let measures = components.measures(self.positions, triangles);
        Surface { planes, built, components, measures }
    }

    fn outsides(&self, faces: &Faces, surface: &Surface) -> Outsides {
        let surfaces = Surfaces {
            positions: self.positions,
            triangles: &faces.triangles,
            records: &surface.built.records,
            components: &surface.components,
            measures: &surface.measures,
        };
        surfaces.outsides()
    }

    /// The surface of `faces`, in which closed surfaces that are inside out are turned; with `SOLID`
    /// and `GROOVE` on the records.
    pub(crate) fn outward_surface(&self, faces: &mut Faces, report: &mut Report) -> Surface {
        let mut surface = self.surface(faces);
        let mut outsides = self.outsides(faces, &surface);
        if !outsides.inside_out.is_empty() {
            let component_of = &surface.components.of_face;
            let is_wrong =
                |face: usize| outsides.inside_out.binary_search(&component_of[face]).is_ok();
            faces.turn(is_wrong, report);
            surface = self.surface(faces);
            outsides = self.outsides(faces, &surface);
        }
        let Surface { built, components, measures, .. } = &mut surface;
        let see_through = self.attributes.see_through_faces(faces.model, faces.triangles.len());
        components.mark_solids(measures, &outsides.has_outside, see_through, &mut built.records);
        surface
    }
}
