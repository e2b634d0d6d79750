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

mod edge_flags;
mod edge_word;
mod edge_words;
mod face_edges;
mod face_normal;
mod mesh;
mod mesh_frame;
mod normal_cone;
mod record;
mod replicate;
mod static_links;
mod topology;

pub use self::edge_flags::{CHAIN_CLASSES, EdgeFlags, chain_class_of, class_names};
pub(crate) use self::edge_word::STEPS_PER_DEGREE;
pub use self::edge_word::{CONCAVE, CREASE_SHIFT, CREASE_STEPS, EdgeWord, threshold_steps};
pub use self::edge_words::edge_words;
pub use self::face_edges::FaceEdges;
pub(crate) use self::face_edges::side_on;
pub(crate) use self::face_normal::{corners_of, face_normal};
pub use self::mesh::{
    Bounds, Chain, ChainLink, Chains, EdgeMesh, FacePlane, FillMesh, FillRun, FillVertex,
    MeshCounts, SourceCounts,
};
pub use self::mesh_frame::MeshFrame;
pub use self::normal_cone::{CONE_MARGIN, ConeFacing, NormalCone, cone_facing};
pub use self::record::{EdgeRecord, EdgeVertex, EdgeVertex16, FinVertex, edge_random};
pub use self::replicate::{Quantization, fins, replicate, replicate_16};
pub use self::static_links::StaticLinks;
pub use self::topology::{EdgeCounts, EdgeTable};
pub(crate) use self::topology::{EdgePart, triangle_side};
