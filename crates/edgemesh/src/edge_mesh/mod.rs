//! The edge mesh: what the preprocessor makes and the GPU draws.
//!
//! - [`mesh`]: the mesh with all of its records, chains and triangles.
//! - [`record`], [`replicate`]: an edge in each of the layouts.
//! - [`edge_flags`]: the classes of an edge.
//! - [`edge_word`], [`edge_words`]: the classes and the angle of the crease, in 24 bits, of an
//!   edge and of all edges.
//! - [`topology`], [`face_edges`], [`static_links`]: which face, edge or line follows which.
//! - [`normal_cone`]: faces that all look one way.
//! - [`mesh_frame`]: where the mesh lies in its file.

pub mod edge_flags;
pub mod edge_word;
pub mod edge_words;
pub mod face_edges;
pub mod face_normal;
pub mod mesh;
pub mod mesh_frame;
pub mod normal_cone;
pub mod record;
pub mod replicate;
pub mod static_links;
pub mod topology;

pub use self::mesh::{
    Bounds, Chain, ChainLink, Chains, EdgeMesh, FacePlane, FillMesh, FillRun, FillVertex,
    LayoutBytes, MeshCounts, SourceCounts,
};
pub use self::mesh_frame::MeshFrame;
