//! The sample model of Edgemesh, embedded: a torus knot, which the path `demo:` stands for.
//!
//! `cargo xtask models` writes it and the other models of this folder, which are not embedded.
//!
//! ```
//! assert!(edgemesh_models::TORUS_KNOT.starts_with(b"#"));
//! ```

/// A tube along the (2, 3) torus knot, 160 x 16 quads, as an OBJ file.
pub const TORUS_KNOT: &[u8] = include_bytes!("../torus_knot.obj");
