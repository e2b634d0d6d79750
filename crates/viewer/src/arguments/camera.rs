//! The camera as words of a command line, written and read back.

use clap::Parser as _;
use edgemesh::arguments::CameraArguments;
use glam::DVec3;

use crate::error::Error;

/// The words of the camera options that are given.
pub(crate) fn camera_words(camera: &CameraArguments) -> Vec<String> {
    let vector = |v: DVec3| format!("{},{},{}", v.x, v.y, v.z);
    let mut words = Vec::new();
    for (name, value) in [
        ("--eye", camera.eye.map(vector)),
        ("--target", camera.target.map(vector)),
        ("--up", camera.up.map(vector)),
        ("--fov", camera.fov.map(|fov| fov.to_string())),
    ] {
        words.extend(value.into_iter().flat_map(|value| [name.to_owned(), value]));
    }
    if camera.ortho {
        words.push("--ortho".to_owned());
    }
    words
}

/// Reads the camera options in a text, such as a copied command; other words are ignored.
///
/// # Errors
/// [`Error::CommandLine`], if there are none or one is wrong.
pub(crate) fn read_camera(text: &str) -> Result<CameraArguments, Error> {
    #[derive(clap::Parser)]
    #[command(no_binary_name = true, disable_help_flag = true)]
    struct Words {
        #[command(flatten)]
        camera: CameraArguments,
    }
    let words = words_in(text);
    if words.is_empty() {
        let what = "there are no camera options, such as --eye 3,2,5 --target 0,0,0";
        return Err(Error::CommandLine(what.into()));
    }
    let read = Words::try_parse_from(words);
    Ok(read.map_err(|error| Error::CommandLine(error.to_string()))?.camera)
}

/// The words of a text that are camera options with their values.
fn words_in(text: &str) -> Vec<String> {
    let mut words = text.split_whitespace();
    let mut found = Vec::new();
    while let Some(word) = words.next() {
        let name = word.split_once('=').map_or(word, |(name, _)| name);
        match name {
            "--ortho" => found.push(word.to_owned()),
            "--eye" | "--target" | "--up" | "--fov" => {
                found.push(word.to_owned());
                if name == word {
                    found.extend(words.next().map(|value| value.trim_matches('\'').to_owned()));
                }
            }
            _ => {}
        }
    }
    found
}
