//! The `.edgemesh` file: an edge mesh as it lies in memory.
//!
//! Idea: every list is stored as the GPU reads it, at a multiple of 16 bytes,
//! so that a file that was read (or mapped) into memory is used where it lies.
//! A checksum over all of it finds every flipped bit, and whatever passes is
//! checked once more for indices, so that no file makes later code read past
//! the end of a list.
//!
//! Rejected: a general format such as CBOR or glTF with an extension, which
//! would be parsed and copied element by element; compression, which would be
//! undone before every use.
//!
//! # Layout, version 1
//!
//! All numbers are little-endian. A file is a header, a table, and sections:
//!
//! ```text
//!  byte  bytes
//!     0      8  magic, "EDGEMESH" in ASCII
//!     8      4  version, u32: 1
//!    12      4  number of sections S, u32
//!    16      8  length of the whole file in bytes, u64
//!    24     32  checksum: BLAKE3 of bytes 0 to 23 and 56 to the end, in a row
//!    56   24 S  section table, 24 bytes a section:
//!                  0   4  tag, four characters of ASCII
//!                  4   4  size of an element in bytes, u32
//!                  8   8  first byte, from the start of the file, u64
//!                 16   8  number of elements, u64
//!               sections, each at the next multiple of 16 bytes, zeros between
//! ```
//!
//! The checksum covers everything but itself: magic, version, lengths, table,
//! sections and the zeros between them. The sections may come in any order. A
//! tag that is not known is skipped, since a newer program may add sections; a
//! known tag stands at most once. All sections are there, empty or not, but for
//! those marked *optional*.
//!
//! ```text
//!  tag   bytes  count   an element
//!  POSI    12   V       position, 3 f32
//!  NORM    12   V       vertex normal, 3 f32
//!  SPLT     4   s < V   welded vertex that vertex V - s + k was split from, u32
//!  TRIS    12   F       triangle, 3 u32: vertices
//!  PLAN    32   F       plane of a face, 8 f32: unit normal, 0, point, 1
//!  EDGE    20   E       edge record, 5 u32: v0, v1, face A, face B, classes
//!  CHNS    20   C       polyline: first link u32, links u32, length f32,
//!                       1 where closed u32, the class it is chained by u32
//!  LNKS    16   L       its edge: record u32, polyline u32, length before it
//!                       f32, 1 where it runs from v1 to v0 u32
//!  FVTX    32   W       fill vertex, 8 f32: position, normal, texture (optional)
//!  FIDX     4   3 F     its triangles in the order of TRIS, u32 (optional)
//!  FRUN    16   R       what triangles from one on share, 4 u32: first triangle,
//!                       material, group, 1 where all corners have texture
//!                       coordinates of the model (optional)
//!  MTRL    52   M       material: ambient, diffuse, specular colour, 3 f32 each;
//!                       shininess, opacity, f32; which of these five it states,
//!                       from bit 0 on, u32; its picture, u32 (optional)
//!  PEND     8   P       end of a picture in PICT, which begins where the one
//!                       before it ends, u64 (optional)
//!  PICT     1           the pictures in a row, PNG or JPEG (optional)
//!  RF32    80   4 E     edge vertex in floats (optional)
//!  RI16    40   4 E     edge vertex at 16 bits (optional)
//!  FRAM     8   4       origin x, y, z and scale s, f64:
//!                       in the mesh = (in the model's file - origin) s
//!  BNDS    12   2       lower and upper corner of the box of POSI, 3 f32
//!  CNTS     8   18      counts before any repair, u64
//!  META     1           JSON in UTF-8
//! ```
//!
//! - A face that is missing is `0xFFFFFFFF`; face B may be missing, or both.
//!   Every face of a record has a vertex that is not on the edge.
//! - Runs ascend by their first triangles, the first one from 0 on; with FIDX
//!   there is at least one. Where FRUN is missing, all triangles are one run of no
//!   material, no group, and 0. A material, group or picture that is missing is
//!   `0xFFFFFFFF`.
//! - Colours are display values, coded as sRGB, 0 to 1. A texture is multiplied by
//!   the diffuse colour; (0, 0) is the lower left corner of its picture.
//! - Classes, from bit 0: boundary, ridge, valley, marked, material,
//!   non-manifold, diagonal, clash, solid, smoothing
//!   ([`crate::edge_mesh::record::EdgeFlags`]).
//! - `RF32`: v0, v1, v2, v3, n0, n1 (3 f32 each), the random scalar (f32), and
//!   a u32 of the corner 0 to 3 in bits 0 and 1 and the classes from bit 8.
//! - `RI16`: v0, v1, v2, v3, n0, n1 (3 i16 each), a byte of the corner in bits
//!   0 and 1 and the random scalar times 64 above, and 3 bytes of classes.
//!   Normals are times 32767. Positions are in steps from the middle of the
//!   box; a step is its largest side / 65534, or 1 where that is 0.
//! - `CNTS`: vertices listed, welded vertices, triangles, degenerate and
//!   duplicate ones, edges, boundary, non-manifold, inconsistent and diagonal
//!   ones, components; then of the polygons as listed: vertices, polygons,
//!   triangles, edges, boundary, non-manifold and inconsistent ones. All are
//!   below 2^32 - 1.
//! - `META`: `name` (of the model), `warnings` (`code`, `count`, `place`,
//!   `message`), `repairs` (`kind`, `count`, `place`); where there are any,
//!   `materials`, as many as in `MTRL` (`name`, and the name of its `texture`),
//!   and `groups` (names). A place is missing or has one key of `line`, `byte`,
//!   `face`, `vertex`, `part`. Keys, codes and kinds that are not known may come.

mod check;
#[cfg(test)]
mod draft;
mod element;
mod error;
mod header;
mod looks;
mod meta;
mod numbers;
mod read;
#[cfg(test)]
mod samples;
mod section;
mod stored;
mod write;

pub use error::{FileError, FileErrorKind};
pub use header::{HEADER_BYTES, VERSION, is_edge_mesh, stated_length, with_checksum};
pub use read::parse;
pub use stored::StoredMesh;
pub use write::to_bytes;

/// A layout of the records that a file holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Layout {
    /// Indexed edge records of 20 bytes; every file has them.
    Indexed,
    /// The paper's edge vertices in 32-bit floats, 4 × 80 bytes an edge.
    ReplicatedF32,
    /// The paper's edge vertices at 16 bits, 4 × 40 bytes an edge.
    ReplicatedI16,
}

impl Layout {
    /// All layouts.
    pub const ALL: [Self; 3] = [Self::Indexed, Self::ReplicatedF32, Self::ReplicatedI16];

    /// The layout's name on the command line.
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Indexed => "indexed",
            Self::ReplicatedF32 => "replicated-f32",
            Self::ReplicatedI16 => "replicated-i16",
        }
    }
}
