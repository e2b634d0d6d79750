//! A picture as the words of a command line of `viewer render`, written and read back.

use std::path::PathBuf;

use clap::Parser as _;
use edgemesh::arguments::CameraArguments;

use super::camera::camera_words;
use super::picture::PictureArguments;
use crate::error::Error;
use crate::scene::lighting::{Light, Lighting};
use crate::technique::value::color_text;

/// The parts of a picture that change in the window.
#[derive(Debug)]
pub(crate) struct PictureWords<'a> {
    /// The files.
    pub(crate) models: &'a [PathBuf],
    /// Name or file of the technique.
    pub(crate) technique: &'a str,
    /// Settings of the technique.
    pub(crate) settings: Vec<String>,
    /// Light and clip planes.
    pub(crate) lighting: &'a Lighting,
    /// Whether the background is transparent.
    pub(crate) is_transparent: bool,
    /// The camera, if it is known.
    pub(crate) camera: Option<CameraArguments>,
}

impl PictureWords<'_> {
    /// The words of the picture, with those of `arguments` that the window does not change.
    /// Size and output file are left out.
    pub(crate) fn words(&self, arguments: &PictureArguments) -> Vec<String> {
        let mut words: Vec<String> =
            self.models.iter().map(|model| model.display().to_string()).collect();
        words.extend(["--technique".to_owned(), self.technique.to_owned()]);
        for setting in &self.settings {
            words.extend(["--set".to_owned(), setting.clone()]);
        }
        words.extend(lighting_words(self.lighting));
        if self.is_transparent {
            words.push("--transparent".to_owned());
        }
        words.extend(self.camera.iter().flat_map(camera_words));
        words.extend(arguments.fixed_words());
        words
    }
}

/// The words of the options that differ from the default light, and of the planes.
fn lighting_words(lighting: &Lighting) -> Vec<String> {
    let default = Lighting::default();
    let mut words = Vec::new();
    let mut add = |name: &str, value: String| words.extend([name.to_owned(), value]);
    if lighting.light != default.light {
        add("--light", light_text(&lighting.light));
    }
    if lighting.color != default.color {
        add("--light-color", color_text(&lighting.color).unwrap_or_default());
    }
    for [x, y, z, d] in &lighting.clip_planes {
        add("--clip", format!("{x},{y},{z},{d}"));
    }
    words
}

/// A light in the form of `--light`.
fn light_text(light: &Light) -> String {
    let (kind, at) = match light {
        Light::Camera(direction) => ("", direction),
        Light::World(direction) => ("world:", direction),
        Light::Point(point) => ("point:", point),
    };
    format!("{kind}{},{},{}", at.x, at.y, at.z)
}

/// Reads files and arguments from words.
///
/// # Errors
/// [`Error::CommandLine`], if they are not the words of a picture.
pub(crate) fn read_words(words: &[String]) -> Result<(Vec<PathBuf>, PictureArguments), Error> {
    #[derive(clap::Parser)]
    #[command(no_binary_name = true)]
    struct Words {
        models: Vec<PathBuf>,
        #[command(flatten)]
        arguments: PictureArguments,
    }
    let read = Words::try_parse_from(words);
    let read = read.map_err(|error| Error::CommandLine(error.to_string().trim().to_owned()))?;
    Ok((read.models, read.arguments))
}

/// The command that draws the picture of `words` in a size in pixels.
pub(crate) fn render_command(words: Vec<String>, [width, height]: [u32; 2]) -> String {
    let size = format!("{width}x{height}");
    let ahead = ["viewer", "render"].map(str::to_owned).into_iter();
    let behind = ["--size", &size, "-o", "picture.png"].map(str::to_owned);
    shell_line(&ahead.chain(words).chain(behind).collect::<Vec<String>>())
}

/// Words quoted for a shell.
pub(crate) fn shell_line(words: &[String]) -> String {
    let is_plain = |word: &str| {
        let plain = |c: char| c.is_ascii_alphanumeric() || "-_./:,=+@%".contains(c);
        !word.is_empty() && word.chars().all(plain)
    };
    let quoted = |word: &String| match is_plain(word) {
        true => word.clone(),
        false => format!("'{}'", word.replace('\'', r"'\''")),
    };
    words.iter().map(quoted).collect::<Vec<String>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_shell_would_read_otherwise_is_quoted() {
        let words = ["a b.obj", "--set", "x.y=#fff", "it's", ""].map(str::to_owned);
        assert_eq!(shell_line(&words), r"'a b.obj' --set 'x.y=#fff' 'it'\''s' ''");
        let line = render_command(vec!["a.obj".into()], [640, 480]);
        assert_eq!(line, "viewer render a.obj --size 640x480 -o picture.png");
    }
}
