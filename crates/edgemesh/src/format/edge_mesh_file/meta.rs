//! The JSON of a file: the name of the model, the report of its build, and the names of
//! materials and groups.
//!
//! It is JSON because reports are text of any length, with kinds that newer programs may
//! add. A warning of an unknown kind is read as one that something is unsupported; an
//! unknown repair, which loses nothing, is left out.

use serde::{Deserialize, Serialize};

use super::error::{FileError, FileErrorKind};
use super::stored::StoredMesh;
use crate::model::Material;
use crate::report::{Place, Repair, RepairKind, Report, Warning, WarningCode};

#[derive(Debug, Serialize, Deserialize)]
struct StoredMeta {
    name: String,
    #[serde(default)]
    warnings: Vec<StoredWarning>,
    #[serde(default)]
    repairs: Vec<StoredRepair>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    materials: Vec<MaterialNames>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    groups: Vec<String>,
}

/// The names of a material and its texture.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct MaterialNames {
    pub(super) name: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) texture: Option<String>,
}

impl MaterialNames {
    pub(super) fn of(material: &Material) -> Self {
        let texture = material.diffuse_texture.as_ref().map(|texture| texture.name.clone());
        Self { name: material.name.clone(), texture }
    }
}

/// The content of the JSON.
#[derive(Debug, PartialEq)]
pub(super) struct Meta {
    pub(super) name: String,
    pub(super) report: Report,
    pub(super) materials: Vec<MaterialNames>,
    pub(super) groups: Vec<String>,
}

#[derive(Debug, Serialize, Deserialize)]
struct StoredWarning {
    code: String,
    count: usize,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    place: Option<StoredPlace>,
    message: String,
}

#[derive(Debug, Serialize, Deserialize)]
struct StoredRepair {
    kind: String,
    count: usize,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    place: Option<StoredPlace>,
}

/// A place, in one of the members; all are `None` for an unknown kind.
#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(default)]
struct StoredPlace {
    #[serde(skip_serializing_if = "Option::is_none")]
    line: Option<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    byte: Option<u64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    face: Option<u64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    vertex: Option<u64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    part: Option<String>,
}

impl StoredPlace {
    fn of(place: &Place) -> Self {
        let none = Self::default();
        match place {
            Place::Line(line) => Self { line: Some(*line), ..none },
            Place::Byte(offset) => Self { byte: Some(*offset), ..none },
            Place::Face(face) => Self { face: Some(*face), ..none },
            Place::Vertex(vertex) => Self { vertex: Some(*vertex), ..none },
            Place::Part(path) => Self { part: Some(path.clone()), ..none },
        }
    }

    fn into_place(self) -> Option<Place> {
        self.line
            .map(Place::Line)
            .or(self.byte.map(Place::Byte))
            .or(self.face.map(Place::Face))
            .or(self.vertex.map(Place::Vertex))
            .or(self.part.map(Place::Part))
    }
}

/// The JSON of a mesh.
pub(super) fn to_json(mesh: &StoredMesh<'_>) -> Result<Vec<u8>, FileError> {
    let warning = |warning: &Warning| StoredWarning {
        code: warning.code.as_str().into(),
        count: warning.count,
        place: warning.place.as_ref().map(StoredPlace::of),
        message: warning.message.clone(),
    };
    let repair = |repair: &Repair| StoredRepair {
        kind: repair.kind.as_str().into(),
        count: repair.count,
        place: repair.place.as_ref().map(StoredPlace::of),
    };
    let meta = StoredMeta {
        name: mesh.name.to_string(),
        warnings: mesh.report.warnings().iter().map(warning).collect(),
        repairs: mesh.report.repairs().iter().map(repair).collect(),
        materials: mesh.materials.iter().map(MaterialNames::of).collect(),
        groups: mesh.groups.to_vec(),
    };
    serde_json::to_vec(&meta).map_err(|error| {
        FileError::new(
            FileErrorKind::Meta,
            format!("the report cannot be written as JSON: {error}"),
        )
    })
}

/// Reads the JSON of a file.
pub(super) fn from_json(json: &[u8]) -> Result<Meta, serde_json::Error> {
    let meta: StoredMeta = serde_json::from_slice(json)?;
    let warning = |stored: StoredWarning| Warning {
        code: WarningCode::from_word(&stored.code).unwrap_or(WarningCode::Unsupported),
        count: stored.count,
        place: stored.place.and_then(StoredPlace::into_place),
        message: stored.message,
    };
    let repair = |stored: StoredRepair| {
        let kind = RepairKind::from_word(&stored.kind)?;
        let place = stored.place.and_then(StoredPlace::into_place);
        Some(Repair { kind, count: stored.count, place })
    };
    let warnings = meta.warnings.into_iter().map(warning);
    let repairs = meta.repairs.into_iter().filter_map(repair);
    Ok(Meta {
        name: meta.name,
        report: Report::from_parts(warnings, repairs),
        materials: meta.materials,
        groups: meta.groups,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::edge_mesh::EdgeMesh;
    use crate::model::{Texture, TextureSource};

    /// The JSON of a mesh, and what is read from it.
    fn there_and_back(name: &str, mesh: &EdgeMesh, report: &Report) -> (String, Meta) {
        let json = to_json(&StoredMesh::of(mesh, name, report)).unwrap();
        let meta = from_json(&json).unwrap();
        (String::from_utf8(json).unwrap(), meta)
    }

    #[test]
    fn reports_are_read_back_with_every_kind_of_place() {
        let mut report = Report::default();
        let places = [
            None,
            Some(Place::Line(3)),
            Some(Place::Byte(1 << 40)),
            Some(Place::Face(7)),
            Some(Place::Vertex(8)),
            Some(Place::Part("meshes[0] \"ä\"".into())),
        ];
        for (code, place) in WarningCode::ALL.into_iter().zip(places.iter().cycle()) {
            report.warn_many(code, 2, place.clone(), || format!("a message of {code}\n\u{1}"));
        }
        for (kind, place) in RepairKind::ALL.into_iter().zip(places.iter().cycle()) {
            report.repair(kind, 3, place.clone());
        }
        let (_, meta) = there_and_back("möbel.obj", &EdgeMesh::default(), &report);
        assert_eq!((meta.name.as_str(), meta.report), ("möbel.obj", report));
    }

    #[test]
    fn the_json_has_the_documented_keys() {
        let mut report = Report::default();
        report.warn(WarningCode::Degenerate, Some(Place::Line(5)), || "flat".into());
        report.repair(RepairKind::SplitEdges, 2, None);
        let expected = "{\"name\":\"a\",\"warnings\":[{\"code\":\"degenerate\",\"count\":1,\
             \"place\":{\"line\":5},\"message\":\"flat\"}],\
             \"repairs\":[{\"kind\":\"split_edges\",\"count\":2}]}";
        assert_eq!(there_and_back("a", &EdgeMesh::default(), &report).0, expected);
    }

    #[test]
    fn names_of_materials_and_groups_are_optional() {
        let mut mesh = EdgeMesh::default();
        let texture = Texture {
            name: "bark.png".into(),
            source: TextureSource::Bytes(b"picture".as_slice().into()),
        };
        let named = |name: &str, diffuse_texture| Material {
            name: name.into(),
            diffuse_texture,
            ..Material::default()
        };
        mesh.fill.materials = vec![named("", None), named("tree", Some(texture))];
        mesh.fill.groups = vec!["trunk".into(), String::new()];
        let (json, meta) = there_and_back("a", &mesh, &Report::default());
        let expected = "{\"name\":\"a\",\"warnings\":[],\"repairs\":[],\
             \"materials\":[{\"name\":\"\"},{\"name\":\"tree\",\"texture\":\"bark.png\"}],\
             \"groups\":[\"trunk\",\"\"]}";
        assert_eq!(json, expected);
        let names: Vec<MaterialNames> = mesh.fill.materials.iter().map(MaterialNames::of).collect();
        assert_eq!((meta.materials, meta.groups), (names, mesh.fill.groups));
    }

    #[test]
    fn unknown_kinds_and_keys_of_newer_programs_are_accepted() {
        let json = br#"{"name": "a", "author": {"x": [1]}, "warnings": [
            {"code": "curved", "count": 2, "message": "new", "place": {"node": 3}},
            {"code": "degenerate", "count": 1, "message": "old", "place": {"line": 4}},
            {"code": "folded", "count": 18446744073709551615, "message": "newer"}],
            "repairs": [{"kind": "ironed", "count": 9}]}"#;
        let Meta { report, .. } = from_json(json).unwrap();
        let [old, new] = report.warnings() else { panic!("{report:?}") };
        assert_eq!((old.code, old.place.clone()), (WarningCode::Degenerate, Some(Place::Line(4))));
        assert_eq!((new.code, &*new.message), (WarningCode::Unsupported, "new"));
        assert_eq!((new.count, new.place.clone()), (usize::MAX, None), "no overflow");
        assert!(report.repairs().is_empty());
        let (materials, groups) = (Vec::new(), Vec::new());
        let plain = Meta { name: "b".into(), report: Report::default(), materials, groups };
        assert_eq!(from_json(br#"{"name": "b"}"#).unwrap(), plain);
    }

    #[test]
    fn broken_json_is_an_error() {
        let nested = [b"{\"name\": ".as_slice(), &[b'['; 100_000]].concat();
        let broken: [&[u8]; 6] = [
            b"",
            b"{}",
            b"{\"name\": 1}",
            b"{\"name\": \"\xff\"}",
            b"{\"name\": \"a\", \"warnings\": [{\"count\": -1}]}",
            &nested,
        ];
        for json in broken {
            assert!(from_json(json).is_err(), "{}", String::from_utf8_lossy(json));
        }
    }
}
