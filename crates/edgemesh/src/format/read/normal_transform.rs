//! The matrix that transforms normals.

use glam::DMat3;

/// The matrix that transforms the normals of a surface whose points `linear`
/// transforms: its inverse transpose, up to a positive factor.
///
/// It is computed from cofactors, because `linear` may have no inverse: a flattened
/// surface keeps one normal.
pub(super) fn normal_transform(linear: DMat3) -> DMat3 {
    let DMat3 { x_axis, y_axis, z_axis } = linear;
    let cofactors =
        DMat3::from_cols(y_axis.cross(z_axis), z_axis.cross(x_axis), x_axis.cross(y_axis));
    if linear.determinant() < 0.0 { -cofactors } else { cofactors }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    #[test]
    fn normals_stay_upright_on_squeezed_and_mirrored_surfaces() {
        // The plane x + y = 0 is squeezed along y: the normal leans toward y.
        let squeezed = normal_transform(DMat3::from_diagonal(DVec3::new(1.0, 0.5, 1.0)));
        assert_eq!(squeezed * DVec3::new(1.0, 1.0, 0.0), DVec3::new(0.5, 1.0, 0.0));
        // The normal of a mirrored plane is mirrored too.
        let mirrored = normal_transform(DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0)));
        assert_eq!(mirrored * DVec3::X, -DVec3::X);
        assert_eq!(mirrored * DVec3::Y, DVec3::Y);
        let flat = normal_transform(DMat3::from_diagonal(DVec3::new(1.0, 0.0, 1.0)));
        assert_eq!(flat * DVec3::ONE, DVec3::Y);
    }
}
