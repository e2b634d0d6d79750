//! The mesh frame: origin and scale of a mesh in its file.
//!
//! Idea: 32 bits suffice for a mesh of usual size around the origin, and most meshes are so. A mesh
//! far away loses its detail, and one of 1e30 or 1e-40 units overflows or vanishes in a view. These
//! are first moved and scaled in 64 bits; the scale is a power of two, which loses nothing.
//!
//! Rejected: moving every mesh. Two files of a scene would not share their coordinates, and
//! positions would not be the numbers of the file.

use glam::{DMat4, DQuat, DVec3};

/// Farther from the origin than this many times its size, a mesh loses more than a thousandth of
/// its size to rounding in 32 bits.
const FAR_FROM_ORIGIN: f64 = 8192.0;

/// Sizes from this one on are scaled. Below it, an eye some radii away and squares of distances
/// stay finite in 32 bits.
const HUGE: f64 = 1e15;

/// Sizes up to this one are scaled. Above it, squares of distances stay normal numbers.
const TINY: f64 = 1e-15;

/// Origin and scale of a mesh in its file:
/// `in_mesh = (in_file - origin) * scale`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshFrame {
    /// The origin of the mesh, in units of the file.
    pub origin: DVec3,
    /// Units of the mesh per unit of the file: a power of two.
    pub scale: f64,
}

impl Default for MeshFrame {
    /// The identity.
    fn default() -> Self {
        Self { origin: DVec3::ZERO, scale: 1.0 }
    }
}

impl MeshFrame {
    /// The frame for vertices between `low` and `high`: the identity, unless 32 bits would lose
    /// detail.
    #[must_use]
    pub(crate) fn of_box(low: DVec3, high: DVec3) -> Self {
        let size = (high - low).max_element();
        let reach = low.abs().max(high.abs()).max_element();
        if !(size > 0.0 && size.is_finite()) {
            return Self::default();
        }
        // Halved first, because the sum of two large numbers can overflow.
        let origin =
            if reach > FAR_FROM_ORIGIN * size { low / 2.0 + high / 2.0 } else { DVec3::ZERO };
        let scale = if (TINY..HUGE).contains(&size) { 1.0 } else { power_of_two_near(1.0 / size) };
        Self { origin, scale }
    }

    /// Whether positions are the numbers of the file.
    #[must_use]
    pub fn is_identity(&self) -> bool {
        *self == Self::default()
    }

    /// Converts a point from units of the file to units of the mesh.
    #[must_use]
    pub fn to_mesh(&self, in_file: DVec3) -> DVec3 {
        (in_file - self.origin) * self.scale
    }

    /// The transform of the mesh that is `in_file` in units of the file.
    pub(crate) fn of_file(&self, in_file: &DMat4) -> DMat4 {
        if self.is_identity() {
            return *in_file;
        }
        self.mesh_from_file() * *in_file * self.file_from_mesh()
    }

    /// The transform of the file that is `in_mesh` in units of the mesh.
    pub(crate) fn in_file(&self, in_mesh: &DMat4) -> DMat4 {
        if self.is_identity() {
            return *in_mesh;
        }
        self.file_from_mesh() * *in_mesh * self.mesh_from_file()
    }

    fn mesh_from_file(&self) -> DMat4 {
        let scale = DVec3::splat(self.scale);
        DMat4::from_scale_rotation_translation(scale, DQuat::IDENTITY, -self.origin * self.scale)
    }

    fn file_from_mesh(&self) -> DMat4 {
        let scale = DVec3::splat(1.0 / self.scale);
        DMat4::from_scale_rotation_translation(scale, DQuat::IDENTITY, self.origin)
    }

    /// Converts a point from units of the mesh to units of the file.
    #[must_use]
    pub fn to_file(&self, in_mesh: DVec3) -> DVec3 {
        in_mesh / self.scale + self.origin
    }
}

/// The power of two at or below a positive `value`, clamped so that its inverse is exact.
fn power_of_two_near(value: f64) -> f64 {
    value.log2().floor().clamp(-1000.0, 1000.0).exp2()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(low: f64, high: f64) -> MeshFrame {
        MeshFrame::of_box(DVec3::splat(low), DVec3::splat(high))
    }

    #[test]
    fn usual_meshes_stay_where_they_are() {
        for (low, high) in [(-1.0, 1.0), (0.0, 1e-6), (1000.0, 1001.0), (-1e9, 1e9), (5.0, 5.0)] {
            assert!(frame(low, high).is_identity(), "{low} to {high}");
        }
    }

    #[test]
    fn far_huge_and_tiny_ones_come_to_the_origin() {
        for (low, high) in
            [(4.5e6, 4.5e6 + 2.0), (0.0, 1e30), (-1e300, 1e300), (0.0, 1e-40), (1e20, 1.01e20)]
        {
            let frame = frame(low, high);
            assert!(!frame.is_identity(), "{low} to {high}");
            let [a, b] = [low, high].map(|x| frame.to_mesh(DVec3::splat(x)).x);
            assert!(b - a > 0.4 && b.abs() <= 128.0, "{low} to {high}: {a} to {b}");
            let back = frame.to_file(DVec3::splat(b)).x;
            assert!((back - high).abs() <= 1e-12 * high.abs(), "{back}");
            assert_eq!(frame.scale.to_bits() << 12, 0, "a power of two");
        }
    }
}
