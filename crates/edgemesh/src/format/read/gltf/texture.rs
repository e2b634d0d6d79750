//! The picture of a base colour: in a view of a buffer, in the JSON itself, or
//! in a file beside it.
//!
//! Based on: glTF 2.0, section 3.8 (textures and images).
//!
//! A fault of a texture or of its picture costs the texture, with a warning.
//! Each picture is looked at once, however many materials show it. Views may
//! overlap, so what is taken out of them is no more than was read all in all.

use std::collections::HashMap;

use gltf_json as json;
use serde::Deserialize;

use super::super::picture::{picture_beside, picture_of_bytes};
use super::Asset;
use super::buffer::{Target, target};
use crate::model::Texture;
use crate::report::{Place, Report, WarningCode};

/// An extension that moves texture coordinates.
const TRANSFORM: &str = "KHR_texture_transform";

/// A texture of the file: its picture, which extensions may give instead.
#[derive(Deserialize)]
struct StatedTexture {
    source: Option<usize>,
}

/// A picture of the file.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct StatedImage<'a> {
    name: Option<&'a str>,
    uri: Option<&'a str>,
    buffer_view: Option<usize>,
}

/// The pictures that were looked at.
#[derive(Debug, Default)]
pub(super) struct Textures {
    /// By the index of the picture; `None` where there is none to show.
    known: HashMap<usize, Option<Texture>>,
    /// How many bytes were taken out of views.
    copied: usize,
}

impl Textures {
    /// The texture of the base colour of a material.
    pub(super) fn of_base_color(
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
                format!("lies by texture coordinates of set {set}, not 0; it was left out")
            });
            return None;
        }
        if transform.is_some() {
            report.warn(WarningCode::Unsupported, Some(Place::Part(part())), || {
                format!("{TRANSFORM} is not read: the texture lies as if it were not there")
            });
        }
        let texture = info.index.value();
        let image = asset.image_of(texture).map_err(|(place, what)| left_out(report, place, &what));
        let image = image.ok()?;
        if !self.known.contains_key(&image) {
            let found = self.picture(asset, image);
            let found = found.map_err(|what| left_out(report, format!("images[{image}]"), &what));
            self.known.insert(image, found.ok());
        }
        self.known.get(&image).cloned().flatten()
    }

    /// The picture of an image; the error goes behind its place.
    fn picture(&mut self, asset: &Asset, image: usize) -> Result<Texture, String> {
        let StatedImage { name, uri, buffer_view } = stated(&asset.document.images, image)?;
        let own_name = || match name {
            Some(name) if !name.is_empty() => name.to_owned(),
            _ => format!("images[{image}]"),
        };
        match (uri, buffer_view) {
            (Some(uri), _) => match target(uri)? {
                Target::Bytes(bytes) => picture_of_bytes(&own_name(), bytes),
                Target::Path(path) => picture_beside(asset.source, &path)
                    .map_err(|why| format!("names '{path}', which {why}")),
            },
            (None, Some(view)) => {
                let part = || format!("images[{image}].bufferView");
                let bytes = asset.view(view, &part).map_err(|error| error.what)?;
                self.copied = self.copied.saturating_add(bytes.len());
                if self.copied > asset.budget.bytes() {
                    return Err("shares its bytes with too many others".into());
                }
                picture_of_bytes(&own_name(), bytes)
            }
            (None, None) => Err("has neither a URI nor a view of a buffer".into()),
        }
    }
}

impl Asset<'_> {
    /// The image of a texture; the error has the place, and what goes behind it.
    fn image_of(&self, texture: usize) -> Result<usize, (String, String)> {
        let place = || format!("textures[{texture}]");
        let found: StatedTexture =
            stated(&self.document.textures, texture).map_err(|what| (place(), what))?;
        found.source.ok_or_else(|| (place(), "has no PNG or JPEG picture".into()))
    }
}

/// An element of a list that the file may well not have.
fn stated<'a, T: Deserialize<'a>>(list: &'a serde_json::Value, index: usize) -> Result<T, String> {
    let element = list.get(index).ok_or("is not there")?;
    T::deserialize(element).map_err(|error| format!("is not understood: {error}"))
}

fn left_out(report: &mut Report, place: String, what: &str) {
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
    use super::super::read_gltf;
    use super::super::sample::{SQUARE, Sample, joined};
    use super::*;
    use crate::model::{Model, TextureSource};

    /// The members of a file with a triangle for each of these materials.
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

    /// What the reader makes of a file of one triangle with this texture, in a
    /// folder with the file `beside.png`.
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
        let mut report = Report::default();
        let model = read_gltf(&source, &mut report).unwrap();
        (model, report)
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
    fn a_fault_costs_the_texture_and_a_warning() {
        let [one, first] = [json!({"index": 0}), json!([{"source": 0}])];
        for (textures, images, place, what) in [
            (json!([]), json!([]), "textures[0]", "is not there"),
            (json!(7), json!([]), "textures[0]", "is not there"),
            (json!([{"source": "x"}]), json!([]), "textures[0]", "is not understood"),
            (json!([{"extensions": {}}]), json!([]), "textures[0]", "no PNG or JPEG picture"),
            (first.clone(), json!([]), "images[0]", "is not there"),
            (first.clone(), json!([{}]), "images[0]", "neither a URI nor a view"),
            (first.clone(), json!([{"uri": 1}]), "images[0]", "is not understood"),
            (first.clone(), json!([{"uri": "none.png"}]), "images[0]", "was not found"),
            (first.clone(), json!([{"uri": "../a.png"}]), "images[0]", "lies outside"),
            (first.clone(), json!([{"uri": "c.ktx2"}]), "images[0]", "is no PNG or JPEG"),
            (first.clone(), json!([{"uri": "http://a/b.png"}]), "images[0]", "not opened"),
            (first.clone(), json!([{"uri": "data:;base64,AAAA"}]), "images[0]", "is no PNG"),
            (first.clone(), json!([{"bufferView": 9}]), "images[0]", "of which there are 3"),
            (first.clone(), json!([{"bufferView": 1}]), "images[0]", "is no PNG or JPEG"),
        ] {
            let (texture, report) = read(&one, &textures, &images);
            assert_eq!(texture, None, "{textures} {images}");
            let told = report.warnings().iter().find(|told| told.code == WarningCode::Material);
            let told = told.unwrap_or_else(|| panic!("{textures} {images}: {report:?}"));
            assert_eq!((told.count, &told.place), (1, &Some(Place::Part(place.into()))));
            assert!(told.message.contains(what), "{textures} {images}: {}", told.message);
        }
    }

    #[test]
    fn other_texture_coordinates_are_told() {
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
        assert_eq!(moved(json!(0), json!({"scale": [2, 2]})), (true, 1), "as if not there");
        assert_eq!(moved(json!(1), json!({"texCoord": 0})), (true, 1), "the extension wins");
        assert_eq!(moved(json!(0), json!({"texCoord": 1})), (false, 1));
    }

    #[test]
    fn a_picture_is_looked_at_once() {
        let mut sample = Sample::default();
        let view = sample.view(SAMPLES[0], &json!({}));
        let materials = [0, 1, 2].map(|index| textured(&json!({"index": index})));
        let looks = json!({
            "textures": [{"source": 0}, {"source": 0}, {"source": 1}],
            "images": [{"bufferView": view}, {"uri": "none.png"}]
        });
        let rest = triangles(&mut sample, &[&materials[..], &materials[..]].concat());
        let (model, report) = read_beside(&sample.json(&joined(rest, &looks)));
        let sources: Vec<_> = model.materials.iter().map(|m| m.diffuse_texture.clone()).collect();
        assert_eq!((sources[0].is_some(), &sources[0]), (true, &sources[1]));
        assert_eq!((&sources[2], &sources[4]), (&None, &sources[0]));
        assert_eq!(report.count(WarningCode::Material), 1, "once for all: {report:?}");
        assert_eq!(model.runs.len(), 6);
    }

    #[test]
    fn views_that_overlap_do_not_multiply() {
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
