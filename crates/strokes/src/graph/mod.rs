//! The stroke graph: the edges that a view draws, linked into chains on the GPU in every frame,
//! and the strokes along them.
//!
//! The paper draws every edge by itself, since a vertex program reads no other edge, and shows
//! the cost: gaps between the caps of creases (Figure 5), textures that break at every edge
//! (Figure 8). Here compute shaders link the edges.
//!
//! ```text
//!   live edges --link_elements--> nodes, each with its successor
//!        nodes --link_chains----> chains: elements in order, with arc lengths
//!   chains --path_joints---> corners, and how many points each element gives
//!          --path_points---> points, 4 px apart, visible or not
//!          --path_strokes--> strokes: from where to where
//!          --path_ribbons--> ribbons: segments with width, brush and joins
//!   ribbons --coverage-----> each pixel once, laid over the picture
//! ```

pub(crate) mod buffers;
pub(crate) mod link;
pub(crate) mod path;
pub(crate) mod readback;
