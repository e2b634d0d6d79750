//! MTL through `tobj`, behind a screen of its own.
//!
//! A material library must never stop geometry, and `tobj` gives up a whole one
//! for a material without a name, and panics at a colour of fewer than three
//! numbers. So only the statements that are used reach it, each in sound form.

use std::ops::Range;

use rustc_hash::FxHashMap;

use super::picture::picture_beside;
use super::source::Source;
use crate::model::{Material, Texture};
use crate::report::{Place, Report, WarningCode};

/// A library that was read.
struct Library {
    /// Its file, as the model names it.
    name: String,
    /// The line of the model's file that names it.
    line: u32,
}

/// Gives `materials` the looks that libraries have under their names; the
/// first one of a name holds. `statements` are those of `mtllib` with their
/// lines.
pub(super) fn read_materials(
    source: &Source,
    statements: &[(String, u32)],
    materials: &mut [Material],
    report: &mut Report,
) {
    let mut libraries = Vec::new();
    let mut by_name = FxHashMap::default();
    for (statement, line) in statements {
        for name in library_names(source, statement) {
            match read_library(source, &name) {
                Ok(known) => {
                    for material in known {
                        let name = material.name.clone();
                        by_name.entry(name).or_insert((material, libraries.len()));
                    }
                    libraries.push(Library { name, line: *line });
                }
                Err(why) => report.warn(WarningCode::Material, Some(Place::Line(*line)), || {
                    format!("material library '{name}' {why}; its colours are left out")
                }),
            }
        }
    }
    let mut textures = Textures { source, known: FxHashMap::default() };
    for material in materials {
        if let Some((known, library)) = by_name.get(&material.name) {
            *material = material_of(known, &libraries[*library], &mut textures, report);
        }
    }
}

fn material_of(
    material: &tobj::Material,
    library: &Library,
    textures: &mut Textures,
    report: &mut Report,
) -> Material {
    let statement = material.diffuse_texture.as_deref();
    let diffuse_texture = statement.and_then(|statement| {
        let found = textures.find(&library.name, statement);
        found
            .map_err(|why| {
                report.warn(WarningCode::Material, Some(Place::Line(library.line)), || {
                    let (name, of) = (texture_name(statement), &material.name);
                    format!("texture '{name}' of material '{of}' {why}; it is left out")
                });
            })
            .ok()
    });
    Material {
        name: material.name.clone(),
        ambient: material.ambient,
        diffuse: material.diffuse,
        specular: material.specular,
        shininess: material.shininess,
        opacity: material.dissolve,
        diffuse_texture,
    }
}

/// The textures that were looked for: many materials share one.
struct Textures<'a> {
    source: &'a Source<'a>,
    known: FxHashMap<(String, String), Result<Texture, String>>,
}

impl Textures<'_> {
    /// The texture of a `map_Kd` statement in a library.
    fn find(&mut self, library: &str, statement: &str) -> Result<Texture, String> {
        let key = (folder_in_name(library).to_owned(), statement.to_owned());
        let source = self.source;
        let find = |key: &(String, String)| find_texture(source, &key.0, &key.1);
        match self.known.get(&key) {
            Some(known) => known.clone(),
            None => self.known.entry(key).or_insert_with_key(find).clone(),
        }
    }
}

/// Looks for a texture beside its library, then in the model's own folder, which
/// many programs write names for. A backslash before a blank is a part of the
/// name in some files, and of a path in others.
fn find_texture(source: &Source, folder: &str, statement: &str) -> Result<Texture, String> {
    let name = texture_name(statement);
    if name.is_empty() {
        return Err("has no name".into());
    }
    let mut first_error = None;
    for folder in [folder, ""] {
        for name in [name, &name.replace("\\ ", " ")] {
            match picture_beside(source, &format!("{folder}{name}")) {
                Ok(texture) => return Ok(Texture { name: name.into(), ..texture }),
                Err(why) => _ = first_error.get_or_insert(why),
            }
        }
    }
    Err(first_error.unwrap_or_default())
}

/// The folder in front of a file's name, with its slash; empty where there is
/// none.
fn folder_in_name(name: &str) -> &str {
    let end = name.rfind(['/', '\\']).map_or(0, |slash| slash + 1);
    &name[..end]
}

/// The file that a `map_Kd` statement names, behind its options.
fn texture_name(statement: &str) -> &str {
    let mut rest = statement.trim();
    loop {
        let (option, behind) = split_word(rest);
        let Some(numbers) = option_numbers(option) else { break };
        rest = behind;
        for number in 0..numbers.end {
            let (word, behind) = split_word(rest);
            if number >= numbers.start && word.parse::<f32>().is_err() {
                break;
            }
            rest = behind;
        }
    }
    let quoted = rest.strip_prefix('"').and_then(|rest| rest.strip_suffix('"'));
    quoted.unwrap_or(rest)
}

/// How many words an option of a texture takes, from at least to at most;
/// `None` where it is none. Those beyond the least are numbers.
fn option_numbers(option: &str) -> Option<Range<usize>> {
    match option {
        "-blendu" | "-blendv" | "-bm" | "-boost" | "-cc" | "-clamp" | "-colorspace"
        | "-imfchan" | "-texres" | "-type" => Some(1..1),
        "-mm" => Some(2..2),
        "-o" | "-s" | "-t" => Some(1..3),
        _ => None,
    }
}

/// The first word of a text, and what stands behind it.
fn split_word(text: &str) -> (&str, &str) {
    let (word, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
    (word, rest.trim_start())
}

/// The files that an `mtllib` statement names: a single one, whose name may hold
/// blanks, or several, where blanks in a name stand behind a backslash.
fn library_names(source: &Source, rest: &str) -> Vec<String> {
    // No file name holds this, as no text does.
    const ESCAPED_BLANK: &str = "\0";
    let unescaped = rest.replace("\\ ", " ");
    let escaped = rest.replace("\\ ", ESCAPED_BLANK);
    let several = || escaped.split_whitespace().map(|name| name.replace(ESCAPED_BLANK, " "));
    if several().count() < 2 || source.sidecar_path(&unescaped).is_ok() {
        return vec![unescaped];
    }
    several().collect()
}

/// Reads a library that lies in the model's folder or below; the error says
/// why not, and never what was in the file.
fn read_library(source: &Source, name: &str) -> Result<Vec<tobj::Material>, String> {
    let bytes = source.sidecar(name)?;
    let text = screened(&String::from_utf8_lossy(&bytes));
    tobj::load_mtl_buf(&mut text.as_bytes())
        .map(|(materials, _)| materials)
        .map_err(|_| "is not a sound material library".into())
}

/// The statements of a library that are used, as the parser reads them surely.
fn screened(text: &str) -> String {
    text.lines().filter_map(screened_statement).collect()
}

fn screened_statement(line: &str) -> Option<String> {
    let line = line.trim();
    let (keyword, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
    let rest = rest.trim();
    let numbers: Vec<f32> = rest.split_whitespace().map_while(|word| word.parse().ok()).collect();
    match (keyword, numbers.as_slice()) {
        ("newmtl", _) if rest.is_empty() => Some("newmtl (unnamed)\n".into()),
        ("newmtl", _) => Some(format!("newmtl {rest}\n")),
        ("Ka" | "Kd" | "Ks", &[r, g, b, ..]) => Some(format!("{keyword} {r} {g} {b}\n")),
        // One number stands for all three.
        ("Ka" | "Kd" | "Ks", &[grey]) => Some(format!("{keyword} {grey} {grey} {grey}\n")),
        ("Ns" | "d", &[value, ..]) => Some(format!("{keyword} {value}\n")),
        ("Tr", &[transparency, ..]) => Some(format!("d {}\n", 1.0 - transparency)),
        ("map_Kd" | "map_kd", _) if !rest.is_empty() => Some(format!("map_Kd {rest}\n")),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::read::picture::SAMPLES;
    use crate::model::TextureSource;

    #[test]
    fn libraries_with_blanks_several_and_nameless_materials() {
        let folder = tempfile::tempdir().unwrap();
        let write =
            |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
        write("a b.mtl", "newmtl first\nKd 1 0 0\n");
        write("c.mtl", "newmtl\nKd 0 1 0\nnewmtl second\nKd 0 0 1\nnewmtl first\nKd 1 1 1\n");
        let source = Source { name: "model.obj", folder: Some(folder.path()), bytes: b"" };
        for (statement, count) in [("a b.mtl", 1), ("a\\ b.mtl", 1), ("a\\ b.mtl c.mtl", 4)] {
            let names = library_names(&source, statement);
            let found = names.iter().map(|name| read_library(&source, name).unwrap().len());
            assert_eq!(found.sum::<usize>(), count, "{statement}");
        }
        assert_eq!(library_names(&source, "x.mtl y.mtl"), ["x.mtl", "y.mtl"]);
        let named = |name: &str| Material { name: name.into(), ..Material::default() };
        let mut materials = [named("first"), named("third")];
        let mut report = Report::default();
        let libraries = [("a\\ b.mtl c.mtl".to_owned(), 3), ("none.mtl".to_owned(), 4)];
        read_materials(&source, &libraries, &mut materials, &mut report);
        assert_eq!(materials[0].diffuse, Some([1.0, 0.0, 0.0]), "the first one holds");
        assert_eq!(materials[1], named("third"));
        assert_eq!(report.warnings()[0].place, Some(Place::Line(4)));
    }

    #[test]
    fn odd_statements_cost_only_themselves() {
        let text = "newmtl a\n  Kd 0.5\nKa 1 2\nKs spectral file.rfl\nNs many\nTr 0.25\n\
            map_Kd\nillum 2\nd -halo 0.5\nKe 0.0\n";
        let text = screened(text);
        let (materials, _) = tobj::load_mtl_buf(&mut text.as_bytes()).unwrap();
        assert_eq!(materials[0].diffuse, Some([0.5; 3]));
        assert_eq!((materials[0].ambient, materials[0].specular), (None, None));
        assert_eq!((materials[0].shininess, materials[0].dissolve), (None, Some(0.75)));
    }

    #[test]
    fn options_of_textures_are_skipped() {
        for (statement, name) in [
            ("a.png", "a.png"),
            ("-s 1 1 1 a.png", "a.png"),
            ("-s 2 a.png", "a.png"),
            ("-o 0.1 -0.5 -t 1 -clamp on -bm 1 -mm 0 1 a b.png", "a b.png"),
            (
                "-blendu off -blendv off -cc on -texres 512 -boost 2 -imfchan m -type cube_top c.jpg",
                "c.jpg",
            ),
            ("-colorspace sRGB -o 0.1 diffuse.jpg", "diffuse.jpg"),
            ("-s 1 1 1 2 fast.png", "2 fast.png"),
            ("  \"C:\\maps\\a b.png\" ", "C:\\maps\\a b.png"),
            ("-unknown 1 a.png", "-unknown 1 a.png"),
            ("-clamp on", ""),
            ("-s 1 1 1", ""),
            ("", ""),
        ] {
            assert_eq!(texture_name(statement), name, "{statement}");
        }
    }

    /// The files of the textures of an OBJ file's materials, `None` where they
    /// have none, and what is told.
    fn textures(mtllib: &str, library: &str) -> (Vec<Option<String>>, Report) {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, bytes: &[u8]| {
            let path = folder.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, bytes).unwrap();
        };
        let names = ["a.png", "b c.png", "maps/a.png", "maps/d.jpg", "lib/e.png", "lib/maps/f.png"];
        names.iter().for_each(|name| write(name, SAMPLES[0]));
        write("no.tga", b"no picture that is read");
        write(mtllib, library.as_bytes());
        let source = Source { name: "model.obj", folder: Some(folder.path()), bytes: b"" };
        let mut report = Report::default();
        let materials = library.lines().filter_map(|line| line.strip_prefix("newmtl "));
        let mut materials: Vec<Material> =
            materials.map(|name| Material { name: name.into(), ..Material::default() }).collect();
        read_materials(&source, &[(mtllib.into(), 7)], &mut materials, &mut report);
        let root = folder.path().canonicalize().unwrap();
        let file = |material: &Material| match &material.diffuse_texture.as_ref()?.source {
            TextureSource::File(path) => {
                Some(path.strip_prefix(&root).unwrap().display().to_string())
            }
            TextureSource::Bytes(_) => panic!("a file is no part of the model"),
        };
        (materials.iter().map(file).collect(), report)
    }

    #[test]
    fn textures_lie_beside_the_library_or_the_model() {
        let library = "newmtl 1\nmap_Kd -s 1 1 1 -o 0 0 0 a.png\nnewmtl 2\nmap_Kd b c.png\n\
            newmtl 3\nmap_Kd maps\\d.jpg\nnewmtl 4\nmap_kd b\\ c.png\nnewmtl 5\nKd 1 1 1\n";
        let (files, report) = textures("m.mtl", library);
        let expected = [Some("a.png"), Some("b c.png"), Some("maps/d.jpg"), Some("b c.png"), None];
        assert_eq!(files, expected.map(|name| name.map(str::to_owned)));
        assert_eq!(report, Report::default());
        let library = "newmtl 1\nmap_Kd e.png\nnewmtl 2\nmap_Kd maps/f.png\nnewmtl 3\n\
            map_Kd a.png\nnewmtl 4\nmap_Kd lib/e.png\n";
        let (files, report) = textures("lib/m.mtl", library);
        let expected =
            [Some("lib/e.png"), Some("lib/maps/f.png"), Some("a.png"), Some("lib/e.png")];
        assert_eq!(files, expected.map(|name| name.map(str::to_owned)));
        assert_eq!(report, Report::default());
    }

    #[test]
    fn textures_that_are_not_opened_cost_a_warning() {
        for (statement, why) in [
            ("none.png", "texture 'none.png' of material 'm' was not found; it is left out"),
            ("-bm 1 ../a.png", "texture '../a.png' of material 'm' lies outside"),
            ("/etc/hostname", "lies outside"),
            ("no.tga", "is no PNG or JPEG picture"),
            ("maps", "is no file of a sensible size"),
            ("-s 1 1 1", "texture '' of material 'm' has no name"),
        ] {
            let (files, report) = textures("m.mtl", &format!("newmtl m\nmap_Kd {statement}\n"));
            assert_eq!(files, [None], "{statement}");
            let [warning] = report.warnings() else { panic!("{statement}: {report:?}") };
            let found = (warning.code, warning.count, warning.place.clone());
            assert_eq!(found, (WarningCode::Material, 1, Some(Place::Line(7))), "{statement}");
            assert!(warning.message.contains(why), "{}", warning.message);
        }
    }
}
