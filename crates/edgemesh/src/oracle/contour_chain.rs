//! What follows a contour: the link that makes chains of them, each in exactly one.
//!
//! Idea: a contour has its front face on the left. At its end the surface is a fan
//! of faces; turning through the front ones, from this contour's own, the first
//! contour met is the next of the chain. That one is found from no other, so links
//! are one to one whatever the number of contours at a vertex; and the outside is
//! on the same side all along. A chain ends only where the surface does.
//!
//! ```text
//!        \ front /             c: the contour that arrives
//!     e1  \     /  e2          e1: the first edge on the way around, no contour
//!          \   /               e2: the next one, a contour: c goes on with it
//!   front   \ /   back
//!  ----c---->o
//!   back
//! ```
//!
//! Where the winding of two faces clashes, or an edge has more than two faces,
//! there is no left and right to keep to: the chain is cut there. The chains
//! themselves are put together in [`super::layer_chain`].
//!
//! It is how a half-edge structure walks the rim of a region, here of the front
//! faces. Rejected: joining the edges that meet at a vertex where they are just two;
//! on rough meshes four and more meet at many vertices.

use crate::edge_mesh::{EdgeFlags, EdgeMesh, FaceEdges};
use crate::index::NONE;
use crate::view::{Line, LineBits};

/// What follows a contour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Successor {
    /// The contour on this record.
    Edge(u32),
    /// Nothing: the surface ends here.
    Boundary,
    /// Nothing: here the surface has no two sides.
    Cut,
}

/// Edges that chains neither contain nor turn across.
const CUTS: EdgeFlags = EdgeFlags::CLASH.union(EdgeFlags::NON_MANIFOLD);

/// What follows the contour on record `edge`; `lines` says what the view makes of
/// every record.
///
/// # Panics
/// Where there is no such record or line.
#[must_use]
pub fn successor(mesh: &EdgeMesh, faces: &FaceEdges, lines: &[Line], edge: u32) -> Successor {
    let record = &mesh.records[edge as usize];
    if record.flags.intersects(CUTS) {
        return Successor::Cut;
    }
    let a_faces = lines[edge as usize].bits.contains(LineBits::A_FACES);
    let mut face = if a_faces { record.face_a } else { record.face_b };
    let mut at = edge;
    // A fan has no more faces than the mesh.
    for _ in 0..mesh.triangles.len() {
        let sides = faces.sides(face);
        let Some(side) = sides.iter().position(|side| *side == at) else { return Successor::Cut };
        at = sides[(side + 1) % 3];
        if at == NONE || mesh.records[at as usize].flags.intersects(CUTS) {
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
