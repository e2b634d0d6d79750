//! Programs: functions in shader files, and the parameters that they declare.
//!
//! A program is named `file:function`. Reflection finds its parameters, so that an effect
//! needs no Rust:
//!
//! ```wgsl
//! struct Params { threshold: f32, edge_color: vec4f }       // fields: variables
//! @group(1) @binding(0) var<uniform> params: Params;
//! @group(1) @binding(1) var normal_texture: texture_2d<f32>; // a texture variable
//! @group(1) @binding(2) var normal_texture_sampler: sampler; // its sampler
//! ```
//!
//! Files in `common/` declare the view in `@group(0)` and the model in `@group(2)`. A
//! vertex program in its own file has its parameters in `@group(3)`.
//!
//! Rejected: parameters by position, or a struct of fixed slots, which are hard to read
//! and break when a line moves.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;

use edgemesh_shaders::files::{PROGRAMS, text as embedded_text};
use edgemesh_shaders::{ShaderError, ShaderSource};
use naga::{AddressSpace, ImageClass, ImageDimension, ScalarKind, ShaderStage, TypeInner};

use super::mistake::{Mistake, Mistakes, Place, SourceText};

/// The stage of a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum ProgramKind {
    /// Places vertices.
    Vertex,
    /// Colors fragments.
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

/// A valid program.
#[derive(Debug, Clone)]
pub(crate) struct Program {
    /// Its name, `file:function`.
    pub(crate) name: String,
    /// Its function, the entry point.
    pub(crate) function: String,
    /// The text of its module with all imports.
    pub(crate) source: Arc<ShaderSource>,
    /// Its parameters and outputs.
    pub(crate) interface: Interface,
    /// Whether it has the override `CLIPS`, which is 0 without clip planes.
    pub(crate) asks_for_clips: bool,
    /// Whether it has the override `BLENDS`, which is 1 for transparent surfaces.
    pub(crate) asks_for_blends: bool,
    /// Whether its loops are limited: true for all but built-in programs.
    pub(crate) is_bounded: bool,
}

/// The programs of a pass, as far as its component has them.
#[derive(Debug, Clone, Default)]
pub(crate) struct PassPrograms {
    /// Places vertices.
    pub(crate) vertex: Option<Program>,
    /// Colors fragments.
    pub(crate) fragment: Option<Program>,
    /// Colors the background.
    pub(crate) background: Option<Program>,
}

impl PassPrograms {
    /// All programs.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &Program> {
        [&self.vertex, &self.fragment, &self.background].into_iter().flatten()
    }

    /// The outputs of the fragment program.
    #[must_use]
    pub(crate) fn outputs(&self) -> &[Output] {
        self.fragment.as_ref().map_or(&[], |program| &program.interface.outputs)
    }
}

/// The parameters and outputs of a program.
#[derive(Debug, Clone, Default)]
pub(crate) struct Interface {
    /// The uniform of its parameters.
    pub(crate) params: Option<Params>,
    /// The textures that it reads.
    pub(crate) textures: Vec<TextureSlot>,
    /// The samplers of its textures.
    pub(crate) samplers: Vec<SamplerSlot>,
    /// What a fragment program returns, by location.
    pub(crate) outputs: Vec<Output>,
}

/// A uniform of parameters.
#[derive(Debug, Clone)]
pub(crate) struct Params {
    /// Its `@group`.
    pub(crate) group: u32,
    /// Its `@binding`.
    pub(crate) binding: u32,
    /// Its size in bytes.
    pub(crate) size: u32,
    /// Its fields.
    pub(crate) fields: Vec<Field>,
    /// Where the variable is declared.
    pub(crate) place: Place,
}

/// A field of a uniform.
#[derive(Debug, Clone)]
pub(crate) struct Field {
    /// Its name, that of a variable.
    pub(crate) name: String,
    /// Its offset in bytes.
    pub(crate) offset: u32,
    /// The count of its numbers, 1 to 4.
    pub(crate) count: usize,
    /// The type of its numbers.
    pub(crate) kind: FieldKind,
    /// Its type in WGSL.
    pub(crate) type_name: String,
    /// Where it is declared.
    pub(crate) place: Place,
}

/// The type of numbers in a field, an output or a texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FieldKind {
    /// `f32`
    Float,
    /// `i32`
    Int,
    /// `u32`
    Uint,
}

/// A texture that a program reads.
#[derive(Debug, Clone)]
pub(crate) struct TextureSlot {
    /// The name of its variable.
    pub(crate) name: String,
    /// Its `@group`.
    pub(crate) group: u32,
    /// Its `@binding`.
    pub(crate) binding: u32,
    /// Its type.
    pub(crate) kind: TextureKind,
}

/// The type of a texture in a shader.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum TextureKind {
    /// `texture_2d<f32>`
    Float,
    /// `texture_2d<u32>`
    Uint,
    /// `texture_depth_2d`
    Depth,
}

/// The sampler of a texture.
#[derive(Debug, Clone)]
pub(crate) struct SamplerSlot {
    /// The name of the texture's variable.
    pub(crate) texture: String,
    /// Its `@group`.
    pub(crate) group: u32,
    /// Its `@binding`.
    pub(crate) binding: u32,
}

/// A value that a fragment program returns.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Output {
    /// Its `@location`.
    pub(crate) location: u32,
    /// The name of its field; `color` for a value that is not in a struct.
    pub(crate) name: String,
    /// The type of its numbers.
    pub(crate) kind: FieldKind,
}

/// The shader files of programs.
#[derive(Debug, Clone, Default)]
pub struct ShaderFiles {
    /// Folders that are searched before the built-in files.
    folders: Vec<PathBuf>,
    /// A folder that is searched before the built-in files, and after all others.
    shipped: Option<PathBuf>,
}

impl ShaderFiles {
    /// Files in `folders` and their subfolders `shaders`, then in `shipped`, a copy of
    /// `shaders/`, then the built-in ones.
    #[must_use]
    pub fn new(folders: &[PathBuf], shipped: Option<PathBuf>) -> Self {
        let mut own = Vec::new();
        for folder in folders {
            own.extend([folder.clone(), folder.join("shaders")]);
        }
        Self { folders: own, shipped }
    }

    /// The files that a path relative to the shader folder can mean, in the order of the
    /// search.
    pub(crate) fn candidates(&self, path: &str) -> Vec<PathBuf> {
        let own = self.folders.iter().map(|folder| folder.join(path));
        own.chain(self.shipped.iter().map(|folder| folder.join(path))).collect()
    }

    /// The text of a path relative to the shader folder.
    fn load(&self, path: &str) -> Option<Arc<SourceText>> {
        let is_outside = path.split(['/', '\\']).any(|part| part == "..");
        if is_outside || std::path::Path::new(path).is_absolute() {
            return None;
        }
        let found = self.candidates(path).into_iter().find(|file| file.is_file());
        if let Some(file) = found {
            return SourceText::read(&file).ok();
        }
        embedded_text(path).map(|text| SourceText::new(format!("shaders/{path}"), text))
    }

    /// The path of a program's file: in a folder, or else built in.
    fn path_of(&self, file: &str) -> Option<String> {
        let own = format!("{file}.wgsl");
        let shipped = format!("programs/{file}.wgsl");
        let is_there = |path: &String| {
            let is_own = self.folders.iter().any(|folder| folder.join(path).is_file());
            is_own || *path == shipped && self.load(path).is_some()
        };
        [&own, &shipped].into_iter().find(|path| is_there(path)).cloned()
    }

    /// Reads the program `name`, which is set at `place`.
    ///
    /// # Errors
    /// Mistakes in the name or in the shader.
    pub(crate) fn program(
        &self,
        name: &str,
        kind: ProgramKind,
        place: &Place,
    ) -> Result<Program, Mistakes> {
        let Some((file, function)) = name.split_once(':') else {
            let message = format!("'{name}' is not a program name");
            let note = "a program is file:function, such as \"phong:phong\"";
            return Err(Mistakes::of(Mistake::error(place, message).note(note)));
        };
        let Some(path) = self.path_of(file) else {
            let message = format!("shader file '{file}.wgsl' not found");
            let places: Vec<String> =
                self.folders.iter().map(|folder| folder.display().to_string()).collect();
            let note = match places.is_empty() {
                true => "searched in the built-in shaders".to_owned(),
                false => format!("searched in {} and the built-in shaders", places.join(", ")),
            };
            return Err(Mistakes::of(Mistake::error(place, message).note(note)));
        };
        let source =
            ShaderSource::resolve(&path, &|path| self.load(path).map(|source| source.text.clone()))
                .map_err(|error| self.mistakes_of(&error))?;
        if source.text.trim().is_empty() {
            let message = format!("the shader file '{file}.wgsl' is empty");
            return Err(Mistakes::of(Mistake::error(place, message)));
        }
        let (module, info) = source.reflect().map_err(|error| self.mistakes_of(&error))?;
        let entry =
            self.entry_point(&module, &path, function, kind, place).map_err(Mistakes::of)?;
        let reflection = Reflection { files: self, source: &source, module: &module };
        let interface = reflection.interface(entry, &info)?;
        let asks_for = |name: &str| {
            module.overrides.iter().any(|(_, known)| known.name.as_deref() == Some(name))
        };
        let (asks_for_clips, asks_for_blends) = (asks_for("CLIPS"), asks_for("BLENDS"));
        let shipped = ShaderSource::embedded(&path);
        let is_bounded = shipped.map_or(true, |shipped| shipped.text != source.text);
        let (name, function) = (name.to_owned(), function.to_owned());
        let source = Arc::new(source);
        Ok(Program {
            name,
            function,
            source,
            interface,
            asks_for_clips,
            asks_for_blends,
            is_bounded,
        })
    }

    /// The index of the entry point of a program.
    fn entry_point(
        &self,
        module: &naga::Module,
        path: &str,
        function: &str,
        kind: ProgramKind,
        place: &Place,
    ) -> Result<usize, Mistake> {
        let entries = || module.entry_points.iter();
        let is_program =
            |entry: &naga::EntryPoint| entry.name == function && entry.stage == kind.stage();
        if let Some(index) = entries().position(is_program) {
            return Ok(index);
        }
        let file = self.load(path);
        let message = format!(
            "{} has no {} program '{function}'",
            file.map_or_else(|| path.to_owned(), |file| file.name.clone()),
            kind.name()
        );
        let of_stage = entries().filter(|entry| entry.stage == kind.stage());
        let names = of_stage.map(|entry| entry.name.as_str());
        let mistake = Mistake::error(place, message).names(function, names);
        Err(match entries().any(|entry| entry.name == function) {
            true => mistake.label("this program is of another stage"),
            false => mistake,
        })
    }
    /// An error in a shader as a mistake in the file with its text.
    fn mistakes_of(&self, error: &ShaderError) -> Mistakes {
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

/// The files in `common/` that built-in programs import.
fn imported_files() -> BTreeSet<&'static str> {
    let programs = PROGRAMS.iter().filter(|(path, _)| path.starts_with("programs/"));
    let imports = programs.flat_map(|(_, text)| text.lines()).filter_map(|line| {
        let path = line.trim().strip_prefix("#import")?.trim();
        path.strip_prefix('<')?.strip_suffix('>')
    });
    imports.collect()
}

/// A message of the validator without names that only it knows.
fn plainer(message: &str) -> &str {
    match message.split_once(" is invalid: ") {
        _ if message.contains("does not match the declared return type") => {
            "the returned value does not have the declared type"
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
    /// The interface of an entry point, given by its index.
    fn interface(
        &self,
        entry: usize,
        info: &naga::valid::ModuleInfo,
    ) -> Result<Interface, Mistakes> {
        let mut mistakes = Mistakes::default();
        let mut interface = Interface::default();
        let uses = info.get_entry_point(entry);
        for (handle, variable) in self.module.global_variables.iter() {
            if !uses[handle].is_empty() {
                self.add(handle, variable, &mut interface, &mut mistakes);
            }
        }
        let entry = &self.module.entry_points[entry];
        if entry.stage == ShaderStage::Fragment {
            interface.outputs = self.outputs(entry);
        }
        mistakes.or(interface).map(|(interface, _)| interface)
    }

    /// Adds a global variable that the program uses to its interface.
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
        // The view and the model, which `common/` declares.
        if matches!(at.group, 0 | 2) {
            if let Err(message) = known_binding(at, &name) {
                let note = "parameters and textures belong in @group(1), those of a vertex \
                            program in its own file in @group(3)";
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
                    let message = "a program can have only one uniform of parameters";
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
                    let message = format!("the sampler '{name}' belongs to no texture");
                    let note = "name a sampler after its texture, such as texture_sampler";
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
                    let message = format!("no variable has the type of the field '{name}'");
                    let note = "fields can be f32, i32, u32, vec2f, vec3f or vec4f";
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

    /// The span of a field's name in that of its struct, or else the whole struct.
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

    /// The outputs of a fragment program, by location.
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

    /// The place of a span of the joined text in its file.
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
    let note = "supported: one uniform struct, texture_2d<f32>, texture_2d<u32>, \
                texture_depth_2d, and samplers";
    Mistake::error(place, format!("the type of '{name}' is not supported")).note(note)
}

/// Checks a binding in the groups of `common/`; an error for others than those that
/// `common/` declares.
fn known_binding(at: naga::ResourceBinding, name: &str) -> Result<(), String> {
    const KNOWN: [(u32, u32, &str); 7] = [
        (0, 0, "frame"),
        (2, 0, "object"),
        (2, 1, "surface_ranges"),
        (2, 2, "materials"),
        (2, 3, "base_texture"),
        (2, 4, "base_sampler"),
        (2, 5, "vertex_colors"),
    ];
    let is_known = |(group, binding, known): &(u32, u32, &str)| {
        at.group == *group && at.binding == *binding && name == *known
    };
    if KNOWN.iter().any(is_known) {
        return Ok(());
    }
    Err(format!(
        "@group({}) @binding({}) is reserved: group 0 belongs to the view, group 2 to the model",
        at.group, at.binding
    ))
}
