//! One view of an edge mesh, on the CPU: the camera, which faces look at the eye, and which edges
//! are features.

mod camera;
mod facing;
mod feature;
mod feature_counts;
mod projection;
mod sight;

pub use self::camera::{
    Camera, CameraError, DEFAULT_DIRECTION, DEFAULT_DISTANCE_RADII, DEFAULT_FOV_Y_DEG, View,
};
pub use self::facing::faces_eye;
pub use self::feature::{EdgeFaces, Line, LineBits, classify_edge, eye_is_outside};
pub use self::feature_counts::{
    FeatureCounts, classify_edges, classify_lines, count_features, facing_bits,
};
pub use self::projection::{GUARD_BAND, WHOLE_BAND, to_pixels};
pub use self::sight::{Sight, SightIndex};
