//! Finds the closed surfaces that are inside out.
//!
//! Idea: a closed surface whose faces look outward encloses a positive volume. A negative one is a
//! hollow if it lies in the matter of others; otherwise it is inside out. How much matter is around
//! it tells the winding number of the others at one of its points (the sum of solid angles, Van
//! Oosterom and Strackee 1983, "The Solid Angle of a Plane Triangle"). A surface that is closed but
//! for small holes counts as closed by flat caps over its rims; one with larger openings, such as
//! a sheet or a bowl, has no outside, and stays as it is.
//!
//! Rejected: rays from a point, which meet edges; the side from which most faces are seen, which
//! turns rooms that are seen from inside.

use glam::{DVec3, Vec3};
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::components::{Components, Measures, Sets, origin_of};
use crate::edge_mesh::{EdgeFlags, EdgeRecord};
use crate::index::{NONE, to_u32};

/// The largest share of its area that flat caps may add to a surface that counts as closed.
const LARGEST_CAPS: f64 = 0.05;

/// A volume below this fraction of the area to the power of 3/2 is none: the surface is flat.
const LEAST_VOLUME: f64 = 1e-9;

/// The surface of a mesh in components.
#[derive(Debug)]
pub(crate) struct Surfaces<'a> {
    pub(crate) positions: &'a [[f32; 3]],
    pub(crate) triangles: &'a [[u32; 3]],
    pub(crate) records: &'a [EdgeRecord],
    pub(crate) components: &'a Components,
    /// Area and volume of each component.
    pub(crate) measures: &'a [Measures],
}

/// What is known of the outside of components.
#[derive(Debug)]
pub(crate) struct Outsides {
    /// Whether each component is closed, perhaps but for small holes.
    pub(crate) has_outside: Vec<bool>,
    /// The components that are inside out, ascending.
    pub(crate) inside_out: Vec<u32>,
}

/// A triangle that closes a hole: two ends of a boundary edge and the middle of its rim.
type Cap = [DVec3; 3];

/// A component that is closed, perhaps by caps.
#[derive(Debug)]
struct Closed {
    component: u32,
    caps: Vec<Cap>,
    /// Six times the volume.
    volume: f64,
}

impl Surfaces<'_> {
    /// What is known of the outside of each component.
    pub(crate) fn outsides(&self) -> Outsides {
        let closed = self.closed();
        let mut has_outside = vec![false; self.components.count];
        for closed in &closed {
            has_outside[closed.component as usize] = true;
        }
        Outsides { has_outside, inside_out: self.inside_out(&closed) }
    }

    fn inside_out(&self, closed: &[Closed]) -> Vec<u32> {
        if closed.iter().all(|closed| closed.volume >= 0.0) {
            return Vec::new();
        }
        let faces = self.faces_by_component();
        let shapes: Vec<Shape> = closed
            .iter()
            .map(|closed| Shape::of(self, closed, &faces[closed.component as usize]))
            .collect();
        // Outer surfaces first: whether they are turned decides what is matter inside of them.
        let mut order: Vec<usize> = (0..shapes.len()).collect();
        order.sort_by(|&a, &b| shapes[b].size().total_cmp(&shapes[a].size()).then(a.cmp(&b)));
        let mut is_turned = vec![false; shapes.len()];
        for (rank, &at) in order.iter().enumerate() {
            if closed[at].volume >= 0.0 {
                continue;
            }
            let point = shapes[at].point();
            let around = order[..rank].iter().filter(|&&other| shapes[other].holds(&shapes[at]));
            let matter: f64 = around
                .map(|&other| {
                    let turns = shapes[other].winding_number(point).round();
                    if is_turned[other] { -turns } else { turns }
                })
                .sum();
            is_turned[at] = matter < 0.5;
        }
        let turned = (0..shapes.len()).filter(|&at| is_turned[at]);
        let mut turned: Vec<u32> = turned.map(|at| closed[at].component).collect();
        turned.sort_unstable();
        turned
    }

    /// The components that have an outside.
    fn closed(&self) -> Vec<Closed> {
        let count = self.components.count;
        let mut has_outside = vec![true; count];
        let mut rims: FxHashMap<u32, Vec<[u32; 2]>> = FxHashMap::default();
        for record in self.records.iter().filter(|record| self.is_rim(record)) {
            let component = self.components.of_face[record.face_a as usize];
            if record.flags().contains(EdgeFlags::CLASH) {
                has_outside[component as usize] = false;
            } else {
                rims.entry(component).or_default().push([record.v0, record.v1]);
            }
        }
        (0..to_u32(count))
            .filter(|&component| has_outside[component as usize])
            .filter_map(|component| {
                let caps = rims.get(&component).map(|rim| self.caps(rim)).unwrap_or_default();
                let open = self.measures[component as usize];
                let mut closed = open;
                caps.iter().for_each(|&cap| closed += Measures::of(cap));
                let are_holes_small =
                    closed.two_areas - open.two_areas <= LARGEST_CAPS * open.two_areas;
                let volume = closed.six_volumes;
                let has_volume = volume.abs() > LEAST_VOLUME * open.two_areas.powf(1.5);
                (are_holes_small && has_volume).then_some(Closed { component, caps, volume })
            })
            .collect()
    }

    fn is_rim(&self, record: &EdgeRecord) -> bool {
        record.face_b == NONE || record.flags().contains(EdgeFlags::CLASH)
    }

    /// Triangles from each edge of a component's rims to the middle of its rim, wound as the faces
    /// across would be.
    fn caps(&self, rim: &[[u32; 2]]) -> Vec<Cap> {
        let mut vertices: Vec<u32> = rim.iter().flatten().copied().collect();
        vertices.sort_unstable();
        vertices.dedup();
        let index = |vertex: u32| to_u32(vertices.partition_point(|&other| other < vertex));
        let loops = Sets::new(vertices.len());
        rim.iter().for_each(|&[a, b]| loops.join(index(a), index(b)));
        let mut middles = vec![(DVec3::ZERO, 0.0); vertices.len()];
        for &[a, b] in rim {
            let (start, end) = (self.position(a), self.position(b));
            let (sum, length) = &mut middles[loops.root(index(a)) as usize];
            *sum += start.midpoint(end) * start.distance(end);
            *length += start.distance(end);
        }
        let cap = |&[a, b]: &[u32; 2]| {
            let (sum, length) = middles[loops.root(index(a)) as usize];
            [self.position(b), self.position(a), sum / length]
        };
        rim.iter().map(cap).collect()
    }

    /// A vertex relative to the origin of volumes.
    fn position(&self, vertex: u32) -> DVec3 {
        Vec3::from(self.positions[vertex as usize]).as_dvec3() - origin_of(self.positions)
    }

    fn faces_by_component(&self) -> Vec<Vec<u32>> {
        let mut faces = vec![Vec::new(); self.components.count];
        for (face, &component) in self.components.of_face.iter().enumerate() {
            faces[component as usize].push(to_u32(face));
        }
        faces
    }
}

/// A closed component as triangles.
struct Shape<'a> {
    surfaces: &'a Surfaces<'a>,
    faces: &'a [u32],
    caps: &'a [Cap],
    low: Vec3,
    high: Vec3,
}

impl<'a> Shape<'a> {
    fn of(surfaces: &'a Surfaces<'a>, closed: &'a Closed, faces: &'a [u32]) -> Self {
        let corners = faces.iter().flat_map(|&face| surfaces.triangles[face as usize]);
        let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for corner in corners {
            let point = Vec3::from(surfaces.positions[corner as usize]);
            (low, high) = (low.min(point), high.max(point));
        }
        Self { surfaces, faces, caps: &closed.caps, low, high }
    }

    fn size(&self) -> f32 {
        (self.high - self.low).element_product()
    }

    /// Whether the box of `other` lies in the box of this shape.
    fn holds(&self, other: &Self) -> bool {
        self.low.cmple(other.low).all() && other.high.cmple(self.high).all()
    }

    fn triangle(&self, face: u32) -> [DVec3; 3] {
        self.surfaces.triangles[face as usize].map(|vertex| self.surfaces.position(vertex))
    }

    /// A point of the shape: the middle of its first face.
    fn point(&self) -> DVec3 {
        let [a, b, c] = self.triangle(self.faces[0]);
        (a + b + c) / 3.0
    }

    /// How many times the shape winds around a point.
    fn winding_number(&self, point: DVec3) -> f64 {
        // Blocks of a fixed size, so that the sum does not depend on the threads.
        let sum_of = |faces: &[u32]| -> f64 {
            faces.iter().map(|&face| half_solid_angle(self.triangle(face), point)).sum()
        };
        let blocks: Vec<f64> = self.faces.par_chunks(1 << 12).map(sum_of).collect();
        let caps: f64 = self.caps.iter().map(|&cap| half_solid_angle(cap, point)).sum();
        (blocks.iter().sum::<f64>() + caps) / std::f64::consts::TAU
    }
}

/// Half of the solid angle of a triangle at a point, positive if its back is seen.
fn half_solid_angle(corners: [DVec3; 3], point: DVec3) -> f64 {
    let [a, b, c] = corners.map(|corner| corner - point);
    let [la, lb, lc] = [a, b, c].map(DVec3::length);
    let cosine = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    f64::atan2(a.dot(b.cross(c)), cosine)
}

#[cfg(test)]
mod tests {
    use crate::build::{BuildOptions, build_edge_mesh};
    use crate::edge_mesh::EdgeFlags;
    use crate::model::Model;
    use crate::report::{RepairKind, Report};

    /// Adds an octahedron with `radius` around (`x`, 0, 0), outward or inward, without its last
    /// `missing` faces.
    fn add(model: &mut Model, x: f64, radius: f64, is_inward: bool, missing: usize) {
        let first = u32::try_from(model.positions.len()).unwrap();
        for (axis, sign) in [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0), (2, 1.0), (2, -1.0)] {
            let mut point = [x, 0.0, 0.0];
            point[axis] += sign * radius;
            model.positions.push(point);
        }
        let faces = [
            [0, 2, 4],
            [2, 1, 4],
            [1, 3, 4],
            [3, 0, 4],
            [2, 0, 5],
            [1, 2, 5],
            [3, 1, 5],
            [0, 3, 5],
        ];
        for [a, b, c] in &faces[..faces.len() - missing] {
            let face = if is_inward { [a, c, b] } else { [a, b, c] };
            model.push_polygon(&face.map(|&corner| crate::model::Corner::at(first + corner)), 0);
        }
    }

    /// The turned faces, and the numbers of ridges and valleys.
    fn built(parts: &[(f64, f64, bool, usize)]) -> (usize, usize, usize) {
        let mut model = Model::default();
        for &(x, radius, is_inward, missing) in parts {
            add(&mut model, x, radius, is_inward, missing);
        }
        let mut report = Report::default();
        let mesh = build_edge_mesh(&model, &BuildOptions::default(), &mut report);
        let count =
            |class| mesh.records.iter().filter(|record| record.flags().contains(class)).count();
        let turned = report.repair_count(RepairKind::InsideOutFaces);
        (turned, count(EdgeFlags::RIDGE), count(EdgeFlags::VALLEY))
    }

    const OUT: bool = false;
    const IN: bool = true;

    #[test]
    fn what_is_inside_out_is_turned() {
        assert_eq!(built(&[(0., 1., OUT, 0)]), (0, 12, 0));
        assert_eq!(built(&[(0., 1., IN, 0)]), (8, 12, 0));
        assert_eq!(built(&[(0., 1., IN, 0), (5., 1., OUT, 0), (9., 1., IN, 0)]), (16, 36, 0));
    }

    #[test]
    fn hollows_stay_and_what_lies_in_them_looks_outward() {
        let nested = |a, b, c| built(&[(0., 4., a, 0), (0.1, 2., b, 0), (0.2, 1., c, 0)]);
        assert_eq!(nested(OUT, IN, OUT), (0, 24, 12));
        assert_eq!(nested(OUT, IN, IN), (8, 24, 12), "nothing is around the inner one");
        assert_eq!(nested(OUT, OUT, IN), (0, 24, 12), "a hollow in a body in a body");
        assert_eq!(nested(IN, IN, OUT), (8, 24, 12), "the outer one is wrong");
        assert_eq!(nested(IN, OUT, OUT), (8, 36, 0), "a room with things in it");
    }

    #[test]
    fn sheets_have_no_outside() {
        assert_eq!(built(&[(0., 1., IN, 1)]).0, 0, "a hole of an eighth");
        assert_eq!(built(&[(0., 1., IN, 4)]).0, 0, "a bowl");
    }

    /// A box of 20 by 20 by 1 quads with one quad left out, which is a thousandth of its area.
    #[test]
    fn a_small_hole_is_closed_by_a_cap() {
        let mut model = Model::default();
        let at = |x: u32, y: u32, z: u32| (z * 21 + y) * 21 + x;
        for z in [0.0, 20.0] {
            for y in 0..21_u8 {
                model.positions.extend((0..21_u8).map(|x| [f64::from(x), f64::from(y), z]));
            }
        }
        let mut push = |a, b, c, d| {
            model.push_polygon(&[a, b, c, d].map(crate::model::Corner::at), 0);
        };
        for y in 0..20 {
            for x in 0..20 {
                if (x, y) != (7, 3) {
                    push(at(x, y, 0), at(x + 1, y, 0), at(x + 1, y + 1, 0), at(x, y + 1, 0));
                }
                push(at(x, y, 1), at(x, y + 1, 1), at(x + 1, y + 1, 1), at(x + 1, y, 1));
            }
            push(at(y + 1, 0, 0), at(y, 0, 0), at(y, 0, 1), at(y + 1, 0, 1));
            push(at(y, 20, 0), at(y + 1, 20, 0), at(y + 1, 20, 1), at(y, 20, 1));
            push(at(0, y, 0), at(0, y + 1, 0), at(0, y + 1, 1), at(0, y, 1));
            push(at(20, y + 1, 0), at(20, y, 0), at(20, y, 1), at(20, y + 1, 1));
        }
        let mut report = Report::default();
        let mesh = build_edge_mesh(&model, &BuildOptions::default(), &mut report);
        assert_eq!(mesh.counts.edges.boundary, 4);
        assert_eq!(report.repair_count(RepairKind::InsideOutFaces), mesh.triangles.len());
        let ridges = mesh.records.iter().filter(|r| r.flags().contains(EdgeFlags::RIDGE));
        assert_eq!(ridges.count(), 80 + 80 + 4);
    }
}
