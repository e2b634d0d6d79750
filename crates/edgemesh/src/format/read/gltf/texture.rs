//! The textures of base colors: pictures in buffer views, in data URIs, or in files
//! beside the model.
//!
//! Based on: glTF 2.0, section 3.8 (textures and images).
//!
//! A fault in a texture or its picture costs the texture, with a warning. Each picture
//! is read once, even if several materials use it. Views may overlap, so the bytes
//! copied from them are limited to the bytes of the files.

use std::collections::HashMap;

use gltf_json as json;
use serde::Deserialize;

use super::super::picture::{picture_beside, picture_of_bytes};
use super::asset::Asset;
use super::uri::{UriTarget, resolve};
use crate::model::Texture;
use crate::report::{Place, Report, WarningCode};

/// An extension that moves texture coordinates.
const TRANSFORM: &str = "KHR_texture_transform";

/// An element of `textures`.
#[derive(Deserialize)]
struct JsonTexture {
    /// The index of its image; extensions may state one instead.
    source: Option<usize>,
}

/// An element of `images`.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct JsonImage<'a> {
    name: Option<&'a str>,
    uri: Option<&'a str>,
    buffer_view: Option<usize>,
}

/// The pictures that were read so far.
#[derive(Debug, Default)]
pub(super) struct PictureCache {
    /// By the index of the image; `None` for one with a fault.
    pictures: HashMap<usize, Option<Texture>>,
    /// The bytes that were copied from views.
    copied_bytes: usize,
}

impl PictureCache {
    /// The texture of the base color of a material.
    pub(super) fn base_color_texture(
        &mut self,
        asset: &Asset,
        material: usize,
        info: &json::texture::Info,
        report: &mut Report,
    ) -> Option<Texture> {
        let part = || format!("materials[{material}].pbrMetallicRoughness.baseColorTexture");
        let extensions = info.extensions.as_ref();
        let transform = extensions.and_then(|extensions| extensions.others.get(TRANSFORM));
        let moved_set = transform.and_then(|transform| transform.get("texCoord")?.as_u64());
        let set = moved_set.unwrap_or(info.tex_coord.into());
        if set != 0 {
            report.warn(WarningCode::Unsupported, Some(Place::Part(part())), || {
                format!(
                    "uses texture coordinate set {set}; only set 0 is supported, so it was left out"
                )
            });
            return None;
        }
        if transform.is_some() {
            report.warn(WarningCode::Unsupported, Some(Place::Part(part())), || {
                format!("{TRANSFORM} is not supported; the texture was not transformed")
            });
        }
        let texture = info.index.value();
        let image =
            asset.image_of(texture).map_err(|(place, what)| warn_left_out(report, place, &what));
        let image = image.ok()?;
        if let Some(picture) = self.pictures.get(&image) {
            return picture.clone();
        }
        let picture = self.read_picture(asset, image);
        let picture =
            picture.map_err(|what| warn_left_out(report, format!("images[{image}]"), &what)).ok();
        self.pictures.insert(image, picture.clone());
        picture
    }

    /// The picture of an image; the error follows its place in a sentence.
    fn read_picture(&mut self, asset: &Asset, image: usize) -> Result<Texture, String> {
        let JsonImage { name, uri, buffer_view } = element(&asset.document.images, image)?;
        let picture_name = || match name {
            Some(name) if !name.is_empty() => name.to_owned(),
            _ => format!("images[{image}]"),
        };
        match (uri, buffer_view) {
            (Some(uri), _) => match resolve(uri)? {
                UriTarget::Bytes(bytes) => picture_of_bytes(&picture_name(), bytes),
                UriTarget::Path(path) => picture_beside(asset.source, &path)
                    .map_err(|why| format!("names '{path}', which {why}")),
            },
            (None, Some(view)) => {
                let part = || format!("images[{image}].bufferView");
                let bytes = asset.view(view, &part).map_err(|error| error.what)?;
                self.copied_bytes = self.copied_bytes.saturating_add(bytes.len());
                if self.copied_bytes > asset.budget.bytes() {
                    return Err("shares its bytes with too many other images".into());
                }
                picture_of_bytes(&picture_name(), bytes)
            }
            (None, None) => Err("has neither a URI nor a buffer view".into()),
        }
    }
}

impl Asset<'_> {
    /// The image of a texture; the error is a place and the sentence that follows it.
    fn image_of(&self, texture: usize) -> Result<usize, (String, String)> {
        let place = || format!("textures[{texture}]");
        let found: JsonTexture =
            element(&self.document.textures, texture).map_err(|what| (place(), what))?;
        found.source.ok_or_else(|| (place(), "has no PNG or JPEG picture".into()))
    }
}

/// An element of a list of the JSON; the error follows its place in a sentence.
fn element<'a, T: Deserialize<'a>>(list: &'a serde_json::Value, index: usize) -> Result<T, String> {
    let element = list.get(index).ok_or("does not exist")?;
    T::deserialize(element).map_err(|error| format!("is malformed: {error}"))
}

fn warn_left_out(report: &mut Report, place: String, what: &str) {
    report.warn(WarningCode::Material, Some(Place::Part(place)), || {
        format!("{what}; the texture was left out")
    });
}

#[cfg(test)]
mod tests {
    use std::fs;

    use base64::Engine as _;
    use base64::engine::general_purpose::STANDARD;
    use serde_json::{Value, json};

    use super::super::super::picture::SAMPLES;
    use super::super::super::source::Source;
    use super::super::sample::{SQUARE, Sample, joined, read_source};
    use super::*;
    use crate::model::{Model, TextureSource};

    /// The JSON of a file with a triangle for each of these materials.
    fn triangles(sample: &mut Sample, materials: &[Value]) -> Value {
        let positions = sample.floats("VEC3", &SQUARE[..3]);
        let texcoords = sample.floats("VEC2", &[[0.0, 0.0]; 3]);
        let attributes = json!({"POSITION": positions, "TEXCOORD_0": texcoords});
        let primitive = |material| json!({"attributes": attributes, "material": material});
        let primitives: Vec<Value> = (0..materials.len()).map(primitive).collect();
        json!({
            "nodes": [{"mesh": 0}], "meshes": [{"primitives": primitives}],
            "materials": materials
        })
    }

    fn textured(texture: &Value) -> Value {
        json!({"pbrMetallicRoughness": {"baseColorTexture": texture}})
    }

    /// The texture of a file with one triangle and this texture, in a folder with the
    /// file `a beside.png`, and the warnings.
    fn read(texture: &Value, textures: &Value, images: &Value) -> (Option<Texture>, Report) {
        let mut sample = Sample::default();
        // The view and the accessor before those of the triangle.
        sample.view(SAMPLES[1], &json!({}));
        let mut rest = triangles(&mut sample, &[textured(texture)]);
        rest["textures"] = textures.clone();
        rest["images"] = images.clone();
        rest["extensionsUsed"] = json!([TRANSFORM]);
        let (model, report) = read_beside(&sample.json(&rest));
        (model.materials[0].diffuse_texture.clone(), report)
    }

    fn read_beside(json: &Value) -> (Model, Report) {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("a beside.png"), SAMPLES[0]).unwrap();
        fs::write(folder.path().join("c.ktx2"), b"\xabKTX 20\xbb").unwrap();
        let text = json.to_string();
        let source =
            Source { name: "test.gltf", folder: Some(folder.path()), bytes: text.as_bytes() };
        read_source(&source).unwrap()
    }

    #[test]
    fn pictures_come_from_three_places() {
        let data = format!("data:image/png;base64,{}", STANDARD.encode(SAMPLES[0]));
        let of = |image: Value| {
            let (texture, report) =
                read(&json!({"index": 1}), &json!([{}, {"source": 0}]), &json!([image]));
            assert_eq!(report, Report::default(), "{image}");
            texture.unwrap()
        };
        let bytes = |name: &str, bytes: &[u8]| Texture {
            name: name.into(),
            source: TextureSource::Bytes(bytes.into()),
        };
        assert_eq!(of(json!({"uri": data})), bytes("images[0]", SAMPLES[0]));
        let in_view = json!({"name": "bark", "bufferView": 0, "mimeType": "image/jpeg"});
        assert_eq!(of(in_view), bytes("bark", SAMPLES[1]));
        let beside = of(json!({"uri": "a%20beside.png", "name": "bark"}));
        assert_eq!(beside.name, "a beside.png");
        let TextureSource::File(path) = beside.source else { panic!("{beside:?}") };
        assert!(path.is_absolute() && path.ends_with("a beside.png"), "{path:?}");
    }

    #[test]
    fn a_texture_with_a_fault_is_left_out_with_a_warning() {
        let [one, first] = [json!({"index": 0}), json!([{"source": 0}])];
        for (textures, images, place, what) in [
            (json!([]), json!([]), "textures[0]", "does not exist"),
            (json!(7), json!([]), "textures[0]", "does not exist"),
            (json!([{"source": "x"}]), json!([]), "textures[0]", "is malformed"),
            (json!([{"extensions": {}}]), json!([]), "textures[0]", "no PNG or JPEG picture"),
            (first.clone(), json!([]), "images[0]", "does not exist"),
            (first.clone(), json!([{}]), "images[0]", "neither a URI nor a buffer view"),
            (first.clone(), json!([{"uri": 1}]), "images[0]", "is malformed"),
            (first.clone(), json!([{"uri": "none.png"}]), "images[0]", "was not found"),
            (first.clone(), json!([{"uri": "../a.png"}]), "images[0]", "lies outside"),
            (first.clone(), json!([{"uri": "c.ktx2"}]), "images[0]", "is not a PNG or JPEG"),
            (first.clone(), json!([{"uri": "http://a/b.png"}]), "images[0]", "not opened"),
            (first.clone(), json!([{"uri": "data:;base64,AAAA"}]), "images[0]", "is not a PNG"),
            (first.clone(), json!([{"bufferView": 9}]), "images[0]", "there are 3"),
            (first.clone(), json!([{"bufferView": 1}]), "images[0]", "is not a PNG or JPEG"),
        ] {
            let (texture, report) = read(&one, &textures, &images);
            assert_eq!(texture, None, "{textures} {images}");
            let warning =
                report.warnings().iter().find(|warning| warning.code == WarningCode::Material);
            let warning = warning.unwrap_or_else(|| panic!("{textures} {images}: {report:?}"));
            assert_eq!((warning.count, &warning.place), (1, &Some(Place::Part(place.into()))));
            assert!(warning.message.contains(what), "{textures} {images}: {}", warning.message);
        }
    }

    #[test]
    fn other_texture_coordinates_give_a_warning() {
        let of = |texture: Value| {
            let images = json!([{"bufferView": 0}]);
            let (texture, report) = read(&texture, &json!([{"source": 0}]), &images);
            (texture.is_some(), report.count(WarningCode::Unsupported))
        };
        assert_eq!(of(json!({"index": 0, "texCoord": 0})), (true, 0));
        assert_eq!(of(json!({"index": 0, "texCoord": 1})), (false, 1));
        let moved = |set: Value, moved: Value| {
            let mut texture = json!({"index": 0, "texCoord": set});
            texture["extensions"][TRANSFORM] = moved;
            of(texture)
        };
        assert_eq!(moved(json!(0), json!({"scale": [2, 2]})), (true, 1), "without the transform");
        assert_eq!(moved(json!(1), json!({"texCoord": 0})), (true, 1), "the extension wins");
        assert_eq!(moved(json!(0), json!({"texCoord": 1})), (false, 1));
    }

    #[test]
    fn a_picture_is_read_once() {
        let mut sample = Sample::default();
        let view = sample.view(SAMPLES[0], &json!({}));
        let materials = [0, 1, 2].map(|index| textured(&json!({"index": index})));
        let textures = json!({
            "textures": [{"source": 0}, {"source": 0}, {"source": 1}],
            "images": [{"bufferView": view}, {"uri": "none.png"}]
        });
        let rest = triangles(&mut sample, &[&materials[..], &materials[..]].concat());
        let (model, report) = read_beside(&sample.json(&joined(rest, &textures)));
        let sources: Vec<_> = model.materials.iter().map(|m| m.diffuse_texture.clone()).collect();
        assert_eq!((sources[0].is_some(), &sources[0]), (true, &sources[1]));
        assert_eq!((&sources[2], &sources[4]), (&None, &sources[0]));
        assert_eq!(report.count(WarningCode::Material), 1, "once for all: {report:?}");
        assert_eq!(model.runs.len(), 6);
    }

    #[test]
    fn overlapping_views_are_limited() {
        let mut sample = Sample::default();
        let large = [SAMPLES[0], &vec![0; 4000]].concat();
        let view = sample.view(&large, &json!({}));
        let numbers = 0..1000;
        let materials: Vec<Value> =
            numbers.clone().map(|index| textured(&json!({"index": index}))).collect();
        let textures: Vec<Value> = numbers.clone().map(|index| json!({"source": index})).collect();
        let images: Vec<Value> = numbers.map(|_| json!({"bufferView": view})).collect();
        let rest = triangles(&mut sample, &materials);
        let json = sample.json(&joined(rest, &json!({"textures": textures, "images": images})));
        let (model, report) = read_beside(&json);
        let count = model.materials.iter().filter(|m| m.diffuse_texture.is_some()).count();
        assert!(count > 0 && count * 4000 < json.to_string().len() + 6000, "{count}");
        assert_eq!(report.count(WarningCode::Material), 1000 - count);
    }
}
