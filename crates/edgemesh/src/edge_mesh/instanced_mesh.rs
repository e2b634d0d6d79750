//! A mesh in several places.

use glam::{DMat4, DVec3, Vec3};
use rayon::prelude::*;

use crate::edge_mesh::mesh::{Bounds, EdgeMesh, MeshCounts};
use crate::edge_mesh::mesh_frame::MeshFrame;

/// A mesh in several places, beside another mesh of the same frame.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct InstancedMesh {
    /// The mesh.
    pub mesh: EdgeMesh,
    /// The transforms from positions of the mesh to each place, in units of the mesh. They turn,
    /// move, mirror and scale alike along all axes.
    pub placements: Vec<DMat4>,
}

impl InstancedMesh {
    /// The box around all places; `None` without vertices or places.
    #[must_use]
    pub fn bounds(&self) -> Option<Bounds> {
        let is_empty = self.mesh.positions.is_empty();
        let places = self.placements.iter().filter(|_| !is_empty);
        places.map(|place| self.placed_bounds(place)).reduce(|all, own| all.union(&own))
    }

    /// The box around the vertices in one place.
    fn placed_bounds(&self, place: &DMat4) -> Bounds {
        if *place == DMat4::IDENTITY {
            return self.mesh.bounds;
        }
        let nothing = || (Vec3::INFINITY, Vec3::NEG_INFINITY);
        let positions = self.mesh.positions.par_iter().with_min_len(1 << 12);
        let (min, max) = positions
            .fold(nothing, |(min, max), &position| {
                let at = place.transform_point3(DVec3::from(position.map(f64::from))).as_vec3();
                (min.min(at), max.max(at))
            })
            .reduce(nothing, |a, b| (a.0.min(b.0), a.1.max(b.1)));
        Bounds { min: min.into(), max: max.into() }
    }

    /// Moves the mesh to another frame, at the same places in the file.
    pub(crate) fn set_frame(&mut self, frame: MeshFrame) {
        let old = self.mesh.frame;
        self.mesh.set_frame(frame);
        self.placements.iter_mut().for_each(|place| {
            *place = frame.of_file(&old.in_file(place));
        });
    }
}

/// The box around a mesh and the places of others; a point at the origin without any vertex.
#[must_use]
pub fn bounds_with(mesh: &EdgeMesh, instanced: &[InstancedMesh]) -> Bounds {
    let own = (!mesh.positions.is_empty()).then_some(mesh.bounds);
    let all = own.into_iter().chain(instanced.iter().filter_map(InstancedMesh::bounds));
    all.reduce(|all, own| all.union(&own)).unwrap_or_default()
}

/// The counts of a mesh and of others, each times its places.
#[must_use]
pub fn counts_with(mesh: &EdgeMesh, instanced: &[InstancedMesh]) -> MeshCounts {
    let mut counts = mesh.counts;
    for InstancedMesh { mesh, placements } in instanced {
        counts.add(&mesh.counts, placements.len());
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle() -> EdgeMesh {
        let positions = vec![[1.0, 0.0, 0.0], [3.0, 0.0, 0.0], [1.0, 1.0, 0.0]];
        let bounds = Bounds::of(&positions);
        let counts = MeshCounts { vertices: 3, components: 1, ..MeshCounts::default() };
        EdgeMesh { positions, bounds, counts, ..EdgeMesh::default() }
    }

    #[test]
    fn boxes_are_around_the_vertices_not_around_their_boxes() {
        // (1 0), (3 0), (1 1), turned by 45 degrees: y from 0.707 to 2.121, x from 0.
        let turn = DMat4::from_rotation_z(std::f64::consts::FRAC_PI_4);
        let instanced = InstancedMesh { mesh: triangle(), placements: vec![turn] };
        let Bounds { min, max } = instanced.bounds().unwrap();
        let half = 0.5_f32.sqrt();
        for (found, expected) in [(min[0], 0.0), (max[0], 3.0 * half), (max[1], 3.0 * half)] {
            assert!((found - expected).abs() < 1e-6, "{found} {expected}");
        }
        let nothing = InstancedMesh { mesh: triangle(), placements: vec![] };
        assert_eq!(bounds_with(&EdgeMesh::default(), &[nothing]), Bounds::default());
        let whole = bounds_with(&EdgeMesh::default(), &[instanced]);
        assert!(whole.min[1] > 0.7, "an empty mesh has no box: {whole:?}");
    }

    #[test]
    fn counts_are_those_of_all_places() {
        let placements = vec![DMat4::IDENTITY; 4];
        let counts = counts_with(&triangle(), &[InstancedMesh { mesh: triangle(), placements }]);
        assert_eq!((counts.vertices, counts.components), (15, 5));
    }

    #[test]
    fn another_frame_keeps_the_places_in_the_file() {
        let place = DMat4::from_translation(DVec3::new(100.0, 0.0, 0.0));
        let mut instanced = InstancedMesh { mesh: triangle(), placements: vec![place] };
        instanced.set_frame(MeshFrame { origin: DVec3::new(50.0, 0.0, 0.0), scale: 0.5 });
        // x = 103 in the file is (103 - 50) / 2 in the mesh.
        assert_eq!(instanced.bounds().unwrap().max[0], 26.5);
    }
}
