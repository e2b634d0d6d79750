//! What a picture is made of, as command lines say it: for `render` and the window alike.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use edgemesh::command::Failure;
use edgemesh::command::input::InputOptions;
use edgemesh::command::options::CameraOptions;
use edgemesh_brushes::BRUSH_NAMES;
use strokes::mesh::layout::Layout;
use strokes::render::pipelines::DetectionStage;

use super::options::{LibraryOptions, LightingOptions, set};
use crate::picture::renderer::PictureOptions;
use crate::scene::scene_file::{SceneObject, is_scene_file, read_scene_file};
use crate::technique::Technique;
use crate::technique::library::Library;

/// Everything that makes a picture but the models and its size.
#[derive(Debug, Clone, Args)]
pub struct PictureArguments {
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
    pub(crate) library: LibraryOptions,
    #[command(flatten)]
    pub(crate) lighting: LightingOptions,
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
    pub(crate) camera: CameraOptions,
    #[command(flatten)]
    pub(crate) input: InputOptions,
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
    /// The files, and the technique as they and the options have it.
    pub(super) fn technique(&self, is_quiet: bool) -> Result<(Library, Technique), Failure> {
        let library = self.library.load();
        let mut technique = self.library.technique(&library, &self.technique, is_quiet)?;
        self.change(&mut technique, is_quiet)?;
        Ok((library, technique))
    }

    /// Changes a technique as the options say.
    pub(crate) fn change(&self, technique: &mut Technique, is_quiet: bool) -> Result<(), Failure> {
        match self.brush.as_deref() {
            None => {}
            Some(name) if name == "none" || BRUSH_NAMES.contains(&name) => {
                set(technique, &format!("strokes.brush={name}"), is_quiet)?;
            }
            Some(path) => {
                if !Path::new(path).is_file() {
                    let names = BRUSH_NAMES.join(", ");
                    return Err(Failure::fault(format!(
                        "--brush {path}: there is no such file; a brush is a PNG file, or one of \
                         none, {names}"
                    )));
                }
                technique.set_brush_file(path).map_err(Failure::usage)?;
            }
        }
        for assignment in &self.set {
            set(technique, assignment, is_quiet)?;
        }
        Ok(())
    }

    /// How a scene is drawn at a size in pixels.
    pub(crate) fn picture_options(&self, size: [u32; 2]) -> Result<PictureOptions, Failure> {
        Ok(PictureOptions {
            size,
            samples: if self.samples == "1" { 1 } else { 4 },
            layout: self.layout.into(),
            stage: self.detection.into(),
            is_transparent: self.transparent,
            lighting: self.lighting.lighting()?,
            shaders: self.library.shaders.clone(),
        })
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

    /// The technique of each object: its own or `default`, and what it sets; empty where
    /// no object has anything of its own.
    pub(crate) fn object_techniques(
        &self,
        objects: &[SceneObject],
        library: &Library,
        default: &Technique,
        is_quiet: bool,
    ) -> Result<Vec<Technique>, Failure> {
        let of_object = |object: &SceneObject| {
            let mut technique = match &object.technique {
                Some(name) => self.library.technique(library, name, is_quiet)?,
                None => default.clone(),
            };
            for setting in &object.settings {
                set(&mut technique, setting, is_quiet).map_err(|failure| Failure {
                    message: format!("{}: {}", object.model.display(), failure.message),
                    ..failure
                })?;
            }
            Ok(technique)
        };
        if objects.iter().all(|object| object.technique.is_none() && object.settings.is_empty()) {
            return Ok(Vec::new());
        }
        objects.iter().map(of_object).collect()
    }
}

/// The objects of all models and scene files, in order.
pub fn objects_of(models: &[PathBuf]) -> Result<Vec<SceneObject>, Failure> {
    let mut objects = Vec::new();
    for path in models {
        if is_scene_file(path) {
            objects.extend(read_scene_file(path)?);
        } else {
            objects.push(SceneObject::plain(path));
        }
    }
    Ok(objects)
}
