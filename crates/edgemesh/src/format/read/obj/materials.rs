//! The materials that an OBJ file uses, from its libraries and their textures.

use rustc_hash::FxHashMap;

use super::mtl::{map_file, parse_mtl};
use crate::format::read::picture::picture_beside;
use crate::format::read::source::Source;
use crate::model::{Material, Texture};
use crate::report::{Place, Report, WarningCode};

/// Fills in `materials` by name from the libraries of the `mtllib` statements, given
/// with their lines. If several materials have one name, the first counts. Warns
/// of libraries and textures that cannot be read.
pub(super) fn read_materials(
    source: &Source,
    statements: &[(String, u32)],
    materials: &mut [Material],
    report: &mut Report,
) {
    let mut by_name = FxHashMap::default();
    for &(ref statement, line) in statements {
        for library in library_names(source, statement) {
            match source.sidecar(&library) {
                Ok(bytes) => {
                    for material in parse_mtl(&String::from_utf8_lossy(&bytes)) {
                        let folder = folder_in_name(&library).to_owned();
                        let name = material.material.name.clone();
                        by_name.entry(name).or_insert((material, folder, line));
                    }
                }
                Err(why) => report.warn(WarningCode::Material, Some(Place::Line(line)), || {
                    format!("material library '{library}' {why}; its materials were left out")
                }),
            }
        }
    }
    // Many materials share a texture.
    let mut textures = FxHashMap::default();
    for material in materials {
        let Some((found, folder, line)) = by_name.get(&material.name) else { continue };
        *material = found.material.clone();
        let Some(statement) = &found.diffuse_map else { continue };
        let texture = textures.entry((folder, statement));
        match texture.or_insert_with(|| find_texture(source, folder, statement)) {
            Ok(texture) => material.diffuse_texture = Some(texture.clone()),
            Err(why) => report.warn(WarningCode::Material, Some(Place::Line(*line)), || {
                let (name, of) = (map_file(statement), &material.name);
                format!("texture '{name}' of material '{of}' {why}; it was left out")
            }),
        }
    }
}

/// Looks for a texture beside its library, then in the model's folder, where many
/// programs expect it. A backslash before a blank is an escape in some files, and
/// the end of a folder's name in others.
fn find_texture(source: &Source, folder: &str, statement: &str) -> Result<Texture, String> {
    let name = map_file(statement);
    if name.is_empty() {
        return Err("has no file name".into());
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

/// The folder in a file's name, with its last slash; may be empty.
fn folder_in_name(name: &str) -> &str {
    let end = name.rfind(['/', '\\']).map_or(0, |slash| slash + 1);
    &name[..end]
}

/// The files that an `mtllib` statement names: one file, whose name may hold blanks,
/// or several, in whose names a backslash precedes each blank.
fn library_names(source: &Source, rest: &str) -> Vec<String> {
    // Cannot be in a file name.
    const ESCAPED_BLANK: &str = "\0";
    let unescaped = rest.replace("\\ ", " ");
    let escaped = rest.replace("\\ ", ESCAPED_BLANK);
    let several = || escaped.split_whitespace().map(|name| name.replace(ESCAPED_BLANK, " "));
    if several().count() < 2 || source.sidecar_path(&unescaped).is_ok() {
        return vec![unescaped];
    }
    several().collect()
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
            let bytes = names.iter().map(|name| source.sidecar(name).unwrap());
            let text = String::from_utf8(bytes.collect::<Vec<_>>().concat()).unwrap();
            assert_eq!(parse_mtl(&text).len(), count, "{statement}");
        }
        assert_eq!(library_names(&source, "x.mtl y.mtl"), ["x.mtl", "y.mtl"]);
        let named = |name: &str| Material { name: name.into(), ..Material::default() };
        let mut materials = [named("first"), named("third")];
        let mut report = Report::default();
        let libraries = [("a\\ b.mtl c.mtl".to_owned(), 3), ("none.mtl".to_owned(), 4)];
        read_materials(&source, &libraries, &mut materials, &mut report);
        assert_eq!(materials[0].diffuse, Some([1.0, 0.0, 0.0]), "the first one counts");
        assert_eq!(materials[1], named("third"));
        assert_eq!(report.warnings()[0].place, Some(Place::Line(4)));
    }

    /// The files of the textures of an OBJ file's materials, in the model's folder, and
    /// the warnings.
    fn textures(mtllib: &str, library: &str) -> (Vec<Option<String>>, Report) {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, bytes: &[u8]| {
            let path = folder.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, bytes).unwrap();
        };
        let names = ["a.png", "b c.png", "maps/a.png", "maps/d.jpg", "lib/e.png", "lib/maps/f.png"];
        names.iter().for_each(|name| write(name, SAMPLES[0]));
        write("no.tga", b"not a picture");
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
            TextureSource::Bytes(_) => panic!("a file is not stored in the model"),
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
    fn textures_that_are_not_found_give_a_warning() {
        for (statement, why) in [
            ("none.png", "texture 'none.png' of material 'm' was not found; it was left out"),
            ("-bm 1 ../a.png", "texture '../a.png' of material 'm' lies outside"),
            ("/etc/hostname", "lies outside"),
            ("no.tga", "is not a PNG or JPEG picture"),
            ("maps", "is not a regular file"),
            ("-s 1 1 1", "texture '' of material 'm' has no file name"),
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
