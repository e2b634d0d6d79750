//! What can go wrong, typed where it arises.
//!
//! The texts name no option of a command: `command/failure.rs` adds those, with an exit
//! status, and `window/error_text.rs` adds what can be done in the window.

use std::path::PathBuf;

use edgemesh::format::whole_file::WriteError;
use edgemesh::load::LoadError;
use edgemesh::view::CameraError;
use edgemesh_shaders::ShaderError;
use strokes::gpu::device::GpuError;
use strokes::gpu::readback::ReadbackError;
use strokes::mesh::buffers::MeshTooLarge;
use strokes::render::error::RenderError;
use strokes::view::frame::MAX_CLIP_PLANES;
use thiserror::Error;

use crate::technique::brush_file::BrushFileError;
use crate::technique::error::{SettingError, TechniqueError};
use crate::technique::mistake::Mistakes;
use crate::technique::write::WriteTechniqueError;
use crate::watch::WatchError;

/// What can go wrong between files and pictures.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// A model or its marks cannot be loaded.
    #[error(transparent)]
    Load(#[from] LoadError),
    /// A scene file cannot be read, or a line of it is wrong.
    #[error(transparent)]
    SceneFile(#[from] SceneFileError),
    /// The technique or its shaders are wrong; the models and the adapter are not at fault.
    #[error(transparent)]
    Technique(#[from] TechniqueError),
    /// A setting does not fit the technique.
    #[error(transparent)]
    Setting(#[from] SettingError),
    /// A setting of an object in a scene file does not fit its technique.
    #[error("{}: set {reason}", model.display())]
    ObjectSetting {
        /// The object's model.
        model: PathBuf,
        /// The setting.
        reason: SettingError,
    },
    /// A changed technique cannot be written as a file.
    #[error(transparent)]
    WriteTechnique(#[from] WriteTechniqueError),
    /// A brush is named that is neither a file nor a shipped one.
    #[error(
        "{path}: there is no such file; a brush is a PNG file, or one of none, {}",
        edgemesh_brushes::BRUSH_NAMES.join(", ")
    )]
    NoSuchBrush {
        /// The name.
        path: String,
    },
    /// A technique names a brush that is not found.
    #[error("{what}: a brush is a PNG file, or one of the directory brushes")]
    BrushNotFound {
        /// What is not found.
        what: String,
    },
    /// A file is not a brush.
    #[error(transparent)]
    Brush(#[from] BrushFileError),
    /// A picture file cannot be read or decoded.
    #[error("{file}: {reason}")]
    Image {
        /// The file, or the name of a shipped image.
        file: String,
        /// What is wrong with it.
        reason: ImageError,
    },
    /// A picture or an animation cannot be encoded.
    #[error("the {what} cannot be encoded: {reason}")]
    Encode {
        /// `PNG` or `animation`.
        what: &'static str,
        /// What the encoder said.
        reason: Box<dyn std::error::Error + Send + Sync>,
    },
    /// A file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// The camera sees nothing.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// More planes cut the scene than shaders take.
    #[error("there are at most {MAX_CLIP_PLANES} clip planes")]
    TooManyClipPlanes,
    /// A text is not the command line of a picture.
    #[error("{0}")]
    CommandLine(String),
    /// There is no adapter, or it does not do.
    #[error(transparent)]
    Adapter(#[from] GpuError),
    /// The adapter of a window was lost again and again.
    #[error("the graphics adapter was lost {times} times within {seconds} seconds")]
    AdapterLost {
        /// How often.
        times: usize,
        /// Within how many seconds.
        seconds: u64,
    },
    /// The adapter was lost while a picture was drawn.
    #[error("the graphics adapter was lost: {reason}")]
    DeviceLost {
        /// What the driver said.
        reason: wgpu::PollError,
    },
    /// A picture or counts cannot be read back from the adapter.
    #[error(transparent)]
    Readback(#[from] ReadbackError),
    /// The adapter has no memory for what is drawn.
    #[error(
        "the graphics adapter ran out of memory: the picture alone, {}x{} with {samples} samples, \
         needs {} MiB",
        size[0], size[1], bytes >> 20
    )]
    OutOfMemory {
        /// Width and height in pixels.
        size: [u32; 2],
        /// Samples a pixel.
        samples: u32,
        /// Bytes of the textures that the picture is drawn into.
        bytes: u64,
    },
    /// The adapter is used wrongly: an internal error.
    #[error("a fault in the use of the graphics adapter: {0}")]
    AdapterFault(String),
    /// A mesh does not fit the adapter.
    #[error("{model}: {reason}")]
    MeshTooLarge {
        /// The model's name.
        model: String,
        /// Its bytes, and what the adapter takes.
        reason: MeshTooLarge,
    },
    /// A picture is larger than a texture can be.
    #[error(
        "a picture of {}x{} is too large: this adapter draws at most {limit} pixels a side at once",
        size[0], size[1]
    )]
    PictureTooLarge {
        /// Width and height in pixels.
        size: [u32; 2],
        /// The most pixels a side.
        limit: u32,
    },
    /// A picture does not fit the memory of the machine.
    #[error(
        "{}x{}: there is no memory for a picture of {} MiB",
        size[0], size[1], (u128::from(size[0]) * u128::from(size[1]) * 4) >> 20
    )]
    NoMemoryForPicture {
        /// Width and height in pixels.
        size: [u32; 2],
    },
    /// Marks are to be saved for a model that comes from no file.
    #[error("{model}: marks can be saved for models that are files, not for this one")]
    MarksWithoutFile {
        /// The model's name.
        model: String,
    },
    /// There is no model to draw.
    #[error("there is no model to draw")]
    NoModel,
    /// Files cannot be watched.
    #[error(transparent)]
    Watch(#[from] WatchError),
    /// No window can be opened: no display is named.
    #[error(
        "no window can be opened, as there is no display (neither DISPLAY nor WAYLAND_DISPLAY is \
         set)"
    )]
    NoDisplay,
    /// No window can be opened.
    #[error(
        "no window can be opened: {reason}; is the display there that DISPLAY or WAYLAND_DISPLAY \
         names?"
    )]
    NoWindow {
        /// What the window system said.
        reason: String,
    },
    /// No adapter draws to the window.
    #[error("{0}")]
    WindowAdapter(String),
    /// A window is open and cannot be filled.
    #[error("{0}")]
    Window(String),
    /// The work was canceled.
    #[error("it was canceled")]
    Canceled,
    /// An internal error.
    #[error("{0}")]
    Internal(String),
}

impl From<Mistakes> for Error {
    fn from(mistakes: Mistakes) -> Self {
        Self::Technique(TechniqueError::Mistakes(mistakes))
    }
}

impl From<RenderError> for Error {
    fn from(error: RenderError) -> Self {
        match error {
            RenderError::Shader(error) => error.into(),
            // Meshes, styles and targets are made for each other here.
            error => Self::Internal(error.to_string()),
        }
    }
}

impl From<ShaderError> for Error {
    fn from(error: ShaderError) -> Self {
        Self::Technique(TechniqueError::Shader(error))
    }
}

/// What is wrong with a picture file.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ImageError {
    /// The operating system does not hand it out.
    #[error("cannot be read: {0}")]
    Io(#[from] std::io::Error),
    /// It is not a picture of a known format, or is too large.
    #[error("is not a picture that can be read: {0}")]
    Decode(#[from] image::ImageError),
}

/// Why a scene file was not read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SceneFileError {
    /// The operating system does not hand it out, or it is not UTF-8.
    #[error("{}: cannot be read: {reason}", path.display())]
    Io {
        /// The scene file.
        path: PathBuf,
        /// What the operating system said.
        reason: std::io::Error,
    },
    /// A line of it is wrong.
    #[error("{}:{line}: {what}", path.display())]
    Line {
        /// The scene file.
        path: PathBuf,
        /// The line, counted from 1.
        line: usize,
        /// What is wrong with it.
        what: String,
    },
}
