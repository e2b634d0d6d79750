//! Options of the light and the clip planes.

use clap::Args;
use strokes::MAX_CLIP_PLANES;

use crate::error::Error;
use crate::scene::lighting::{Light, Lighting, parse_clip_plane, parse_light};
use crate::technique::value::{VariableType, parse_color};

/// Options of the light and the clip planes.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Light")]
pub(crate) struct LightingArguments {
    /// Direction or place of the light: X,Y,Z in camera space (right, up, toward the viewer),
    /// world:X,Y,Z or point:X,Y,Z [default: -0.5,0.7,1]
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_light, allow_hyphen_values = true)]
    light: Option<Light>,
    /// Color of the light
    #[arg(long, value_name = "#RRGGBB", default_value = "#ffffff", value_parser = parse_light_color)]
    light_color: LightColor,
    /// Cut away everything behind a plane, where X NX + Y NY + Z NZ + D < 0; repeatable
    #[arg(long, value_name = "NX,NY,NZ,D", value_parser = parse_plane, allow_hyphen_values = true)]
    clip: Vec<ClipPlane>,
}

/// A color, as clap reads it.
#[derive(Debug, Clone, Copy, Default)]
struct LightColor([f32; 3]);

/// A plane, as clap reads it.
#[derive(Debug, Clone, Copy)]
struct ClipPlane([f64; 4]);

impl LightingArguments {
    /// # Errors
    /// [`Error::TooManyClipPlanes`].
    pub(crate) fn lighting(&self) -> Result<Lighting, Error> {
        if self.clip.len() > MAX_CLIP_PLANES {
            return Err(Error::TooManyClipPlanes);
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
    color.map(LightColor).ok_or_else(|| "needs a color as #rrggbb".to_owned())
}

fn parse_plane(text: &str) -> Result<ClipPlane, String> {
    parse_clip_plane(text).map(ClipPlane)
}

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
