//! Loads models and edge meshes: reads a file, builds its edge mesh, and applies the marks beside
//! it.
//!
//! ```text
//!   model --read--> Model --build--> EdgeMesh + Report = LoadedMesh
//!                      marks ---^          ^
//!   .edgemesh file ------------------------'
//! ```
//!
//! ```
//! use edgemesh::load::{DEMO, LoadOptions, NoProgress, load};
//!
//! let loaded = load(DEMO.as_ref(), &LoadOptions::default(), &NoProgress)?;
//! assert!(loaded.mesh.records.len() > 1000);
//! # Ok::<(), edgemesh::load::LoadError>(())
//! ```

mod error;
mod input;
mod loaded_mesh;
mod marks;
mod options;
mod progress;

pub use error::LoadError;
pub use input::{DEMO, STANDARD_INPUT, load, load_scene};
pub use loaded_mesh::{LoadedMesh, ModelSource};
pub use marks::{MarksError, SideMarks, marks_text, read_marks, side_file};
pub use options::{InputFormat, LoadOptions};
pub use progress::{NoProgress, Progress, Stage};
