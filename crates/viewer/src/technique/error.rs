//! What is wrong with a technique.

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
    /// A shader of the stroke renderer is wrong.
    #[error(transparent)]
    Shader(#[from] ShaderError),
    /// The programs of a pass do not fit together.
    #[error("the pass '{pass}' cannot be built: its programs do not fit together: {reason}")]
    Programs {
        /// The pass.
        pass: String,
        /// What the device said.
        reason: String,
    },
}

/// A setting `PASS.VARIABLE=VALUE` does not fit a technique.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{assignment}: {what}")]
pub struct SettingError {
    /// The setting.
    pub assignment: String,
    /// What is wrong with it, with the names that exist.
    pub what: String,
}
