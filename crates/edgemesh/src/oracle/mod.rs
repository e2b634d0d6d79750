//! The CPU twin of the shaders: the same decisions and corners, function by
//! function, with the same names and argument order.
//!
//! | here | `shaders/common/` | paper |
//! |---|---|---|
//! | [`facing`](crate::view::facing) | `facing.wgsl` | Equation 1, the sign of one face |
//! | [`feature`](crate::view::feature) | `feature.wgsl` | Equation 1 |
//! | [`normal_cone`](crate::edge_mesh::normal_cone) | `normal_cone.wgsl` | faces that all look one way (not in the paper) |
//! | [`spine`] | `spine.wgsl` | section 3.3, projection; section 6, clipping |
//! | [`stroke_quad`] | `stroke_quad.wgsl` | Equations 2 and 3 |
//! | [`stroke_cap`] | `stroke_cap.wgsl` | Equations 4 and 5; section 6, half disks |
//! | [`stroke_segment`] | `stroke_segment.wgsl` | what the vertices of an edge share; section 4 |
//! | [`stroke_vertex`] | `stroke_vertex.wgsl` | one vertex of it |
//!
//! Detectors of edges in images are in [`detector`].
//!
//! A GPU test runs both over thousands of random and adversarial edges; the
//! counts of [`count_features`](crate::count_features) are what `edgemesh info` prints and what the
//! GPU's own counts must equal.

pub mod contour_chain;
pub mod detector;
pub mod equation_1;
pub mod layer_chain;
pub mod spine;
mod stroke_cap;
mod stroke_quad;
pub mod stroke_segment;
pub mod stroke_vertex;
