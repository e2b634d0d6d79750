//! The model while the files of a scene are walked.
//!
//! A few words can make much: a `USE` repeats whatever it names, and `Sphere {}`
//! is a thousand corners. So everything that is visited or made is paid from an
//! allowance, which grows with what the files write out themselves.
//!
//! ```text
//! walk_v1, walk_v2 --nodes--> shapes_v1, shapes_v2 --FaceSet--> faces --> Model
//!                                  |                               ^
//!                 solids, elevation_grid, extrusion ---------------'
//! ```

use std::collections::HashMap;
use std::path::PathBuf;
use std::rc::Rc;

use glam::DAffine3;

use super::document::{Document, NodeRef};
use super::lists::ListKey;
use super::materials::MaterialKey;
use super::textures::TextureKey;
use super::{Version, walk_v1, walk_v2};
use crate::format::read::error::{ReadError, ReadErrorKind};
use crate::index::{NONE, to_u32};
use crate::model::{Attributes, Model, Smoothing, Texture};
use crate::report::{Report, WarningCode};

/// How many elements may be made beyond those that the files write out: nodes,
/// coordinates and corners. Some 30,000 spheres; about 1 GiB at worst.
const MADE_ELEMENTS: usize = 1 << 26;

/// Where a shape stands, and in which group.
#[derive(Debug, Clone, Default)]
pub(super) struct Placement {
    /// From the shape's own coordinates to those of the model.
    pub(super) transform: DAffine3,
    /// The `DEF` name that is nearest around the shape.
    pub(super) group: Option<Rc<str>>,
}

impl Placement {
    /// The same place, in the group of `node` where that has a name.
    pub(super) fn named(&self, node: NodeRef) -> Self {
        Self { transform: self.transform, group: node.name().or(self.group.as_ref()).cloned() }
    }

    /// The place inside of a node that moves what is in it.
    pub(super) fn moved(self, transform: DAffine3) -> Self {
        Self { transform: self.transform * transform, ..self }
    }

    /// Whether it turns shapes inside out.
    pub(super) fn is_mirrored(&self) -> bool {
        self.transform.matrix3.determinant() < 0.0
    }
}

/// What is made of the scene so far.
#[derive(Debug)]
pub(super) struct Scene<'r> {
    /// The polygons and lines so far.
    pub(super) model: Model,
    /// What was left out.
    pub(super) report: &'r mut Report,
    /// The lists of positions and the like that are in the model already.
    pub(super) lists: HashMap<ListKey, u32>,
    /// The materials that are in the model already.
    pub(super) materials: HashMap<MaterialKey, u32>,
    /// The textures that were looked for, found or not.
    pub(super) textures: HashMap<TextureKey, Option<Texture>>,
    groups: HashMap<Rc<str>, u32>,
    /// The files that were inlined, by path; each is parsed once.
    pub(super) documents: HashMap<PathBuf, Rc<Document>>,
    /// The files that are being walked, each inlined by the one before it.
    pub(super) open: Vec<PathBuf>,
    /// The line of the model's own file that inlines what is being walked.
    pub(super) inline_line: Option<u32>,
    allowance: usize,
}

impl<'r> Scene<'r> {
    /// An empty scene; `path` is the file that it comes from.
    pub(super) fn new(path: Option<PathBuf>, report: &'r mut Report) -> Self {
        Self {
            model: Model::default(),
            report,
            lists: HashMap::new(),
            materials: HashMap::new(),
            textures: HashMap::new(),
            groups: HashMap::new(),
            documents: HashMap::new(),
            open: path.into_iter().collect(),
            inline_line: None,
            allowance: MADE_ELEMENTS,
        }
    }

    /// Adds what is in a file.
    pub(super) fn walk(
        &mut self,
        document: &Document,
        placement: Placement,
    ) -> Result<(), ReadError> {
        match document.version {
            Version::One => walk_v1::walk(self, document, placement),
            Version::Two => walk_v2::walk(self, document, placement),
        }
    }

    /// Lets what a file writes out itself be made without limit.
    pub(super) fn allow(&mut self, document: &Document) {
        self.allowance = self.allowance.saturating_add(document.element_count());
    }

    /// Pays for `count` elements that `node` makes.
    pub(super) fn spend(&mut self, node: NodeRef, count: usize) -> Result<(), ReadError> {
        match self.allowance.checked_sub(count) {
            Some(left) => self.allowance = left,
            None => {
                let what = format!(
                    "USE, Inline and solids make more than {MADE_ELEMENTS} vertices and corners \
                     of this file; split it"
                );
                return Err(node.document.origin.error(ReadErrorKind::Size, node.line(), what));
            }
        }
        Ok(())
    }

    /// Pays for a look at a node.
    pub(super) fn visit(&mut self, node: NodeRef) -> Result<(), ReadError> {
        self.spend(node, 1 + node.field_count())
    }

    /// Counts a warning about a node.
    pub(super) fn warn(
        &mut self,
        node: NodeRef,
        code: WarningCode,
        message: impl FnOnce() -> String,
    ) {
        self.warn_in_line(node, code, node.line(), message);
    }

    /// Counts a warning about a line of the file that a node stands in.
    pub(super) fn warn_in_line(
        &mut self,
        node: NodeRef,
        code: WarningCode,
        line: u32,
        message: impl FnOnce() -> String,
    ) {
        node.document.origin.warn(self.report, code, line, message);
    }

    /// Says that a node is left out because its type is not read.
    pub(super) fn warn_unread(&mut self, node: NodeRef) {
        self.warn(node, WarningCode::Unsupported, || {
            let why = if node.is_prototype() { "comes of a prototype" } else { "is not read" };
            format!("node {} {why} and was left out", node.kind())
        });
    }

    /// The line of the model's own file that stands for a line of the file
    /// that is being walked.
    pub(super) fn model_line(&self, line: u32) -> u32 {
        self.inline_line.unwrap_or(line)
    }

    /// Gives the polygons that follow their attributes.
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

    /// The model, with a colour for each vertex where one has any.
    pub(super) fn finish(mut self) -> Model {
        if !self.model.colors.is_empty() {
            self.pad_colors();
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
