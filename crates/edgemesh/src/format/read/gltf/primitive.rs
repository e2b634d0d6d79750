//! A primitive of a mesh, with its place and its attributes.

use gltf_json as json;
use json::mesh::Semantic;
use json::validation::Checked;

use super::super::error::{ReadError, ReadErrorKind};
use super::accessor::Accessor;
use super::asset::Asset;
use crate::report::Place;

/// A primitive of a mesh.
#[derive(Debug, Clone, Copy)]
pub(super) struct Primitive<'a> {
    pub(super) asset: &'a Asset<'a>,
    pub(super) json: &'a json::mesh::Primitive,
    /// The index of its mesh.
    pub(super) mesh: usize,
    /// Its index in the mesh.
    pub(super) index: usize,
}

impl<'a> Primitive<'a> {
    /// Its part of the JSON, such as `meshes[0].primitives[2]`.
    pub(super) fn part(&self) -> String {
        format!("meshes[{}].primitives[{}]", self.mesh, self.index)
    }

    /// Its place in the file.
    pub(super) fn place(&self) -> Option<Place> {
        Some(Place::Part(self.part()))
    }

    /// An error at its place.
    pub(super) fn error(&self, kind: ReadErrorKind, what: impl Into<String>) -> ReadError {
        self.asset.error(kind, self.part(), what)
    }

    /// The accessor of an attribute, if the primitive has it.
    ///
    /// # Errors
    /// As [`Asset::accessor`].
    pub(super) fn attribute(&self, semantic: Semantic) -> Result<Option<Accessor<'a>>, ReadError> {
        let part = || format!("{}.attributes", self.part());
        let index = self.json.attributes.get(&Checked::Valid(semantic));
        index.map(|index| self.asset.accessor(index.value(), part)).transpose()
    }

    /// The extension with this name, if the primitive has it.
    pub(super) fn extension(&self, name: &str) -> Option<&'a json::Value> {
        self.json.extensions.as_ref()?.others.get(name)
    }
}
