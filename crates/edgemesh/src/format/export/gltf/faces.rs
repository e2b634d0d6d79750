//! The triangles of a mesh in the primitives of a file: one for each material and part of a rig.
//!
//! ```text
//! mesh       0 1 2 3 4 5          sides of triangle 0 1 2:     01 12 20
//! primitive  a a b a b b          of its mirror image 0 2 1:   02 21 10
//! slot       0 1 0 2 1 2
//! ```

use crate::index::to_u32;

/// The triangles of a mesh in the primitives of a file.
#[derive(Debug)]
pub(super) struct PrimitiveFaces {
    /// The primitive of each triangle, and its index there.
    places: Vec<(u32, u32)>,
    /// The triangles of each primitive, ascending.
    faces: Vec<Vec<u32>>,
    /// Whether the node of each primitive mirrors it, so that triangles are stored reversed.
    is_mirrored: Vec<bool>,
}

impl PrimitiveFaces {
    /// Sorts triangles by the number of their primitive, below the length of `is_mirrored`.
    pub(super) fn new(primitives: impl Iterator<Item = u32>, is_mirrored: Vec<bool>) -> Self {
        let mut faces = vec![Vec::new(); is_mirrored.len()];
        let place = |(face, primitive): (usize, u32)| {
            let own = &mut faces[primitive as usize];
            own.push(to_u32(face));
            (primitive, to_u32(own.len() - 1))
        };
        let places = primitives.enumerate().map(place).collect();
        Self { places, faces, is_mirrored }
    }

    /// The number of primitives.
    pub(super) const fn len(&self) -> usize {
        self.faces.len()
    }

    /// The triangles of a primitive.
    pub(super) fn of(&self, primitive: usize) -> &[u32] {
        &self.faces[primitive]
    }

    /// The primitive of a triangle.
    pub(super) fn primitive(&self, face: u32) -> usize {
        self.places[face as usize].0 as usize
    }

    /// The side of the primitive that is a side of a triangle of the mesh: three for a triangle.
    pub(super) fn side(&self, face: u32, side: u32) -> usize {
        let (primitive, slot) = self.places[face as usize];
        let side = if self.is_mirrored[primitive as usize] { 2 - side } else { side };
        (3 * slot + side) as usize
    }

    /// The corners of a triangle as they are stored.
    pub(super) fn stored(&self, primitive: usize, [a, b, c]: [u32; 3]) -> [u32; 3] {
        if self.is_mirrored[primitive] { [a, c, b] } else { [a, b, c] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_are_counted_for_each_primitive() {
        let faces = PrimitiveFaces::new([0, 0, 1, 0, 1].into_iter(), vec![false, true]);
        assert_eq!((faces.len(), faces.of(0), faces.of(1)), (2, &[0, 1, 3][..], &[2, 4][..]));
        assert_eq!((faces.primitive(3), faces.side(3, 2)), (0, 8));
        assert_eq!([0, 1, 2].map(|side| faces.side(4, side)), [5, 4, 3], "reversed");
        assert_eq!(
            (faces.stored(0, [7, 8, 9]), faces.stored(1, [7, 8, 9])),
            ([7, 8, 9], [7, 9, 8])
        );
    }
}
