//! The transforms of both versions as matrices.
//!
//! The order is that of VRML 97 6.52 and of `Transform` in VRML 1.0: a point is scaled
//! along rotated axes around a center, then rotated around it, then translated.

use glam::{DAffine3, DMat3, DQuat, DVec3};

use crate::format::read::vrml::parse::NodeRef;

/// The rotation around an axis by an angle in radians; the identity for an axis of length
/// 0.
pub(super) fn rotation([x, y, z, angle]: [f64; 4]) -> DQuat {
    let axis = DVec3::new(x, y, z).try_normalize();
    axis.map_or(DQuat::IDENTITY, |axis| DQuat::from_axis_angle(axis, angle))
}

/// The transform of a `Transform` node; `scale` is the name of the field of its scale.
pub(super) fn of_transform(node: NodeRef, scale: &str) -> DAffine3 {
    const NO_ROTATION: [f64; 4] = [0.0, 0.0, 1.0, 0.0];
    let vector = |field, default: f64| DVec3::from(node.vector(field, [default; 3]));
    let rotation = |field| rotation(node.vector(field, NO_ROTATION));
    let center = vector("center", 0.0);
    let axes = rotation("scaleOrientation");
    DAffine3::from_translation(vector("translation", 0.0) + center)
        * DAffine3::from_quat(rotation("rotation"))
        * DAffine3::from_quat(axes)
        * DAffine3::from_scale(vector(scale, 1.0))
        * DAffine3::from_quat(axes.inverse())
        * DAffine3::from_translation(-center)
}

/// The transform of a VRML 1.0 `MatrixTransform` node, whose rows are the axes and the
/// origin; perspective is ignored.
pub(super) fn of_matrix(node: NodeRef) -> DAffine3 {
    const IDENTITY: [f64; 16] = [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.];
    let [xx, xy, xz, _, yx, yy, yz, _, zx, zy, zz, _, x, y, z, _] = node.vector("matrix", IDENTITY);
    DAffine3 {
        matrix3: DMat3::from_cols_array(&[xx, xy, xz, yx, yy, yz, zx, zy, zz]),
        translation: DVec3::new(x, y, z),
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;
    use crate::format::read::vrml::parse::Document;
    use crate::format::read::vrml::tests::parsed;

    fn moved(text: &str, to: impl Fn(NodeRef) -> DAffine3, point: [f64; 3]) -> [f64; 3] {
        let document: Document = parsed(text);
        let node = document.root().first_child().unwrap();
        let point = to(node).transform_point3(point.into());
        // Removes the rounding error of a quarter turn in radians.
        (point * 1e9).round().to_array().map(|part| part / 1e9 + 0.0)
    }

    #[test]
    fn points_are_scaled_rotated_and_translated() {
        let text = format!(
            "#VRML V2.0 utf8\nTransform {{ translation 0 0 5 rotation 0 0 2 {FRAC_PI_2}
             scale 2 1 1 center 1 0 0 }}"
        );
        let to = |node: NodeRef| of_transform(node, "scale");
        assert_eq!(moved(&text, to, [1.0, 0.0, 0.0]), [1.0, 0.0, 5.0]);
        assert_eq!(moved(&text, to, [2.0, 1.0, 0.0]), [0.0, 2.0, 5.0]);
        let text = format!(
            "#VRML V2.0 utf8\nTransform {{ scale 2 1 1 scaleOrientation 0 0 1 {FRAC_PI_2} }}"
        );
        assert_eq!(moved(&text, to, [1.0, 1.0, 1.0]), [1.0, 2.0, 1.0]);
    }

    #[test]
    fn an_axis_of_length_0_is_the_identity() {
        assert_eq!(rotation([0.0, 0.0, 0.0, 1.0]), DQuat::IDENTITY);
    }

    #[test]
    fn rows_of_a_matrix_are_axes_and_origin() {
        let text = "#VRML V1.0 ascii
            MatrixTransform { matrix 0 2 0 0  -1 0 0 0  0 0 1 0  7 8 9 1 }";
        assert_eq!(moved(text, of_matrix, [1.0, 1.0, 1.0]), [6.0, 10.0, 10.0]);
        assert_eq!(moved("#VRML V1.0 ascii\nMatrixTransform { }", of_matrix, [1.; 3]), [1.; 3]);
    }
}
