//! Reads model files; every reader stands behind one firewall.
//!
//! ```text
//! file --source: size, first bytes--> format --reader--> Model --firewall--> Model
//!                                                |
//!                          files beside it, in its folder or below only
//! ```
//!
//! Before a reader sees a byte, the path must lead to a file of a sensible size
//! whose first bytes are those of a model (`sniff`). Whatever a reader makes
//! is checked once more (`firewall`), and a panic in it ends in an error that
//! asks for a report. Errors name the file, the place in it, and what to do.

mod error;
mod firewall;
mod gltf;
mod mtl;
mod number;
mod obj;
mod picture;
mod ply;
mod sniff;
mod source;
mod stl;
mod vrml;
mod words;

use std::io::Read;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

pub use error::{ReadError, ReadErrorKind};
pub(crate) use sniff::EDGE_MESH_MAGIC;
pub use sniff::Format;
pub use source::MAX_FILE_BYTES;
use source::{Source, folder_of, load, load_stream};

use crate::model::Model;
use crate::report::Report;

/// Reads the model file at `path`, with what had to be dropped in the
/// [`Report`]; the format is told by the first bytes, then by the name.
///
/// Files that the model names are read where they lie in its folder or below.
///
/// # Errors
/// [`ReadError`], when nothing sound can be made of the file.
pub fn read_model(path: &Path) -> Result<(Model, Report), ReadError> {
    read_model_as(path, None)
}

/// Reads the model file at `path` as the format that is given.
///
/// # Errors
/// As [`read_model`].
pub fn read_model_as(path: &Path, format: Option<Format>) -> Result<(Model, Report), ReadError> {
    let (bytes, format) = load(path, format)?;
    let name = path.display().to_string();
    read_source(&Source { name: &name, folder: Some(folder_of(path)), bytes: &bytes }, format)
}

/// Reads a model from a stream that is called `name` in messages; files that it
/// names are not opened, as a stream has no folder.
///
/// # Errors
/// As [`read_model`].
pub fn read_model_stream(
    stream: impl Read,
    name: &Path,
    format: Option<Format>,
) -> Result<(Model, Report), ReadError> {
    let (bytes, format) = load_stream(stream, name, format)?;
    let name = name.display().to_string();
    read_source(&Source { name: &name, folder: None, bytes: &bytes }, format)
}

/// Reads a model from bytes, as the format that is given; for tests and
/// programs that hold files in memory.
///
/// # Errors
/// As [`read_model`].
pub fn read_model_bytes(
    name: &str,
    bytes: &[u8],
    format: Format,
) -> Result<(Model, Report), ReadError> {
    read_source(&Source { name, folder: None, bytes }, format)
}

fn read_source(source: &Source, format: Format) -> Result<(Model, Report), ReadError> {
    let mut report = Report::default();
    let read = || match format {
        Format::Obj => obj::read_obj(source, &mut report),
        Format::Ply => ply::read_ply(source, &mut report),
        Format::Stl => stl::read_stl(source, &mut report),
        Format::Gltf | Format::Glb => gltf::read_gltf(source, &mut report),
        Format::Wrl => vrml::read_vrml(source, &mut report),
    };
    // The report is thrown away where the reader panics.
    let mut model = catch_unwind(AssertUnwindSafe(read)).unwrap_or_else(|_| {
        let what = format!(
            "internal error in the {} reader; please report it with the file",
            format.name()
        );
        Err(source.error(ReadErrorKind::Internal, None, what))
    })?;
    model.name = source.name.into();
    // OBJ tells of its vertices itself, with their lines.
    firewall::check(source, &mut model, &mut report, format == Format::Obj)?;
    Ok((model, report))
}
