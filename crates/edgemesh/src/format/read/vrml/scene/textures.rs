//! Textures: `ImageTexture` (VRML 97 6.22) and `Texture2` (VRML 1.0).
//!
//! As with inlined files, only pictures in the folder of the file or below are opened, and
//! the first that exists is used. Each node is read once, even if several shapes use it.

use super::scene_builder::SceneBuilder;
use crate::format::read::picture::picture_beside;
use crate::format::read::vrml::parse::NodeRef;
use crate::format::read::words::quoted;
use crate::model::Texture;
use crate::report::WarningCode;

impl SceneBuilder<'_> {
    /// The texture of a node, whose `field` names files; `None` if none of them can be
    /// used, with a warning.
    pub(super) fn texture(&mut self, node: NodeRef, field: &str) -> Option<Texture> {
        let key = node.key();
        if let Some(texture) = self.textures.get(&key) {
            return texture.clone();
        }
        let texture = self.find_texture(node, field);
        self.textures.insert(key, texture.clone());
        texture
    }

    fn find_texture(&mut self, node: NodeRef, field: &str) -> Option<Texture> {
        let mut left_out = None;
        for url in node.words(field).filter(|url| !url.is_empty()) {
            match picture(node, url) {
                Ok(texture) => return Some(texture),
                Err(why) => {
                    left_out = left_out.or_else(|| {
                        Some(format!("texture {} {why}; it was left out", quoted(url.as_bytes())))
                    });
                }
            }
        }
        if let Some(message) = left_out {
            self.warn(node, WarningCode::Material, || message);
        } else if !node.numbers("image").values.is_empty() {
            self.warn(node, WarningCode::Unsupported, || {
                format!("the pixels of a {} are not supported; they were left out", node.kind())
            });
        }
        None
    }
}

/// The picture at `url`, relative to the file of `node`.
fn picture(node: NodeRef, url: &str) -> Result<Texture, String> {
    if url.contains("://") || url.starts_with("urn:") {
        return Err("is on the network and was not fetched".into());
    }
    picture_beside(&node.document.origin.source(), url)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use crate::format::read::picture::SAMPLES;
    use crate::format::read::read_model;
    use crate::model::{Material, Texture, TextureSource};
    use crate::report::{Report, WarningCode};

    /// The materials of a scene beside two pictures, `a.png` and `maps/b.jpg`.
    fn materials(text: &str) -> (Vec<Material>, Report) {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("maps")).unwrap();
        fs::write(folder.path().join("a.png"), SAMPLES[0]).unwrap();
        fs::write(folder.path().join("maps/b.jpg"), SAMPLES[1]).unwrap();
        fs::write(folder.path().join("c.gif"), b"GIF89a").unwrap();
        let path = folder.path().join("scene.wrl");
        let header = if text.starts_with("#VRML") { "" } else { "#VRML V2.0 utf8\n" };
        fs::write(&path, format!("{header}{text}")).unwrap();
        let (model, report) = read_model(&path).unwrap();
        let folder = folder.path().canonicalize().unwrap();
        let relative = |material: &Material| {
            let mut material = material.clone();
            if let Some(Texture { source: TextureSource::File(path), .. }) =
                &mut material.diffuse_texture
            {
                *path = path.strip_prefix(&folder).unwrap().into();
            }
            material
        };
        (model.materials.iter().map(relative).collect(), report)
    }

    fn texture(name: &str) -> Option<Texture> {
        Some(Texture { name: name.into(), source: TextureSource::File(name.into()) })
    }

    fn shape(texture: &str) -> String {
        format!("Shape {{ appearance Appearance {{ texture {texture} }} geometry Box {{ }} }} ")
    }

    #[test]
    fn pictures_are_files_beside_the_scene() {
        let texture_of = |url: &str| {
            let (materials, report) = materials(&shape(&format!("ImageTexture {{ url {url} }}")));
            assert!(report.warnings().is_empty(), "{report:?}");
            materials[0].diffuse_texture.clone()
        };
        assert_eq!(texture_of("\"a.png\""), texture("a.png"));
        assert_eq!(texture_of("[ \"none.png\" \"\" \"maps/b.jpg\" ]"), texture("maps/b.jpg"));
        let (materials, report) = materials(
            "#VRML V1.0 ascii\nMaterial { } Texture2 { filename \"a.png\" } Cube { }
             Texture2 { filename \"\" } Cube { }",
        );
        let textures: Vec<_> = materials.iter().map(|m| m.diffuse_texture.clone()).collect();
        assert_eq!((textures, report), (vec![texture("a.png"), None], Report::default()));
    }

    #[test]
    fn missing_pictures_give_a_warning() {
        for (node, why) in [
            ("ImageTexture { url \"none.png\" }", "texture 'none.png' was not found"),
            ("ImageTexture { url [ \"../x.png\" \"none.png\" ] }", "lies outside"),
            ("ImageTexture { url \"http://example.org/a.png\" }", "was not fetched"),
            ("MovieTexture { url \"c.gif\" }", "is not a PNG or JPEG picture"),
        ] {
            let (materials, report) = materials(&shape(node));
            assert!(materials.is_empty(), "{node}: no other property");
            let [warning] = report.warnings() else { panic!("{node}: {report:?}") };
            assert_eq!((warning.code, warning.count), (WarningCode::Material, 1), "{node}");
            assert!(warning.message.contains(why), "{node}: {}", warning.message);
        }
        let shared = shape("DEF T ImageTexture { url \"none.png\" }") + &shape("USE T");
        assert_eq!(materials(&shared).1.count(WarningCode::Material), 1, "read once");
        let (_, report) = materials(&shape("PixelTexture { image 1 1 1 255 }"));
        assert_eq!(report.count(WarningCode::Unsupported), 1);
    }

    #[test]
    fn transforms_of_textures_give_a_warning() {
        let (materials, report) = materials(&shape(
            "ImageTexture { url \"a.png\" } textureTransform TextureTransform { scale 2 2 }",
        ));
        assert_eq!(materials[0].diffuse_texture, texture("a.png"));
        assert_eq!(report.count(WarningCode::Unsupported), 1, "{report:?}");
        let text = "Texture2 { filename \"a.png\" } Texture2Transform { } Cube { }";
        let (_, report) = self::materials(&format!("#VRML V1.0 ascii\n{text}"));
        assert_eq!(report.count(WarningCode::Unsupported), 1, "{report:?}");
    }
}
