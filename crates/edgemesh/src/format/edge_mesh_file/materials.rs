//! Materials as sections: numbers, pictures and names.
//!
//! ```text
//! MTRL  colors, exponent, opacity   picture 1 ----.     picture 0
//! PEND  end 0  end 1 <----------------------------'         |
//! PICT  |bytes of picture 0|bytes of picture 1|  <----------'
//! META  names of material and texture
//! ```
//!
//! The numbers are binary, not JSON, so that they are read back bit by bit. Each picture
//! is stored once, even if several materials use it, and pictures cannot overlap, so
//! that a small file cannot demand much memory.

use std::borrow::Cow;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use rustc_hash::FxHashMap;

use super::error::{FileError, FileErrorKind};
use super::meta::MaterialNames;
use crate::index::{NONE, to_u32};
use crate::model::{Material, Texture, TextureSource};

/// The numbers of a material: 52 bytes.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(super) struct StoredMaterial {
    ambient: [f32; 3],
    diffuse: [f32; 3],
    specular: [f32; 3],
    shininess: f32,
    opacity: f32,
    /// A bit for each of these five that the material states, from bit 0; the others
    /// are 0.
    stated: u32,
    /// The index of the picture of its texture, or [`NONE`].
    pub(super) picture: u32,
}

impl StoredMaterial {
    fn new(material: &Material, picture: u32) -> Self {
        let Material { ambient, diffuse, specular, shininess, opacity, .. } = material;
        let is_stated = [
            ambient.is_some(),
            diffuse.is_some(),
            specular.is_some(),
            shininess.is_some(),
            opacity.is_some(),
        ];
        let stated =
            is_stated.iter().rev().fold(0, |bits, &is_stated| bits << 1 | u32::from(is_stated));
        Self {
            ambient: ambient.unwrap_or_default(),
            diffuse: diffuse.unwrap_or_default(),
            specular: specular.unwrap_or_default(),
            shininess: shininess.unwrap_or_default(),
            opacity: opacity.unwrap_or_default(),
            stated,
            picture,
        }
    }

    fn to_material(self, names: MaterialNames, bytes: Option<Arc<[u8]>>) -> Material {
        let is_stated = |bit: u32| self.stated >> bit & 1 == 1;
        let MaterialNames { name, texture } = names;
        Material {
            name,
            ambient: is_stated(0).then_some(self.ambient),
            diffuse: is_stated(1).then_some(self.diffuse),
            specular: is_stated(2).then_some(self.specular),
            shininess: is_stated(3).then_some(self.shininess),
            opacity: is_stated(4).then_some(self.opacity),
            diffuse_texture: bytes.map(|bytes| Texture {
                name: texture.unwrap_or_default(),
                source: TextureSource::Bytes(bytes),
            }),
        }
    }
}

/// The sections of materials.
#[derive(Debug, Default)]
pub(super) struct MaterialSections {
    pub(super) materials: Vec<StoredMaterial>,
    /// The end of each picture in `pictures`.
    pub(super) picture_ends: Vec<u64>,
    pub(super) pictures: Vec<u8>,
}

impl MaterialSections {
    /// The sections of materials whose pictures are all in memory (see
    /// [`with_pictures`]).
    pub(super) fn new(materials: &[Material]) -> Self {
        let mut sections = Self::default();
        let mut pictures = FxHashMap::default();
        for material in materials {
            let texture = material.diffuse_texture.as_ref().map(|texture| &texture.source);
            let picture = match texture {
                Some(TextureSource::Bytes(bytes)) => {
                    *pictures.entry(&**bytes).or_insert_with(|| sections.push_picture(bytes))
                }
                _ => NONE,
            };
            sections.materials.push(StoredMaterial::new(material, picture));
        }
        sections
    }

    fn push_picture(&mut self, bytes: &[u8]) -> u32 {
        self.pictures.extend_from_slice(bytes);
        self.picture_ends.push(self.pictures.len() as u64);
        to_u32(self.picture_ends.len() - 1)
    }
}

/// The materials with all pictures in memory: those in files are read.
///
/// # Errors
/// [`FileErrorKind::Texture`] if a file cannot be read.
pub(super) fn with_pictures(materials: &[Material]) -> Result<Cow<'_, [Material]>, FileError> {
    let file_of = |material: &Material| match &material.diffuse_texture {
        Some(Texture { source: TextureSource::File(path), .. }) => Some(path.clone()),
        _ => None,
    };
    if materials.iter().all(|material| file_of(material).is_none()) {
        return Ok(Cow::Borrowed(materials));
    }
    let mut pictures: FxHashMap<PathBuf, Arc<[u8]>> = FxHashMap::default();
    let mut materials = materials.to_vec();
    for material in &mut materials {
        let Some(path) = file_of(material) else { continue };
        let Some(texture) = &mut material.diffuse_texture else { continue };
        let bytes = match pictures.get(&path) {
            Some(bytes) => Arc::clone(bytes),
            None => texture.source.encoded().map_err(|error| {
                let (name, of) = (&texture.name, &material.name);
                let what = format!(
                    "texture '{name}' of material '{of}' cannot be read: {error}; \
                     put it back, or remove it from the material"
                );
                FileError::new(FileErrorKind::Texture, what)
            })?,
        };
        texture.source = TextureSource::Bytes(Arc::clone(&bytes));
        pictures.insert(path, bytes);
    }
    Ok(Cow::Owned(materials))
}

/// The materials of checked sections.
pub(super) fn to_materials(
    materials: &[StoredMaterial],
    picture_ends: &[u64],
    pictures: &[u8],
    names: Vec<MaterialNames>,
) -> Vec<Material> {
    let starts = std::iter::once(&0).chain(picture_ends);
    let range = |(&start, &end): (&u64, &u64)| -> Option<Range<usize>> {
        Some(usize::try_from(start).ok()?..usize::try_from(end).ok()?)
    };
    let bytes = |ends| range(ends).and_then(|range| pictures.get(range)).unwrap_or_default();
    let pictures: Vec<Arc<[u8]>> =
        starts.zip(picture_ends).map(|ends| bytes(ends).into()).collect();
    let of = |(material, names): (&StoredMaterial, MaterialNames)| {
        material.to_material(names, pictures.get(material.picture as usize).cloned())
    };
    materials.iter().zip(names).map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn textured(name: &str, source: TextureSource) -> Material {
        let texture = Texture { name: format!("{name}.png"), source };
        Material { name: name.into(), diffuse_texture: Some(texture), ..Material::default() }
    }

    fn bytes(bytes: &[u8]) -> TextureSource {
        TextureSource::Bytes(bytes.into())
    }

    fn names(material: &Material) -> MaterialNames {
        MaterialNames::of(material)
    }

    #[test]
    fn values_that_are_not_stated_stay_unstated() {
        let whole = Material {
            name: "whole".into(),
            ambient: Some([0.1, 0.2, 0.3]),
            diffuse: Some([0.4, 0.5, 0.6]),
            specular: Some([0.7, 0.8, 0.9]),
            shininess: Some(f32::INFINITY),
            opacity: Some(-0.0),
            diffuse_texture: None,
        };
        let materials = [
            Material::default(),
            Material { ambient: None, specular: None, opacity: None, ..whole.clone() },
            Material { diffuse: None, shininess: None, ..whole.clone() },
            whole,
        ];
        let sections = MaterialSections::new(&materials);
        assert_eq!(sections.materials[0], StoredMaterial { picture: NONE, ..Zeroable::zeroed() });
        let stated: Vec<u32> = sections.materials.iter().map(|material| material.stated).collect();
        assert_eq!(stated, [0, 0b0_1010, 0b1_0101, 0b1_1111]);
        let names = materials.iter().map(names).collect();
        assert_eq!(to_materials(&sections.materials, &[], &[], names), materials);
    }

    #[test]
    fn a_picture_is_stored_once() {
        let materials =
            [("a", b"one".as_slice()), ("b", b""), ("c", b"three"), ("d", b"one"), ("e", b"")]
                .map(|(name, picture)| textured(name, bytes(picture)));
        let sections = MaterialSections::new(&materials);
        assert_eq!(
            (sections.pictures.as_slice(), sections.picture_ends.as_slice()),
            (&b"onethree"[..], &[3, 3, 8][..])
        );
        let pictures: Vec<u32> =
            sections.materials.iter().map(|material| material.picture).collect();
        assert_eq!(pictures, [0, 1, 2, 0, 1]);
        let names = materials.iter().map(names).collect();
        let found =
            to_materials(&sections.materials, &sections.picture_ends, &sections.pictures, names);
        assert_eq!(found, materials);
    }

    #[test]
    fn files_are_read_once_and_stored() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        std::fs::write(&path, b"picture").unwrap();
        let file = || TextureSource::File(path.clone());
        let materials = [textured("a", file()), Material::default(), textured("b", file())];
        let found = with_pictures(&materials).unwrap();
        let expected = [
            textured("a", bytes(b"picture")),
            Material::default(),
            textured("b", bytes(b"picture")),
        ];
        assert_eq!(*found, expected);
        assert!(
            matches!(with_pictures(&found), Ok(Cow::Borrowed(_))),
            "all pictures are in memory"
        );
        drop(folder);
        let error = with_pictures(&materials).unwrap_err();
        assert_eq!((error.kind, error.place.clone()), (FileErrorKind::Texture, None));
        let what = error.to_string();
        assert!(what.starts_with("texture 'a.png' of material 'a' cannot be read: "), "{what}");
    }
}
