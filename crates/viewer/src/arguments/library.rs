//! Where techniques come from.

use std::path::PathBuf;

use clap::Args;

use crate::technique::library::Library;

/// Where techniques, components, shaders and images come from.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Techniques")]
pub(crate) struct LibraryArguments {
    /// Your own folder with techniques, components, shaders and images
    /// [default: edgemesh in the folder for settings, as ~/.config/edgemesh]
    #[arg(long, value_name = "DIR", global = true)]
    pub(crate) folder: Option<PathBuf>,
    /// Take shaders from this copy of shaders/ instead of the shipped ones
    #[arg(long, value_name = "DIR", global = true)]
    pub(crate) shaders: Option<PathBuf>,
}

impl LibraryArguments {
    /// Reads the techniques and components.
    pub(crate) fn load(&self) -> Library {
        let folder = self.folder.clone().or_else(Library::default_folder);
        Library::load(folder.as_deref())
    }
}
