//! Layouts of the edges of an edge mesh.
//!
//! 1. The **indexed edge record**, 20 bytes for each edge: indices into positions and faces that
//!    the fill shares. The paper (section 6) expects it once vertex programs can read memory.
//! 2. The **replicated edge vertex** of the paper (section 3): four successive copies of
//!    `<v0, v1, v2, v3, n0, n1, r, i>`, 80 bytes each in 32-bit floats, made by
//!    [`crate::edge_mesh::replicate`].
//! 3. The replicated edge vertex at 16 bits: 37 bytes, padded to 40 with the classes.
//!
//! ```text
//!            v1              face A = <v0, v1, v2>, left of v0 -> v1
//!           /|\              face B = <v3, v1, v0>, right of it
//!         /  |  \
//!      v2  A | B  v3         boundary edges: v3 = v0
//!         \  |  /
//!           \|/
//!            v0
//! ```

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use crate::edge_mesh::edge_flags::EdgeFlags;
use crate::edge_mesh::edge_word::EdgeWord;

/// The indexed edge record: 20 bytes. WGSL twin: `EdgeRecord` in
/// `shaders/common/mesh.wgsl`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct EdgeRecord {
    /// Start vertex.
    pub v0: u32,
    /// End vertex.
    pub v1: u32,
    /// The face that traverses the edge from `v0` to `v1`, or [`NONE`](crate::index::NONE) for a
    /// line without faces.
    pub face_a: u32,
    /// The face across, or [`NONE`](crate::index::NONE).
    pub face_b: u32,
    /// Classes that no view changes, and the crease angle.
    pub word: EdgeWord,
}

impl EdgeRecord {
    /// The classes that no view changes.
    #[must_use]
    pub const fn flags(&self) -> EdgeFlags {
        self.word.flags()
    }
}

/// The paper's edge vertex at 16 bits: 37 bytes (section 3.1), padded to 40 with the edge word.
///
/// Positions are whole steps from the center of the bounds
/// ([`Quantization`](crate::edge_mesh::Quantization)); normals are in units of 1 / 32767.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct EdgeVertex16 {
    /// Start of the edge.
    pub v0: [i16; 3],
    /// End of the edge.
    pub v1: [i16; 3],
    /// Third vertex of face A.
    pub v2: [i16; 3],
    /// Third vertex of face B; `v0` for boundary edges.
    pub v3: [i16; 3],
    /// Welded vertex normal at `v0`.
    pub n0: [i16; 3],
    /// Welded vertex normal at `v1`.
    pub n1: [i16; 3],
    /// The corner index i, 0 to 3, in the low two bits; the random scalar of the edge in the six
    /// bits above, in steps of 1 / 64.
    pub corner_and_random: u8,
    /// The [`EdgeWord`] in 24 bits, lowest byte first.
    pub flags: [u8; 3],
}

impl EdgeVertex16 {
    /// The corner index i, 0 to 3.
    #[must_use]
    pub const fn corner(&self) -> u32 {
        (self.corner_and_random & 3) as u32
    }

    /// The random scalar of the edge, rounded down to steps of 1 / 64.
    #[must_use]
    pub fn random(&self) -> f32 {
        f32::from(self.corner_and_random >> 2) / 64.0
    }

    /// The classes and the crease angle.
    #[must_use]
    pub const fn word(&self) -> EdgeWord {
        let [low, middle, high] = self.flags;
        EdgeWord::from_24_bits(u32::from_le_bytes([low, middle, high, 0]))
    }

    /// The classes.
    #[must_use]
    pub const fn flags(&self) -> EdgeFlags {
        self.word().flags()
    }
}

/// The paper's edge vertex in 32-bit floats: 80 bytes, four successive ones for each edge.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct EdgeVertex {
    /// Start of the edge.
    pub v0: [f32; 3],
    /// End of the edge.
    pub v1: [f32; 3],
    /// Third vertex of face A.
    pub v2: [f32; 3],
    /// Third vertex of face B; `v0` for boundary edges.
    pub v3: [f32; 3],
    /// Welded vertex normal at `v0`.
    pub n0: [f32; 3],
    /// Welded vertex normal at `v1`.
    pub n1: [f32; 3],
    /// The random scalar of the edge, 0 to 1.
    pub r: f32,
    /// The corner index i, 0 to 3, in the low two bits; the [`EdgeWord`] above.
    pub corner_and_flags: u32,
}

impl EdgeVertex {
    /// The lowest bit of the edge word in [`Self::corner_and_flags`].
    pub(crate) const FLAGS_SHIFT: u32 = 2;

    /// The corner index i, 0 to 3.
    #[must_use]
    pub const fn corner(&self) -> u32 {
        self.corner_and_flags & 3
    }

    /// The classes and the crease angle.
    #[must_use]
    pub const fn word(&self) -> EdgeWord {
        EdgeWord(self.corner_and_flags >> Self::FLAGS_SHIFT)
    }

    /// The classes.
    #[must_use]
    pub const fn flags(&self) -> EdgeFlags {
        self.word().flags()
    }
}

/// Card and Mitchell's vertex of a fin (*Rendering Outlines*, Figure 2): 48 bytes, four successive
/// ones for each edge. It serves comparisons only: its face normals cannot be posed, and it has no
/// creases.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct FinVertex {
    /// One end of the edge.
    pub position: [f32; 3],
    /// The vertex normal, along which the fin stands out; zero for the two vertices on the edge.
    pub normal: [f32; 3],
    /// Normal of face A.
    pub face_a: [f32; 3],
    /// Normal of face B; at boundaries the opposite of `face_a`, so that exactly one of the two
    /// looks at the eye.
    pub face_b: [f32; 3],
}

/// The random scalar r of an edge, in [0, 1): a hash of the positions of its ends in either order.
/// So the indexed record need not store it, and renumbering a mesh does not change it.
///
/// The mixing is PCG's output function (O'Neill 2014). WGSL twin: `edge_random`
/// in `shaders/common/mesh.wgsl`.
#[must_use]
pub fn edge_random(p0: Vec3, p1: Vec3) -> f32 {
    let bits = pcg(point_hash(p0).wrapping_add(point_hash(p1)));
    // 24 bits, so that every value is exact and 1 is never reached.
    #[expect(clippy::cast_precision_loss, reason = "24 bits fit a float")]
    let scaled = (bits >> 8) as f32;
    scaled / 16_777_216.0
}

fn point_hash(point: Vec3) -> u32 {
    // Adding 0 makes -0 and 0 the same number.
    point.to_array().iter().fold(0, |hash, coordinate| pcg(hash ^ (coordinate + 0.0).to_bits()))
}

const fn pcg(value: u32) -> u32 {
    let state = value.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_the_papers() {
        assert_eq!(size_of::<EdgeRecord>(), 20);
        assert_eq!(size_of::<EdgeVertex>(), 80);
        assert_eq!(size_of::<EdgeVertex16>(), 40);
        assert_eq!(size_of::<FinVertex>(), 48);
        assert_eq!(std::mem::offset_of!(EdgeVertex16, flags), 37, "the payload");
    }

    #[test]
    fn the_random_scalar_ignores_direction_and_spreads() {
        let (a, b) = (Vec3::new(1.0, 2.0, 3.0), Vec3::new(-1.0, 0.5, 0.0));
        assert!((edge_random(a, b) - edge_random(b, a)).abs() < f32::EPSILON);
        assert!((edge_random(-a * 0.0, b) - edge_random(Vec3::ZERO, b)).abs() < f32::EPSILON);
        let mean = (0..1000_u16).map(|k| edge_random(a * f32::from(k), b)).sum::<f32>() / 1000.0;
        assert!((0.45..0.55).contains(&mean), "{mean}");
    }
}
