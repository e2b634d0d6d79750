//! MTL through `tobj`, behind a screen of its own.
//!
//! A material library must never stop geometry, and `tobj` gives up a whole one
//! for a material without a name, and panics at a colour of fewer than three
//! numbers. So only the statements that are used reach it, each in sound form.

use std::fs;
use std::path::{Component, Path};

use super::MAX_FILE_BYTES;

/// The files that an `mtllib` statement names: a single one, whose name may hold
/// blanks, or several, where blanks in a name stand behind a backslash.
pub(super) fn library_names(model_path: &Path, rest: &str) -> Vec<String> {
    // No file name holds this, as no text does.
    const ESCAPED_BLANK: &str = "\0";
    let unescaped = rest.replace("\\ ", " ");
    let escaped = rest.replace("\\ ", ESCAPED_BLANK);
    let several = || escaped.split_whitespace().map(|name| name.replace(ESCAPED_BLANK, " "));
    if several().count() < 2 || read_library(model_path, &unescaped).is_ok() {
        return vec![unescaped];
    }
    several().collect()
}

/// Reads a library that lies in the model's folder or below; the error says
/// why not, and never what was in the file.
pub(super) fn read_library(model_path: &Path, name: &str) -> Result<Vec<tobj::Material>, String> {
    let relative = name.replace('\\', "/");
    let relative = Path::new(&relative);
    let stays_inside =
        relative.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
    if !stays_inside {
        return Err("lies outside the model's folder and was not opened".into());
    }
    let folder = match model_path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let folder = folder.canonicalize().map_err(|error| error.to_string())?;
    let target = folder.join(relative).canonicalize().map_err(|_| "was not found".to_owned())?;
    if !target.starts_with(&folder) {
        return Err("lies outside the model's folder and was not opened".into());
    }
    let metadata = fs::metadata(&target).map_err(|error| error.to_string())?;
    if !metadata.is_file() || metadata.len() > MAX_FILE_BYTES {
        return Err("is no file of a sensible size".into());
    }
    let bytes = fs::read(&target).map_err(|error| error.to_string())?;
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
        let model = folder.path().join("model.obj");
        let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
        write("a b.mtl", "newmtl first\nKd 1 0 0\n");
        write("c.mtl", "newmtl\nKd 0 1 0\nnewmtl second\nKd 0 0 1\n");
        for (statement, count) in [("a b.mtl", 1), ("a\\ b.mtl", 1), ("a\\ b.mtl c.mtl", 3)] {
            let names = library_names(&model, statement);
            let found = names.iter().map(|name| read_library(&model, name).unwrap().len());
            assert_eq!(found.sum::<usize>(), count, "{statement}");
        }
        assert_eq!(library_names(&model, "x.mtl y.mtl"), ["x.mtl", "y.mtl"]);
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
    fn libraries_outside_the_folder_are_not_opened() {
        for name in ["../secret.mtl", "/etc/hostname", "..\\secret.mtl"] {
            let why = read_library(Path::new("model.obj"), name).unwrap_err();
            assert!(why.contains("outside"), "{name}: {why}");
        }
        assert!(read_library(Path::new("model.obj"), "none.mtl").unwrap_err().contains("found"));
    }
}
