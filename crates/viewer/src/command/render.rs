//! `viewer render`: models to pictures.

use std::fmt::Write as _;
use std::io::IsTerminal as _;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};

use clap::Args;
use edgemesh::command::{Failure, TerminalProgress, print_to_stdout, print_warnings, to_json};
use edgemesh::format::whole_file::{check_folder, write_file};
use edgemesh::load::LoadOptions;
use edgemesh::view::{Camera, FeatureCounts};
use image::RgbaImage;
use serde::Serialize;
use strokes::Gpu;

use super::failure::DIFFERS;
use super::warnings::warn;
use crate::arguments::PictureArguments;
use crate::error::Error;
use crate::picture::animation::AnimationKind;
use crate::picture::png::{DEFAULT_REFERENCE_THRESHOLD, as_stored, compare, encode_png, read_png};
use crate::picture::renderer::{Emptiness, FrameStatistics, PictureInput, PictureOptions};
use crate::picture::tiles::AnySizeRenderer;
use crate::picture::turntable;
use crate::scene::models::Scene;
use crate::scene::object_techniques::object_techniques;
use crate::scene::scene_file::{SceneObject, objects_of};
use crate::technique::Technique;
use crate::technique::library::Library;
use crate::watch::Watcher;

/// Renders models to a PNG, without a window
#[derive(Debug, Clone, Args)]
#[command(after_long_help = long_help(), after_help = EXAMPLES)]
pub(super) struct RenderCommand {
    /// Models (OBJ, PLY, STL, glTF, VRML, OFF, 3MF), edge meshes, or scene files (.toml); -
    /// is standard input
    #[arg(value_name = "MODEL", required = true)]
    models: Vec<PathBuf>,
    /// The picture to write (PNG), or - for standard output
    #[arg(short, long, value_name = "OUT.png")]
    output: PathBuf,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "1024x1024", value_parser = parse_size, allow_hyphen_values = true)]
    size: [u32; 2],
    #[command(flatten)]
    picture: PictureArguments,
    /// Turn the camera around the target in N steps and write numbered pictures, or one
    /// animation if OUT ends in .gif or .apng
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000), allow_hyphen_values = true)]
    turntable: Option<u32>,
    /// Keep running and draw again when the technique, a shader or an image changes; mistakes
    /// are reported and the last good picture stays
    #[arg(long, conflicts_with_all = ["turntable", "reference"])]
    watch: bool,
    /// Write counts and times as JSON to a file, or - for standard output
    #[arg(long, value_name = "FILE")]
    stats: Option<PathBuf>,
    /// Compare with this picture; if it differs, write the difference instead and exit with 5
    #[arg(long, value_name = "PNG", conflicts_with = "turntable")]
    reference: Option<PathBuf>,
    /// Share of pixels that may differ
    #[arg(long, value_name = "T", default_value_t = DEFAULT_REFERENCE_THRESHOLD, value_parser = parse_share, allow_hyphen_values = true)]
    reference_threshold: f64,
}

pub(super) const EXAMPLES: &str = "Examples:\n  \
    viewer render bunny.obj -o bunny.png\n  \
    viewer render bunny.obj -o bunny.png --technique pen --set strokes.width=4 --size 2048x1024\n  \
    viewer render part.obj -o part.png --technique hidden_line --set hidden.color=#c04000\n  \
    viewer render scene.toml -o scene.png --technique pen\n  \
    viewer render bunny.obj -o fur.png --technique fur --set contour.width=40\n  \
    viewer render bunny.obj -o bunny.png --technique linked --set strokes.wobble=3\n  \
    viewer render part.obj -o part.png --eye 3,2,5 --ortho --crease 20 --stats -\n  \
    viewer render bunny.obj -o bunny.png --technique mine.toml --watch\n  \
    viewer render part.obj -o turn.gif --turntable 72 --size 512x512";

fn long_help() -> String {
    let library = Library::shipped();
    let mut techniques = String::new();
    for name in library.technique_names() {
        let about = library.technique(name).map(|(technique, _)| technique.about);
        let _ = writeln!(techniques, "  {name:<18} {}", about.unwrap_or_default());
    }
    format!(
        "Techniques:\n{techniques}\nTheir passes: viewer techniques print NAME. The variables of a \
         pass: viewer components print COMPONENT.\n--set CLASS.VARIABLE=VALUE gives a line class \
         (contour, marked, boundary, material, smoothing, ridge, valley; hidden-ridge and so on for \
         hidden lines) a separate pass.\n\n{EXAMPLES}"
    )
}

/// The JSON of `--stats`; scripts rely on its keys.
#[derive(Debug, Serialize)]
struct Statistics {
    adapter: String,
    backend: String,
    size: [u32; 2],
    triangles: usize,
    edges: usize,
    /// None if vertex shaders detect, which count nothing.
    features: Option<FeatureCounts>,
    strokes: Option<u32>,
    passes: Vec<PassTime>,
    frame_ms: f64,
}

#[derive(Debug, Serialize)]
struct PassTime {
    name: String,
    gpu_ms: Option<f64>,
}

impl RenderCommand {
    pub(super) fn run(&self, is_quiet: bool) -> Result<(), Failure> {
        self.check_outputs()?;
        let library = self.picture.library.load();
        let technique = self.picture.technique(&library, &mut warn(is_quiet))?;
        let watcher = self.watch.then(|| self.watcher(&technique)).transpose()?;
        let reference = self.reference.as_deref().map(read_png).transpose()?;
        let objects = objects_of(&self.models).map_err(Error::from)?;
        let overrides = object_techniques(&objects, &library, &technique, &mut warn(is_quiet))?;
        let (gpu, scene) = self.open_and_load(&objects, is_quiet)?;
        if !is_quiet {
            for model in &scene.models {
                print_warnings(&model.name, &model.report);
            }
        }
        log::info!("drawing on {} ({})", gpu.info.name, gpu.info.backend);
        let camera = self.picture.camera.camera(&scene.bounds, &scene.frame)?;
        let options = self.options()?;
        let input = PictureInput { scene: &scene, technique: &technique, overrides: &overrides };
        let mut renderer = AnySizeRenderer::new(&gpu, input, &options)?;
        let statistics = match self.turntable {
            Some(steps) => self.write_turntable(&mut renderer, &camera, steps, is_quiet)?,
            None => self.write_picture(&mut renderer, &camera, reference.as_ref(), is_quiet)?,
        };
        self.write_statistics(&gpu, &scene, &statistics)?;
        let Some(mut watcher) = watcher else { return Ok(()) };
        loop {
            if watcher.wait(FOREVER) {
                let started = Instant::now();
                let drawn = self.draw_again(&mut renderer, &scene, &objects, &camera, is_quiet);
                match drawn {
                    Ok(()) if is_quiet => {}
                    Ok(()) => report_drawn(&self.output, started.elapsed()),
                    // The files may be half saved.
                    Err(failure) if watcher.settled() => report(&failure.message),
                    Err(_) => {}
                }
            }
        }
    }

    fn options(&self) -> Result<PictureOptions, Error> {
        Ok(self.picture.picture_options(self.size, self.picture.lighting.lighting()?))
    }

    /// Watches the folders of the technique.
    fn watcher(&self, technique: &Technique) -> Result<Watcher, Failure> {
        let mut folders = technique.folders.clone();
        folders.extend(self.picture.library.shaders.clone());
        folders.extend(self.picture.brush.iter().filter_map(|brush| {
            let path = Path::new(brush);
            path.is_file().then(|| path.parent().map_or_else(PathBuf::new, Path::to_owned))
        }));
        if folders.is_empty() {
            let message = "--watch: there are no files to watch; give a technique file, --folder or \
                           --shaders";
            return Err(Failure::usage(message));
        }
        Ok(Watcher::new(&folders, std::slice::from_ref(&self.output)).map_err(Error::from)?)
    }

    /// Reads the technique again and draws it.
    fn draw_again(
        &self,
        renderer: &mut AnySizeRenderer,
        scene: &Scene,
        objects: &[SceneObject],
        camera: &Camera,
        is_quiet: bool,
    ) -> Result<(), Failure> {
        let library = self.picture.library.load();
        let technique = self.picture.technique(&library, &mut warn(is_quiet))?;
        let overrides = &object_techniques(objects, &library, &technique, &mut warn(is_quiet))?;
        let input = PictureInput { scene, technique: &technique, overrides };
        renderer.reload(input, &self.options()?)?;
        self.write_picture(renderer, camera, None, is_quiet).map(drop)
    }

    /// Opens the device while the models are read, since both take time.
    fn open_and_load(
        &self,
        objects: &[SceneObject],
        is_quiet: bool,
    ) -> Result<(Gpu, Scene), Error> {
        thread::scope(|scope| {
            let opening =
                scope.spawn(|| pollster::block_on(Gpu::open(self.picture.adapter.as_deref())));
            let options = LoadOptions { with_instances: true, ..self.picture.input.load_options() };
            let scene = Scene::load(objects, &options, &TerminalProgress::new(is_quiet));
            let gpu = opening.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
            // Mistakes in a model are likelier and more useful than those of the adapter.
            let scene = scene?;
            Ok((gpu?, scene))
        })
    }

    /// Checks the options that would otherwise fail after all the work.
    fn check_outputs(&self) -> Result<(), Failure> {
        let is_stream = |path: &Path| path == Path::new("-");
        if !is_stream(&self.output) {
            self.check_ending()?;
            if self.models.contains(&self.output) {
                return Err(Failure::usage("--output is one of the models; give another file"));
            }
        } else if self.turntable.is_some() {
            return Err(Failure::usage("--turntable writes several files; --output cannot be -"));
        } else if self.stats.as_deref().is_some_and(is_stream) {
            return Err(Failure::usage("--output and --stats cannot both be -"));
        }
        let files = [Some(&self.output), self.stats.as_ref()];
        for file in files.into_iter().flatten().filter(|file| !is_stream(file)) {
            check_folder(file)?;
        }
        Ok(())
    }

    fn check_ending(&self) -> Result<(), Failure> {
        let is_png = self.output.extension().is_some_and(|end| end.eq_ignore_ascii_case("png"));
        let is_animation = AnimationKind::of(&self.output).is_some();
        let message = match (is_png || is_animation, self.turntable) {
            (true, Some(_)) => return Ok(()),
            (true, None) if is_png => return Ok(()),
            (_, None) => "must end in .png (.gif and .apng need --turntable)",
            (false, Some(_)) => "must end in .png, .gif or .apng",
        };
        Err(Failure::usage(format!("--output {}: {message}", self.output.display())))
    }

    fn write_picture(
        &self,
        renderer: &mut AnySizeRenderer,
        camera: &Camera,
        reference: Option<&RgbaImage>,
        is_quiet: bool,
    ) -> Result<FrameStatistics, Failure> {
        let (picture, statistics) = renderer.render(camera, &mut |done, total| {
            show_progress("tile", done, total);
            Ok(())
        })?;
        if let Some(reference) = reference {
            self.compare_with(&picture, reference)?;
        }
        if let Some(emptiness) = renderer.why_empty(&picture, camera) {
            warn_empty(&self.output, emptiness, is_quiet);
        }
        self.write_png(&self.output, &picture)?;
        Ok(statistics)
    }

    fn compare_with(&self, picture: &RgbaImage, reference: &RgbaImage) -> Result<(), Failure> {
        let stored = as_stored(picture, self.picture.transparent);
        let Some(difference) = compare(&stored, reference) else {
            let (width, height) = reference.dimensions();
            return Err(Failure::fault(format!(
                "the reference is {width}x{height} and the picture {}x{}; give --size {width}x{height}",
                self.size[0], self.size[1]
            )));
        };
        if difference.share <= self.reference_threshold {
            return Ok(());
        }
        self.write_png(&self.output, &difference.picture)?;
        let message = format!(
            "the picture differs from the reference in {} pixels, {:.4} % (allowed {:.4} %); the \
             difference is in {}",
            difference.wrong_pixels,
            difference.share * 100.0,
            self.reference_threshold * 100.0,
            self.output.display()
        );
        Err(Failure { message, status: DIFFERS })
    }

    fn write_turntable(
        &self,
        renderer: &mut AnySizeRenderer,
        camera: &Camera,
        steps: u32,
        is_quiet: bool,
    ) -> Result<FrameStatistics, Failure> {
        let mut last = None;
        turntable::write(&self.output, steps, self.size, self.picture.transparent, |step| {
            let camera = turntable::camera_at(camera, step, steps);
            let (picture, statistics) = renderer.render(&camera, &mut |_, _| Ok(()))?;
            if let Some(emptiness) = renderer.why_empty(&picture, &camera).filter(|_| step == 0) {
                warn_empty(&self.output, emptiness, is_quiet);
            }
            last = Some(statistics);
            show_progress("picture", step + 1, steps);
            Ok(picture)
        })?;
        last.ok_or_else(|| Failure::usage("--turntable needs at least one step"))
    }

    fn write_png(&self, path: &Path, picture: &RgbaImage) -> Result<(), Failure> {
        write_result(path, &encode_png(picture, self.picture.transparent)?)
    }

    fn write_statistics(
        &self,
        gpu: &Gpu,
        scene: &Scene,
        statistics: &FrameStatistics,
    ) -> Result<(), Failure> {
        let Some(path) = &self.stats else { return Ok(()) };
        let sum = |count: fn(&edgemesh::edge_mesh::MeshCounts) -> usize| {
            scene.objects.iter().map(|object| count(&scene.models[object.model].mesh.counts)).sum()
        };
        let passes = statistics.passes.iter();
        let statistics = Statistics {
            adapter: gpu.info.name.clone(),
            backend: gpu.info.backend.to_string(),
            size: self.size,
            triangles: sum(|counts| counts.triangles),
            edges: sum(|counts| counts.edges.edges),
            features: statistics.tally.map(|tally| tally.features()),
            strokes: statistics.tally.map(|tally| tally.stroke_count),
            passes: passes
                .map(|(name, gpu_ms)| PassTime { name: name.clone(), gpu_ms: *gpu_ms })
                .collect(),
            frame_ms: statistics.frame_ms,
        };
        write_result(path, to_json(&statistics)?.as_bytes())
    }
}

/// Waits are renewed after this long.
const FOREVER: Duration = Duration::from_secs(3600);

/// Reports an error while the command goes on.
#[expect(clippy::print_stderr, reason = "messages of a command")]
fn report(message: &str) {
    eprintln!("error: {message}");
}

/// Tells why a picture is of one color.
#[expect(clippy::print_stderr, reason = "messages of a command")]
fn warn_empty(path: &Path, emptiness: Emptiness, is_quiet: bool) {
    let hint = match emptiness {
        Emptiness::OutOfSight => "without --eye and --target the picture shows all of it",
        Emptiness::CutAway => "move or leave out --clip",
        Emptiness::NothingDrawn => "try another --technique, or an --eye farther away",
    };
    if !is_quiet {
        eprintln!("warning: {}: the picture is empty: {emptiness}; {hint}", path.display());
    }
}

/// Reports that a picture was written again.
#[expect(clippy::print_stderr, reason = "messages of a command")]
fn report_drawn(path: &Path, after: Duration) {
    eprintln!("{}: drawn again in {} ms", path.display(), after.as_millis());
}

/// Shows progress on a terminal.
#[expect(clippy::print_stderr, reason = "progress, on a terminal only")]
pub(super) fn show_progress(what: &str, done: u32, total: u32) {
    if std::io::stderr().is_terminal() {
        let end = if done == total { "\n" } else { "" };
        eprint!("\r{what} {done} of {total}{end}");
    }
}

/// Writes a file, or standard output for `-`.
fn write_result(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    if path == Path::new("-") {
        return print_to_stdout(bytes);
    }
    Ok(write_file(path, bytes)?)
}

pub(super) fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let side = |text: &str| text.trim().parse().ok().filter(|&side: &u32| side > 0);
    text.split_once(['x', 'X'])
        .and_then(|(width, height)| Some([side(width)?, side(height)?]))
        .ok_or_else(|| "needs width and height in pixels, such as 1920x1080".into())
}

fn parse_share(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|share| (0.0..=1.0).contains(share))
        .ok_or_else(|| "needs a share from 0 to 1".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_two_numbers() {
        assert_eq!(parse_size("1920x1080"), Ok([1920, 1080]));
        for text in ["1920", "0x10", "10x", "10x-1", "axb", "1x2x3"] {
            assert!(parse_size(text).is_err(), "{text}");
        }
    }
}
