//! MTL through `tobj`, behind a screen of its own.
//!
//! A material library must never stop geometry, and `tobj` gives up a whole one
//! for a material without a name, and panics at a colour of fewer than three
//! numbers. So only the statements that are used reach it, each in sound form.

use rustc_hash::FxHashMap;

use super::source::Source;
use crate::model::Material;
use crate::report::{Place, Report, WarningCode};

/// Gives `materials` the colours that libraries have under their names; the
/// first one of a name holds. `libraries` are `mtllib` statements with their
/// lines.
pub(super) fn read_materials(
    source: &Source,
    libraries: &[(String, u32)],
    materials: &mut [Material],
    report: &mut Report,
) {
    let mut by_name = FxHashMap::default();
    for (statement, line) in libraries {
        for name in library_names(source, statement) {
            match read_library(source, &name) {
                Ok(known) => {
                    for material in known {
                        by_name.entry(material.name.clone()).or_insert(material);
                    }
                }
                Err(why) => report.warn(WarningCode::Material, Some(Place::Line(*line)), || {
                    format!("material library '{name}' {why}; its colours are left out")
                }),
            }
        }
    }
    for material in materials {
        if let Some(known) = by_name.get(&material.name) {
            *material = material_of(known);
        }
    }
}

fn material_of(material: &tobj::Material) -> Material {
    Material {
        name: material.name.clone(),
        ambient: material.ambient,
        diffuse: material.diffuse,
        specular: material.specular,
        shininess: material.shininess,
        opacity: material.dissolve,
        diffuse_texture: material.diffuse_texture.clone(),
    }
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
        ("map_Kd", _) if !rest.is_empty() => Some(format!("map_Kd {rest}\n")),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
}
