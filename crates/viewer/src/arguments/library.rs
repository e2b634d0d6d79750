//! Folders of techniques, components, shaders and images.

use std::path::PathBuf;

use clap::Args;

use crate::technique::library::Library;

/// Folders of techniques, components, shaders and images.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Techniques")]
pub(crate) struct LibraryArguments {
    /// Your folder with techniques, components, shaders and images [default: edgemesh in the
    /// settings folder, such as ~/.config/edgemesh]
    #[arg(long, value_name = "DIR", global = true)]
    pub(crate) folder: Option<PathBuf>,
    /// Use the shaders in this copy of shaders/ instead of the built-in ones
    #[arg(long, value_name = "DIR", global = true)]
    pub(crate) shaders: Option<PathBuf>,
}

impl LibraryArguments {
    /// Reads techniques and components.
    pub(crate) fn load(&self) -> Library {
        let folder = self.folder.clone().or_else(Library::default_folder);
        Library::load(folder.as_deref())
    }
}
