//! The plan of a technique: all that its passes need, checked without a GPU.
//!
//! ```text
//!   Technique --+                       +--> passes: variables, programs, reads, target
//!   ShaderFiles +--> Plan::of (no GPU) -+--> textures: sizes and formats
//!   images -----+                       '--> or all mistakes
//! ```
//!
//! A pass reads what an earlier pass wrote in the same frame. A pass that reads a texture
//! that it writes reads what was there before; in the first frame that is empty. Textures
//! are kept from frame to frame.

use std::path::PathBuf;

use super::core::CoreComponent;
use super::core_view::render_target::{FORMAT, SCALE, TARGET, TEXTURE};
use super::core_view::{Blend, CoreView, RenderTarget, RunMode, programs};
use super::mistake::{Mistake, Mistakes, Place};
use super::pass::Pass;
use super::program::{
    FieldKind, Output, PassPrograms, Program, ProgramKind, ShaderFiles, TextureKind,
};
use super::texture_format::{MAX_OUTPUT_BYTES_PER_PIXEL, TextureFormat, TextureSize};
use super::texture_name::{TextureName, TextureSource};
use super::{Technique, image_file, plan_params};

/// A checked technique.
#[derive(Debug, Clone, Default)]
pub struct Plan {
    /// One plan per pass of the technique.
    pub(crate) passes: Vec<PassPlan>,
    /// The textures between passes.
    pub(crate) textures: Vec<TexturePlan>,
    /// Warnings about values that are replaced.
    pub(crate) warnings: Mistakes,
}

/// The requirements of a pass.
#[derive(Debug, Clone)]
pub(crate) struct PassPlan {
    /// The variables of its core component.
    pub(crate) core: CoreView,
    /// The frames in which it runs.
    pub(crate) run: RunMode,
    /// The target.
    pub(crate) target: Target,
    /// Its programs.
    pub(crate) programs: PassPrograms,
    /// The textures that it reads.
    pub(crate) reads: Vec<TextureRead>,
    /// Whether it reads a texture that it writes.
    pub(crate) is_in_place: bool,
}

/// The target of a pass.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Target {
    /// The picture.
    Framebuffer,
    /// Textures, by their indices in the plan.
    Textures {
        /// One per output, by location.
        colors: Vec<usize>,
        /// The depth, if the pass writes it.
        depth: Option<usize>,
    },
}

/// A texture that a pass reads.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TextureRead {
    /// The variable with the texture.
    pub(crate) variable: String,
    /// The texture.
    pub(crate) source: ReadSource,
    /// Whether it is filtered between texels.
    pub(crate) is_filtered: bool,
}

/// The kinds of textures that a pass reads.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum ReadSource {
    /// No texture: one white texel.
    None,
    /// A texture of the plan, by its index.
    Generated(usize),
    /// An image.
    Image(image_file::ImageFile),
}

/// A texture between passes.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TexturePlan {
    /// Its name, without the directory `<generated>`.
    pub(crate) name: String,
    /// Its size.
    pub(crate) size: TextureSize,
    /// Its format.
    pub(crate) format: TextureFormat,
    /// The variable of the first pass that writes it.
    pub(crate) place: Place,
}

impl Plan {
    /// Checks a technique and makes its plan.
    ///
    /// # Errors
    /// All mistakes in the technique, its shaders and its images.
    pub fn of(technique: &Technique, shaders: &ShaderFiles) -> Result<Self, Mistakes> {
        let passes = &technique.passes;
        let mut planner = Planner {
            shaders,
            folders: &technique.folders,
            textures: Vec::new(),
            mistakes: Mistakes::default(),
        };
        let views: Vec<CoreView> =
            passes.iter().map(|pass| CoreView::read(pass, &mut planner.mistakes)).collect();
        // Programs before targets: what a pass writes depends on what its program returns.
        let programs: Vec<PassPrograms> =
            passes.iter().zip(&views).map(|(pass, view)| planner.programs(pass, view)).collect();
        let inputs = passes.iter().zip(&views).zip(&programs);
        let targets: Vec<Target> =
            inputs.map(|((pass, view), programs)| planner.target(pass, view, programs)).collect();
        let writes: Vec<Vec<usize>> = targets.iter().map(Target::textures).collect();
        let mut plans = Vec::new();
        let parts = views.into_iter().zip(programs).zip(targets);
        for (at, ((core, programs), target)) in parts.enumerate() {
            let pass = &passes[at];
            let reads = planner.reads(technique, at, &writes);
            plan_params::check(pass, &programs, &mut planner.mistakes);
            for program in programs.iter() {
                planner.check_textures(pass, program, &reads);
            }
            let is_in_place = reads.iter().any(|read| match read.source {
                ReadSource::Generated(texture) => writes[at].contains(&texture),
                _ => false,
            });
            let run = RunMode::read(pass, &mut planner.mistakes);
            planner.check_blend(pass, core.blend(), &target, is_in_place);
            plans.push(PassPlan { core, run, target, programs, reads, is_in_place });
        }
        let Planner { textures, mistakes, .. } = planner;
        let plan = Self { passes: plans, textures, warnings: Mistakes::default() };
        mistakes.or(plan).map(|(plan, warnings)| Self { warnings, ..plan })
    }
}

impl Target {
    /// The indices of the textures that are written.
    #[must_use]
    pub(crate) fn textures(&self) -> Vec<usize> {
        match self {
            Self::Framebuffer => Vec::new(),
            Self::Textures { colors, depth } => colors.iter().copied().chain(*depth).collect(),
        }
    }
}

struct Planner<'a> {
    shaders: &'a ShaderFiles,
    folders: &'a [PathBuf],
    textures: Vec<TexturePlan>,
    mistakes: Mistakes,
}

impl Planner<'_> {
    fn programs(&mut self, pass: &Pass, view: &CoreView) -> PassPrograms {
        let mut program = |name: Option<String>, variable, kind| {
            let found = self.shaders.program(&name?, kind, pass.place_of(variable));
            found.map_err(|mistakes| self.mistakes.append(mistakes)).ok()
        };
        let names = view.programs();
        PassPrograms {
            vertex: program(names.vertex, programs::VERTEX, ProgramKind::Vertex),
            fragment: program(names.fragment, programs::FRAGMENT, ProgramKind::Fragment),
            background: program(names.background, programs::BACKGROUND, ProgramKind::Fragment),
        }
    }

    /// Where a pass draws. Adds the textures that it writes to the plan.
    fn target(&mut self, pass: &Pass, view: &CoreView, programs: &PassPrograms) -> Target {
        let target = match view {
            CoreView::Strokes(_) => return Target::Framebuffer,
            CoreView::CopyToTexture(view) => {
                let (size, format) = match view.is_depth {
                    true => (TextureSize::PICTURE, TextureFormat::DEPTH),
                    false => (TextureSize::PICTURE, TextureFormat::PICTURE),
                };
                let place = pass.place_of(TEXTURE).clone();
                let name = view.texture.clone();
                let plan = TexturePlan { name, size, format, place };
                let texture = self.texture(pass, &view.texture, plan);
                return match view.is_depth {
                    true => Target::Textures { colors: Vec::new(), depth: Some(texture) },
                    false => Target::Textures { colors: vec![texture], depth: None },
                };
            }
            CoreView::GenerateTexture(view) => {
                let place = pass.place_of(TEXTURE).clone();
                let name = view.texture.clone();
                let plan = TexturePlan { name, size: view.size, format: view.format, place };
                let texture = self.texture(pass, &view.texture, plan);
                return Target::Textures { colors: vec![texture], depth: None };
            }
            CoreView::SimpleRender(view) => &view.target,
            CoreView::ProcessTexture(view) => &view.target,
            CoreView::PingPong(view) => &view.target,
            CoreView::Composite(view) => &view.target,
        };
        match &target.name {
            None => Target::Framebuffer,
            Some(name) => self.render_targets(pass, name, target, programs.outputs()),
        }
    }

    /// The textures of a named target: one per output of the fragment program, and the depth
    /// of a pass that draws the scene.
    fn render_targets(
        &mut self,
        pass: &Pass,
        name: &str,
        target: &RenderTarget,
        outputs: &[Output],
    ) -> Target {
        let plan = |suffix: &str, format| TexturePlan {
            name: format!("{name}_{suffix}"),
            size: target.size,
            format,
            place: pass.place_of(TARGET).clone(),
        };
        let count = outputs.len().max(1);
        let formats: Vec<TextureFormat> = (0..count).map(|at| target.format(at)).collect();
        let mut colors = Vec::new();
        for (at, &format) in formats.iter().enumerate() {
            let suffix = match outputs.get(at) {
                Some(output) if output.location > 0 => output.name.as_str(),
                _ => "color",
            };
            if let Some(output) = outputs.get(at)
                && output.kind != format.number_kind()
            {
                let message = format!(
                    "the output '{}' of the fragment program does not fit the format {}",
                    output.name,
                    format.word()
                );
                self.mistakes.add(Mistake::error(pass.place_of(FORMAT), message));
            }
            colors.push(self.texture(pass, name, plan(suffix, format)));
        }
        self.check_cost(pass, &formats);
        let depth = (pass.component.core == CoreComponent::SimpleRender)
            .then(|| self.texture(pass, name, plan("depth", TextureFormat::DEPTH)));
        Target::Textures { colors, depth }
    }

    /// Checks that every adapter can write the outputs of a pass at once.
    fn check_cost(&mut self, pass: &Pass, formats: &[TextureFormat]) {
        let cost: u32 = formats.iter().map(|format| format.output_bytes_per_pixel()).sum();
        if cost > MAX_OUTPUT_BYTES_PER_PIXEL {
            let message = format!(
                "the outputs take {cost} bytes per pixel; the limit is {MAX_OUTPUT_BYTES_PER_PIXEL}"
            );
            let note =
                "use smaller formats for some of them, such as rgba16f or rgba8 (8 bytes each)";
            self.mistakes.add(Mistake::error(pass.place_of(FORMAT), message).note(note));
        }
    }

    /// The index of a texture, which is added to the plan unless it is there. `target` is
    /// its name in the file, without a suffix.
    fn texture(&mut self, pass: &Pass, target: &str, texture: TexturePlan) -> usize {
        let TexturePlan { size, format, ref place, .. } = texture;
        if !super::component_file::is_name(target) {
            let message = format!("'{target}' is not a valid name of a render target");
            let note = "names consist of letters, digits and _";
            self.mistakes.add(Mistake::error(place, message).note(note));
        }
        if size.scale <= 0.0 {
            let message = "the scale of a texture must be greater than 0";
            self.mistakes.add(Mistake::error(pass.place_of(SCALE), message));
        }
        if let Some(known) = self.textures.iter().position(|known| known.name == texture.name) {
            let first = &self.textures[known];
            if first.size != size || first.format != format {
                let message = format!("two passes write '{target}' in different sizes or formats");
                let mistake = Mistake::error(place, message);
                self.mistakes.add(mistake.also(&first.place, "first written here"));
            }
            return known;
        }
        self.textures.push(texture);
        self.textures.len() - 1
    }

    /// The textures that the pass at index `at` reads.
    fn reads(
        &mut self,
        technique: &Technique,
        at: usize,
        writes: &[Vec<usize>],
    ) -> Vec<TextureRead> {
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
            reads.push(TextureRead { variable: variable.name.clone(), source, is_filtered });
        }
        reads
    }

    fn check_filter(&mut self, name: &TextureName, texture: usize, place: &Place) {
        let texture = &self.textures[texture];
        if name.filters() && !texture.format.is_filterable() {
            let word = texture.format.word();
            let message = format!("'{}' cannot be filtered: its format is {word}", texture.name);
            let note = "omit the :1, or give its pass another render_target_format";
            self.mistakes.add(Mistake::error(place, message).note(note));
        }
    }

    /// The index of a generated texture that the pass at index `at` reads.
    fn generated(
        &mut self,
        technique: &Technique,
        at: usize,
        writes: &[Vec<usize>],
        name: &str,
        place: &Place,
    ) -> Option<usize> {
        let Some(texture) = self.textures.iter().position(|known| known.name == name) else {
            let names: Vec<&str> =
                self.textures.iter().map(|texture| texture.name.as_str()).collect();
            let mistake = Mistake::error(place, format!("no pass writes the texture '{name}'"));
            self.mistakes.add(mistake.names(name, names));
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
            self.mistakes.add(mistake.note("move the pass that writes it above this one"));
        }
        Some(texture)
    }

    /// Checks that the textures of a program are variables, and that they have the kind that
    /// it reads.
    fn check_textures(&mut self, pass: &Pass, program: &Program, reads: &[TextureRead]) {
        for slot in &program.interface.textures {
            let is_variable = pass.component.textures().any(|(_, known)| known.name == slot.name);
            if !is_variable {
                let message = format!(
                    "the program reads a texture '{}', which is not a variable of {}",
                    slot.name, pass.component.name
                );
                let names: Vec<&str> =
                    pass.component.textures().map(|(_, known)| known.name.as_str()).collect();
                let place = pass.place_of(programs::FRAGMENT);
                self.mistakes.add(Mistake::error(place, message).names(&slot.name, names));
                continue;
            }
            let Some(read) = reads.iter().find(|read| read.variable == slot.name) else { continue };
            let format = match &read.source {
                ReadSource::Generated(texture) => self.textures[*texture].format,
                ReadSource::None | ReadSource::Image(_) => TextureFormat::Rgba8,
            };
            let fits = match slot.kind {
                TextureKind::Depth => format == TextureFormat::DEPTH,
                TextureKind::Uint => format.number_kind() == FieldKind::Uint,
                TextureKind::Float => format.number_kind() == FieldKind::Float,
            };
            if !fits {
                let expected = match slot.kind {
                    TextureKind::Depth => "a depth texture",
                    TextureKind::Uint => "a texture of unsigned integers",
                    TextureKind::Float => "a color texture",
                };
                let message = format!("'{}' needs {expected}", slot.name);
                let place = pass.place_of(&slot.name);
                let note = "a pass with render_target = \"x\" writes <generated>:x_color and \
                            <generated>:x_depth";
                self.mistakes.add(Mistake::error(place, message).note(note));
            }
        }
    }

    fn check_blend(&mut self, pass: &Pass, blend: Blend, target: &Target, is_in_place: bool) {
        let Target::Textures { colors, .. } = target else { return };
        if blend == Blend::Replace {
            return;
        }
        let place = pass.place_of(Blend::VARIABLE);
        if is_in_place {
            let message =
                format!("'{}' reads the texture that it draws to, so it cannot blend", pass.name);
            let note = "mix with the previous content in the program instead";
            self.mistakes.add(Mistake::error(place, message).note(note));
        }
        for &color in colors {
            let format = self.textures[color].format;
            if !format.is_blendable() {
                let message = format!("the format {} cannot be blended", format.word());
                self.mistakes.add(Mistake::error(place, message));
            }
        }
    }
}
