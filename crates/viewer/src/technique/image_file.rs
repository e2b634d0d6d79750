//! Images: built-in ones and files of the user.

use std::path::{Path, PathBuf};
use std::time::SystemTime;

use edgemesh_brushes::IMAGES;

use super::mistake::{Mistake, Place};
use super::texture_name::{TextureName, TextureSource};

/// An image that was found.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(crate) enum ImageFile {
    /// A built-in image, by its index in [`IMAGES`].
    Shipped(usize),
    /// A file, by its path.
    File(PathBuf),
}

impl ImageFile {
    /// The bytes of the file, a PNG or JPEG.
    ///
    /// # Errors
    /// If the file cannot be read.
    pub(crate) fn bytes(&self) -> std::io::Result<std::borrow::Cow<'static, [u8]>> {
        match self {
            Self::Shipped(at) => Ok(IMAGES[*at].png.into()),
            Self::File(path) => std::fs::read(path).map(Into::into),
        }
    }

    /// Time of the last change; `None` for built-in images.
    #[must_use]
    pub(crate) fn changed(&self) -> Option<SystemTime> {
        match self {
            Self::Shipped(_) => None,
            Self::File(path) => path.metadata().and_then(|data| data.modified()).ok(),
        }
    }

    /// The name of its directory.
    #[must_use]
    pub(crate) fn directory(&self) -> Option<&str> {
        match self {
            Self::Shipped(at) => Some(IMAGES[*at].directory),
            Self::File(path) => path.parent()?.file_name()?.to_str(),
        }
    }

    /// Its name for messages: `directory:image` or a path.
    #[must_use]
    pub(crate) fn name(&self) -> String {
        match self {
            Self::Shipped(at) => format!("{}:{}", IMAGES[*at].directory, IMAGES[*at].name),
            Self::File(path) => path.display().to_string(),
        }
    }
}

const ENDINGS: [&str; 3] = ["png", "jpg", "jpeg"];

/// Finds an image in `folders`, in their subfolders `images`, and among the built-in ones.
///
/// # Errors
/// An unknown image, with the directories or images that are available.
pub(crate) fn find(
    name: &TextureName,
    folders: &[PathBuf],
    place: &Place,
) -> Result<ImageFile, Mistake> {
    let error = |message: String| Mistake::error(place, message);
    let (directory, image) = match &name.source {
        TextureSource::File(path) => {
            let inside = folders.iter().map(|folder| folder.join(path));
            let mut candidates = inside.chain([PathBuf::from(path)]);
            let found = candidates.find(|path| path.is_file());
            let missing = || error(format!("image file '{path}' not found"));
            return found.map(ImageFile::File).ok_or_else(missing);
        }
        TextureSource::Image { directory: Some(directory), image } => (directory, image),
        _ => return Err(error(format!("'{name}' is not an image"))),
    };
    let is_safe = |part: &str| !part.contains(['/', '\\']) && part != "..";
    if !is_safe(directory) || !is_safe(image) {
        return Err(error(format!("'{name}' points outside the image directories")));
    }
    let images = images_of(directory, folders);
    if images.is_empty() {
        let mistake = error(format!("unknown image directory '{directory}'"));
        let mut names: Vec<&str> = IMAGES.iter().map(|image| image.directory).collect();
        names.dedup();
        return Err(mistake.names(directory, names));
    }
    let found = match image.as_str() {
        "*" => images.iter().min_by_key(|(name, _)| name),
        _ => images.iter().find(|(known, _)| known == image),
    };
    match found {
        Some((_, file)) => Ok(file.clone()),
        None => {
            let mut names: Vec<&str> = images.iter().map(|(name, _)| name.as_str()).collect();
            names.sort_unstable();
            names.dedup();
            Err(error(format!("unknown image '{image}' in {directory}")).names(image, names))
        }
    }
}

/// The images of a directory with their names: those of the first folder first, built-in
/// ones last.
#[must_use]
pub(crate) fn images_of(directory: &str, folders: &[PathBuf]) -> Vec<(String, ImageFile)> {
    let mut images = Vec::new();
    for folder in folders {
        for path in [folder.join(directory), folder.join("images").join(directory)] {
            images.extend(files_of(&path));
        }
    }
    let shipped = IMAGES.iter().enumerate().filter(|(_, image)| image.directory == directory);
    images.extend(shipped.map(|(at, image)| (image.name.to_owned(), ImageFile::Shipped(at))));
    images
}

fn files_of(folder: &Path) -> Vec<(String, ImageFile)> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut files: Vec<(String, ImageFile)> = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| {
            let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
            ending.is_some_and(|ending| ENDINGS.iter().any(|known| ending == *known))
        })
        .filter_map(|path| {
            let name = path.file_stem()?.to_string_lossy().into_owned();
            Some((name, ImageFile::File(path)))
        })
        .collect();
    files.sort_by(|a, b| a.0.cmp(&b.0));
    files
}
