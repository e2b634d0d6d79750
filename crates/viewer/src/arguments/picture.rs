//! Arguments of a picture, except the models and the size.

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

/// Arguments of a picture, except the models and the size.
#[derive(Debug, Clone, Args)]
pub(crate) struct PictureArguments {
    /// Name of a technique, or a technique file; viewer techniques list shows all names
    #[arg(long, value_name = "NAME|FILE", default_value = "ink")]
    pub(crate) technique: String,
    /// Set a variable of the technique; repeatable
    #[arg(long, value_name = "PASS.VARIABLE=VALUE")]
    pub(crate) set: Vec<String>,
    /// Brush of all visible strokes: a PNG file, or pen, charcoal, watercolor, fur, dash,
    /// none
    #[arg(long, value_name = "FILE")]
    pub(crate) brush: Option<String>,
    #[command(flatten)]
    pub(crate) library: LibraryArguments,
    #[command(flatten)]
    pub(crate) lighting: LightingArguments,
    /// Memory layout of the edges; the replicated layouts are the paper's
    #[arg(long, value_name = "LAYOUT", default_value = "indexed")]
    layout: LayoutName,
    /// Shader stage that detects features; vertex is the paper's way
    #[arg(long, value_name = "PATH", default_value = "compute")]
    detection: PathName,
    /// Samples per pixel
    #[arg(long, value_name = "N", default_value = "4", value_parser = ["1", "4"], allow_hyphen_values = true)]
    samples: String,
    /// Use the adapter whose name contains this text [default: the best]
    #[arg(long, value_name = "NAME")]
    pub(crate) adapter: Option<String>,
    /// Make the background transparent
    #[arg(long)]
    pub(crate) transparent: bool,
    #[command(flatten)]
    pub(crate) camera: CameraArguments,
    #[command(flatten)]
    pub(crate) input: InputArguments,
}

/// Names of the layouts.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum LayoutName {
    /// 20 bytes per edge; shares everything else with the faces
    Indexed,
    /// Four vertices per edge, with 32-bit floats
    ReplicatedF32,
    /// Four vertices per edge, with 16-bit integers
    ReplicatedI16,
    /// Fins with face normals (Card and Mitchell); contours and boundaries only
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

/// Names of the detection stages.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum PathName {
    /// Compute shaders, which list the edges to draw
    Compute,
    /// The vertex shader, which processes every edge
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
    /// The technique with the changes of the arguments. `warn` receives warnings.
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

    /// Changes a technique by the arguments. `warn` receives warnings.
    ///
    /// # Errors
    /// [`Error::Setting`], [`Error::NoSuchBrush`].
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

    /// Options of a picture with a light and a size in pixels.
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

    /// The words of the arguments that the window does not change: how models are read, and
    /// the layout. Folders and the adapter are left out, since they belong to the machine.
    #[cfg(feature = "window")]
    pub(super) fn fixed_words(&self) -> Vec<String> {
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
