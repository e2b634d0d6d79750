//! CPU twins of the shaders: the same decisions and corners, function by function, with the
//! same names and argument order. They serve tests, comparisons and research; the product draws
//! without them.
//!
//! | here | `shaders/common/` | paper |
//! |---|---|---|
//! | [`faces_eye`](crate::view::faces_eye) | `facing.wgsl` | Equation 1, the sign of one face |
//! | [`classify_edge`](crate::view::classify_edge) | `feature.wgsl` | Equation 1 |
//! | [`cone_facing`](crate::edge_mesh::cone_facing) | `normal_cone.wgsl` | faces that all look one way (not in the paper) |
//! | [`spine`] | `spine.wgsl` | section 3.3, projection; section 6, clipping |
//! | `stroke_quad` | `stroke_quad.wgsl` | Equations 2 and 3 |
//! | `stroke_cap` | `stroke_cap.wgsl` | Equations 4 and 5; section 6, half disks |
//! | [`stroke_segment`] | `stroke_segment.wgsl` | shared by the vertices of an edge; section 4 |
//! | [`stroke_vertex`] | `stroke_vertex.wgsl` | one vertex of a stroke |
//!
//! Detectors of edges in images are in [`detector`].
//!
//! GPU tests run both twins over thousands of random and adversarial edges. `edgemesh info` prints
//! the counts of [`count_features`](crate::count_features), which the GPU's counts must equal.

pub mod contour_chain;
pub mod detector;
pub mod equation_1;
pub mod layer_chain;
pub mod spine;
mod stroke_cap;
mod stroke_quad;
pub mod stroke_segment;
pub mod stroke_vertex;
