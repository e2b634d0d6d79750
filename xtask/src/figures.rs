//! `cargo xtask figures FOLDER`: redraws figures of the papers as pictures and a page in
//! `docs/`.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::failure::Failure;
use crate::{adapter, programs};

/// Width and height of the pictures.
const SIZE: &str = "320x320";

/// A figure of a paper.
struct Figure {
    /// Prefix of the names of its pictures.
    name: &'static str,
    title: &'static str,
    /// What the figure shows.
    text: &'static str,
    panels: &'static [Panel],
}

/// A picture: its caption, its model, and the options of `viewer render`.
struct Panel(&'static str, &'static str, &'static str);

const CORRIDOR: &str = "docs/figures/corridor.obj";
const CORRIDOR_DEPTH: &str = "--eye 0.6,1.5,1.2 --target 0,0.6,-6 --technique outline_depth \
                              --set edges.unit=scene --set edges.threshold=";

const FIGURES: [Figure; 15] = [
    Figure {
        name: "thesis-3.2",
        title: "NPRView thesis, section 3.2: derivatives of a picture",
        text: "The gradient from the Sobel operator (Equations 3.1 to 3.3) is large at edges and \
               points across them; the Laplacian of the Gaussian (Equation 3.6) crosses zero \
               there. In a shaded picture both find light as well as shape. The detectors below \
               therefore read normals and depths.",
        panels: &[
            Panel(
                "gradient, above a threshold",
                "spot",
                "--technique docs/figures/derivatives.toml",
            ),
            Panel(
                "gradient magnitude",
                "spot",
                "--technique docs/figures/derivatives.toml --set gradient.show=intensities",
            ),
            Panel(
                "gradient orientation",
                "spot",
                "--technique docs/figures/derivatives.toml --set gradient.show=orientation",
            ),
            Panel(
                "zero crossings",
                "spot",
                "--technique docs/figures/derivatives.toml --set gradient.render=false --set crossings.render=true",
            ),
        ],
    },
    Figure {
        name: "thesis-3.9",
        title: "NPRView thesis, Figure 3.9: a contour that normals miss",
        text: "One plate lies in front of another, parallel one. Their normals are equal, so only \
               the depth separates them.",
        panels: &[
            Panel("light", "docs/figures/plates.obj", "--technique phong"),
            Panel("normals", "docs/figures/plates.obj", "--technique outline_normals"),
            Panel("depths", "docs/figures/plates.obj", "--technique outline_depth"),
        ],
    },
    Figure {
        name: "thesis-3.11",
        title: "NPRView thesis, Figure 3.11: thresholds of depth differences",
        text: "At a threshold of 0.3, the detector misses the outlines of low boxes; at 0.05, it \
               marks the whole floor and wall as edges, because they are seen at a grazing angle. \
               The Laplacian handles planes well but misses low boxes at the same threshold. The \
               distance from the plane through each pixel has neither fault.",
        panels: &[
            Panel("differences, 0.3", CORRIDOR, "0.3"),
            Panel("differences, 0.05", CORRIDOR, "0.05"),
            Panel(
                "Laplacian, 0.05",
                CORRIDOR,
                "--eye 0.6,1.5,1.2 --target 0,0.6,-6 --technique outline_laplacian --set edges.unit=scene --set edges.threshold=0.05",
            ),
            Panel(
                "planes",
                CORRIDOR,
                "--eye 0.6,1.5,1.2 --target 0,0.6,-6 --technique outline_planes",
            ),
        ],
    },
    Figure {
        name: "thesis-3.14",
        title: "NPRView thesis, Figure 3.14: a crease that depths miss",
        text: "The groove between the halves is narrower than a pixel: no depth sample falls into \
               it, and both depth detectors see a plane. The normals bend toward it from both \
               sides.",
        panels: &[
            Panel(
                "light",
                "docs/figures/groove.obj",
                "--eye 1,0.8,8 --target 0,0,0 --technique phong",
            ),
            Panel(
                "depth differences",
                "docs/figures/groove.obj",
                "--eye 1,0.8,8 --target 0,0,0 --technique outline_depth",
            ),
            Panel(
                "Laplacian of the depth",
                "docs/figures/groove.obj",
                "--eye 1,0.8,8 --target 0,0,0 --technique outline_laplacian",
            ),
            Panel(
                "normals",
                "docs/figures/groove.obj",
                "--eye 1,0.8,8 --target 0,0,0 --technique outline_normals",
            ),
        ],
    },
    Figure {
        name: "thesis-3.15",
        title: "NPRView thesis, Figure 3.15: smooth edges mistaken for creases",
        text: "Smooth normals hide the polygons of a model from the detector of normals. Depths do \
               not: with a low threshold, every edge of the mesh is found.",
        panels: &[
            Panel("normals", "spot", "--technique outline_normals"),
            Panel(
                "Laplacian of the depth, low threshold",
                "spot",
                "--technique outline_laplacian --set edges.threshold=0.001",
            ),
        ],
    },
    Figure {
        name: "thesis-3.16",
        title: "NPRView thesis, Figure 3.16: normals and depths compared",
        text: "Blue edges are found in normals, red ones in depths, black ones in both: each \
               detector finds what the other misses. With a lower depth threshold, the depth \
               detector finds more, but polygon edges that should be smooth show up.",
        panels: &[
            Panel("depths", "suzanne", "--technique debug_depth"),
            Panel("normals", "suzanne", "--technique debug_normals"),
            Panel("both", "suzanne", "--technique outline_combined --set edges.detect_ids=false"),
            Panel(
                "a lower depth threshold",
                "suzanne",
                "--technique outline_combined --set edges.detect_ids=false --set edges.depth_threshold=0.003",
            ),
        ],
    },
    Figure {
        name: "thesis-3.19",
        title: "NPRView thesis, Figure 3.19: the combined detector",
        text: "Edges found between regions only are green: here, the ring of another material \
               around a hole.",
        panels: &[
            Panel("light", "models/bracket.obj", "--technique phong"),
            Panel(
                "region ids of materials",
                "models/bracket.obj",
                "--technique debug_ids --set ids.regions=materials",
            ),
            Panel(
                "combined",
                "models/bracket.obj",
                "--technique outline_combined --set data.regions=materials",
            ),
        ],
    },
    Figure {
        name: "thesis-4.3",
        title: "NPRView thesis, Figure 4.3: toon maps per vertex and per pixel",
        text: "Per vertex, the borders of the steps follow the triangles of a coarse ball, and its \
               highlight, which lies between vertices, is missing. Per pixel, the borders are \
               round.",
        panels: &[
            Panel(
                "per vertex, three steps",
                "docs/figures/ball.obj",
                "--technique docs/figures/toon_map.toml --set by_vertex.render=true --set by_pixel.render=false --set by_vertex.toon_map=toon_maps:three_steps:0",
            ),
            Panel(
                "per pixel, three steps",
                "docs/figures/ball.obj",
                "--technique docs/figures/toon_map.toml --set by_pixel.toon_map=toon_maps:three_steps:0",
            ),
            Panel(
                "per vertex, spectrum",
                "docs/figures/ball.obj",
                "--technique docs/figures/toon_map.toml --set by_vertex.render=true --set by_pixel.render=false --set by_vertex.toon_map=toon_maps:spectrum:0",
            ),
            Panel(
                "per pixel, spectrum",
                "docs/figures/ball.obj",
                "--technique docs/figures/toon_map.toml --set by_pixel.toon_map=toon_maps:spectrum:0",
            ),
        ],
    },
    Figure {
        name: "thesis-4.4",
        title: "NPRView thesis, Figures 4.4 and 4.5: toon maps",
        text: "One model with five toon maps.",
        panels: &[
            Panel("two steps", "spot", "--technique toon"),
            Panel(
                "three steps",
                "spot",
                "--technique toon --set fill.toon_map=toon_maps:three_steps:0",
            ),
            Panel("gradient", "spot", "--technique toon --set fill.toon_map=toon_maps:gradient:0"),
            Panel("metallic", "spot", "--technique toon --set fill.toon_map=toon_maps:metallic:0"),
            Panel("spectrum", "spot", "--technique toon --set fill.toon_map=toon_maps:spectrum:0"),
        ],
    },
    Figure {
        name: "card-mitchell-1",
        title: "Card and Mitchell, Figure 1: light, fins, and filtered outlines",
        text: "Fins stand out from the contour. Filters also outline creases and occlusions.",
        panels: &[
            Panel("light", "spot", "--technique phong --set fill.clear_color=#ffffff"),
            Panel("fins", "spot", "--technique fins"),
            Panel("filtered outlines", "spot", "--technique docs/figures/five_taps.toml"),
        ],
    },
    Figure {
        name: "card-mitchell-4",
        title: "Card and Mitchell, Figure 4: cartoon light",
        text: "Bands of diffuse light and one of highlights, with outlines.",
        panels: &[
            Panel("default", "teapot", "--technique cartoon"),
            Panel("five bands of light", "teapot", "--technique cartoon --set fill.band_count=5"),
            Panel("no highlight", "teapot", "--technique cartoon --set fill.has_specular=false"),
        ],
    },
    Figure {
        name: "card-mitchell-9",
        title: "Card and Mitchell, Figure 9: edges in normals, in depths, and in both",
        text: "Normals show the creases of the lid and the joint between spout and body; depths \
               show where one part lies in front of another. Together they form an outline.",
        panels: &[
            Panel(
                "normals",
                "teapot",
                "--technique docs/figures/five_taps.toml --set depth.render=false",
            ),
            Panel(
                "depths",
                "teapot",
                "--technique docs/figures/five_taps.toml --set normals.threshold=-1",
            ),
            Panel("both", "teapot", "--technique docs/figures/five_taps.toml"),
        ],
    },
    Figure {
        name: "card-mitchell-thick",
        title: "Card and Mitchell, thickening outlines with morphology",
        text: "Lines two pixels wide, after one and four dilations, and equally wide lines from \
               jump flooding, whose ends and corners are round.",
        panels: &[
            Panel("as detected", "spot", "--technique outline_thick --set thicken.pass_count=0"),
            Panel("one dilation", "spot", "--technique outline_thick --set thicken.pass_count=1"),
            Panel("four dilations", "spot", "--technique outline_thick --set thicken.pass_count=4"),
            Panel("flooded, 10 pixels", "spot", "--technique outline_wide"),
        ],
    },
    Figure {
        name: "card-mitchell-clip",
        title: "Card and Mitchell: cut, self-intersecting and broken models",
        text: "Filters outline the cut of a clip plane, the line where the teapot's spout passes \
               through its body although no edge of the mesh lies there, and a soup of triangles \
               that share nothing.",
        panels: &[
            Panel("cut", "teapot", "--technique outline_planes --clip 0,0,-1,0.5"),
            Panel("spout through body", "teapot", "--technique outline_planes"),
            Panel(
                "a cut knot",
                "models/torus_knot.obj",
                "--technique outline_planes --clip 0,0,-1,0",
            ),
            Panel(
                "intersecting boxes with open sides",
                "docs/figures/soup.obj",
                "--technique outline_planes",
            ),
        ],
    },
    Figure {
        name: "chiang-5",
        title: "Chiang et al., Figure 5: the extra depth filter",
        text: "Without the filter, every bend of the surface in the normal map is an edge; with \
               it, only those with a change in depth. With the gradient as printed in the paper, \
               derivatives keep their signs, and edges from bright to dark are missed.",
        panels: &[
            Panel("with the filter", "stanford-bunny", "--technique sobel"),
            Panel(
                "without the filter",
                "stanford-bunny",
                "--technique sobel --set edges.extra_filter=false",
            ),
            Panel(
                "gradients as printed",
                "stanford-bunny",
                "--technique sobel --set edges.gradient=printed",
            ),
        ],
    },
];

/// Draws the figures; `models` is the folder with the models that are not part of this project.
pub(crate) fn run(models: &str) -> Result<(), Failure> {
    let programs = programs::build()?;
    adapter::ensure(&programs.viewer)?;
    let root = programs::workspace_root();
    let models = std::path::absolute(models)
        .map_err(|error| Failure::file("find", Path::new(models), error))?;
    for figure in &FIGURES {
        for (number, panel) in figure.panels.iter().enumerate() {
            let mut command = Command::new(&programs.viewer);
            command.current_dir(root).arg("-q").arg("render").arg(model(panel, &models));
            command.arg("-o").arg(root.join("docs").join(picture_name(figure, number)));
            command.args(["--size", SIZE]).args(options(panel));
            adapter::use_vulkan(&mut command)?;
            programs::run(&mut command)?;
        }
        println!("{}", figure.name);
    }
    let path = root.join("docs/figures.md");
    std::fs::write(&path, page()).map_err(|error| Failure::file("write", &path, error))
}

/// The file of a panel's model.
fn model(Panel(_, model, _): &Panel, models: &Path) -> PathBuf {
    match model.contains('/') {
        true => model.into(),
        false => models.join(format!("{model}.obj")),
    }
}

fn options(Panel(_, _, options): &Panel) -> Vec<String> {
    let whole = match options.starts_with("--") {
        true => (*options).to_owned(),
        false => format!("{CORRIDOR_DEPTH}{options}"),
    };
    whole.split_whitespace().map(str::to_owned).collect()
}

fn picture_name(figure: &Figure, number: usize) -> String {
    format!("figures/{}-{}.png", figure.name, number + 1)
}

fn page() -> String {
    let mut page =
        "# Figures of the papers\n\nRedrawn on other models than those of the papers.\n`cargo \
                    xtask figures FOLDER` draws the pictures and writes this page. Below each \
                    figure are the commands that draw its pictures.\n"
            .to_owned();
    for figure in &FIGURES {
        let _ = write!(page, "\n## {}\n\n{}\n\n|", figure.title, figure.text);
        for Panel(caption, ..) in figure.panels {
            let _ = write!(page, " {caption} |");
        }
        let _ = write!(page, "\n|{}\n|", "---|".repeat(figure.panels.len()));
        for (number, Panel(caption, ..)) in figure.panels.iter().enumerate() {
            let _ = write!(page, " ![{caption}]({}) |", picture_name(figure, number));
        }
        page.push_str("\n\n```sh\n");
        for (number, panel) in figure.panels.iter().enumerate() {
            let (model, number) = (model(panel, Path::new("")), number + 1);
            let options = options(panel).join(" ").replace("=#ffffff", "='#ffffff'");
            let _ = writeln!(page, "viewer render {} -o {number}.png {options}", model.display());
        }
        page.push_str("```\n");
    }
    page.push_str(
        "\nModels: Spot by Keenan Crane; Suzanne from Blender; the teapot by Martin Newell; the \
         bunny from the Stanford 3D Scanning Repository. The others are part of this project.\n",
    );
    page
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_is_what_the_figures_say_and_its_pictures_are_there() {
        let docs = programs::workspace_root().join("docs");
        assert_eq!(std::fs::read_to_string(docs.join("figures.md")).unwrap(), page());
        for figure in &FIGURES {
            for number in 0..figure.panels.len() {
                let picture = docs.join(picture_name(figure, number));
                assert!(picture.is_file(), "{} is missing", picture.display());
            }
        }
    }
}
