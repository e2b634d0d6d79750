//! Names of textures: `directory:image:filter` (NPRView thesis, section 2.2.2).
//!
//! - `toon_maps:two_steps:0`: an image, sampled at the nearest texel; without a filter, or
//!   with `:1`, images are filtered between texels and mip levels.
//! - `papers:*`: the first image of a directory, by name.
//! - `<generated>:scene_color`: a texture that a pass draws; sampled at the nearest texel,
//!   or filtered with `:1`.
//! - `paper.png`: a file, searched in the technique's folder first.
//! - `rough`: an image of the variable's directory.
//! - `none`: no texture.

use std::fmt;

/// The directory of textures that passes draw.
pub(crate) const GENERATED: &str = "<generated>";

/// The name of a texture.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct TextureName {
    /// The texture without its filter.
    pub(crate) source: TextureSource,
    /// Whether it is filtered between texels; none for the default of its kind.
    pub(crate) is_filtered: Option<bool>,
}

/// The kinds of textures.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(crate) enum TextureSource {
    /// No texture.
    None,
    /// A texture that a pass draws, by its name without `<generated>`.
    Generated(String),
    /// An image of a directory.
    Image {
        /// The directory; none for that of the variable.
        directory: Option<String>,
        /// The image without its ending, or `*` for the first one.
        image: String,
    },
    /// A file, by its path.
    File(String),
}

impl TextureName {
    /// No texture.
    pub(crate) const NONE: Self = Self { source: TextureSource::None, is_filtered: None };

    /// A texture that a pass draws.
    #[must_use]
    pub(crate) fn generated(name: impl Into<String>) -> Self {
        Self { source: TextureSource::Generated(name.into()), is_filtered: None }
    }

    /// Reads a name.
    ///
    /// # Errors
    /// The expected form, if the text does not have it.
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        let expected = || {
            "expected directory:image or directory:image:filter, where filter is 0 or 1".to_owned()
        };
        let text = text.trim();
        if matches!(text, "" | "none") {
            return Ok(Self::NONE);
        }
        let (name, is_filtered) = match text.rsplit_once(':') {
            Some((name, "0")) => (name, Some(false)),
            Some((name, "1")) => (name, Some(true)),
            _ => (text, None),
        };
        let is_file = [".png", ".jpg", ".jpeg"]
            .iter()
            .any(|ending| name.to_ascii_lowercase().ends_with(ending));
        let source = match name.split_once(':') {
            _ if is_file => TextureSource::File(name.to_owned()),
            Some((directory, image)) => {
                if directory.is_empty() || image.is_empty() || image.contains(':') {
                    return Err(expected());
                }
                match directory {
                    GENERATED => TextureSource::Generated(image.to_owned()),
                    _ => TextureSource::Image {
                        directory: Some(directory.to_owned()),
                        image: image.to_owned(),
                    },
                }
            }
            None => TextureSource::Image { directory: None, image: name.to_owned() },
        };
        Ok(Self { source, is_filtered })
    }

    /// Whether it is filtered between texels: by default images and files are, generated
    /// textures are not.
    #[must_use]
    pub(crate) const fn filters(&self) -> bool {
        match self.is_filtered {
            Some(is_filtered) => is_filtered,
            None => matches!(self.source, TextureSource::Image { .. } | TextureSource::File(_)),
        }
    }
}

impl fmt::Display for TextureName {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.source {
            TextureSource::None => formatter.write_str("none"),
            TextureSource::Generated(name) => write!(formatter, "{GENERATED}:{name}"),
            TextureSource::Image { directory: Some(directory), image } => {
                write!(formatter, "{directory}:{image}")
            }
            TextureSource::Image { directory: None, image } => formatter.write_str(image),
            TextureSource::File(path) => formatter.write_str(path),
        }?;
        match self.is_filtered {
            Some(is_filtered) => write!(formatter, ":{}", u8::from(is_filtered)),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_come_back_as_they_were_written() {
        for (text, filters) in [
            ("toon_maps:two_steps:0", false),
            ("papers:*", true),
            ("<generated>:scene_color", false),
            ("<generated>:scene_color:1", true),
            ("C:/pictures/paper.png", true),
            ("rough", true),
            ("none", false),
        ] {
            let name = TextureName::parse(text).unwrap();
            assert_eq!((name.to_string().as_str(), name.filters()), (text, filters));
        }
        assert_eq!(TextureName::parse("").unwrap(), TextureName::NONE);
        for text in ["a:b:c", ":b", "a:", "a::1", "a:b:2"] {
            assert!(TextureName::parse(text).is_err(), "{text}");
        }
    }
}
