//! Light and clip planes.

use edgemesh::edge_mesh::{Bounds, MeshFrame};
use edgemesh::view::View;
use glam::{DVec3, Vec3};
use strokes::{MAX_CLIP_PLANES, Surroundings};

/// A white light source.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Light {
    /// A direction in camera space: right, up, toward the viewer.
    Camera(DVec3),
    /// A direction in world space.
    World(DVec3),
    /// A point, in units of the files.
    Point(DVec3),
}

/// Light and clip planes.
#[derive(Debug, Clone, PartialEq)]
pub struct Lighting {
    /// The light.
    pub light: Light,
    /// Color of the light: red, green, blue, 0 to 1.
    pub color: [f32; 3],
    /// Planes (n, d): points with n . p + d < 0 for any plane are cut away. In units of the
    /// files.
    pub clip_planes: Vec<[f64; 4]>,
}

impl Default for Lighting {
    /// From the upper left, as in technical drawing.
    fn default() -> Self {
        let light = Light::Camera(DVec3::new(-0.5, 0.7, 1.0));
        Self { light, color: [1.0; 3], clip_planes: Vec::new() }
    }
}

impl Lighting {
    /// Light and clip planes for shaders, in a view of a scene with `bounds` in `frame`.
    #[must_use]
    pub fn surroundings(&self, view: &View, bounds: &Bounds, frame: &MeshFrame) -> Surroundings {
        let axis = |row: usize| view.clip_from_world.row(row).truncate().normalize_or_zero();
        let toward_viewer = -view.distance.truncate();
        let direction = |direction: Vec3| direction.normalize_or(Vec3::Z).extend(0.0).to_array();
        let light = match self.light {
            Light::Camera(given) => {
                let given = given.as_vec3();
                direction(given.x * axis(0) + given.y * axis(1) + given.z * toward_viewer)
            }
            Light::World(given) => direction(given.as_vec3()),
            Light::Point(point) => frame.to_mesh(point).as_vec3().extend(1.0).to_array(),
        };
        let plane = |&[x, y, z, d]: &[f64; 4]| {
            let normal = DVec3::new(x, y, z);
            // A point p of the mesh is at p / scale + origin in the file.
            let offset = frame.scale * (normal.dot(frame.origin) + d);
            normal.extend(offset).as_vec4().to_array()
        };
        #[expect(clippy::cast_possible_truncation, reason = "as the shader has it")]
        let radius = bounds.radius() as f32;
        Surroundings {
            light,
            light_color: self.color,
            scene_center: bounds.center().as_vec3().to_array(),
            scene_radius: radius,
            clip_planes: self.clip_planes.iter().take(MAX_CLIP_PLANES).map(plane).collect(),
        }
    }
}

/// Reads `X,Y,Z` (camera space), `world:X,Y,Z` or `point:X,Y,Z`.
///
/// # Errors
/// The expected form.
pub(crate) fn parse_light(text: &str) -> Result<Light, String> {
    let (kind, numbers) = text.split_once(':').unwrap_or(("camera", text));
    let what = || {
        "needs three numbers as X,Y,Z (right, up, toward the viewer), world:X,Y,Z or point:X,Y,Z"
            .to_owned()
    };
    let [x, y, z] = numbers_of(numbers).ok_or_else(what)?;
    let vector = DVec3::new(x, y, z);
    match kind {
        "point" => Ok(Light::Point(vector)),
        _ if vector == DVec3::ZERO => Err("a direction must not be 0,0,0".into()),
        "camera" => Ok(Light::Camera(vector)),
        "world" => Ok(Light::World(vector)),
        _ => Err(what()),
    }
}

/// Reads `NX,NY,NZ,D`.
///
/// # Errors
/// The expected form.
pub(crate) fn parse_clip_plane(text: &str) -> Result<[f64; 4], String> {
    let what = || "needs four numbers as NX,NY,NZ,D".to_owned();
    let plane: [f64; 4] = numbers_of(text).ok_or_else(what)?;
    if plane[..3] == [0.0; 3] {
        return Err("the normal of a plane must not be 0,0,0".into());
    }
    Ok(plane)
}

fn numbers_of<const N: usize>(text: &str) -> Option<[f64; N]> {
    let numbers: Option<Vec<f64>> = text
        .split(',')
        .map(|number| number.trim().parse().ok().filter(|number: &f64| number.is_finite()))
        .collect();
    numbers?.try_into().ok()
}

#[cfg(test)]
mod tests {
    use edgemesh::view::Camera;

    use super::*;

    #[test]
    fn lights_and_planes_are_read() {
        assert_eq!(parse_light("0,1,0").unwrap(), Light::Camera(DVec3::Y));
        assert_eq!(parse_light("world:1,0,0").unwrap(), Light::World(DVec3::X));
        assert_eq!(parse_light("point:0,0,0").unwrap(), Light::Point(DVec3::ZERO));
        for text in ["0,0,0", "1,2", "sun:1,2,3", "1,nan,2", ""] {
            assert!(parse_light(text).is_err(), "{text}");
        }
        assert_eq!(parse_clip_plane("0,1,0,-0.5").unwrap(), [0.0, 1.0, 0.0, -0.5]);
        assert!(parse_clip_plane("0,0,0,1").is_err() && parse_clip_plane("1,2,3").is_err());
    }

    #[test]
    fn a_light_of_the_camera_turns_with_it_and_planes_keep_their_place() {
        let bounds = Bounds { min: [-1.0; 3], max: [1.0; 3] };
        let camera = Camera { eye: DVec3::X * 9.0, ..Camera::default_view(&bounds) };
        let view = camera.view(&bounds, 1.0);
        let frame = MeshFrame { origin: DVec3::new(100.0, 0.0, 0.0), scale: 0.5 };
        let clip_planes = vec![[1.0, 0.0, 0.0, -101.0]];
        let lighting =
            Lighting { light: Light::Camera(DVec3::Z), clip_planes, ..Lighting::default() };
        let around = lighting.surroundings(&view, &bounds, &frame);
        assert!(Vec3::from_slice(&around.light[..3]).distance(Vec3::X) < 1e-6);
        // x = 101 in the file is x = 0.5 in the mesh.
        assert_eq!(around.clip_planes, [[1.0, 0.0, 0.0, -0.5]]);
    }
}
