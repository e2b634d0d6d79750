//! What a model part has: objects, groups of properties, and the items of its build.

use std::collections::HashMap;

use glam::DAffine3;

use crate::model::Material;

/// A model part.
#[derive(Debug)]
pub(super) struct ModelPart {
    /// Its name in the archive.
    pub(super) name: String,
    /// Its unit in meters.
    pub(super) unit: f64,
    /// The objects, in their order.
    pub(super) objects: Vec<Object>,
    /// The groups of properties by their ids.
    pub(super) groups: HashMap<u32, PropertyGroup>,
    /// What the build places; only that of the first part counts.
    pub(super) items: Vec<Reference>,
}

/// An object.
#[derive(Debug)]
pub(super) struct Object {
    pub(super) id: u32,
    /// Its name; may be empty.
    pub(super) name: String,
    /// What it is instead of a model, such as `support`; such objects are not drawn.
    pub(super) other_kind: Option<String>,
    /// The property of triangles without one.
    pub(super) property: Option<Property>,
    pub(super) content: Content,
    /// Its line in the part.
    pub(super) line: u32,
}

/// What an object consists of.
#[derive(Debug)]
pub(super) enum Content {
    Mesh(Mesh),
    /// Other objects.
    Components(Vec<Reference>),
}

/// Triangles.
#[derive(Debug, Default)]
pub(super) struct Mesh {
    pub(super) positions: Vec<[f64; 3]>,
    /// Indices of positions, all in range.
    pub(super) triangles: Vec<[u32; 3]>,
    /// The properties of triangles, in runs that ascend by first triangle; triangles before
    /// the first run have that of the object.
    pub(super) runs: Vec<PropertyRun>,
}

/// A property of successive triangles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct PropertyRun {
    /// The first triangle; the run ends where the next one begins.
    pub(super) first: usize,
    /// `None` for the property of the object.
    pub(super) property: Option<Property>,
}

/// An element of a group of properties.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Property {
    /// The id of the group.
    pub(super) group: u32,
    /// The element, counted from 0.
    pub(super) index: u32,
}

/// A group of properties.
#[derive(Debug)]
pub(super) enum PropertyGroup {
    /// Materials, or colors as materials without a name.
    Materials(Vec<Material>),
    /// Another group, such as `texture2dgroup`.
    Unsupported(String),
}

/// A placed object.
#[derive(Debug)]
pub(super) struct Reference {
    /// The part that has the object; `None` for the same part.
    pub(super) part: Option<String>,
    /// The id of the object.
    pub(super) object: u32,
    pub(super) transform: DAffine3,
    /// Its line in its part.
    pub(super) line: u32,
}
