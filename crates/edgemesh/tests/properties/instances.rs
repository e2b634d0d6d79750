//! Meshes in several places: copied into one mesh, in files, and out of glTF again.

use std::collections::BTreeMap;

use edgemesh::build::{BuildOptions, build_edge_mesh, build_instanced};
use edgemesh::edge_mesh::{EdgeFlags, EdgeMesh, InstancedMesh, counts_with};
use edgemesh::format::edge_mesh_file::to_bytes_with_instances;
use edgemesh::format::export::{ExportFormat, Parts, to_bytes_with};
use edgemesh::format::read::{Format, read_model_bytes};
use edgemesh::load::{LoadOptions, LoadedMesh, NoProgress, load};
use edgemesh::model::{Attributes, InstancedModel, Material, Model, Segment};
use edgemesh::report::Report;
use edgemesh::view::count_features;
use glam::{DMat3, DMat4, DQuat, DVec3, Vec4};

use crate::meshes::{sheet, torus};

/// A turn, a mirror with a scale, and the first place.
fn placements() -> Vec<DMat4> {
    let turn = DMat4::from_rotation_translation(
        DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 1.2),
        DVec3::new(40.0, 0.0, 0.0),
    );
    let mirror = DMat4::from_scale_rotation_translation(
        DVec3::new(-0.5, 0.5, 0.5),
        DQuat::from_rotation_x(0.4),
        DVec3::new(0.0, 40.0, 0.0),
    );
    vec![DMat4::IDENTITY, turn, mirror]
}

/// Meshes with split vertices, lines without a face, sheets and materials.
fn parts() -> Vec<Model> {
    let bow_tie = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [-1., 0., 1.], [-1., 0., -1.]];
    let mut lines = Model::from_polygons(&bow_tie, &[&[0, 1, 2], &[0, 3, 4]]);
    lines.segments.push(Segment { ends: [1, 4], line: 0 });
    lines.segments.push(Segment { ends: [1, 2], line: 0 });
    let mut colored = torus(5, 9).model();
    colored.groups = vec!["ring".into()];
    colored.materials = vec![Material { name: "red".into(), ..Material::default() }];
    colored.set_attributes(Attributes { material: 0, group: 0, ..Attributes::default() });
    colored.runs[0].first_polygon = 7;
    vec![lines, colored, sheet(3, 4).model()]
}

/// The model with a copy of its instances, apart from the code that is tested.
fn copied(model: &Model) -> Model {
    let mut flat = Model { instanced: Vec::new(), ..model.clone() };
    for InstancedModel { model: part, placements } in &model.instanced {
        let first_material = u32::try_from(flat.materials.len()).unwrap();
        flat.materials.extend(part.materials.iter().cloned());
        for place in placements {
            let is_mirrored = DMat3::from_mat4(*place).determinant() < 0.0;
            let first = u32::try_from(flat.positions.len()).unwrap();
            let moved = part.positions.iter().map(|&at| place.transform_point3(at.into()));
            flat.positions.extend(moved.map(|at| at.to_array()));
            let first_group = u32::try_from(flat.groups.len()).unwrap();
            flat.groups.extend(part.groups.iter().cloned());
            for polygon in 0..part.polygon_count() {
                let run = part.runs.iter().rev().find(|run| run.first_polygon as usize <= polygon);
                let mut attributes = run.map_or_else(Attributes::default, |run| run.attributes);
                if run.is_some() {
                    attributes.material += first_material;
                    attributes.group += first_group;
                }
                flat.set_attributes(attributes);
                let mut corners: Vec<_> =
                    part.corner_range(polygon).map(|at| part.corner(at)).collect();
                corners.iter_mut().for_each(|corner| corner.position += first);
                if is_mirrored {
                    // A polygon is cut from its first corner on.
                    corners[1..].reverse();
                }
                flat.push_polygon(&corners, 0);
            }
            let line =
                |segment: &Segment| Segment { ends: segment.ends.map(|at| at + first), line: 0 };
            flat.segments.extend(part.segments.iter().map(line));
        }
    }
    flat
}

fn scenes() -> Vec<Model> {
    let scene = |part: Model| Model {
        instanced: vec![InstancedModel { model: part, placements: placements() }],
        ..Model::from_polygons(&[[-9., 0., 0.], [-8., 0., 0.], [-8., 1., 0.]], &[&[0, 1, 2]])
    };
    let mut scenes: Vec<Model> = parts().into_iter().map(scene).collect();
    let mut alone = scenes[1].clone();
    (alone.positions, alone.corner_positions) = (Vec::new(), Vec::new());
    let mut far = scenes[0].clone();
    far.positions.iter_mut().for_each(|at| at[0] += 4.5e6);
    for part in &mut far.instanced {
        part.model.positions.iter_mut().for_each(|at| at[0] += 4.5e6);
        let shift = DMat4::from_translation(DVec3::new(4.5e6, 0.0, 0.0));
        part.placements.iter_mut().for_each(|place| *place = shift * *place * shift.inverse());
    }
    scenes.extend([alone, far]);
    scenes
}

fn build(model: &Model) -> (EdgeMesh, Vec<InstancedMesh>) {
    build_instanced(model, &BuildOptions::default(), &mut Report::default())
}

/// Writes a file and loads it.
fn loaded(name: &str, bytes: &[u8], with_instances: bool) -> LoadedMesh {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    let options = LoadOptions { with_instances, ..LoadOptions::default() };
    load(&path, &options, &NoProgress).unwrap()
}

/// The point in steps that rounding does not change.
fn steps(mesh: &EdgeMesh, vertex: u32) -> [i64; 3] {
    let at = mesh.positions[vertex as usize].map(f64::from);
    #[expect(clippy::cast_possible_truncation, reason = "small numbers")]
    at.map(|x| (x * 512.0).round() as i64)
}

/// How often each triangle occurs, from its least corner on, so that the winding counts.
fn triangles(mesh: &EdgeMesh) -> BTreeMap<[[i64; 3]; 3], usize> {
    let mut all = BTreeMap::new();
    for triangle in &mesh.triangles {
        let mut corners = triangle.map(|vertex| steps(mesh, vertex));
        let least = (0..3).min_by_key(|&at| corners[at]).unwrap();
        corners.rotate_left(least);
        *all.entry(corners).or_default() += 1;
    }
    all
}

/// How often each edge occurs with those of its classes that are in `classes`.
fn edges(mesh: &EdgeMesh, classes: EdgeFlags) -> BTreeMap<([[i64; 3]; 2], u32), usize> {
    let mut all = BTreeMap::new();
    for record in &mesh.records {
        let mut ends = [record.v0, record.v1].map(|vertex| steps(mesh, vertex));
        ends.sort_unstable();
        *all.entry((ends, (record.flags() & classes).bits())).or_default() += 1;
    }
    all
}

/// Compares with a mesh of the same scene in which rounding may differ.
fn assert_same(flat: &EdgeMesh, expected: &EdgeMesh, what: &str) {
    assert_eq!(flat.counts, expected.counts, "{what}");
    assert_eq!(triangles(flat), triangles(expected), "{what}");
    let all = EdgeFlags::all();
    assert_eq!(edges(flat, all), edges(expected, all), "{what}");
    let of_chains = |mesh: &EdgeMesh| {
        let loops = mesh.chains.chains.iter().filter(|chain| chain.is_loop == 1).count();
        (mesh.chains.chains.len(), mesh.chains.links.len(), loops)
    };
    assert_eq!(of_chains(flat), of_chains(expected), "{what}");
    for eye in [[3.0, 50.0, 9.0, 1.0], [-90.0, 7.0, -60.0, 1.0], [0.3, 0.2, 1.0, 0.0]] {
        let eye = Vec4::from(eye);
        assert_eq!(count_features(flat, eye), count_features(expected, eye), "{what} {eye}");
    }
    let of_fill = |mesh: &EdgeMesh| {
        let name = |index: u32| mesh.fill.materials.get(index as usize).map(|own| own.name.clone());
        let mut runs: Vec<_> = mesh.fill.runs.iter().map(|run| name(run.material)).collect();
        runs.sort();
        runs.dedup();
        (mesh.fill.indices.len(), runs)
    };
    assert_eq!(of_fill(flat), of_fill(expected), "{what}");
}

/// A file with instances, read without them, is the mesh of a model with copies.
#[test]
fn copies_are_what_a_model_of_copies_gives() {
    for (at, model) in scenes().iter().enumerate() {
        let what = format!("scene {at}");
        let (mesh, instanced) = build(model);
        let expected =
            build_edge_mesh(&copied(model), &BuildOptions::default(), &mut Report::default());
        assert_eq!(mesh.frame.is_identity(), expected.frame.is_identity(), "{what}");
        let report = Report::default();
        let bytes = to_bytes_with_instances(&mesh, &instanced, "a", &report, &[]).unwrap();
        let shared = loaded("a.edgemesh", &bytes, true);
        assert_eq!((&shared.mesh, &shared.instanced), (&mesh, &instanced), "{what}");
        assert_eq!(shared.counts(), expected.counts, "{what}");
        let flat = loaded("a.edgemesh", &bytes, false);
        assert!(flat.instanced.is_empty());
        if mesh.frame == expected.frame {
            assert_same(&flat.mesh, &expected, &what);
        }
        let (found, bounds, frame) = (shared.bounds(), expected.bounds, expected.frame);
        for (found, expected) in [(found.min, bounds.min), (found.max, bounds.max)] {
            let scale = expected.iter().fold(1.0, |most: f32, x| most.max(x.abs()));
            let distance = glam::Vec3::from(found).distance(expected.into());
            assert!(distance < 1e-5 * scale || mesh.frame != frame, "{what}: {distance}");
        }
    }
}

/// glTF files have a node for each place, and say the same when they are read.
#[test]
fn exported_scenes_say_the_same() {
    for (at, model) in scenes().iter().enumerate() {
        let (mesh, instanced) = build(model);
        let parts = Parts { instanced: &instanced, ..Parts::default() };
        let expected = counts_with(&mesh, &instanced).triangles;
        for format in [ExportFormat::Glb, ExportFormat::Gltf] {
            let bytes = to_bytes_with(&mesh, parts, "a", format).unwrap();
            let (again, report) = read_model_bytes("a", &bytes, Format::Gltf).unwrap();
            assert!(report.warnings().is_empty(), "scene {at}: {report:?}");
            let flat = build_edge_mesh(&again, &BuildOptions::default(), &mut Report::default());
            assert_eq!(flat.counts.triangles, expected, "scene {at}");
            let report = Report::default();
            let stored = to_bytes_with_instances(&mesh, &instanced, "a", &report, &[]).unwrap();
            let copies = loaded("a.edgemesh", &stored, false).mesh;
            if mesh.frame == flat.frame {
                assert_eq!(triangles(&flat), triangles(&copies), "scene {at}");
                let drawn = EdgeFlags::ALWAYS_DRAWN;
                assert_eq!(edges(&flat, drawn), edges(&copies, drawn), "scene {at}");
            }
        }
    }
}

/// Marks count the vertices of instanced meshes behind those of the model, and mark all places.
#[test]
fn marks_go_to_their_mesh() {
    let scene = &scenes()[2];
    let options = BuildOptions { marks: vec![[0, 1], [3, 4], [2, 3]], ..BuildOptions::default() };
    let mut report = Report::default();
    let (mesh, instanced) = build_instanced(scene, &options, &mut report);
    let marked = |mesh: &EdgeMesh| {
        let is_marked = |flags: EdgeFlags| flags.contains(EdgeFlags::MARKED);
        mesh.records.iter().filter(|record| is_marked(record.flags())).count()
    };
    assert_eq!((marked(&mesh), marked(&instanced[0].mesh)), (1, 1));
    let code = edgemesh::report::WarningCode::Mark;
    assert_eq!(report.count(code), 1, "no edge joins two meshes: {report:?}");
}
