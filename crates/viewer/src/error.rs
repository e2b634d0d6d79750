//! Errors, typed where they arise.
//!
//! Their texts name no option of a command: `command/failure.rs` adds hints and exit
//! statuses, and `window/error_text.rs` hints for the window.

use std::path::PathBuf;

use edgemesh::format::whole_file::WriteError;
use edgemesh::load::LoadError;
use edgemesh::view::CameraError;
use edgemesh_shaders::ShaderError;
use strokes::{GpuError, MAX_CLIP_PLANES, MeshTooLarge, ReadbackError, RenderError};
use thiserror::Error;

use crate::technique::brush_file::BrushFileError;
use crate::technique::error::{SettingError, TechniqueError};
use crate::technique::mistake::Mistakes;
use crate::technique::write::WriteTechniqueError;
use crate::watch::WatchError;

/// An error between files and pictures.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// A model or its marks cannot be loaded.
    #[error(transparent)]
    Load(#[from] LoadError),
    /// A scene file cannot be read, or has a wrong line.
    #[error(transparent)]
    SceneFile(#[from] SceneFileError),
    /// The technique or its shaders have mistakes.
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
    /// A brush that is neither a file nor a built-in one.
    #[error(
        "{path}: file not found; a brush is a PNG file, or one of none, {}",
        edgemesh_brushes::BRUSH_NAMES.join(", ")
    )]
    NoSuchBrush {
        /// The given name.
        path: String,
    },
    /// A technique names a brush that is not found.
    #[error("{what}: a brush is a PNG file, or one of the directory brushes")]
    BrushNotFound {
        /// The message about the missing brush.
        what: String,
    },
    /// A file is not a brush.
    #[error(transparent)]
    Brush(#[from] BrushFileError),
    /// A picture file cannot be read or decoded.
    #[error("{file}: {reason}")]
    Image {
        /// The file, or the name of a built-in image.
        file: String,
        /// The cause.
        reason: ImageError,
    },
    /// A picture or an animation cannot be encoded.
    #[error("the {what} cannot be encoded: {reason}")]
    Encode {
        /// `PNG` or `animation`.
        what: &'static str,
        /// The encoder's error.
        reason: Box<dyn std::error::Error + Send + Sync>,
    },
    /// A file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// The camera sees nothing.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// More clip planes than shaders support.
    #[error("there are at most {MAX_CLIP_PLANES} clip planes")]
    TooManyClipPlanes,
    /// A text is not the command line of a picture.
    #[error("{0}")]
    CommandLine(String),
    /// There is no suitable adapter.
    #[error(transparent)]
    Adapter(#[from] GpuError),
    /// The adapter of a window was lost too often.
    #[error("the graphics adapter was lost {times} times within {seconds} seconds")]
    AdapterLost {
        /// Number of losses.
        times: usize,
        /// Within this many seconds.
        seconds: u64,
    },
    /// The adapter was lost while a picture was drawn.
    #[error("the graphics adapter was lost: {reason}")]
    DeviceLost {
        /// The error of the driver.
        reason: wgpu::PollError,
    },
    /// A picture or counts cannot be read back from the adapter.
    #[error(transparent)]
    Readback(#[from] ReadbackError),
    /// The adapter has too little memory.
    #[error(
        "the graphics adapter ran out of memory: the picture alone, {}x{} with {samples} samples, \
         needs {} MiB",
        size[0], size[1], bytes >> 20
    )]
    OutOfMemory {
        /// Width and height in pixels.
        size: [u32; 2],
        /// Samples per pixel.
        samples: u32,
        /// Bytes of the textures of the picture.
        bytes: u64,
    },
    /// The adapter was used incorrectly: an internal error.
    #[error("internal graphics error: {0}")]
    AdapterFault(String),
    /// A mesh does not fit the adapter.
    #[error("{model}: {reason}")]
    MeshTooLarge {
        /// The model's name.
        model: String,
        /// Its size and the adapter's limit.
        reason: MeshTooLarge,
    },
    /// The instances of models are too many objects.
    #[error(
        "too large: the instances of the models are {count} objects; the limit is {limit}: split \
         the scene"
    )]
    TooManyObjects {
        /// The number of objects.
        count: usize,
        /// The most objects.
        limit: usize,
    },
    /// A picture is larger than the largest texture.
    #[error(
        "a picture of {}x{} is too large: this adapter draws at most {limit} pixels a side at once",
        size[0], size[1]
    )]
    PictureTooLarge {
        /// Width and height in pixels.
        size: [u32; 2],
        /// The longest side in pixels.
        limit: u32,
    },
    /// The machine has too little memory for a picture.
    #[error(
        "{}x{}: not enough memory for a picture of {} MiB",
        size[0], size[1], (u128::from(size[0]) * u128::from(size[1]) * 4) >> 20
    )]
    NoMemoryForPicture {
        /// Width and height in pixels.
        size: [u32; 2],
    },
    /// Marks cannot be saved for a model that is not from a file.
    #[error("{model}: marks can be saved only for models from files")]
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
    /// No window can be opened because no display is set.
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
        /// The error of the window system.
        reason: String,
    },
    /// No adapter can draw to the window.
    #[error("{0}")]
    WindowAdapter(String),
    /// A window is open but cannot be drawn.
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
            // Meshes, styles and targets are made for each other in this crate.
            error => Self::Internal(error.to_string()),
        }
    }
}

impl From<ShaderError> for Error {
    fn from(error: ShaderError) -> Self {
        Self::Technique(TechniqueError::Shader(error))
    }
}

/// Why a picture file cannot be used.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ImageError {
    /// The file cannot be read.
    #[error("cannot be read: {0}")]
    Io(#[from] std::io::Error),
    /// Not a picture of a known format, or too large.
    #[error("is not a readable picture: {0}")]
    Decode(#[from] image::ImageError),
}

/// Why a scene file cannot be used.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SceneFileError {
    /// The file cannot be read, or is not UTF-8.
    #[error("{}: cannot be read: {reason}", path.display())]
    Io {
        /// The scene file.
        path: PathBuf,
        /// The error of the operating system.
        reason: std::io::Error,
    },
    /// A wrong line.
    #[error("{}:{line}: {what}", path.display())]
    Line {
        /// The scene file.
        path: PathBuf,
        /// The line, counted from 1.
        line: usize,
        /// The mistake.
        what: String,
    },
}
