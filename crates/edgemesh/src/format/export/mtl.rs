//! MTL: the material library of an exported OBJ file.
//!
//! Source: Alias|Wavefront, *Advanced Visualizer Manual*, appendix B2: `newmtl`, `Ka`, `Kd`, `Ks`,
//! `Ns`, `d`, `map_Kd`.
//!
//! A texture is named only if its picture is a file in the folder of the library or below: readers
//! look nowhere else. Other textures are left out and reported. Rejected: copies of the pictures
//! beside the library, because an export would overwrite files that nobody named.

use std::fmt::Write as _;
use std::path::Path;

use super::names::{MaterialNames, statement_name};
use crate::model::{Material, Texture, TextureSource};
use crate::report::{Report, WarningCode};

/// What a library begins with.
pub const LIBRARY_HEAD: &[u8; 11] = b"# Edgemesh ";

/// The text of a library with `materials` for the folder `folder`; textures that it cannot name
/// are warnings.
pub(super) fn library(materials: &[Material], folder: &Path, report: &mut Report) -> String {
    let names = MaterialNames::of(materials);
    let mut text = format!("# Edgemesh {}\n", env!("CARGO_PKG_VERSION"));
    for (number, material) in materials.iter().enumerate() {
        let _ = writeln!(text, "newmtl {}", names.name(crate::index::to_u32(number)));
        let Material { ambient, diffuse, specular, .. } = material;
        for (keyword, color) in [("Ka", ambient), ("Kd", diffuse), ("Ks", specular)] {
            if let Some([red, green, blue]) = color {
                let _ = writeln!(text, "{keyword} {red} {green} {blue}");
            }
        }
        for (keyword, number) in [("Ns", material.shininess), ("d", material.opacity)] {
            if let Some(number) = number {
                let _ = writeln!(text, "{keyword} {number}");
            }
        }
        let Some(texture) = &material.diffuse_texture else { continue };
        match file_below(texture, folder) {
            Some(file) => {
                let _ = writeln!(text, "map_Kd {file}");
            }
            None => report.warn(WarningCode::Material, None, || {
                let name = &texture.name;
                format!(
                    "the texture '{name}' is no file in the folder of the export, so it was left \
                     out; export as .glb to keep it"
                )
            }),
        }
    }
    text
}

/// The path of a picture from `folder`, if it is a file there or below whose name fits a line.
fn file_below(texture: &Texture, folder: &Path) -> Option<String> {
    let TextureSource::File(path) = &texture.source else { return None };
    let [path, folder] = [path, folder].map(|path| path.canonicalize().ok());
    let path = path?;
    let parts = path.strip_prefix(folder?).ok()?.iter().map(|part| part.to_str());
    let file = parts.collect::<Option<Vec<&str>>>()?.join("/");
    (file == statement_name(&file)).then_some(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colors_and_files_in_the_folder_are_named() {
        let folder = tempfile::tempdir().unwrap();
        let below = folder.path().join("maps");
        std::fs::create_dir(&below).unwrap();
        let picture = below.join("bark 1.png");
        std::fs::write(&picture, "picture").unwrap();
        let texture = |source| Some(Texture { name: "bark".into(), source });
        let bark = Material {
            name: "bark".into(),
            diffuse: Some([1.0, 0.5, 0.0]),
            shininess: Some(30.0),
            opacity: Some(0.25),
            diffuse_texture: texture(TextureSource::File(picture)),
            ..Material::default()
        };
        let inside = texture(TextureSource::Bytes(b"picture".as_slice().into()));
        let other = Material { diffuse_texture: inside, ..Material::default() };
        let mut report = Report::default();
        let text = library(&[bark.clone(), other], folder.path(), &mut report);
        let rows: Vec<&str> = text.lines().skip(1).collect();
        let expected =
            ["newmtl bark", "Kd 1 0.5 0", "Ns 30", "d 0.25", "map_Kd maps/bark 1.png", "newmtl _1"];
        assert_eq!(rows, expected);
        assert_eq!(report.count(WarningCode::Material), 1);
        library(&[bark], &below.join(".."), &mut report);
        assert_eq!(report.count(WarningCode::Material), 1, "the same folder");
    }
}
