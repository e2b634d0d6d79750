//! The images of Edgemesh, embedded: stroke textures, papers, tonal art maps, toon maps.
//!
//! All of them are made by `cargo xtask brushes`.
//!
//! ```
//! let pen = edgemesh_brushes::image("brushes", "pen").expect("the pen ships");
//! assert!(pen.png.starts_with(b"\x89PNG"));
//! ```

/// An image that ships.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct Image {
    /// The directory that techniques find it in: `brushes`, `papers`, `tonal_art_maps` or
    /// `toon_maps`.
    pub directory: &'static str,
    /// Its name there.
    pub name: &'static str,
    /// The PNG file.
    pub png: &'static [u8],
}

macro_rules! images {
    ($($directory:literal $name:literal $path:literal;)+) => {
        &[$(Image {
            directory: $directory,
            name: $name,
            png: include_bytes!(concat!("../", $path)),
        }),+]
    };
}

/// All images, directory by directory, by name.
pub const IMAGES: &[Image] = images! {
    "brushes" "charcoal" "charcoal.png";
    "brushes" "dash" "dash.png";
    "brushes" "fur" "fur.png";
    "brushes" "pen" "pen.png";
    "brushes" "watercolor" "watercolor.png";
    "papers" "canvas" "papers/canvas.png";
    "papers" "laid" "papers/laid.png";
    "papers" "rough" "papers/rough.png";
    "tonal_art_maps" "charcoal_123" "tonal_art_maps/charcoal_123.png";
    "tonal_art_maps" "charcoal_456" "tonal_art_maps/charcoal_456.png";
    "tonal_art_maps" "pen_123" "tonal_art_maps/pen_123.png";
    "tonal_art_maps" "pen_456" "tonal_art_maps/pen_456.png";
    "toon_maps" "gradient" "toon_maps/gradient.png";
    "toon_maps" "metallic" "toon_maps/metallic.png";
    "toon_maps" "spectrum" "toon_maps/spectrum.png";
    "toon_maps" "three_steps" "toon_maps/three_steps.png";
    "toon_maps" "two_steps" "toon_maps/two_steps.png";
};

/// The stroke textures: the images of the directory `brushes`.
pub const BRUSH_NAMES: [&str; 5] = ["pen", "charcoal", "watercolor", "fur", "dash"];

/// The image `name` of `directory`.
#[must_use]
pub fn image(directory: &str, name: &str) -> Option<&'static Image> {
    IMAGES.iter().find(|image| image.directory == directory && image.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_brush_has_its_name() {
        let brushes = IMAGES.iter().filter(|image| image.directory == "brushes");
        let mut names: Vec<&str> = brushes.map(|image| image.name).collect();
        let mut listed = BRUSH_NAMES.to_vec();
        names.sort_unstable();
        listed.sort_unstable();
        assert_eq!(names, listed);
    }
}
