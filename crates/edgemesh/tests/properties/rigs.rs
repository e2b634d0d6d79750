//! Skins and morph targets come back from an export as they were.

use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;

use edgemesh::build::{BuildOptions, build_edge_mesh};
use edgemesh::format::export::{ExportFormat, Parts, to_bytes_with};
use edgemesh::format::read::{Format, read_model_bytes};
use edgemesh::index::NONE;
use edgemesh::model::{
    Corner, Displacement, Influence, MeshRig, Model, NodeTransform, Rig, RigNode, RigPart, Skin,
};
use edgemesh::report::Report;
use glam::{DAffine3, DQuat, DVec3};

/// A strip of two squares, three vertices long and two high.
///
/// ```text
/// 1---3---5
/// | / | / |     faces look to +z
/// 0---2---4
/// ```
const STRIP: [[u32; 3]; 4] = [[0, 2, 3], [0, 3, 1], [2, 4, 5], [2, 5, 3]];

fn strip_positions() -> Vec<[f64; 3]> {
    (0..6_u8).map(|k| [f64::from(k / 2), f64::from(k % 2), 0.0]).collect()
}

fn node(parent: u32, translation: DVec3, angle: f64, scale: DVec3) -> RigNode {
    let rotation = DQuat::from_rotation_z(angle);
    RigNode { parent, transform: NodeTransform::Parts { translation, rotation, scale } }
}

/// A part that lifts vertex 5, half way at rest.
fn part(node: u32, skin: u32) -> RigPart {
    let lift = Displacement { vertex: 5, offset: [0.0, 0.0, 2.0] };
    RigPart { vertices: 0..6, node, skin, weights: vec![0.5], targets: vec![vec![lift]] }
}

/// The strip with this rig, in its rest pose.
fn model(rig: Rig, is_mirrored: bool) -> Model {
    let rest = rig.rest_pose();
    let positions = rig.posed_positions(&rest, |part| &rig.parts[part].weights);
    let mut model = Model { positions, ..Model::default() };
    for [a, b, c] in STRIP {
        let corners = if is_mirrored { [a, c, b] } else { [a, b, c] };
        model.push_polygon(&corners.map(Corner::at), 0);
    }
    model.rig = Some(Box::new(rig));
    model
}

/// An elbow: joint 1 hangs on joint 0 and is bent; the middle of the strip hangs on both.
fn elbow() -> Model {
    let whole = |joint| vec![Influence { joint, weight: 1.0 }];
    let both = vec![Influence { joint: 0, weight: 0.25 }, Influence { joint: 1, weight: 0.75 }];
    let of_vertices = [whole(0), whole(0), both.clone(), both, whole(1), whole(1)];
    let ends = of_vertices.iter().scan(0, |end, own| {
        *end += u32::try_from(own.len()).unwrap();
        Some(*end)
    });
    let moved_back = DAffine3::from_translation(DVec3::new(-1.0, 0.0, 0.0));
    let rig = Rig {
        nodes: vec![
            node(NONE, DVec3::new(0.0, 0.0, 3.0), 0.0, DVec3::ONE),
            node(0, DVec3::X, FRAC_PI_2, DVec3::ONE),
            node(NONE, DVec3::ZERO, 0.0, DVec3::ONE),
        ],
        node_order: vec![0, 1, 2],
        skins: vec![Skin {
            joints: vec![0, 1],
            inverse_binds: vec![DAffine3::IDENTITY, moved_back],
        }],
        parts: vec![part(2, 0)],
        positions: strip_positions(),
        influence_ends: ends.collect(),
        influences: of_vertices.concat(),
    };
    model(rig, false)
}

/// A strip that its node mirrors.
fn mirrored() -> Model {
    let rig = Rig {
        nodes: vec![node(NONE, DVec3::Y, 0.0, DVec3::new(-1.0, 1.0, 1.0))],
        node_order: vec![0],
        parts: vec![part(0, NONE)],
        positions: strip_positions(),
        ..Rig::default()
    };
    model(rig, true)
}

/// Exports a model with its rig and reads it again.
fn round_trip(model: &Model) -> Model {
    let mesh = build_edge_mesh(model, &BuildOptions::default(), &mut Report::default());
    // Nothing is dropped or turned.
    let corners = model.corner_positions.as_chunks().0.to_vec();
    let rig = MeshRig { rig: model.rig.clone().unwrap(), corners };
    let bytes = to_bytes_with(
        &mesh,
        Parts { rig: Some(&rig), ..Parts::default() },
        "strip",
        ExportFormat::Glb,
    )
    .unwrap();
    let (back, report) = read_model_bytes("back", &bytes, Format::Glb).unwrap();
    assert!(report.warnings().is_empty(), "{report:?}");
    back
}

/// A place in steps of a thousandth.
fn place(position: [f64; 3]) -> [String; 3] {
    position.map(|x| format!("{:.3}", x + 0.0))
}

/// The triangles by the places of their corners, each from its smallest corner on, sorted.
fn faces(model: &Model) -> Vec<[[String; 3]; 3]> {
    let corners = model.corner_positions.as_chunks::<3>().0;
    let mut faces: Vec<_> = corners
        .iter()
        .map(|corners| {
            let mut face = corners.map(|corner| place(model.positions[corner as usize]));
            let first = (0..3).min_by_key(|&k| face[k].clone()).unwrap_or_default();
            face.rotate_left(first);
            face
        })
        .collect();
    faces.sort();
    faces
}

/// The joints of a vertex with their weights, and its displacement.
type Bent = (Vec<(u32, f32)>, [f32; 3]);

/// How each vertex bends, by its place before it is posed.
fn bending(model: &Model) -> BTreeMap<[String; 3], Bent> {
    let rig = model.rig.as_ref().unwrap();
    let mut start = 0;
    let of_vertex = |vertex: usize| {
        let end = rig.influence_ends.get(vertex).map_or(start, |&end| end as usize);
        let own = rig.influences[start..end].iter().filter(|own| own.weight > 0.0);
        let joints = own.map(|own| (own.joint, own.weight)).collect();
        start = end;
        let own = |lift: &&Displacement| lift.vertex as usize == vertex;
        let lift = rig.parts[0].targets[0].iter().find(own).map_or([0.0; 3], |lift| lift.offset);
        (place(rig.positions[vertex]), (joints, lift))
    };
    (0..rig.positions.len()).map(of_vertex).collect()
}

#[test]
fn skins_and_morph_targets_come_back() {
    for (name, model) in [("elbow", elbow()), ("mirrored", mirrored())] {
        let back = round_trip(&model);
        assert_eq!(faces(&back), faces(&model), "{name}: as they are posed and wound");
        assert_eq!(bending(&back), bending(&model), "{name}");
        let [own, read] = [&model, &back].map(|model| model.rig.as_ref().unwrap());
        assert_eq!(read.parts[0].weights, own.parts[0].weights, "{name}");
        assert_eq!(read.nodes.len(), own.nodes.len(), "{name}: no node for the mesh");
        assert_eq!(read.skins, own.skins, "{name}");
    }
}
