//! The edge mesh: built from a model, drawn by the GPU.
//!
//! - [`EdgeMesh`]: the mesh with its records, chains and triangles.
//! - [`InstancedMesh`]: a mesh in several places.
//! - [`EdgeRecord`], [`EdgeVertex`], [`EdgeVertex16`], [`FinVertex`]: an edge in each layout;
//!   [`replicate`], [`replicate_16`] and [`fins`] write the layouts that repeat vertices.
//! - [`EdgeFlags`]: the classes of an edge. [`EdgeWord`]: these and the crease angle.
//! - [`EdgeTable`], [`FaceEdges`], [`StaticLinks`]: which sides share an edge, which edges bound a
//!   face, which edge follows which in a chain.
//! - [`NormalCone`]: bounds of faces that all look one way.
//! - [`MeshFrame`]: origin and scale of the mesh in its file.

mod edge_flags;
mod edge_word;
mod face_edges;
mod face_normal;
mod instanced_mesh;
mod mesh;
mod mesh_frame;
mod normal_cone;
mod record;
mod replicate;
mod static_links;
mod topology;

pub(crate) use self::edge_flags::class_of_name;
pub use self::edge_flags::{CHAIN_CLASSES, EdgeFlags, chain_class_of, class_names};
pub use self::edge_word::{
    CONCAVE, CONCAVE_16, CREASE_SHIFT, CREASE_SHIFT_16, CREASE_STEPS, EdgeWord, STEPS_PER_STEP_16,
    threshold_steps,
};
pub use self::face_edges::FaceEdges;
pub(crate) use self::face_edges::side_on;
pub(crate) use self::face_normal::{corners_of, face_normal};
pub use self::instanced_mesh::{InstancedMesh, bounds_with, counts_with};
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
