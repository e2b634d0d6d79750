//! Programs: functions in shader files, and what they want to be given.
//!
//! A program is named `file:function`. Its parameters are found by reflection, so that
//! an effect needs no Rust:
//!
//! ```wgsl
//! struct Params { threshold: f32, edge_color: vec4f }       // fields: variables
//! @group(1) @binding(0) var<uniform> params: Params;
//! @group(1) @binding(1) var normal_texture: texture_2d<f32>; // a texture variable
//! @group(1) @binding(2) var normal_texture_sampler: sampler; // how that is sampled
//! ```
//!
//! `@group(0)` is the view, `@group(2)` what is drawn; both come with `common/`. A
//! vertex program in a file of its own has its parameters in `@group(3)`.
//!
//! Rejected: parameters by position, or a struct of fixed slots, which read well
//! nowhere and break when a line moves.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;

use edgemesh_shaders::files::{PROGRAMS, text as embedded_text};
use edgemesh_shaders::{ShaderError, ShaderSource};
use naga::{AddressSpace, ImageClass, ImageDimension, ScalarKind, ShaderStage, TypeInner};

use super::library::text_of;
use super::mistake::{Mistake, Mistakes, Place, SourceText};

/// Which program of a pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ProgramKind {
    /// Places vertices.
    Vertex,
    /// Colours fragments.
    Fragment,
}

impl ProgramKind {
    const fn stage(self) -> ShaderStage {
        match self {
            Self::Vertex => ShaderStage::Vertex,
            Self::Fragment => ShaderStage::Fragment,
        }
    }

    const fn name(self) -> &'static str {
        match self {
            Self::Vertex => "vertex",
            Self::Fragment => "fragment",
        }
    }
}

/// A program, valid by itself.
#[derive(Debug, Clone)]
pub struct Program {
    /// The function.
    pub function: String,
    /// The module's text, imports and all.
    pub source: Arc<ShaderSource>,
    /// What it wants to be given.
    pub interface: Interface,
    /// Whether it can be told that there are no clip planes.
    pub asks_for_clips: bool,
    /// Whether its loops are counted, as it is not one that ships.
    pub is_bounded: bool,
}

/// What a program wants to be given, and gives.
#[derive(Debug, Clone, Default)]
pub struct Interface {
    /// The uniform with its parameters.
    pub params: Option<Params>,
    /// The textures that it reads.
    pub textures: Vec<TextureSlot>,
    /// The samplers: the textures that they are for, by name.
    pub samplers: Vec<SamplerSlot>,
    /// What a fragment program writes, by location.
    pub outputs: Vec<Output>,
}

/// A uniform of parameters.
#[derive(Debug, Clone)]
pub struct Params {
    /// Its group.
    pub group: u32,
    /// Its binding.
    pub binding: u32,
    /// Its bytes.
    pub size: u32,
    /// Its fields.
    pub fields: Vec<Field>,
    /// Where the struct stands.
    pub place: Place,
}

/// A field of a uniform.
#[derive(Debug, Clone)]
pub struct Field {
    /// Its name, that of a variable.
    pub name: String,
    /// Where it begins, in bytes.
    pub offset: u32,
    /// How many numbers it has.
    pub count: usize,
    /// What numbers.
    pub kind: FieldKind,
    /// Its type, as WGSL has it.
    pub type_name: String,
    /// Where it stands.
    pub place: Place,
}

/// The numbers of a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FieldKind {
    /// `f32`
    Float,
    /// `i32`
    Int,
    /// `u32`
    Uint,
}

/// A texture that a program reads.
#[derive(Debug, Clone)]
pub struct TextureSlot {
    /// The name of its variable.
    pub name: String,
    /// Its group.
    pub group: u32,
    /// Its binding.
    pub binding: u32,
    /// What is in it.
    pub kind: TextureKind,
}

/// What a shader takes a texture for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TextureKind {
    /// `texture_2d<f32>`
    Float,
    /// `texture_2d<u32>`
    Uint,
    /// `texture_depth_2d`
    Depth,
}

/// A sampler.
#[derive(Debug, Clone)]
pub struct SamplerSlot {
    /// The texture variable that it is for.
    pub texture: String,
    /// Its group.
    pub group: u32,
    /// Its binding.
    pub binding: u32,
}

/// A value that a fragment program writes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Output {
    /// Its location.
    pub location: u32,
    /// The name of its field; `color` where the program returns it bare.
    pub name: String,
    /// What numbers.
    pub kind: FieldKind,
}

/// The shader files that programs are taken from.
#[derive(Debug, Clone, Default)]
pub struct ShaderFiles {
    /// Folders that come before what is shipped.
    folders: Vec<PathBuf>,
    /// A folder that stands for what is shipped.
    shipped: Option<PathBuf>,
}

impl ShaderFiles {
    /// Files of `folders`, before those that are shipped; these come from `shipped`, a
    /// copy of `shaders/`, where there is one.
    #[must_use]
    pub fn new(folders: &[PathBuf], shipped: Option<PathBuf>) -> Self {
        let mut own = Vec::new();
        for folder in folders {
            own.extend([folder.clone(), folder.join("shaders")]);
        }
        Self { folders: own, shipped }
    }

    /// The files that a path from the shader folder can be, the first one first.
    pub(crate) fn candidates(&self, path: &str) -> Vec<PathBuf> {
        let own = self.folders.iter().map(|folder| folder.join(path));
        own.chain(self.shipped.iter().map(|folder| folder.join(path))).collect()
    }

    /// The text of a path from the shader folder, under the name that messages use.
    fn load(&self, path: &str) -> Option<Arc<SourceText>> {
        let is_outside = path.split(['/', '\\']).any(|part| part == "..");
        if is_outside || std::path::Path::new(path).is_absolute() {
            return None;
        }
        let found = self.candidates(path).into_iter().find(|file| file.is_file());
        if let Some(file) = found {
            return text_of(&file).ok();
        }
        embedded_text(path).map(|text| SourceText::new(format!("shaders/{path}"), text))
    }

    /// The path of a program's file: beside the technique, or among those shipped.
    fn path_of(&self, file: &str) -> Option<String> {
        let own = format!("{file}.wgsl");
        let shipped = format!("programs/{file}.wgsl");
        let is_there = |path: &String| {
            let is_own = self.folders.iter().any(|folder| folder.join(path).is_file());
            is_own || *path == shipped && self.load(path).is_some()
        };
        [&own, &shipped].into_iter().find(|path| is_there(path)).cloned()
    }

    /// The program `name`, which was named at `place`.
    ///
    /// # Errors
    /// Mistakes in the name, or in the shader.
    pub fn program(
        &self,
        name: &str,
        kind: ProgramKind,
        place: &Place,
    ) -> Result<Program, Mistakes> {
        let Some((file, function)) = name.split_once(':') else {
            let message = format!("'{name}' is no program");
            let note = "a program is file:function, as \"phong:phong\"";
            return Err(Mistakes::of(Mistake::error(place, message).note(note)));
        };
        let Some(path) = self.path_of(file) else {
            let message = format!("there is no shader file '{file}.wgsl'");
            let places: Vec<String> =
                self.folders.iter().map(|folder| folder.display().to_string()).collect();
            let note = match places.is_empty() {
                true => "looked for among the shipped ones".to_owned(),
                false => format!("looked for in {} and among the shipped ones", places.join(", ")),
            };
            return Err(Mistakes::of(Mistake::error(place, message).note(note)));
        };
        let source =
            ShaderSource::resolve(&path, &|path| self.load(path).map(|source| source.text.clone()))
                .map_err(|error| self.told(&error))?;
        if source.text.trim().is_empty() {
            let message = format!("the shader file '{file}.wgsl' is empty");
            return Err(Mistakes::of(Mistake::error(place, message)));
        }
        let (module, info) = source.reflect().map_err(|error| self.told(&error))?;
        self.reflected(&path, function, kind, place, Arc::new(source), &module, &info)
    }

    #[expect(clippy::too_many_arguments, reason = "what reflection has found")]
    fn reflected(
        &self,
        path: &str,
        function: &str,
        kind: ProgramKind,
        place: &Place,
        source: Arc<ShaderSource>,
        module: &naga::Module,
        info: &naga::valid::ModuleInfo,
    ) -> Result<Program, Mistakes> {
        let of_kind = |entry: &&naga::EntryPoint| entry.stage == kind.stage();
        let entries: Vec<&str> =
            module.entry_points.iter().filter(of_kind).map(|entry| entry.name.as_str()).collect();
        let Some(index) = module
            .entry_points
            .iter()
            .position(|entry| entry.name == function && entry.stage == kind.stage())
        else {
            let file = self.load(path);
            let message = format!(
                "{} has no {} program '{function}'",
                file.map_or_else(|| path.to_owned(), |file| file.name.clone()),
                kind.name()
            );
            let mut mistake = Mistake::error(place, message).names(function, entries);
            if module.entry_points.iter().any(|entry| entry.name == function) {
                mistake = mistake.label("it is of another stage");
            }
            return Err(Mistakes::of(mistake));
        };
        let reflection = Reflection { files: self, source: &source, module };
        let mut mistakes = Mistakes::default();
        let mut interface = Interface::default();
        let uses = info.get_entry_point(index);
        for (handle, variable) in module.global_variables.iter() {
            if !uses[handle].is_empty() {
                reflection.add(handle, variable, &mut interface, &mut mistakes);
            }
        }
        if kind == ProgramKind::Fragment {
            interface.outputs = reflection.outputs(&module.entry_points[index]);
        }
        let is_clips = |known: &naga::Override| known.name.as_deref() == Some("CLIPS");
        let asks_for_clips = module.overrides.iter().any(|(_, known)| is_clips(known));
        let shipped = ShaderSource::embedded(path);
        let is_bounded = shipped.map_or(true, |shipped| shipped.text != source.text);
        let function = function.to_owned();
        let program = Program { function, source, interface, asks_for_clips, is_bounded };
        mistakes.or(program).map(|(program, _)| program)
    }

    /// A mistake in a shader, underlined in the file that it was written in.
    fn told(&self, error: &ShaderError) -> Mistakes {
        let Some(source) = self.load(&error.file) else {
            return Mistakes::of(Mistake::without_place(error.to_string()));
        };
        let span = source.span(error.line, error.column, error.length.max(1));
        let mut mistake = Mistake::error(&Place { source, span }, plainer(&error.message));
        if let Some(path) = error.message.strip_prefix("there is no ") {
            mistake = mistake.names(path, imported_files());
        }
        Mistakes::of(mistake)
    }
}

/// The common files that programs import, as those that ship show.
fn imported_files() -> BTreeSet<&'static str> {
    let programs = PROGRAMS.iter().filter(|(path, _)| path.starts_with("programs/"));
    let imports = programs.flat_map(|(_, text)| text.lines()).filter_map(|line| {
        let path = line.trim().strip_prefix("#import")?.trim();
        path.strip_prefix('<')?.strip_suffix('>')
    });
    imports.collect()
}

/// What a validator says, without what only it can know.
fn plainer(message: &str) -> &str {
    match message.split_once(" is invalid: ") {
        _ if message.contains("does not match the declared return type") => {
            "what is returned is not of the type that the function declares"
        }
        Some((_, rest)) => rest,
        None => message,
    }
}

struct Reflection<'a> {
    files: &'a ShaderFiles,
    source: &'a ShaderSource,
    module: &'a naga::Module,
}

impl Reflection<'_> {
    /// Adds a variable that the program uses to what it wants.
    fn add(
        &self,
        handle: naga::Handle<naga::GlobalVariable>,
        variable: &naga::GlobalVariable,
        interface: &mut Interface,
        mistakes: &mut Mistakes,
    ) {
        let Some(at) = variable.binding else { return };
        let name = variable.name.clone().unwrap_or_default();
        let place = || self.place(self.module.global_variables.get_span(handle));
        let inner = &self.module.types[variable.ty].inner;
        // The view and what is drawn: `common/` declares them.
        if matches!(at.group, 0 | 2) {
            if let Err(message) = known_binding(at, &name) {
                let note = "parameters and textures are in @group(1), those of a vertex program \
                            in a file of its own in @group(3)";
                mistakes.add(Mistake::error(&place(), message).note(note));
            }
            return;
        }
        let (group, binding) = (at.group, at.binding);
        match (variable.space, inner) {
            (AddressSpace::Uniform, TypeInner::Struct { members, span }) => {
                let fields = self.fields(variable.ty, members, mistakes);
                let params = Params { group, binding, size: *span, fields, place: place() };
                if interface.params.replace(params).is_some() {
                    let message = "a program has one uniform of parameters";
                    mistakes.add(Mistake::error(&place(), message));
                }
            }
            (_, TypeInner::Image { dim: ImageDimension::D2, arrayed: false, class }) => {
                let kind = match class {
                    ImageClass::Sampled { kind: ScalarKind::Float, multi: false } => {
                        TextureKind::Float
                    }
                    ImageClass::Sampled { kind: ScalarKind::Uint, multi: false } => {
                        TextureKind::Uint
                    }
                    ImageClass::Depth { multi: false } => TextureKind::Depth,
                    _ => {
                        mistakes.add(wrong_binding(&place(), &name));
                        return;
                    }
                };
                interface.textures.push(TextureSlot { name, group, binding, kind });
            }
            (_, TypeInner::Sampler { comparison: false }) => {
                let Some(texture) = name.strip_suffix("_sampler") else {
                    let message = format!("the sampler '{name}' is for no texture");
                    let note = "a sampler is called as its texture and _sampler";
                    mistakes.add(Mistake::error(&place(), message).note(note));
                    return;
                };
                let texture = texture.to_owned();
                interface.samplers.push(SamplerSlot { texture, group, binding });
            }
            _ => mistakes.add(wrong_binding(&place(), &name)),
        }
    }

    fn fields(
        &self,
        of: naga::Handle<naga::Type>,
        members: &[naga::StructMember],
        mistakes: &mut Mistakes,
    ) -> Vec<Field> {
        let mut fields = Vec::new();
        let span = self.module.types.get_span(of);
        for member in members {
            let name = member.name.clone().unwrap_or_default();
            let place = self.place(self.field_span(span, &name));
            let inner = &self.module.types[member.ty].inner;
            let (scalar, count) = match inner {
                TypeInner::Scalar(scalar) => (*scalar, 1),
                TypeInner::Vector { size, scalar } => (*scalar, *size as usize),
                _ => {
                    let message = format!("the field '{name}' has a type that no variable has");
                    let note = "fields are f32, i32, u32, vec2f, vec3f or vec4f";
                    mistakes.add(Mistake::error(&place, message).note(note));
                    continue;
                }
            };
            let (kind, type_name) = match (scalar.kind, count) {
                (ScalarKind::Float, 1) => (FieldKind::Float, "f32".to_owned()),
                (ScalarKind::Float, _) => (FieldKind::Float, format!("vec{count}f")),
                (ScalarKind::Sint, _) => (FieldKind::Int, "i32".to_owned()),
                _ => (FieldKind::Uint, "u32".to_owned()),
            };
            fields.push(Field { name, offset: member.offset, count, kind, type_name, place });
        }
        fields
    }

    /// The name of a field in the text of its struct, or the whole of it.
    fn field_span(&self, of: naga::Span, name: &str) -> naga::Span {
        let Some(range) = of.to_range() else { return of };
        let text = self.source.text.get(range.clone()).unwrap_or_default();
        let is_letter = |letter: char| letter.is_alphanumeric() || letter == '_';
        let is_field = |at: &usize| {
            let (before, behind) = (&text[..*at], &text[at + name.len()..]);
            !before.ends_with(is_letter) && behind.trim_start().starts_with(':')
        };
        let found = text.match_indices(name).map(|found| found.0).find(is_field);
        found.map_or(of, |at| {
            let start = edgemesh::index::to_u32(range.start + at);
            naga::Span::new(start, start + edgemesh::index::to_u32(name.len()))
        })
    }

    /// What a fragment program writes.
    fn outputs(&self, entry: &naga::EntryPoint) -> Vec<Output> {
        let Some(result) = &entry.function.result else { return Vec::new() };
        let kind_of = |ty| match &self.module.types[ty].inner {
            TypeInner::Scalar(scalar) | TypeInner::Vector { scalar, .. } => match scalar.kind {
                ScalarKind::Uint => FieldKind::Uint,
                ScalarKind::Sint => FieldKind::Int,
                _ => FieldKind::Float,
            },
            _ => FieldKind::Float,
        };
        let location_of = |binding: &Option<naga::Binding>| match binding {
            Some(naga::Binding::Location { location, .. }) => Some(*location),
            _ => None,
        };
        if let Some(location) = location_of(&result.binding) {
            return vec![Output { location, name: "color".to_owned(), kind: kind_of(result.ty) }];
        }
        let TypeInner::Struct { members, .. } = &self.module.types[result.ty].inner else {
            return Vec::new();
        };
        let output = |member: &naga::StructMember| {
            let location = location_of(&member.binding)?;
            let name = member.name.clone().unwrap_or_default();
            Some(Output { location, name, kind: kind_of(member.ty) })
        };
        let mut outputs: Vec<Output> = members.iter().filter_map(output).collect();
        outputs.sort_by_key(|output| output.location);
        outputs
    }

    /// A span of the joined text, in the file that it was written in.
    fn place(&self, span: naga::Span) -> Place {
        let at = span.location(&self.source.text);
        let (file, line) = self.source.origin(at.line_number as usize);
        let source = self.files.load(file).unwrap_or_else(|| SourceText::new(file, ""));
        let length = (at.length as usize).max(1);
        let span = source.span(line, at.line_position as usize, length);
        Place { source, span }
    }
}

fn wrong_binding(place: &Place, name: &str) -> Mistake {
    let note = "a program is given a uniform struct, texture_2d<f32>, texture_2d<u32>, \
                texture_depth_2d, and samplers";
    Mistake::error(place, format!("'{name}' is nothing that a program can be given")).note(note)
}

/// The bindings that `common/` declares, by group, binding and name.
fn known_binding(at: naga::ResourceBinding, name: &str) -> Result<(), String> {
    const KNOWN: [(u32, u32, &str); 6] = [
        (0, 0, "frame"),
        (2, 0, "object"),
        (2, 1, "surface_ranges"),
        (2, 2, "materials"),
        (2, 3, "base_texture"),
        (2, 4, "base_sampler"),
    ];
    let is_known = |(group, binding, known): &(u32, u32, &str)| {
        at.group == *group && at.binding == *binding && name == *known
    };
    if KNOWN.iter().any(is_known) {
        return Ok(());
    }
    Err(format!(
        "@group({}) @binding({}) is taken: groups 0 and 2 are the view's and the model's",
        at.group, at.binding
    ))
}
