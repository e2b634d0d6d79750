//! The `.edgemesh` file: an edge mesh in its memory layout.
//!
//! Idea: every list is stored as the GPU reads it, at a multiple of 16 bytes, so
//! that a file in memory (read or mapped) is used in place. A checksum finds every
//! flipped bit. Then all indices are checked, so that no file can make later code
//! read past the end of a list.
//!
//! Rejected: a general format such as CBOR, or glTF with an extension, which would be
//! parsed and copied element by element; compression, which would be undone before
//! every use.
//!
//! # Layout, version 2
//!
//! All numbers are little-endian. A file has a header, a table, and sections:
//!
//! ```text
//!  byte  bytes
//!     0      8  magic, "EDGEMESH" in ASCII
//!     8      4  version, u32: 2
//!    12      4  number of sections S, u32
//!    16      8  length of the whole file in bytes, u64
//!    24     32  checksum: BLAKE3 of bytes 0 to 23 and 56 to the end
//!    56   24 S  section table, 24 bytes for each section:
//!                  0   4  tag, four characters of ASCII
//!                  4   4  size of an element in bytes, u32
//!                  8   8  first byte, from the start of the file, u64
//!                 16   8  number of elements, u64
//!               sections, each at the next multiple of 16 bytes, with zeros between
//! ```
//!
//! The checksum covers everything except itself: magic, version, lengths, table,
//! sections and the zeros between them. The sections may come in any order. Unknown
//! tags are skipped, because a newer program may add sections; a known tag occurs at
//! most once. All sections are required, empty or not, except those marked
//! *optional*.
//!
//! ```text
//!  tag   bytes  count   an element
//!  POSI    12   V       position, 3 f32
//!  NORM    12   V       vertex normal, 3 f32
//!  SPLT     4   s < V   welded vertex that vertex V - s + k was split from, u32
//!  TRIS    12   F       triangle, 3 u32: vertices
//!  PLAN    32   F       plane of a face, 8 f32: unit normal, 0, point, 1
//!  EDGE    20   E       edge record, 5 u32: v0, v1, face A, face B, word
//!  CHNS    20   C       chain: first link u32, links u32, length f32, 1 if closed
//!                       u32, class u32
//!  LNKS    16   L       edge of a chain: record u32, chain u32, length before it
//!                       f32, 1 if it runs from v1 to v0 u32
//!  FVTX    32   W       fill vertex, 8 f32: position, normal, texture (optional)
//!  FCOL     4   W       color of a fill vertex, 4 bytes: red, green, blue, opacity
//!                       (optional)
//!  FIDX     4   3 F     its triangles in the order of TRIS, u32 (optional)
//!  FRUN    16   R       material range, 4 u32: first triangle, material, group, 1 if
//!                       all corners have texture coordinates of the model (optional)
//!  MTRL    52   M       material: ambient, diffuse, specular color, 3 f32 each;
//!                       shininess, opacity, f32; a bit for each of these five that
//!                       is stated, from bit 0, u32; its picture, u32 (optional)
//!  PEND     8   P       end of a picture in PICT, which begins at the end of the
//!                       previous one, u64 (optional)
//!  PICT     1           the pictures, PNG or JPEG (optional)
//!  RF32    80   4 E     edge vertex in floats (optional)
//!  RI16    40   4 E     edge vertex at 16 bits (optional)
//!  INST    16   I       instanced mesh: end of its file in IMSH, end of its places in
//!                       IPLC, u64 each; they begin at the ends of the previous one, files
//!                       at the next multiple of 16 (optional)
//!  IMSH     1           the files of the instanced meshes, with zeros between (optional)
//!  IPLC    96   P       placement, 12 f64: the columns of a transform from positions of
//!                       the instanced mesh to positions of the mesh (optional)
//!  FRAM     8   4       origin x, y, z and scale s of the mesh frame, f64:
//!                       position in mesh = (position in model file - origin) s
//!  BNDS    12   2       lower and upper corner of the bounds of POSI, 3 f32
//!  CNTS     8   18      counts before any repair, u64
//!  META     1           JSON in UTF-8
//! ```
//!
//! - A missing face is `0xFFFFFFFF`; face B may be missing, or both. Every face of a
//!   record has a vertex that is not on the edge.
//! - Material ranges ascend by their first triangle, which is 0 in the first range;
//!   with FIDX there is at least one. Without FRUN all triangles are one range without
//!   material, group and texture coordinates. A missing material, group or picture is
//!   `0xFFFFFFFF`.
//! - Colors are sRGB, 0 to 1, or 0 to 255 in FCOL, which are multiplied by those of the
//!   material. A texture is multiplied by the diffuse color; (0, 0) is
//!   the lower left corner of its picture.
//! - Classes, from bit 0: boundary, ridge, valley, marked, material,
//!   non-manifold, diagonal, clash, solid, smoothing, groove,
//!   paired
//!   ([`crate::edge_mesh::EdgeFlags`]).
//! - The word of an edge has its classes in bits 0 to 11, the certain angle between
//!   its face normals in bits 12 to 28, in steps of 1/720 degree, rounded up, and
//!   bit 29 if it is concave ([`crate::edge_mesh::EdgeWord`]).
//! - `RF32`: v0, v1, v2, v3, n0, n1 (3 f32 each), the random scalar (f32), and
//!   a u32 of the corner 0 to 3 in bits 0 and 1 and the word from bit 2.
//! - `RI16`: v0, v1, v2, v3, n0, n1 (3 i16 each), a byte of the corner in bits
//!   0 and 1 and the random scalar times 64 above, and 3 bytes of the word: its
//!   classes in bits 0 to 9, the angle in bits 10 to 22 in steps of 1/45 degree,
//!   rounded up, and bit 23 if it is concave; there a diagonal is ridge and valley,
//!   a paired edge boundary and non-manifold, and bit 6 is groove.
//!   Normals are times 32767. Positions are in steps from the center of the
//!   bounds; a step is their largest side / 65534, or 1 if that is 0.
//! - `CNTS`: vertices of the file, welded vertices, triangles, degenerate triangles,
//!   duplicate triangles, edges, boundary edges, non-manifold edges, inconsistent
//!   edges, diagonals, components; then of the polygons of the file: vertices,
//!   polygons, triangles, edges, boundary edges, non-manifold edges, inconsistent
//!   edges. All are below 2^32 - 1.
//! - An instanced mesh is a whole file as described here, with its own checksum and the
//!   frame of this one, and without instances. It is drawn once for each of its places, of
//!   which a file has 10,000 at most; their transforms are finite. All counts are of this
//!   mesh alone.
//! - Version 1 is read, too. Its words have classes only, and its replicated layouts
//!   are skipped.
//! - `META`: `name` (of the model), `warnings` (`code`, `count`, `place`,
//!   `message`), `repairs` (`kind`, `count`, `place`), optional `materials`, as many as
//!   in `MTRL` (`name`, and the name of its `texture`), and optional `groups` (names).
//!   An optional place has one key of `line`, `byte`, `face`, `vertex`, `part`. Readers
//!   accept unknown keys, codes and kinds.

mod check;
#[cfg(test)]
mod draft;
mod element;
mod error;
mod header;
mod instances;
mod layout;
mod materials;
mod meta;
mod numbers;
mod read;
#[cfg(test)]
mod samples;
mod section;
mod stored;
mod version_1;
mod write;

pub use error::{FileError, FileErrorKind};
pub use header::with_checksum;
pub(crate) use header::{HEADER_BYTES, is_edge_mesh, stated_length};
pub use layout::Layout;
pub use read::parse;
pub use stored::StoredMesh;
pub use write::{to_bytes, to_bytes_with_instances};
