//! Everything that makes a picture but the models and its size.

use std::path::Path;

use clap::{Args, ValueEnum};
use edgemesh::arguments::{CameraArguments, InputArguments};
use edgemesh_brushes::BRUSH_NAMES;
use strokes::{DetectionStage, Layout};

use super::library::LibraryArguments;
use super::lighting::LightingArguments;
use crate::error::Error;
use crate::picture::renderer::PictureOptions;
use crate::scene::lighting::Lighting;
use crate::technique::Technique;
use crate::technique::library::Library;
use crate::technique::mistake::Mistakes;

/// Everything that makes a picture but the models and its size.
#[derive(Debug, Clone, Args)]
pub(crate) struct PictureArguments {
    /// How it looks: a technique by its name, or a file that describes one; see
    /// viewer techniques list
    #[arg(long, value_name = "NAME|FILE", default_value = "ink")]
    pub(crate) technique: String,
    /// Set a variable of the technique; repeatable
    #[arg(long, value_name = "PASS.VARIABLE=VALUE")]
    pub(crate) set: Vec<String>,
    /// The brush of all visible strokes: a PNG file, or pen, charcoal, watercolor,
    /// fur, dash, none
    #[arg(long, value_name = "FILE")]
    pub(crate) brush: Option<String>,
    #[command(flatten)]
    pub(crate) library: LibraryArguments,
    #[command(flatten)]
    pub(crate) lighting: LightingArguments,
    /// How the edges lie in memory; the replicated layouts are the paper's
    #[arg(long, value_name = "LAYOUT", default_value = "indexed")]
    layout: LayoutName,
    /// Where features are detected; in the vertex shader is the paper's way
    #[arg(long, value_name = "PATH", default_value = "compute")]
    detection: PathName,
    /// Samples a pixel
    #[arg(long, value_name = "N", default_value = "4", value_parser = ["1", "4"])]
    samples: String,
    /// The adapter whose name contains this [default: the best]
    #[arg(long, value_name = "NAME")]
    pub(crate) adapter: Option<String>,
    /// No paper behind the model
    #[arg(long)]
    pub(crate) transparent: bool,
    #[command(flatten)]
    pub(crate) camera: CameraArguments,
    #[command(flatten)]
    pub(crate) input: InputArguments,
}

/// The layouts by name.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum LayoutName {
    /// 20 bytes an edge, everything else shared with the faces
    Indexed,
    /// Four vertices an edge, in 32-bit floats
    ReplicatedF32,
    /// Four vertices an edge, at 16 bits
    ReplicatedI16,
    /// Card and Mitchell's fins, with face normals: contours and boundaries only
    FaceNormals,
}

impl From<LayoutName> for Layout {
    fn from(name: LayoutName) -> Self {
        match name {
            LayoutName::Indexed => Self::Indexed,
            LayoutName::ReplicatedF32 => Self::Replicated,
            LayoutName::ReplicatedI16 => Self::Replicated16,
            LayoutName::FaceNormals => Self::FaceNormals,
        }
    }
}

/// The detection paths by name.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum PathName {
    /// In compute shaders, which list the edges to draw
    Compute,
    /// In the vertex shader, through which every edge goes
    Vertex,
}

impl From<PathName> for DetectionStage {
    fn from(name: PathName) -> Self {
        match name {
            PathName::Compute => Self::Compute,
            PathName::Vertex => Self::Vertex,
        }
    }
}

impl PictureArguments {
    /// The technique with what the arguments change in it. `warn` receives what was put
    /// right.
    ///
    /// # Errors
    /// [`Error::Technique`], and as [`Self::change`].
    pub(crate) fn technique(
        &self,
        library: &Library,
        warn: &mut dyn FnMut(&Mistakes),
    ) -> Result<Technique, Error> {
        let (mut technique, warnings) = library.technique(&self.technique)?;
        warn(&warnings);
        self.change(&mut technique, warn)?;
        Ok(technique)
    }

    /// Changes a technique as the arguments say. `warn` receives what was put right.
    ///
    /// # Errors
    /// [`Error::Setting`] for what does not fit, [`Error::NoSuchBrush`].
    pub(crate) fn change(
        &self,
        technique: &mut Technique,
        warn: &mut dyn FnMut(&Mistakes),
    ) -> Result<(), Error> {
        match self.brush.as_deref() {
            None => {}
            Some(name) if name == "none" || BRUSH_NAMES.contains(&name) => {
                warn(&technique.set(&format!("strokes.brush={name}"))?);
            }
            Some(path) if Path::new(path).is_file() => technique.set_brush_file(path)?,
            Some(path) => return Err(Error::NoSuchBrush { path: path.to_owned() }),
        }
        for assignment in &self.set {
            warn(&technique.set(assignment)?);
        }
        Ok(())
    }

    /// How a scene is drawn in a light, at a size in pixels.
    pub(crate) fn picture_options(&self, size: [u32; 2], lighting: Lighting) -> PictureOptions {
        PictureOptions {
            size,
            samples: if self.samples == "1" { 1 } else { 4 },
            layout: self.layout.into(),
            stage: self.detection.into(),
            is_transparent: self.transparent,
            lighting,
            shaders: self.library.shaders.clone(),
        }
    }

    /// The arguments that the window does not change, as a command line has them: how
    /// models are read and how edges lie in memory. Folders and the adapter are those of
    /// a machine, not of a picture.
    pub(crate) fn fixed_words(&self) -> Vec<String> {
        let mut words = Vec::new();
        let mut add = |name: &str, value: Option<String>| {
            words.extend(value.into_iter().flat_map(|value| [name.to_owned(), value]));
        };
        let name_of = |value: Option<clap::builder::PossibleValue>| {
            value.map(|value| value.get_name().to_owned())
        };
        let is_usual = matches!(self.layout, LayoutName::Indexed);
        add("--layout", name_of(self.layout.to_possible_value()).filter(|_| !is_usual));
        let is_usual = matches!(self.detection, PathName::Compute);
        add("--detection", name_of(self.detection.to_possible_value()).filter(|_| !is_usual));
        add("--samples", Some(self.samples.clone()).filter(|samples| samples != "4"));
        let input = &self.input;
        let format = input.format.and_then(|format| format.to_possible_value());
        add("--format", name_of(format));
        let number = |number: Option<f64>| number.map(|number| number.to_string());
        add("--weld", number(input.weld));
        add("--marks", input.marks.as_ref().map(|path| path.display().to_string()));
        add("--crease", number(input.creases.crease));
        add("--ridge", number(input.creases.ridge));
        add("--valley", number(input.creases.valley));
        for (name, is_given) in [("--no-weld", input.no_weld), ("--strict", input.strict)] {
            words.extend(is_given.then(|| name.to_owned()));
        }
        words
    }
}
