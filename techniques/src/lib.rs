//! The techniques of Edgemesh and the components that they are made of, embedded.
//!
//! Each is a TOML file; the guide is `docs/techniques.md` in the repository.
//!
//! ```
//! let (_, ink) = edgemesh_techniques::TECHNIQUES.iter().find(|(name, _)| *name == "ink").unwrap();
//! assert!(ink.contains("[[pass]]"));
//! ```

/// The name of a file without its ending, and its text.
pub type EmbeddedFile = (&'static str, &'static str);

macro_rules! embedded {
    ($folder:literal: $($name:literal),+ $(,)?) => {
        &[$(($name, include_str!(concat!("../", $folder, $name, ".toml")))),+]
    };
}

/// The files of components, by name.
pub const COMPONENTS: &[EmbeddedFile] =
    embedded!["components/": "core", "detectors", "fills", "lines"];

/// The techniques, by name.
pub const TECHNIQUES: &[EmbeddedFile] = embedded![
    "":
    "anime",
    "blueprint",
    "cartoon",
    "charcoal",
    "debug_depth",
    "debug_features",
    "debug_ids",
    "debug_normals",
    "fins",
    "fur",
    "gooch",
    "hatching",
    "hidden_line",
    "ink",
    "linked",
    "outline_combined",
    "outline_depth",
    "outline_ids",
    "outline_laplacian",
    "outline_normals",
    "outline_planes",
    "outline_thick",
    "outline_wide",
    "pen",
    "phong",
    "sobel",
    "toon",
    "toon_image",
    "watercolour",
    "wireframe",
];

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::Path;

    use super::*;

    /// A file that nobody embeds is in the folder, but not in the program.
    #[test]
    fn every_file_of_the_folder_is_embedded() {
        for (folder, embedded) in [("components", COMPONENTS), (".", TECHNIQUES)] {
            let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
            let paths = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
            let mut names: Vec<String> = paths
                .filter(|path| path.extension().is_some_and(|ending| ending == "toml"))
                .map(|path| path.file_stem().unwrap().to_string_lossy().into_owned())
                .filter(|name| name != "Cargo")
                .collect();
            names.sort();
            assert_eq!(names, embedded.iter().map(|(name, _)| *name).collect::<Vec<_>>());
        }
    }
}
