//! The plan of a technique: everything that its passes need, checked before anything
//! is run.
//!
//! ```text
//!   Technique --+                       +--> passes: programs, what they read and write
//!   ShaderFiles +--> plan (no GPU) -----+--> textures: sizes and formats
//!   images -----+                       '--> or mistakes, all at once
//! ```
//!
//! A pass reads what an earlier one wrote in the same frame. What a pass reads and
//! writes itself it works on in place: it sees what was there before, in the first
//! frame nothing. Textures stay from frame to frame.

use std::path::PathBuf;

use edgemesh::line::class::LineClass;

use super::class_pass::{ALL_CLASSES, classes_of};
use super::core::CoreComponent;
use super::curve::parse_curve;
use super::mistake::{Mistake, Mistakes, Place};
use super::pass::Pass;
use super::program::{Output, Program, ProgramKind, ShaderFiles, TextureKind};
use super::texture_format::{
    DEPTH_FORMAT, FORMATS, TextureSize, format_of, is_blendable, is_filterable, kind_of,
};
use super::texture_name::{TextureName, TextureSource};
use super::{Technique, image_file, plan_params};

/// A technique with everything checked.
#[derive(Debug, Clone, Default)]
pub struct Plan {
    /// One a pass of the technique.
    pub passes: Vec<PassPlan>,
    /// The textures that passes write.
    pub textures: Vec<TexturePlan>,
}

/// What a pass needs.
#[derive(Debug, Clone)]
pub struct PassPlan {
    /// Where it draws.
    pub target: Target,
    /// The program that places vertices, where the component has one.
    pub vertex: Option<Program>,
    /// The program that colours fragments, where the component has one.
    pub fragment: Option<Program>,
    /// The program that colours what is behind the scene.
    pub background: Option<Program>,
    /// What it reads, by the names of its texture variables.
    pub reads: Vec<Read>,
    /// Whether it reads a texture that it writes.
    pub is_in_place: bool,
}

/// Where a pass draws.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Target {
    /// The picture itself.
    Framebuffer,
    /// Textures, by their numbers in the plan.
    Textures {
        /// By location.
        colors: Vec<usize>,
        /// The depth, where the pass writes it.
        depth: Option<usize>,
    },
}

/// A texture that a pass reads.
#[derive(Debug, Clone, PartialEq)]
pub struct Read {
    /// The variable.
    pub variable: String,
    /// What it is.
    pub source: ReadSource,
    /// Whether it is sampled between its texels.
    pub is_filtered: bool,
}

/// What a pass reads.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ReadSource {
    /// Nothing: one white texel.
    None,
    /// A texture of the plan.
    Generated(usize),
    /// An image.
    Image(image_file::ImageFile),
}

/// A texture that passes write.
#[derive(Debug, Clone, PartialEq)]
pub struct TexturePlan {
    /// Its name, without the directory.
    pub name: String,
    /// Its size.
    pub size: TextureSize,
    /// Its format.
    pub format: wgpu::TextureFormat,
    /// Where it was asked for first.
    pub place: Place,
}

impl Plan {
    /// Checks a technique and makes its plan.
    ///
    /// # Errors
    /// All mistakes, in the technique and in its shaders.
    pub fn of(technique: &Technique, shaders: &ShaderFiles) -> Result<Self, Mistakes> {
        let mut planner = Planner {
            shaders,
            folders: &technique.folders,
            plan: Self::default(),
            mistakes: Mistakes::default(),
        };
        // Programs first: what a pass writes depends on what its program returns.
        let programs: Vec<Programs> =
            technique.passes.iter().map(|pass| planner.programs(pass)).collect();
        let targets: Vec<Target> = technique
            .passes
            .iter()
            .zip(&programs)
            .map(|(pass, programs)| planner.target(pass, programs))
            .collect();
        let writes: Vec<Vec<usize>> = targets.iter().map(Target::textures).collect();
        for (at, pass) in technique.passes.iter().enumerate() {
            let reads = planner.reads(technique, at, &writes);
            let [vertex, fragment, background] = programs[at].clone();
            plan_params::check(pass, vertex.as_ref(), fragment.as_ref(), &mut planner.mistakes);
            if let Some(background) = &background {
                plan_params::check_used(pass, background, &mut planner.mistakes);
            }
            for program in [&vertex, &fragment, &background].into_iter().flatten() {
                planner.check_textures(pass, program, &reads);
            }
            let is_in_place = reads.iter().any(|read| match read.source {
                ReadSource::Generated(texture) => writes[at].contains(&texture),
                _ => false,
            });
            planner.check_strokes(pass);
            let target = targets[at].clone();
            planner.check_blend(pass, &target, is_in_place);
            let pass = PassPlan { target, vertex, fragment, background, reads, is_in_place };
            planner.plan.passes.push(pass);
        }
        let Planner { plan, mistakes, .. } = planner;
        mistakes.or(plan).map(|(plan, _)| plan)
    }
}

/// The programs of a pass: vertex, fragment, background.
type Programs = [Option<Program>; 3];

impl Target {
    /// The textures that are written.
    #[must_use]
    pub fn textures(&self) -> Vec<usize> {
        match self {
            Self::Framebuffer => Vec::new(),
            Self::Textures { colors, depth } => colors.iter().copied().chain(*depth).collect(),
        }
    }
}

struct Planner<'a> {
    shaders: &'a ShaderFiles,
    folders: &'a [PathBuf],
    plan: Plan,
    mistakes: Mistakes,
}

impl Planner<'_> {
    fn programs(&mut self, pass: &Pass) -> Programs {
        let variables = [
            ("vertex_program", ProgramKind::Vertex),
            ("fragment_program", ProgramKind::Fragment),
            ("background_program", ProgramKind::Fragment),
        ];
        variables.map(|(variable, kind)| {
            let name = pass.string(variable);
            if name.is_empty() {
                return None;
            }
            match self.shaders.program(name, kind, pass.place_of(variable)) {
                Ok(program) => Some(program),
                Err(mistakes) => {
                    self.mistakes.append(mistakes);
                    None
                }
            }
        })
    }

    /// Where a pass draws; the textures that it writes are added to the plan.
    fn target(&mut self, pass: &Pass, [_, fragment, _]: &Programs) -> Target {
        let core = pass.component.core;
        let size = TextureSize {
            sides: [pass.int("render_target_width"), pass.int("render_target_height")],
            scale: pass.number("render_target_scale"),
        };
        match core {
            CoreComponent::CopyToTexture | CoreComponent::GenerateTexture => {
                let name = pass.string("texture").to_owned();
                let is_depth = pass.bool("depth");
                let (format, size) = match core {
                    CoreComponent::GenerateTexture => (self.formats(pass, 1)[0], size),
                    _ if is_depth => (DEPTH_FORMAT, TextureSize::PICTURE),
                    _ => (strokes::gpu::target_formats::COLOR_FORMAT, TextureSize::PICTURE),
                };
                let texture = self.texture(pass, "texture", name, size, format);
                match is_depth {
                    true => Target::Textures { colors: Vec::new(), depth: Some(texture) },
                    false => Target::Textures { colors: vec![texture], depth: None },
                }
            }
            _ if pass.string("render_target").is_empty() => Target::Framebuffer,
            _ => {
                let outputs = fragment.as_ref().map(|program| program.interface.outputs.clone());
                self.render_targets(pass, size, &outputs.unwrap_or_default())
            }
        }
    }

    fn render_targets(&mut self, pass: &Pass, size: TextureSize, outputs: &[Output]) -> Target {
        let name = pass.string("render_target").to_owned();
        let formats = self.formats(pass, outputs.len().max(1));
        let mut colors = Vec::new();
        for (at, format) in formats.iter().enumerate() {
            let suffix = match outputs.get(at) {
                Some(output) if output.location > 0 => output.name.as_str(),
                _ => "color",
            };
            if let Some(output) = outputs.get(at)
                && output.kind != kind_of(*format)
            {
                let message = format!(
                    "'{}' of the fragment program does not fit the format {}",
                    output.name,
                    super::texture_format::word_of(*format)
                );
                let place = pass.place_of("render_target_format");
                self.mistakes.add(Mistake::error(place, message));
            }
            let name = format!("{name}_{suffix}");
            colors.push(self.texture(pass, "render_target", name, size, *format));
        }
        self.check_cost(pass, &formats);
        let depth = (pass.component.core == CoreComponent::SimpleRender).then(|| {
            self.texture(pass, "render_target", format!("{name}_depth"), size, DEPTH_FORMAT)
        });
        Target::Textures { colors, depth }
    }

    /// What every adapter can write at once for a pixel.
    fn check_cost(&mut self, pass: &Pass, formats: &[wgpu::TextureFormat]) {
        let limits = wgpu::Limits::default();
        let cost: u32 = formats.iter().filter_map(|format| format.target_pixel_byte_cost()).sum();
        let most = limits.max_color_attachment_bytes_per_sample;
        if cost > most {
            let message = format!("the outputs take {cost} bytes a pixel, adapters have {most}");
            let note = "give some of them smaller formats, as rgba16f or rgba8 (8 bytes each)";
            let place = pass.place_of("render_target_format");
            self.mistakes.add(Mistake::error(place, message).note(note));
        }
    }

    /// The formats of `count` outputs: the last one stands for those behind it.
    fn formats(&mut self, pass: &Pass, count: usize) -> Vec<wgpu::TextureFormat> {
        let text = pass.string("render_target_format");
        let mut formats = Vec::new();
        for word in text.split(',').map(str::trim) {
            let format = format_of(word);
            if format.is_none() {
                let place = pass.place_of("render_target_format");
                let mistake = Mistake::error(place, format!("there is no format '{word}'"));
                self.mistakes.add(mistake.names(word, FORMATS.map(|(word, _)| word)));
            }
            formats.push(format.unwrap_or(strokes::gpu::target_formats::COLOR_FORMAT));
        }
        let last = formats.last().copied().unwrap_or(strokes::gpu::target_formats::COLOR_FORMAT);
        formats.resize(count, last);
        formats
    }

    /// The number of a texture of the plan, which is added where it is new.
    fn texture(
        &mut self,
        pass: &Pass,
        variable: &str,
        name: String,
        size: TextureSize,
        format: wgpu::TextureFormat,
    ) -> usize {
        let place = pass.place_of(variable).clone();
        let target = pass.string(variable);
        if !super::component_file::is_name(target) {
            let message = format!("'{target}' cannot be the name of a render target");
            let note = "names are letters, digits and _";
            self.mistakes.add(Mistake::error(&place, message).note(note));
        }
        if size.scale <= 0.0 {
            let place = pass.place_of("render_target_scale");
            let message = format!("a texture of size {} is nothing", size.scale);
            self.mistakes.add(Mistake::error(place, message));
        }
        if let Some(known) = self.plan.textures.iter().position(|known| known.name == name) {
            let first = &self.plan.textures[known];
            if first.size != size || first.format != format {
                let message = format!("two passes write '{target}' in different sizes or formats");
                self.mistakes.add(Mistake::error(&place, message).also(&first.place, "here"));
            }
            return known;
        }
        self.plan.textures.push(TexturePlan { name, size, format, place });
        self.plan.textures.len() - 1
    }

    /// What pass number `at` reads.
    fn reads(&mut self, technique: &Technique, at: usize, writes: &[Vec<usize>]) -> Vec<Read> {
        let pass = &technique.passes[at];
        let mut reads = Vec::new();
        for (index, variable) in pass.component.textures() {
            let super::value::Value::Texture(name) = &pass.values()[index] else { continue };
            let place = pass.place_of(&variable.name);
            let source = match &name.source {
                TextureSource::None => ReadSource::None,
                TextureSource::Generated(generated) => {
                    match self.generated(technique, at, writes, generated, place) {
                        Some(texture) => ReadSource::Generated(texture),
                        None => continue,
                    }
                }
                _ => match image_file::find(name, self.folders, place) {
                    Ok(image) => ReadSource::Image(image),
                    Err(mistake) => {
                        self.mistakes.add(mistake);
                        continue;
                    }
                },
            };
            let is_filtered = name.filters();
            if let ReadSource::Generated(texture) = source {
                self.check_filter(name, texture, place);
            }
            reads.push(Read { variable: variable.name.clone(), source, is_filtered });
        }
        reads
    }

    fn check_filter(&mut self, name: &TextureName, texture: usize, place: &Place) {
        let texture = &self.plan.textures[texture];
        if name.filters() && !is_filterable(texture.format) {
            let word = super::texture_format::word_of(texture.format);
            let message = format!("'{}' cannot be filtered: its format is {word}", texture.name);
            let note = "leave the :1 out, or give its pass another render_target_format";
            self.mistakes.add(Mistake::error(place, message).note(note));
        }
    }

    /// A generated texture that pass number `at` reads.
    fn generated(
        &mut self,
        technique: &Technique,
        at: usize,
        writes: &[Vec<usize>],
        name: &str,
        place: &Place,
    ) -> Option<usize> {
        let Some(texture) = self.plan.textures.iter().position(|known| known.name == name) else {
            let names: Vec<&str> =
                self.plan.textures.iter().map(|texture| texture.name.as_str()).collect();
            let mistake = Mistake::error(place, format!("no pass writes the texture '{name}'"));
            let mistake = mistake.names(name, names);
            self.mistakes.add(mistake);
            return None;
        };
        let is_written = writes[..=at].iter().any(|written| written.contains(&texture));
        if !is_written {
            let later = writes.iter().position(|written| written.contains(&texture));
            let later = later.map(|pass| &technique.passes[pass]);
            let message = format!("'{name}' is read before it is written");
            let mut mistake = Mistake::error(place, message);
            if let Some(later) = later {
                mistake = mistake.also(&later.place, format!("'{}' writes it", later.name));
            }
            self.mistakes.add(mistake.note("put the pass that writes it above this one"));
        }
        Some(texture)
    }

    /// The textures that a program wants must be variables, of the right kind.
    fn check_textures(&mut self, pass: &Pass, program: &Program, reads: &[Read]) {
        for slot in &program.interface.textures {
            let is_variable = pass.component.textures().any(|(_, known)| known.name == slot.name);
            if !is_variable {
                let message = format!(
                    "the program wants a texture '{}', which {} has not",
                    slot.name, pass.component.name
                );
                let names: Vec<&str> =
                    pass.component.textures().map(|(_, known)| known.name.as_str()).collect();
                let place = pass.place_of("fragment_program");
                self.mistakes.add(Mistake::error(place, message).names(&slot.name, names));
                continue;
            }
            let Some(read) = reads.iter().find(|read| read.variable == slot.name) else { continue };
            let fits = match (&read.source, slot.kind) {
                (ReadSource::Generated(texture), kind) => {
                    let format = self.plan.textures[*texture].format;
                    match kind {
                        TextureKind::Depth => format == DEPTH_FORMAT,
                        TextureKind::Uint => format == wgpu::TextureFormat::R32Uint,
                        TextureKind::Float => format != wgpu::TextureFormat::R32Uint,
                    }
                }
                (_, kind) => kind == TextureKind::Float,
            };
            if !fits {
                let wanted = match slot.kind {
                    TextureKind::Depth => "a depth texture",
                    TextureKind::Uint => "whole numbers",
                    TextureKind::Float => "colours",
                };
                let message = format!("'{}' needs {wanted}", slot.name);
                let place = pass.place_of(&slot.name);
                let note = "a pass with render_target = \"x\" writes <generated>:x_color and \
                            <generated>:x_depth";
                self.mistakes.add(Mistake::error(place, message).note(note));
            }
        }
    }

    /// Texts of strokes that have a form of their own.
    fn check_strokes(&mut self, pass: &Pass) {
        if pass.component.core != CoreComponent::Strokes {
            return;
        }
        if let Err(word) = classes_of(pass.string("classes")) {
            let message = format!("there is no class '{word}'");
            let classes = LineClass::ALL.map(LineClass::name).into_iter().chain([ALL_CLASSES]);
            let mistake = Mistake::error(pass.place_of("classes"), message);
            self.mistakes.add(mistake.names(&word, classes));
        }
        for (variable, most) in [("width_curve", 10.0), ("opacity_curve", 1.0)] {
            if let Err(what) = parse_curve(pass.string(variable), most) {
                self.mistakes.add(Mistake::error(pass.place_of(variable), what));
            }
        }
    }

    fn check_blend(&mut self, pass: &Pass, target: &Target, is_in_place: bool) {
        let blend = pass.string("blend");
        let Target::Textures { colors, .. } = target else { return };
        if matches!(blend, "" | "replace") {
            return;
        }
        if is_in_place {
            let message = format!("'{}' reads what it draws to, so it cannot blend", pass.name);
            let note = "what was there before is read as a texture: mix it in the program";
            self.mistakes.add(Mistake::error(pass.place_of("blend"), message).note(note));
        }
        for &color in colors {
            let texture = &self.plan.textures[color];
            if !is_blendable(texture.format) {
                let word = super::texture_format::word_of(texture.format);
                let message = format!("blending does not work in the format {word}");
                self.mistakes.add(Mistake::error(pass.place_of("blend"), message));
            }
        }
    }
}
