//! What several verbs take: where techniques come from, and the light.

use std::path::PathBuf;

use clap::Args;
use edgemesh::command::Failure;

use crate::picture::renderer::technique_failure;
use crate::scene::lighting::{Light, Lighting, parse_clip_plane, parse_light};
use crate::technique::Technique;
use crate::technique::library::Library;
use crate::technique::mistake::Mistakes;
use crate::technique::value::{VariableType, parse_color};

/// Where techniques, components, shaders and images come from.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Techniques")]
pub(crate) struct LibraryOptions {
    /// Your own folder with techniques, components, shaders and images
    /// [default: edgemesh in the folder for settings, as ~/.config/edgemesh]
    #[arg(long, value_name = "DIR", global = true)]
    pub(crate) folder: Option<PathBuf>,
    /// Take shaders from this copy of shaders/ instead of the shipped ones
    #[arg(long, value_name = "DIR", global = true)]
    pub(crate) shaders: Option<PathBuf>,
}

impl LibraryOptions {
    pub(crate) fn load(&self) -> Library {
        let folder = self.folder.clone().or_else(Library::default_folder);
        Library::load(folder.as_deref())
    }

    /// A technique by name or file; what was put right in it is told.
    pub(crate) fn technique(
        &self,
        library: &Library,
        name: &str,
        is_quiet: bool,
    ) -> Result<Technique, Failure> {
        let found = library.technique(name);
        let (technique, warnings) = found.map_err(|mistakes| technique_failure(&mistakes))?;
        print_mistakes(&warnings, is_quiet);
        Ok(technique)
    }
}

/// Sets a variable; what was put right is told.
pub(crate) fn set(
    technique: &mut Technique,
    assignment: &str,
    is_quiet: bool,
) -> Result<(), Failure> {
    let wrong = |what: String| Failure::usage(format!("--set {assignment}: {what}"));
    let warnings = technique.set(assignment).map_err(wrong)?;
    print_mistakes(&warnings, is_quiet);
    Ok(())
}

/// Tells mistakes on the standard error stream.
#[expect(clippy::print_stderr, reason = "messages of a command")]
pub(crate) fn print_mistakes(mistakes: &Mistakes, is_quiet: bool) {
    if !is_quiet && !mistakes.list.is_empty() {
        eprint!("{mistakes}");
    }
}

/// The light, and what cuts the scene.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Light")]
pub(crate) struct LightingOptions {
    /// Where the light comes from: a direction in the camera's space (right, up,
    /// toward the viewer), world:X,Y,Z, or point:X,Y,Z [default: -0.5,0.7,1]
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_light, allow_hyphen_values = true)]
    light: Option<Light>,
    /// The colour of the light
    #[arg(long, value_name = "#RRGGBB", default_value = "#ffffff", value_parser = parse_light_color)]
    light_color: LightColor,
    /// Cut away what lies behind a plane: X NX + Y NY + Z NZ + D < 0; repeatable
    #[arg(long, value_name = "NX,NY,NZ,D", value_parser = parse_plane, allow_hyphen_values = true)]
    clip: Vec<ClipPlane>,
}

/// A colour as an option has it.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct LightColor([f32; 3]);

/// A plane as an option has it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ClipPlane([f64; 4]);

impl LightingOptions {
    pub(crate) fn lighting(&self) -> Result<Lighting, Failure> {
        let most = strokes::view::frame::MAX_CLIP_PLANES;
        if self.clip.len() > most {
            return Err(Failure::usage(format!("--clip: there are at most {most} planes")));
        }
        let default = Lighting::default();
        Ok(Lighting {
            light: self.light.unwrap_or(default.light),
            color: self.light_color.0,
            clip_planes: self.clip.iter().map(|plane| plane.0).collect(),
        })
    }
}

fn parse_light_color(text: &str) -> Result<LightColor, String> {
    let color = parse_color(text, VariableType::Rgb).and_then(|color| color.try_into().ok());
    color.map(LightColor).ok_or_else(|| "needs a colour as #rrggbb".to_owned())
}

fn parse_plane(text: &str) -> Result<ClipPlane, String> {
    parse_clip_plane(text).map(ClipPlane)
}

/// The default direction, as the help text has it.
#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    #[test]
    fn the_default_light_is_the_one_that_the_help_names() {
        let named = parse_light("-0.5,0.7,1").unwrap();
        assert_eq!(named, Lighting::default().light);
        assert_eq!(named, Light::Camera(DVec3::new(-0.5, 0.7, 1.0)));
    }
}
