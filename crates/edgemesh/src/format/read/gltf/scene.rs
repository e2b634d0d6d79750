//! Nodes: their hierarchy, their transforms, and which are drawn.
//!
//! Based on: glTF 2.0, section 3.5 (scenes and nodes).
//!
//! A chain of nodes can be 20,000 deep, and a broken file can have a cycle. So the
//! functions here do not recurse: they find the parents first, and a node that is
//! not reached from a root is part of a cycle.

use glam::{DAffine3, DMat4, DQuat, DVec3};
use gltf_json as json;

use super::super::error::{ReadError, ReadErrorKind};
use super::asset::Asset;
use crate::index::{NONE, to_u32};
use crate::model::NodeTransform;

/// The nodes of a file as trees.
#[derive(Debug)]
pub(super) struct NodeHierarchy {
    /// The parent of each node, or [`NONE`].
    pub(super) parents: Vec<u32>,
    /// All nodes, each after its parent.
    pub(super) order: Vec<usize>,
}

impl NodeHierarchy {
    /// The hierarchy of all nodes.
    ///
    /// # Errors
    /// `Cycle` if the nodes are not trees, `Syntax` if a child does not exist.
    pub(super) fn new(asset: &Asset) -> Result<Self, ReadError> {
        let nodes = &asset.document.nodes;
        let parents = find_parents(asset)?;
        let roots = (0..nodes.len()).filter(|&node| parents[node] == NONE);
        let (order, is_reached) = walk(nodes, roots, |_| true);
        match is_reached.iter().position(|&reached| !reached) {
            None => Ok(Self { parents, order }),
            Some(node) => {
                let what = "is its own ancestor; export the scene again";
                Err(asset.error(ReadErrorKind::Cycle, format!("nodes[{node}]"), what))
            }
        }
    }

    /// The nodes that are drawn, each after its parent: those of the default scene,
    /// else of the first scene, else all.
    ///
    /// # Errors
    /// `Syntax` if the scene names a node that does not exist.
    pub(super) fn drawn_nodes(&self, asset: &Asset) -> Result<Vec<usize>, ReadError> {
        let document = asset.document;
        let default = document.scene.and_then(|scene| document.scenes.get(scene));
        let Some(scene) = default.or_else(|| document.scenes.first()) else {
            let roots = self.order.iter().copied().filter(|&node| self.parents[node] == NONE);
            return Ok(walk(&document.nodes, roots, is_visible).0);
        };
        for &root in &scene.nodes {
            asset.get(&document.nodes, root, "nodes", || "scenes".into())?;
        }
        Ok(walk(&document.nodes, scene.nodes.iter().copied(), is_visible).0)
    }
}

/// The parent of each node, or [`NONE`].
fn find_parents(asset: &Asset) -> Result<Vec<u32>, ReadError> {
    let nodes = &asset.document.nodes;
    let mut parents = vec![NONE; nodes.len()];
    for (at, node) in nodes.iter().enumerate() {
        for child in children(node) {
            let part = || format!("nodes[{at}].children");
            asset.get(nodes, child, "nodes", part)?;
            if parents[child] != NONE {
                let what =
                    format!("nodes[{child}] is already a child of nodes[{}]", parents[child]);
                return Err(asset.error(ReadErrorKind::Cycle, part(), what));
            }
            parents[child] = to_u32(at);
        }
    }
    Ok(parents)
}

/// The nodes below `roots`, depth first, and whether each node was reached. Nodes for
/// which `enters` is false are left out, with all below them.
fn walk(
    nodes: &[json::Node],
    roots: impl DoubleEndedIterator<Item = usize>,
    enters: impl Fn(&json::Node) -> bool,
) -> (Vec<usize>, Vec<bool>) {
    let mut order = Vec::new();
    let mut is_reached = vec![false; nodes.len()];
    let mut waiting: Vec<usize> = roots.rev().collect();
    while let Some(at) = waiting.pop() {
        let (Some(node), Some(reached)) = (nodes.get(at), is_reached.get_mut(at)) else { continue };
        if *reached || !enters(node) {
            continue;
        }
        *reached = true;
        order.push(at);
        waiting.extend(children(node).rev());
    }
    (order, is_reached)
}

fn children(node: &json::Node) -> impl DoubleEndedIterator<Item = usize> {
    node.children.iter().flatten().map(json::Index::value)
}

/// Whether a node is visible: `KHR_node_visibility` can hide it, and so does a scale of
/// zero along all axes (specification, section 3.5.3).
pub(super) fn is_visible(node: &json::Node) -> bool {
    if node.scale.is_some_and(|scale| scale.iter().all(|&axis| axis == 0.0)) {
        return false;
    }
    let extension = node.extensions.as_ref().and_then(|all| all.others.get("KHR_node_visibility"));
    extension.and_then(|visibility| visibility.get("visible")) != Some(&false.into())
}

/// The transform from a node to its parent.
pub(super) fn node_transform(node: &json::Node) -> NodeTransform {
    if let Some(matrix) = node.matrix {
        let matrix = DMat4::from_cols_array(&matrix.map(f64::from));
        return NodeTransform::Matrix(DAffine3::from_mat4(matrix));
    }
    let rotation = node.rotation.unwrap_or_default().0.map(f64::from);
    let rotation = DQuat::from_array(rotation);
    let length = rotation.length();
    NodeTransform::Parts {
        translation: DVec3::from(node.translation.unwrap_or_default().map(f64::from)),
        rotation: if length > 0.0 { rotation / length } else { DQuat::IDENTITY },
        scale: DVec3::from(node.scale.unwrap_or([1.0; 3]).map(f64::from)),
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::source::Source;
    use super::super::document::Document;
    use super::*;

    /// The parents and the drawn nodes of a file with this JSON.
    fn graph(json: &str) -> Result<(Vec<u32>, Vec<usize>), ReadError> {
        let json = format!(r#"{{"asset": {{"version": "2.0"}}, {json}}}"#);
        let document: Document = serde_json::from_str(&json).unwrap();
        let source = Source { name: "test.gltf", folder: None, bytes: b"" };
        let asset = Asset::new(&source, &document, None);
        let graph = NodeHierarchy::new(&asset)?;
        let drawn = graph.drawn_nodes(&asset)?;
        Ok((graph.parents, drawn))
    }

    const TREES: &str = r#""nodes": [{"children": [2, 1]}, {}, {"children": [3]}, {}, {}]"#;

    #[test]
    fn without_a_scene_all_nodes_are_drawn_in_order() {
        let (parents, drawn) = graph(TREES).unwrap();
        assert_eq!(parents, [NONE, 0, 0, 2, NONE]);
        assert_eq!(drawn, [0, 2, 3, 1, 4]);
    }

    #[test]
    fn the_default_scene_comes_before_the_first() {
        let scenes = r#""scenes": [{"nodes": [4]}, {"nodes": [2, 2]}, {}]"#;
        let drawn = |scene: &str| graph(&format!("{TREES}, {scenes}{scene}")).unwrap().1;
        assert_eq!(drawn(r#", "scene": 1"#), [2, 3], "twice in the list, drawn once");
        assert_eq!(drawn(""), [4]);
        assert!(drawn(r#", "scene": 2"#).is_empty());
    }

    #[test]
    fn the_children_of_invisible_nodes_are_not_drawn() {
        let hidden = r#"{"children": [1], "extensions": {"KHR_node_visibility":
            {"visible": false}}}"#;
        assert_eq!(graph(&format!(r#""nodes": [{hidden}, {{}}, {{}}]"#)).unwrap().1, [2]);
        let flat = r#""nodes": [{"scale": [0, 0, 0], "children": [1]}, {}, {"scale": [1, 0, 1]}]"#;
        assert_eq!(graph(flat).unwrap().1, [2], "a flat node is drawn");
    }

    #[test]
    fn cycles_and_second_parents_are_errors() {
        let refusal = |json| graph(json).unwrap_err();
        let error = refusal(r#""nodes": [{}, {"children": [2]}, {"children": [1]}]"#);
        assert_eq!(error.kind, ReadErrorKind::Cycle);
        assert!(error.to_string().contains("nodes[1]"), "{error}");
        assert_eq!(refusal(r#""nodes": [{"children": [0]}]"#).kind, ReadErrorKind::Cycle);
        let error = refusal(r#""nodes": [{"children": [2]}, {"children": [2]}, {}]"#);
        assert!(error.to_string().contains("nodes[1].children"), "{error}");
        assert_eq!(refusal(r#""nodes": [{"children": [7]}]"#).kind, ReadErrorKind::Syntax);
        assert_eq!(refusal(r#""scenes": [{"nodes": [7]}]"#).kind, ReadErrorKind::Syntax);
    }

    #[test]
    fn a_deep_chain_is_walked() {
        let nodes: Vec<String> =
            (1..100_000).map(|child| format!(r#"{{"children": [{child}]}}"#)).collect();
        let (_, drawn) = graph(&format!(r#""nodes": [{}, {{}}]"#, nodes.join(","))).unwrap();
        assert_eq!(drawn.len(), 100_000);
    }

    #[test]
    fn transforms_are_matrices_or_parts() {
        let parsed = |json: &str| node_transform(&serde_json::from_str(json).unwrap());
        let point = |json: &str| parsed(json).parent_from_node().transform_point3(DVec3::ONE);
        assert_eq!(point("{}"), DVec3::ONE);
        assert_eq!(point(r#"{"matrix": [2,0,0,0, 0,1,0,0, 0,0,1,0, 5,6,7,1]}"#).x, 7.0);
        let turned = r#"{"rotation": [0, 0, 2, 0], "scale": [2, 1, 1]}"#;
        assert_eq!(point(turned), DVec3::new(-2.0, -1.0, 1.0), "the quaternion is normalized");
        assert_eq!(point(r#"{"rotation": [0, 0, 0, 0]}"#), DVec3::ONE);
    }
}
