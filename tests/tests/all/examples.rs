//! The examples of the crates do what their heads say.

use std::fs;
use std::process::Command;

use testkit::locate::{example, workspace_root};

/// Runs an example on a model of the project, and returns its standard output.
fn run(name: &str, model: &str, more: &[&str]) -> String {
    let model = workspace_root().join("models").join(model);
    let output = Command::new(example(name)).arg(model).args(more).output().unwrap();
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{name}: {stderr}");
    String::from_utf8(output.stdout).unwrap()
}

/// A cube seen from a corner shows nine of its twelve edges: six of its outline, three within.
#[test]
fn edges_of_a_view_prints_the_edges_of_a_cube() {
    let printed = run("edges_of_a_view", "cube.obj", &[]);
    let count = |class: &str| printed.lines().filter(|line| line.starts_with(class)).count();
    assert_eq!((count("contour "), count("ridge ")), (6, 3), "{printed}");
}

#[test]
fn mesh_to_png_is_short() {
    let text = fs::read_to_string(workspace_root().join("crates/strokes/examples/mesh_to_png.rs"));
    let Ok(text) = text else { return eprintln!("left out the example: no source") };
    assert!(text.lines().count() <= 40, "{} lines", text.lines().count());
}

#[cfg(feature = "gpu")]
mod on_the_gpu {
    use std::collections::BTreeMap;

    use image::{Rgba, RgbaImage};

    use super::run;

    /// Runs an example that draws a picture.
    fn picture(name: &str, model: &str) -> RgbaImage {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("picture.png");
        run(name, model, &[out.to_str().unwrap()]);
        image::open(&out).unwrap().into_rgba8()
    }

    fn count(picture: &RgbaImage, color: [u8; 3]) -> usize {
        let [red, green, blue] = color;
        picture.pixels().filter(|pixel| **pixel == Rgba([red, green, blue, 255])).count()
    }

    #[test]
    fn mesh_to_png_draws_black_lines_on_white() {
        let picture = picture("mesh_to_png", "bracket.obj");
        assert_eq!(picture.dimensions(), (1024, 1024));
        let (ink, paper) = (count(&picture, [0, 0, 0]), count(&picture, [255, 255, 255]));
        assert!((4_000..40_000).contains(&ink), "{ink} black pixels");
        assert!(ink + paper > 1_000_000, "{paper} white pixels, and few others");
    }

    /// The lines are there, the program's background and surface too, and lines behind the
    /// surface are hidden: of a cube's edges nine are seen, so its middle is all surface.
    #[test]
    fn embed_in_wgpu_draws_over_the_scene_of_the_program() {
        let picture = picture("embed_in_wgpu", "cube.obj");
        assert_eq!(picture.dimensions(), (1024, 768));
        let ink = count(&picture, [0, 0, 0]);
        let sky = count(&picture, picture.get_pixel(0, 0).0[..3].try_into().unwrap());
        let surface = picture.pixels().filter(|pixel| pixel.0[0] > pixel.0[2]).count();
        assert!((2_000..20_000).contains(&ink), "{ink} black pixels");
        assert!(sky > 100_000 && surface > 100_000, "sky {sky}, surface {surface}");
        assert!(sky + surface + ink > 760_000, "nothing else");
        // The three faces have a color each; a hidden edge would cross one of them.
        let mut shades: BTreeMap<[u8; 4], usize> = BTreeMap::new();
        for pixel in picture.pixels() {
            *shades.entry(pixel.0).or_default() += 1;
        }
        let large = shades.values().filter(|count| **count > 10_000).count();
        assert_eq!(large, 4, "three faces and the sky: {shades:?}");
    }
}
