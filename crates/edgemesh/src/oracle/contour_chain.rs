//! The successor of a contour, which links contours into chains; each contour is in exactly one.
//!
//! Idea: a contour has its front face on the left. At its end the surface is a fan of faces.
//! Turning through the front faces, from the face of this contour on, the first contour is the next
//! one of the chain. No other contour finds it, so links are one to one for any number of contours
//! at a vertex, and the outside stays on the same side. A chain ends only where the surface ends.
//!
//! ```text
//!        \ front /             c: the contour that arrives
//!     e1  \     /  e2          e1: the first edge on the way around, not a contour
//!          \   /               e2: the next edge, a contour, which follows c
//!   front   \ /   back
//!  ----c---->o
//!   back
//! ```
//!
//! An edge whose winding clashes, or with more than two faces, has no left and right: the chain is
//! cut there. [`super::layer_chain`] makes the chains.
//!
//! A half-edge structure walks the rim of a region in this way; here the region is the front faces.
//! Rejected: joining contours at vertices where exactly two meet; on rough meshes four and more
//! meet at many vertices.

use crate::edge_mesh::{EdgeFlags, EdgeMesh, FaceEdges};
use crate::index::NONE;
use crate::view::{Line, LineBits};

/// The successor of a contour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Successor {
    /// The contour on this record.
    Edge(u32),
    /// None: the surface ends here.
    Boundary,
    /// None: the surface has no left and right here.
    Cut,
}

/// Edges that chains neither contain nor cross.
const CUTS: EdgeFlags = EdgeFlags::CLASH.union(EdgeFlags::NON_MANIFOLD);

/// Finds the successor of the contour on record `edge`; `lines` has an element for each record.
///
/// # Panics
/// Panics if `edge` is out of range or `lines` is too short.
#[must_use]
pub fn successor(mesh: &EdgeMesh, faces: &FaceEdges, lines: &[Line], edge: u32) -> Successor {
    let record = &mesh.records[edge as usize];
    if record.flags().intersects(CUTS) {
        return Successor::Cut;
    }
    let a_faces = lines[edge as usize].bits.contains(LineBits::A_FACES);
    let mut face = if a_faces { record.face_a } else { record.face_b };
    let mut at = edge;
    // A fan has at most all faces of the mesh.
    for _ in 0..mesh.triangles.len() {
        let sides = faces.sides(face);
        let Some(side) = sides.iter().position(|side| *side == at) else { return Successor::Cut };
        at = sides[(side + 1) % 3];
        if at == NONE || mesh.records[at as usize].flags().intersects(CUTS) {
            return Successor::Cut;
        }
        if lines[at as usize].bits.contains(LineBits::CONTOUR) {
            return Successor::Edge(at);
        }
        let across = &mesh.records[at as usize];
        face = if across.face_a == face { across.face_b } else { across.face_a };
        if face == NONE {
            return Successor::Boundary;
        }
    }
    Successor::Cut
}
