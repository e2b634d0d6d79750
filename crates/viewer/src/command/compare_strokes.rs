//! `viewer compare-strokes`: measures brushes in each parameterization along camera paths.

use std::path::{Path, PathBuf};

use clap::Args;
use edgemesh::arguments::InputArguments;
use edgemesh::command::{Failure, TerminalProgress, print_warnings};
use edgemesh::format::whole_file::write_file;
use edgemesh::line::{LineClass, Parameterization};
use edgemesh::load::LoadedMesh;
use edgemesh::view::Camera;
use edgemesh_brushes::BRUSH_NAMES;
use glam::Vec2;
use image::{Rgba, RgbaImage, imageops};
use strokes::{Brush, Gpu, GraphReadback};

use super::render::{parse_size, show_progress};
use crate::comparison::measure::Sums;
use crate::comparison::page::{Row, Sheet, csv, html};
use crate::comparison::samples::{FrameLines, FrameSource};
use crate::comparison::{CameraPath, Way};
use crate::error::Error;
use crate::picture::png::encode_png;
use crate::picture::renderer::{PictureInput, PictureOptions, PictureRenderer};
use crate::scene::models::Scene;
use crate::scene::scene_file::SceneObject;
use crate::technique::brush_file::shipped_brush;
use crate::technique::library::Library;

const EXAMPLES: &str = "Examples:\n  \
    viewer compare-strokes bunny.obj -o comparison\n  \
    viewer compare-strokes bunny.obj teapot.obj -o comparison --frames 90 --width 10\n  \
    viewer compare-strokes bunny.obj -o turn --path turntable --brush pen --frames 360";

/// Measures and compares how brushes lie along strokes, in three parameterizations
///
/// Writes strokes.csv, a sheet of pictures per model and brush, and index.html with all
/// results to a folder.
#[derive(Debug, Clone, Args)]
#[command(after_help = EXAMPLES)]
pub(super) struct CompareStrokesCommand {
    /// Models, each compared by itself
    #[arg(value_name = "MODEL", required = true)]
    models: Vec<PathBuf>,
    /// Folder for the results; created if it is missing
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Only this camera path; repeatable [default: all]
    #[arg(long, value_name = "PATH", value_parser = parse_path)]
    path: Vec<CameraPath>,
    /// Only this brush; repeatable [default: all]
    #[arg(long, value_name = "BRUSH", value_parser = BRUSH_NAMES)]
    brush: Vec<String>,
    /// Frames of each camera path
    #[arg(long, value_name = "N", default_value = "12", value_parser = clap::value_parser!(u32).range(2..=3600), allow_hyphen_values = true)]
    frames: u32,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "640x640", value_parser = parse_size, allow_hyphen_values = true)]
    size: [u32; 2],
    /// Width of the strokes in pixels
    #[arg(long, value_name = "PX", default_value = "6", value_parser = parse_width, allow_hyphen_values = true)]
    width: f32,
    /// Use the adapter whose name contains this text [default: the best]
    #[arg(long, value_name = "NAME")]
    adapter: Option<String>,
    #[command(flatten)]
    input: InputArguments,
}

fn parse_path(text: &str) -> Result<CameraPath, String> {
    let names = CameraPath::ALL.map(CameraPath::name).join(", ");
    let found = CameraPath::ALL.into_iter().find(|path| path.name() == text);
    found.ok_or_else(|| format!("needs one of {names}"))
}

fn parse_width(text: &str) -> Result<f32, String> {
    let width: Option<f32> = text.parse().ok().filter(|width| (0.5..=100.0).contains(width));
    width.ok_or_else(|| "needs a number of pixels from 0.5 to 100".to_owned())
}

/// One brush on one model, in all parameterizations.
struct Comparison<'a> {
    command: &'a CompareStrokesCommand,
    model: &'a LoadedMesh,
    brush: String,
    brush_aspect: f32,
    /// In the order of [`Way::ALL`].
    renderers: [PictureRenderer; 3],
}

impl CompareStrokesCommand {
    pub(super) fn run(&self, is_quiet: bool) -> Result<(), Failure> {
        let objects: Vec<SceneObject> =
            self.models.iter().map(|path| SceneObject::plain(path)).collect();
        let gpu = pollster::block_on(Gpu::open(self.adapter.as_deref()));
        let mut scenes = Vec::new();
        let (options, progress) = (self.input.load_options(), TerminalProgress::new(is_quiet));
        for object in &objects {
            scenes.push(Scene::load(std::slice::from_ref(object), &options, &progress)?);
        }
        let gpu = gpu.map_err(Error::from)?;
        std::fs::create_dir_all(&self.output).map_err(|error| {
            Failure::fault(format!("{}: cannot be created: {error}", self.output.display()))
        })?;
        let (mut rows, mut sheets) = (Vec::new(), Vec::new());
        let mut done = 0;
        let is_wanted =
            |brush: &&str| self.brush.is_empty() || self.brush.iter().any(|b| b == brush);
        let brushes: Vec<&str> = BRUSH_NAMES.into_iter().filter(is_wanted).collect();
        let paths = if self.path.is_empty() { &CameraPath::ALL[..] } else { &self.path };
        let all = brushes.len() * paths.len() * scenes.len();
        for scene in &scenes {
            for model in scene.models.iter().filter(|_| !is_quiet) {
                print_warnings(&model.name, &model.report);
            }
            for &brush in &brushes {
                let mut comparison = self.comparison(&gpu, scene, brush)?;
                for &path in paths {
                    rows.extend(comparison.measure(scene, path)?);
                    done += 1;
                    show_progress("picture", done, u32::try_from(all).unwrap_or(u32::MAX));
                }
                let sheet = comparison.sheet(scene)?;
                let name = format!("{}-{brush}.png", file_stem(&comparison.model.name));
                write_file(&self.output.join(name), &sheet.png)?;
                sheets.push(sheet);
            }
        }
        write_file(&self.output.join("strokes.csv"), csv(&rows).as_bytes())?;
        let page = html(&gpu.info.name, &rows, &sheets);
        Ok(write_file(&self.output.join("index.html"), page.as_bytes())?)
    }

    fn comparison<'a>(
        &'a self,
        gpu: &'a Gpu,
        scene: &'a Scene,
        brush: &str,
    ) -> Result<Comparison<'a>, Error> {
        let library = Library::shipped();
        let renderer = |way: Way| {
            let mut technique = library.technique("ink")?.0;
            let width = format!("strokes.width={}", self.width);
            for setting in [&format!("strokes.brush={brush}"), &width] {
                technique.set(setting)?;
            }
            for setting in way.settings() {
                technique.set(setting)?;
            }
            if way == Way::Chained {
                // Each class has its own layer, in order: different seeds make styles differ.
                for (seed, class) in LineClass::ALL.into_iter().enumerate() {
                    technique.set(&format!("{}.seed={seed}", class.name()))?;
                }
            }
            let options = PictureOptions { size: self.size, ..PictureOptions::default() };
            PictureRenderer::new(gpu, PictureInput::new(scene, &technique), &options)
        };
        let [object_space, screen_space, chained] = Way::ALL.map(renderer);
        let texture = shipped_brush(brush).transpose().ok().flatten();
        Ok(Comparison {
            command: self,
            model: &scene.models[0],
            brush: brush.to_owned(),
            brush_aspect: texture.as_ref().map_or(1.0, Brush::aspect),
            renderers: [object_space?, screen_space?, chained?],
        })
    }
}

impl Comparison<'_> {
    fn viewport_px(&self) -> Vec2 {
        #[expect(clippy::cast_precision_loss, reason = "picture sizes are small")]
        Vec2::from(self.command.size.map(|side| side as f32))
    }

    /// The lines of a frame in all parameterizations.
    fn lines(&self, scene: &Scene, camera: &Camera, graph: &GraphReadback) -> [FrameLines; 3] {
        let viewport_px = self.viewport_px();
        let view = camera.view(&scene.bounds, f64::from(viewport_px.x / viewport_px.y));
        let source = FrameSource {
            mesh: &self.model.mesh,
            view: &view,
            viewport_px,
            width_px: self.command.width,
            brush_aspect: self.brush_aspect,
            graph,
        };
        [
            source.edge_by_edge(Parameterization::ObjectSpace),
            source.edge_by_edge(Parameterization::ScreenSpace),
            source.chained(),
        ]
    }

    /// Measures the frames of one camera path.
    fn measure(&mut self, scene: &Scene, path: CameraPath) -> Result<Vec<Row>, Error> {
        let texture_px = self.command.width * self.brush_aspect;
        let mut sums = [[Sums::default(); 3]; LineClass::ALL.len()];
        let mut times = [Vec::new(), Vec::new(), Vec::new()];
        let mut before: Option<[FrameLines; 3]> = None;
        for frame in 0..self.command.frames {
            let camera = path.camera(&scene.bounds, frame);
            for (renderer, times) in self.renderers.iter_mut().zip(&mut times) {
                times.push(renderer.render(&camera)?.1.frame_ms);
            }
            let Some(graph) = self.renderers[2].read_graph(0)? else { continue };
            let lines = self.lines(scene, &camera, &graph);
            for (layer, sums) in sums.iter_mut().enumerate() {
                for (way, (sums, lines)) in sums.iter_mut().zip(&lines).enumerate() {
                    sums.add_frame(lines, layer, texture_px);
                    if let Some(before) = &before {
                        sums.add_step(&before[way], lines, layer, texture_px);
                    }
                }
            }
            before = Some(lines);
        }
        let row = |class: LineClass, way: usize, sums: Sums| Row {
            model: self.model.name.clone(),
            path: path.name(),
            class: class.name(),
            brush: self.brush.clone(),
            way: Way::ALL[way],
            sums,
            frame_ms: median(&times[way]),
        };
        let rows = LineClass::ALL.into_iter().zip(sums).flat_map(|(class, sums)| {
            sums.into_iter().enumerate().map(move |(way, sums)| (class, way, sums))
        });
        Ok(rows
            .filter(|(_, _, sums)| sums.length_px > 0.0)
            .map(|(class, way, sums)| row(class, way, sums))
            .collect())
    }

    /// The default view in all parameterizations, whole and at 400 percent.
    fn sheet(&mut self, scene: &Scene) -> Result<Sheet, Error> {
        let camera = Camera::default_view(&scene.bounds);
        let [width, height] = self.command.size;
        let mut sheet = RgbaImage::from_pixel(3 * width, 2 * height, Rgba([255; 4]));
        let mut middle = None;
        for (column, renderer) in (0..).zip(&mut self.renderers) {
            let picture = renderer.render(&camera)?.0;
            let [x, y] = *middle.get_or_insert_with(|| inky_corner(&picture));
            let part = imageops::crop_imm(&picture, x, y, width / 4, height / 4).to_image();
            let large = imageops::resize(&part, width, height, imageops::FilterType::Nearest);
            imageops::replace(&mut sheet, &picture, i64::from(column * width), 0);
            imageops::replace(&mut sheet, &large, i64::from(column * width), i64::from(height));
        }
        let title = format!(
            "{}, {}: object-space, screen-space, chained; below at 400 %",
            self.model.name, self.brush
        );
        Ok(Sheet { title, png: encode_png(&sheet, false)? })
    }
}

/// The corner of the sixteenth of a picture with the most ink.
fn inky_corner(picture: &RgbaImage) -> [u32; 2] {
    let (width, height) = (picture.width() / 4, picture.height() / 4);
    let ink = |x: u32, y: u32| -> u64 {
        let part = imageops::crop_imm(picture, x, y, width, height).to_image();
        part.pixels().map(|pixel| u64::from(255 - pixel.0[1])).sum()
    };
    let corners = (0..=6_u32).flat_map(|y| (0..=6_u32).map(move |x| [x, y]));
    let places = corners.map(|[x, y]| [x * width / 2, y * height / 2]);
    places.max_by_key(|&[x, y]| ink(x, y)).unwrap_or_default()
}

fn median(times: &[f64]) -> f64 {
    let mut times = times.to_vec();
    times.sort_by(f64::total_cmp);
    times.get(times.len() / 2).copied().unwrap_or_default()
}

/// A model's name as part of a file name.
fn file_stem(name: &str) -> String {
    let stem = Path::new(name).file_stem().map(|stem| stem.to_string_lossy().into_owned());
    stem.unwrap_or_else(|| "model".into())
}
