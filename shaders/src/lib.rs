//! The WGSL of Edgemesh, embedded, and the resolver of its imports.
//!
//! - [`files`]: the files of this folder, by who draws with them.
//! - [`source`]: `#import`, and mistakes at the line where they were written.
//!
//! ```
//! let shader = edgemesh_shaders::ShaderSource::embedded("fill.wgsl")?;
//! let module = shader.validate()?;
//! assert!(!module.entry_points.is_empty());
//! # Ok::<(), edgemesh_shaders::ShaderError>(())
//! ```

#![warn(clippy::print_stdout, clippy::print_stderr)]

pub mod files;
pub mod source;

pub use self::source::{ShaderError, ShaderSource};
