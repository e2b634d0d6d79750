//! Why a technique cannot be drawn.

use edgemesh_shaders::ShaderError;
use thiserror::Error;

use super::mistake::Mistakes;

/// Why a technique cannot be drawn.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum TechniqueError {
    /// Mistakes in its file or its shaders, underlined. The text has no `error:` before the
    /// first one.
    #[error("{}", .0.text())]
    Mistakes(Mistakes),
    /// A shader of the stroke renderer is invalid.
    #[error(transparent)]
    Shader(#[from] ShaderError),
    /// The programs of a pass do not fit together.
    #[error("the pass '{pass}' cannot be built: its programs do not fit together: {reason}")]
    Programs {
        /// Name of the pass.
        pass: String,
        /// The error of the device.
        reason: String,
    },
}

/// A setting `PASS.VARIABLE=VALUE` that does not fit a technique.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{assignment}: {what}")]
pub struct SettingError {
    /// The setting.
    pub(crate) assignment: String,
    /// The mistake, with the names that exist.
    pub(crate) what: String,
}
