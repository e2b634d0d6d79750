//! Reads model files.
//!
//! ```text
//! file --load, sniff--> bytes, format --reader--> Model --firewall--> Model
//!                                         |
//!                        files beside it, in its folder or below
//! ```
//!
//! `load` checks the size of a file and `sniff` detects its format before a reader
//! sees a byte. `firewall` checks what a reader returns: its indices, its numbers,
//! its counts. A panic in a reader becomes an error that asks for a bug report.
//! Errors name the file, the place in it, and what to do.

mod byte_order_mark;
mod error;
mod firewall;
mod foreign;
mod format;
mod gltf;
mod load;
mod non_finite;
mod normal_transform;
mod number;
mod obj;
mod off;
mod picture;
mod picture_structure;
mod ply;
mod sniff;
mod source;
mod stated;
mod stl;
mod threemf;
mod vrml;
mod words;

use std::io::Read;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

pub use error::{ReadError, ReadErrorKind};
pub use format::Format;
use load::{load, load_stream};
use source::Source;

use crate::format::validate;
use crate::format::whole_file::folder_of;
use crate::model::Model;
use crate::report::Report;

/// Reads the model file at `path`; the [`Report`] lists what was left out. The
/// format is detected from the first bytes, then from the file extension.
///
/// Other files that the model names are opened only in its folder or below.
///
/// # Errors
/// Fails if the file cannot be read, or holds no usable model.
pub fn read_model(path: &Path) -> Result<(Model, Report), ReadError> {
    read_model_as(path, None)
}

/// As [`read_model`], in the given format.
///
/// # Errors
/// As [`read_model`].
pub fn read_model_as(path: &Path, format: Option<Format>) -> Result<(Model, Report), ReadError> {
    let (bytes, format) = load(path, format)?;
    let name = path.display().to_string();
    read_source(&Source { name: &name, folder: Some(folder_of(path)), bytes: &bytes }, format)
}

/// As [`read_model`], from a stream; `name` stands for it in messages. Other files
/// that the model names are not opened, because a stream has no folder.
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

/// As [`read_model_stream`], from bytes in memory.
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
        Format::Gltf | Format::Glb => gltf::read_gltf(source, validate::gltf::check, &mut report),
        Format::Wrl => vrml::read_vrml(source, &mut report),
        Format::Off => off::read_off(source, &mut report),
        Format::ThreeMf => threemf::read_3mf(source, &mut report),
    };
    // A panic may leave the report half written; the caller does not get it then.
    let mut model = catch_unwind(AssertUnwindSafe(read)).unwrap_or_else(|_| {
        let what = format!(
            "internal error in the {} reader; please report it, with the file",
            format.name()
        );
        Err(source.error(ReadErrorKind::Internal, None, what))
    })?;
    model.name = source.name.into();
    // The OBJ reader has warned of its vertices itself, with their lines.
    firewall::check(source, &mut model, &mut report, format == Format::Obj)?;
    Ok((model, report))
}
