//! Finds the connected components of faces, and the solids among them.
//!
//! Idea: a union-find over all faces, by several threads at once. A thread hangs a root below a
//! smaller root by compare-and-swap, and tries again if another thread was faster (Anderson and
//! Woll 1991, "Wait-free Parallel Algorithms for the Union-Find Problem"). Roots only become
//! smaller, so the smallest face becomes the root of each set in any order.
//!
//! Rejected: a walk from face to face, which is sequential.

use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use crate::edge_mesh::{EdgeFlags, EdgeRecord, EdgeTable, corners_of};
use crate::index::{NONE, to_u32};

/// Successive faces whose volumes one thread sums.
const FACES_PER_BLOCK: usize = 1 << 16;

/// Disjoint sets of numbers; the root of a set is its smallest number.
#[derive(Debug)]
pub(crate) struct Sets {
    parents: Vec<AtomicU32>,
}

impl Sets {
    pub(crate) fn new(count: usize) -> Self {
        Self { parents: (0..to_u32(count)).into_par_iter().map(AtomicU32::new).collect() }
    }

    pub(crate) fn root(&self, mut item: u32) -> u32 {
        loop {
            let parent = self.parents[item as usize].load(Ordering::Relaxed);
            if parent == item {
                return item;
            }
            let grandparent = self.parents[parent as usize].load(Ordering::Relaxed);
            // Halving is only a shortcut: a lost race does no harm.
            self.parents[item as usize].store(grandparent, Ordering::Relaxed);
            item = grandparent;
        }
    }

    pub(crate) fn join(&self, a: u32, b: u32) {
        let (mut a, mut b) = (a, b);
        loop {
            (a, b) = (self.root(a), self.root(b));
            if a == b {
                return;
            }
            let (low, high) = (a.min(b), a.max(b));
            let hung = self.parents[high as usize].compare_exchange(
                high,
                low,
                Ordering::Relaxed,
                Ordering::Relaxed,
            );
            if hung.is_ok() {
                return;
            }
        }
    }
}

/// The components of a mesh's faces.
#[derive(Debug)]
pub(crate) struct Components {
    /// The component of each face, counted from 0 in the order of first faces.
    pub(crate) of_face: Vec<u32>,
    pub(crate) count: usize,
}

impl Components {
    /// The components of faces that share records.
    pub(crate) fn of_records(face_count: usize, records: &[EdgeRecord]) -> Self {
        let sets = Sets::new(face_count);
        records.par_iter().with_min_len(1 << 12).for_each(|record| {
            if record.face_b != NONE {
                sets.join(record.face_a, record.face_b);
            }
        });
        Self::number(&sets, face_count)
    }

    fn number(sets: &Sets, face_count: usize) -> Self {
        let mut of_face: Vec<u32> =
            (0..to_u32(face_count)).into_par_iter().map(|face| sets.root(face)).collect();
        let mut count = 0;
        for face in 0..face_count {
            let root = of_face[face] as usize;
            // A root is the smallest of its set, so it already has a number.
            of_face[face] = if root == face {
                count += 1;
                count - 1
            } else {
                of_face[root]
            };
        }
        Self { of_face, count: count as usize }
    }

    /// The number of components if an edge joins all of its faces, also more than two.
    pub(crate) fn count_joined_by_edges(&self, table: &EdgeTable) -> usize {
        let sets = Sets::new(self.count);
        for (_, sides) in table.iter().filter(|(_, sides)| sides.len() > 2) {
            for pair in sides.windows(2) {
                let [a, b] = [pair[0], pair[1]].map(|side| self.of_face[side as usize / 3]);
                sets.join(a, b);
            }
        }
        (0..to_u32(self.count)).filter(|&component| sets.root(component) == component).count()
    }

    /// Sets `SOLID` on the edges of closed components whose faces look outward, and clears `GROOVE`
    /// on the edges of components without an outside.
    ///
    /// A component is closed if each of its edges has two faces with the same winding; its faces
    /// look outward if the volume that it encloses is positive. One with a face of
    /// `see_through_faces` hides nothing, as an open one.
    pub(crate) fn mark_solids(
        &self,
        measures: &[Measures],
        has_outside: &[bool],
        see_through_faces: impl Iterator<Item = usize>,
        records: &mut [EdgeRecord],
    ) {
        let opens = EdgeFlags::BOUNDARY | EdgeFlags::NON_MANIFOLD | EdgeFlags::CLASH;
        let is_open: Vec<AtomicBool> = (0..self.count).map(|_| AtomicBool::new(false)).collect();
        records.par_iter().with_min_len(1 << 12).for_each(|record| {
            if record.flags().intersects(opens) {
                for face in [record.face_a, record.face_b].into_iter().filter(|&f| f != NONE) {
                    is_open[self.of_face[face as usize] as usize].store(true, Ordering::Relaxed);
                }
            }
        });
        let mut is_open: Vec<bool> = is_open.into_iter().map(AtomicBool::into_inner).collect();
        let mut has_outside = has_outside.to_vec();
        for component in see_through_faces.map(|face| self.of_face[face] as usize) {
            (is_open[component], has_outside[component]) = (true, false);
        }
        records.par_iter_mut().with_min_len(1 << 12).for_each(|record| {
            let component = self.of_face[record.face_a as usize] as usize;
            let is_solid = !is_open[component] && measures[component].six_volumes > 0.0;
            record.word.set(EdgeFlags::SOLID, is_solid);
            if !has_outside[component] {
                record.word.set(EdgeFlags::GROOVE, false);
            }
        });
    }

    /// Area and volume of each component.
    ///
    /// Blocks are computed in parallel and summed in order, so that the sums do not depend on the
    /// threads.
    pub(crate) fn measures(&self, positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Vec<Measures> {
        let origin = origin_of(positions);
        let of_block = |(block, faces): (usize, &[[u32; 3]])| {
            let mut sums: Vec<(u32, Measures)> = Vec::new();
            for (at, &triangle) in faces.iter().enumerate() {
                let measures = Measures::of(corners_of(positions, triangle).map(|c| c - origin));
                let component = self.of_face[block * FACES_PER_BLOCK + at];
                match sums.last_mut() {
                    Some(last) if last.0 == component => last.1 += measures,
                    _ => sums.push((component, measures)),
                }
            }
            sums
        };
        let blocks: Vec<_> =
            triangles.par_chunks(FACES_PER_BLOCK).enumerate().map(of_block).collect();
        let mut sums = vec![Measures::default(); self.count];
        for (component, measures) in blocks.into_iter().flatten() {
            sums[component as usize] += measures;
        }
        sums
    }
}

/// Area and volume of a surface.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Measures {
    pub(crate) two_areas: f64,
    /// Six times the volume between the surface and the origin of [`origin_of`].
    pub(crate) six_volumes: f64,
}

impl Measures {
    /// Those of a triangle, with its corners relative to the origin.
    pub(crate) fn of([a, b, c]: [DVec3; 3]) -> Self {
        let two_areas = (b - a).cross(c - a).length();
        Self { two_areas, six_volumes: a.dot(b.cross(c)) }
    }
}

impl std::ops::AddAssign for Measures {
    fn add_assign(&mut self, other: Self) {
        self.two_areas += other.two_areas;
        self.six_volumes += other.six_volumes;
    }
}

/// The origin of volumes: the first vertex, so that they stay exact far away.
pub(crate) fn origin_of(positions: &[[f32; 3]]) -> DVec3 {
    positions.first().map_or(DVec3::ZERO, |&first| Vec3::from(first).as_dvec3())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::{BuildOptions, build_edge_mesh};
    use crate::model::Model;
    use crate::report::Report;

    #[test]
    fn sets_joined_at_once_have_their_smallest_as_root() {
        let sets = Sets::new(10_000);
        (0..9_997_u32).into_par_iter().for_each(|item| sets.join(item + 3, item));
        for item in 0..10_000 {
            assert_eq!(sets.root(item), item % 3);
        }
    }

    fn records_of(positions: &[[f32; 3]], polygons: &[&[u32]]) -> Vec<EdgeRecord> {
        let model = Model::from_polygons(positions, polygons);
        build_edge_mesh(&model, &BuildOptions::default(), &mut Report::default()).records
    }

    #[test]
    fn closed_and_outward_is_solid() {
        let corners = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]];
        let outward: [&[u32]; 4] = [&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[0, 3, 2]];
        let inward: [&[u32]; 4] = [&[0, 1, 2], &[0, 3, 1], &[1, 3, 2], &[0, 2, 3]];
        let solid_count = |polygons: &[&[u32]]| {
            let records = records_of(&corners, polygons);
            records.iter().filter(|record| record.flags().contains(EdgeFlags::SOLID)).count()
        };
        assert_eq!(solid_count(&outward), 6);
        assert_eq!(solid_count(&inward), 6, "turned outward");
        assert_eq!(solid_count(&outward[..3]), 0, "open");
    }
}
