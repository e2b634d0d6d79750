//! The variables with the programs of a pass.

use super::reader::Reader;

/// The variable with the vertex program.
pub(in crate::technique) const VERTEX: &str = "vertex_program";
/// The variable with the fragment program.
pub(in crate::technique) const FRAGMENT: &str = "fragment_program";
/// The variable with the fragment program of the background.
pub(in crate::technique) const BACKGROUND: &str = "background_program";

/// The programs of a pass, each as `file:function`.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct ProgramNames {
    /// Places vertices.
    pub(crate) vertex: Option<String>,
    /// Colors fragments.
    pub(crate) fragment: Option<String>,
    /// Colors the fragments of the background.
    pub(crate) background: Option<String>,
}

impl ProgramNames {
    /// The program of a component that has a fragment program only.
    pub(super) fn read_fragment(reader: &mut Reader) -> Self {
        Self { fragment: reader.optional_string(FRAGMENT), ..Self::default() }
    }
}
