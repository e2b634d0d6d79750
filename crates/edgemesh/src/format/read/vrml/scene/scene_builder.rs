//! The model that is built from a scene, with the caches and limits of the build.
//!
//! A small file can generate much: a `USE` repeats what it names, and `Sphere {}` has
//! about a thousand corners. So every node that is visited and every element that is
//! added is charged to an allowance, which grows with the size of the files.

use std::collections::HashMap;
use std::rc::Rc;

use super::materials::MaterialKey;
use super::number_list::ListKey;
use super::placement::Placement;
use crate::format::read::error::{ReadError, ReadErrorKind};
use crate::format::read::vrml::parse::{Document, NodeKey, NodeRef};
use crate::index::{NONE, to_u32};
use crate::model::{Attributes, Material, Model, Smoothing, Texture};
use crate::report::{Report, WarningCode};

/// How many elements may be generated beyond those in the files: nodes, coordinates
/// and corners. This is about 30,000 spheres, or 1 GiB at most.
const GENERATED_ELEMENTS: usize = 1 << 26;

/// A model to which the nodes of a scene are added.
#[derive(Debug)]
pub(super) struct SceneBuilder<'r> {
    /// The polygons and lines so far.
    pub(super) model: Model,
    /// The warnings.
    pub(super) report: &'r mut Report,
    /// The index of the first element of each shared list in the model.
    pub(super) lists: HashMap<ListKey, u32>,
    materials: HashMap<MaterialKey, u32>,
    /// The textures of nodes; `None` for one that was not found.
    pub(super) textures: HashMap<NodeKey, Option<Texture>>,
    groups: HashMap<Rc<str>, u32>,
    /// The line of the model's file that inlines the current file.
    pub(super) inline_line: Option<u32>,
    allowance: usize,
}

impl<'r> SceneBuilder<'r> {
    /// An empty model.
    pub(super) fn new(report: &'r mut Report) -> Self {
        Self {
            model: Model::default(),
            report,
            lists: HashMap::new(),
            materials: HashMap::new(),
            textures: HashMap::new(),
            groups: HashMap::new(),
            inline_line: None,
            allowance: GENERATED_ELEMENTS,
        }
    }

    /// Adds the elements of a file to the allowance.
    pub(super) fn allow(&mut self, document: &Document) {
        self.allowance = self.allowance.saturating_add(document.element_count());
    }

    /// Charges `count` elements that `node` generates.
    ///
    /// # Errors
    /// [`ReadErrorKind::Size`] if the allowance is exceeded.
    pub(super) fn spend(&mut self, node: NodeRef, count: usize) -> Result<(), ReadError> {
        match self.allowance.checked_sub(count) {
            Some(left) => self.allowance = left,
            None => {
                let what = format!(
                    "USE, Inline and solids generate more than {GENERATED_ELEMENTS} vertices and \
                     corners; split the file"
                );
                return Err(node.document.origin.error(ReadErrorKind::Size, node.line(), what));
            }
        }
        Ok(())
    }

    /// Charges a visit of a node.
    ///
    /// # Errors
    /// As [`Self::spend`].
    pub(super) fn visit(&mut self, node: NodeRef) -> Result<(), ReadError> {
        self.spend(node, 1 + node.field_count())
    }

    /// Adds a warning about a node.
    pub(super) fn warn(
        &mut self,
        node: NodeRef,
        code: WarningCode,
        message: impl FnOnce() -> String,
    ) {
        self.warn_in_line(node, code, node.line(), message);
    }

    /// Adds a warning about a line of the file of a node.
    pub(super) fn warn_in_line(
        &mut self,
        node: NodeRef,
        code: WarningCode,
        line: u32,
        message: impl FnOnce() -> String,
    ) {
        node.document.origin.warn(self.report, code, line, message);
    }

    /// Warns that a node of an unsupported type was left out.
    pub(super) fn warn_unsupported(&mut self, node: NodeRef) {
        self.warn(node, WarningCode::Unsupported, || {
            let why =
                if node.is_prototype() { "comes from a prototype" } else { "is not supported" };
            format!("node {} {why} and was left out", node.kind())
        });
    }

    /// The line of the model's file for a line of the current file, which may be inlined.
    pub(super) fn model_line(&self, line: u32) -> u32 {
        self.inline_line.unwrap_or(line)
    }

    /// Sets the attributes of the polygons that are added next.
    pub(super) fn set_attributes(
        &mut self,
        placement: &Placement,
        material: u32,
        smoothing: Smoothing,
    ) {
        let group = placement.group.as_ref().map_or(NONE, |name| self.group(name));
        self.model.set_attributes(Attributes { material, group, smoothing });
    }

    fn group(&mut self, name: &Rc<str>) -> u32 {
        if let Some(&group) = self.groups.get(name) {
            return group;
        }
        let group = to_u32(self.model.groups.len());
        self.model.groups.push(name.to_string());
        self.groups.insert(Rc::clone(name), group);
        group
    }

    /// The index of a material, which is added if it is new.
    pub(super) fn material(&mut self, material: Material) -> u32 {
        let materials = &mut self.model.materials;
        *self.materials.entry(MaterialKey::of(&material)).or_insert_with(|| {
            materials.push(material);
            to_u32(materials.len() - 1)
        })
    }

    /// The model.
    pub(super) fn finish(mut self) -> Model {
        // Colors that no corner names are not those of the positions.
        if self.model.corner_colors.is_empty() {
            self.model.colors.clear();
        }
        self.model
    }
}

#[cfg(test)]
mod tests {
    use crate::format::read::vrml::tests::sound;

    #[test]
    fn shapes_over_one_list_in_one_place_share_its_points() {
        let faces = |index: &str, coord: &str| {
            format!(
                "Shape {{ geometry IndexedFaceSet {{ coord {coord} coordIndex [ {index} ] }} }} "
            )
        };
        let first = faces("0 1 2", "DEF C Coordinate { point [ 0 0 0, 1 0 0, 1 1 0, 0 1 0 ] }");
        let model = sound(
            &(first
                + &faces("0 2 3", "USE C")
                + &format!(
                    "Transform {{ translation 0 0 1 children {} }}",
                    faces("0 1 2", "USE C")
                )),
        );
        assert_eq!(model.positions.len(), 8);
        assert_eq!(model.corner_positions, [0, 1, 2, 0, 2, 3, 4, 5, 6]);
        let text = "#VRML V1.0 ascii\nCoordinate3 { point [ 0 0 0, 1 0 0, 1 1 0, 0 1 0 ] }
            IndexedFaceSet { coordIndex [ 0,1,2 ] } Separator { Material { }
            IndexedFaceSet { coordIndex [ 0,2,3 ] } }";
        assert_eq!(sound(text).corner_positions, [0, 1, 2, 0, 2, 3]);
    }

    #[test]
    fn groups_are_the_nearest_names() {
        let text = "DEF unused Group { } DEF a Group { children [ Shape { geometry Box { } }
            DEF b Shape { geometry Box { } } Group { children DEF c Group { children USE b } } ] }
            Shape { geometry Box { } }";
        let model = sound(text);
        assert_eq!(model.groups, ["a", "b"]);
        let mut groups = model.per_polygon(|run| run.group);
        groups.dedup();
        assert_eq!(groups, [0, 1, crate::index::NONE]);
        let text =
            "#VRML V1.0 ascii\nDEF a Separator { Cube { } DEF b Cube { } Cube { } } Cube { }";
        let model = sound(text);
        let mut groups = model.per_polygon(|run| run.group);
        groups.dedup();
        assert_eq!(
            (model.groups, groups),
            (vec!["a".into(), "b".into()], vec![0, 1, 0, crate::index::NONE])
        );
    }
}
