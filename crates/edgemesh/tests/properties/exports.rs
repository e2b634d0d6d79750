//! Exported files give back their edge mesh: with the small reader of
//! [`gltf_edges`](crate::gltf_edges), with the readers of this crate, and with a reader of JSON.

#![expect(clippy::missing_assert_message, reason = "each compares a part of a file with the mesh")]

use std::collections::{BTreeMap, BTreeSet};

use edgemesh::build::{BuildOptions, build_edge_mesh};
use edgemesh::edge_mesh::{EdgeFlags, EdgeMesh, class_names};
use edgemesh::format::export::{ExportFormat, to_bytes};
use edgemesh::format::read::{Format, read_model_bytes};
use edgemesh::index::NONE;
use edgemesh::model::{Attributes, Model, Segment};
use edgemesh::report::Report;
use edgemesh::view::{LineBits, classify_edges};
use glam::{DVec3, Vec3};
use proptest::prelude::*;
use serde_json::Value;

use crate::config;
use crate::gltf_edges::{DecodedFile, Edge, decode, edge};
use crate::meshes::{
    Mesh, closed_mesh, moebius_strip, one_sided_mesh, oriented_mesh, sheet, soup, torus,
};

const NAME: &str = "Gr\u{fc}\u{df}e \"\u{4e16}\u{754c}\"\\\n#1";

/// The edge mesh of a model without its fill, so that files have its own vertices.
fn build(model: &Model) -> EdgeMesh {
    let options = BuildOptions { with_fill: false, ..BuildOptions::default() };
    build_edge_mesh(model, &options, &mut Report::default())
}

fn export(mesh: &EdgeMesh, format: ExportFormat) -> Vec<u8> {
    to_bytes(mesh, NAME, format).unwrap()
}

/// Meshes with edges of different kinds.
fn samples() -> Vec<(&'static str, Model)> {
    let cube: Vec<[f32; 3]> =
        (0..8_u8).map(|k| [k & 1, k >> 1 & 1, k >> 2].map(f32::from)).collect();
    let quads: [&[u32]; 6] =
        [&[0, 2, 3, 1], &[4, 5, 7, 6], &[0, 1, 5, 4], &[2, 6, 7, 3], &[0, 4, 6, 2], &[1, 3, 7, 5]];
    let fan = [[0., 0., 0.], [0., 0., 1.], [1., 0., 0.], [0., 1., 0.], [-1., -1., 0.]];
    let bow_tie = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [-1., 0., 1.], [-1., 0., -1.]];
    vec![
        ("cube of quads", Model::from_polygons(&cube, &quads)),
        ("open sheet", sheet(3, 4).model()),
        ("two materials", two_materials()),
        ("non-manifold fan", Model::from_polygons(&fan, &[&[0, 1, 2], &[0, 1, 3], &[1, 0, 4]])),
        ("pages of a book", book(4)),
        ("bow tie", Model::from_polygons(&bow_tie, &[&[0, 1, 2], &[0, 3, 4]])),
        ("M\u{f6}bius strip", moebius_strip(12).model()),
        ("torus", torus(5, 9).model()),
        ("lines only", lines(Model::from_polygons(&fan, &[]))),
        ("lines over a sheet", lines(sheet(2, 2).model())),
        ("flat faces", Model::from_polygons(&[[0.; 3], [1.; 3], [2.; 3]], &[&[0, 1, 2]])),
        ("nothing", Model::default()),
    ]
}

/// A sheet whose two halves differ.
fn two_materials() -> Model {
    let sheet = sheet(4, 2);
    let mut model = Mesh { polygons: sheet.polygons[..4].to_vec(), ..sheet.clone() }.model();
    model.materials = vec![Default::default(); 2];
    for polygon in &sheet.polygons[4..] {
        model.set_attributes(Attributes { material: 1, ..Attributes::default() });
        let corners: Vec<_> = polygon.iter().copied().map(edgemesh::model::Corner::at).collect();
        model.push_polygon(&corners, 0);
    }
    model
}

/// Pages of several leaves that share a spine of three edges.
fn book(leaves: u8) -> Model {
    let mut mesh = Mesh::default();
    for leaf in 0..=leaves {
        for height in 0..4_u8 {
            let (y, x) = f32::from(leaf).sin_cos();
            let out = f32::from(u8::from(leaf > 0));
            mesh.positions.push([x * out, y * out, f32::from(height)]);
        }
    }
    for leaf in 1..=u32::from(leaves) {
        for height in 0..3 {
            let outer = 4 * leaf + height;
            mesh.polygons.push(vec![height, outer, outer + 1, height + 1]);
        }
    }
    mesh.model()
}

/// A cube whose sides have colors of their own, and one more in the corners of its first side.
fn painted_cube() -> Model {
    let (_, mut model) = samples().swap_remove(0);
    model.colors =
        (0..7_u8).map(|k| [f32::from(k) / 51.0, 1.0 - f32::from(k) / 255.0, 0.2, 0.4]).collect();
    model.corner_colors = (0..24).map(|corner| corner / 4).collect();
    model.corner_colors[2] = 6;
    model
}

/// A model with lines along its edges, on beyond them, across, and twice.
fn lines(mut model: Model) -> Model {
    let beyond = u32::try_from(model.positions.len()).unwrap();
    model.positions.extend([[-1.0, -0.25, 0.0], [-1.0, 0.0, 0.0]]);
    let on = [[1, 2], [2, beyond], [beyond, beyond + 1]];
    let ends = [[[0, 1]; 2].as_slice(), &on, &[[2, 4], [4, 3], [3, 0]]].concat();
    model.segments.extend(ends.into_iter().map(|ends| Segment { ends, line: 0 }));
    model
}

/// The places and colors at the corners of each triangle, sorted.
fn painted_triangles(mesh: &EdgeMesh) -> Vec<[([u32; 3], [u8; 4]); 3]> {
    let fill = &mesh.fill;
    let corner = |index: &u32| {
        let place = fill.vertices[*index as usize].position.map(f32::to_bits);
        (place, fill.colors[*index as usize])
    };
    let triangles = fill.indices.as_chunks().0;
    let mut triangles: Vec<[_; 3]> = triangles
        .iter()
        .map(|triangle: &[u32; 3]| {
            let mut corners = triangle.each_ref().map(corner);
            corners.sort_unstable();
            corners
        })
        .collect();
    triangles.sort_unstable();
    triangles
}

/// The colors of corners come back from every format that has them; OBJ has no opacities.
#[test]
fn colors_come_back() {
    let painted =
        |model: &Model| build_edge_mesh(model, &BuildOptions::default(), &mut Report::default());
    let mesh = painted(&painted_cube());
    assert_eq!(mesh.fill.colors[0], [0, 255, 51, 102]);
    for (written, format) in [
        (ExportFormat::Glb, Format::Glb),
        (ExportFormat::Gltf, Format::Gltf),
        (ExportFormat::Ply, Format::Ply),
        (ExportFormat::Obj, Format::Obj),
    ] {
        let (model, _) = read_model_bytes("out", &export(&mesh, written), format).unwrap();
        let again = painted(&model);
        let mut expected = mesh.clone();
        if format == Format::Obj {
            expected.fill.colors.iter_mut().for_each(|color| color[3] = 255);
        }
        assert_eq!(painted_triangles(&again), painted_triangles(&expected), "{format:?}");
        assert_eq!(hard_edges(&again), hard_edges(&mesh), "{format:?}");
        assert_eq!(again.positions.len(), 8, "{format:?}");
    }
    let bytes = edgemesh::format::edge_mesh_file::to_bytes(&mesh, "", &Report::default(), &[]);
    let bytes = bytes.unwrap();
    assert_eq!(edgemesh::format::edge_mesh_file::parse(&bytes).unwrap().to_mesh(), mesh);
}

/// Hard edges with the words for their classes, of triangles and of lines.
fn hard_edges(mesh: &EdgeMesh) -> [BTreeMap<Edge, Vec<String>>; 2] {
    let mut flags = [BTreeMap::<Edge, EdgeFlags>::new(), BTreeMap::new()];
    let hard = |flags: EdgeFlags| flags & EdgeFlags::ALWAYS_DRAWN;
    for record in mesh.records.iter().filter(|record| !hard(record.flags()).is_empty()) {
        let is_line = usize::from(record.face_a == NONE);
        let ends = [record.v0, record.v1].map(|vertex| mesh.positions[vertex as usize]);
        *flags[is_line].entry(edge(ends)).or_default() |= hard(record.flags());
    }
    let words = |flags| class_names(flags).map(str::to_owned).collect();
    flags.map(|flags| flags.into_iter().map(|(edge, flags)| (edge, words(flags))).collect())
}

/// The unit normal of a face, computed again.
fn normal(mesh: &EdgeMesh, face: u32) -> DVec3 {
    let [a, b, c] = mesh.triangles[face as usize]
        .map(|vertex| Vec3::from(mesh.positions[vertex as usize]).as_dvec3());
    (b - a).cross(c - a).normalize_or_zero()
}

/// Asserts that a file describes each edge as the mesh does.
fn check_gltf(mesh: &EdgeMesh, decoded: &DecodedFile) {
    let [hard, lines] = hard_edges(mesh);
    assert_eq!(decoded.name, NAME);
    assert_eq!(decoded.hard, hard);
    assert!(decoded.lines.iter().eq(lines.keys()));
    if !mesh.triangles.is_empty() || !lines.is_empty() {
        assert_eq!(decoded.positions, mesh.positions);
    }
    assert_eq!(decoded.triangles, mesh.triangles);
    for (written, own) in decoded.normals.iter().zip(&mesh.vertex_normals) {
        assert_eq!(*written, if *own == [0.0; 3] { [0.0, 0.0, 1.0] } else { *own });
    }
    assert!([0, mesh.positions.len()].contains(&decoded.normals.len()));
    check_silhouettes(mesh, decoded);
}

/// Edges of two faces that are not hard are silhouettes, unless flat.
fn check_silhouettes(mesh: &EdgeMesh, decoded: &DecodedFile) {
    let (mut seen, mut checked) = (0, BTreeSet::new());
    for record in &mesh.records {
        if record.flags().intersects(EdgeFlags::ALWAYS_DRAWN) {
            continue;
        }
        let ends = [record.v0, record.v1].map(|vertex| mesh.positions[vertex as usize]);
        if decoded.hard.contains_key(&edge(ends)) {
            continue; // Another pair of its faces is hard.
        }
        if !checked.insert(edge(ends)) {
            continue; // The silhouette is that of the first pair of faces.
        }
        let found = decoded.silhouettes.get(&edge(ends));
        seen += usize::from(found.is_some());
        let sign = if record.flags().contains(EdgeFlags::CLASH) { -1.0 } else { 1.0 };
        let [a, b] = [normal(mesh, record.face_a), normal(mesh, record.face_b) * sign];
        let is_own = |face: u32, normal: DVec3| {
            let [x, y, z, _] = mesh.face_planes[face as usize].normal;
            Vec3::new(x, y, z).as_dvec3().distance(normal) < 1e-6
        };
        if !is_own(record.face_a, a) || !is_own(record.face_b, b * sign) {
            continue; // A sliver with the plane of a neighbor, or none.
        }
        match found {
            None => assert!(a.distance(b) < 2e-6, "{a} and {b} are not flat"),
            Some(normals) => {
                let [own, across] = normals.map(|normal| Vec3::from(normal).as_dvec3());
                let errors = [
                    own.distance(a).max(across.distance(b)),
                    own.distance(b).max(across.distance(a)),
                ];
                assert!(errors[0].min(errors[1]) < 1e-6, "{a} and {b}, not {own} and {across}");
                assert!(a.distance(b) > 5e-7, "{a} and {b} are flat");
            }
        }
    }
    assert_eq!(seen, decoded.silhouettes.len(), "a silhouette that is no edge");
}

#[test]
fn gltf_reads_back_equal() {
    for (name, model) in samples() {
        let mesh = build(&model);
        let glb = decode(&export(&mesh, ExportFormat::Glb));
        assert_eq!(glb, decode(&export(&mesh, ExportFormat::Gltf)), "{name}");
        println!("{name}: {} hard edges, {} silhouettes", glb.hard.len(), glb.silhouettes.len());
        check_gltf(&mesh, &glb);
    }
}

#[test]
fn line_strings_take_what_follows_on() {
    let decoded = |name: &str| {
        let (_, model) = samples().into_iter().find(|sample| sample.0 == name).unwrap();
        decode(&export(&build(&model), ExportFormat::Glb))
    };
    // The sides of the sheet; its corners turn too much to go on.
    let sheet = decoded("open sheet");
    assert_eq!((sheet.hard.len(), sheet.in_strings.len()), (14, 14));
    assert!(sheet.silhouettes.is_empty(), "all is flat");
    let cube = decoded("cube of quads");
    assert_eq!((cube.hard.len(), cube.in_strings.len()), (12, 0));
    // The spine has several records an edge, and is in a string once.
    let book = decoded("pages of a book");
    let spine = edge([[0., 0., 0.], [0., 0., 1.]]);
    assert_eq!(book.hard[&spine], ["non_manifold"]);
    assert!(book.in_strings.contains(&spine));
    // The string ends where the line leaves the sheet.
    let lines = decoded("lines over a sheet");
    let marked = |edge: &&Edge| lines.hard[*edge].contains(&"marked".to_owned());
    assert_eq!((lines.lines.len(), lines.in_strings.iter().filter(marked).count()), (3, 2));
    let materials = decoded("two materials");
    assert_eq!(materials.hard.values().filter(|words| words[..] == ["material"]).count(), 2);
}

/// The mesh that is built of a file of `format`.
fn read_back(bytes: &[u8], format: Format) -> EdgeMesh {
    let (model, report) = read_model_bytes("back", bytes, format).unwrap();
    assert!(report.warnings().is_empty(), "{report:?}");
    build(&model)
}

fn triangles(mesh: &EdgeMesh) -> Vec<[[u32; 3]; 3]> {
    let place = |vertex: u32| mesh.positions[vertex as usize].map(crate::meshes::key);
    mesh.triangles.iter().map(|triangle| triangle.map(place)).collect()
}

const WITH_A_READER: [(ExportFormat, Format); 4] = [
    (ExportFormat::Obj, Format::Obj),
    (ExportFormat::Ply, Format::Ply),
    (ExportFormat::Glb, Format::Glb),
    (ExportFormat::Gltf, Format::Gltf),
];

/// Asserts that the triangles and all classes of the edges of a mesh come back.
fn check_classes(mesh: &EdgeMesh) {
    for (written, read) in WITH_A_READER {
        let back = read_back(&export(mesh, written), read);
        // Triangles that were cut from different polygons can be the two sides of one.
        if back.triangles.len() == back.counts.triangles {
            assert_eq!(hard_edges(&back), hard_edges(mesh), "{written:?}");
            assert_eq!(triangles(&back), triangles(mesh), "{written:?}");
        }
    }
}

#[test]
fn classes_come_back() {
    for (name, model) in samples() {
        if model.positions.is_empty() {
            continue; // Files without a vertex are refused.
        }
        println!("{name}");
        check_classes(&build(&model));
        let with_fill = build_edge_mesh(&model, &BuildOptions::default(), &mut Report::default());
        check_classes(&with_fill);
    }
}

/// A fold of 20 degrees and one of 60, as an export with a threshold of 10 states them.
#[test]
fn stated_creases_do_not_depend_on_their_angle() {
    let turned = |degrees: f32| degrees.to_radians().sin_cos();
    let ((s20, c20), (s60, c60)) = (turned(20.0), turned(60.0));
    let positions = [
        [0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [-c60, 0.0, s60],
        [-c60, 1.0, s60],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [1.0 + c20, 0.0, -s20],
        [1.0 + c20, 1.0, -s20],
    ];
    let quads: [&[u32]; 3] = [&[2, 0, 1, 3], &[0, 4, 5, 1], &[4, 6, 7, 5]];
    let model = Model::from_polygons(&positions, &quads);
    let angle = 10.0_f64.to_radians();
    let options =
        BuildOptions { ridge_angle_rad: angle, valley_angle_rad: angle, ..BuildOptions::default() };
    let mesh = build_edge_mesh(&model, &options, &mut Report::default());
    let count = |mesh: &EdgeMesh, class: EdgeFlags| {
        mesh.records.iter().filter(|record| record.flags().contains(class)).count()
    };
    let creases = |mesh: &EdgeMesh| [EdgeFlags::RIDGE, EdgeFlags::VALLEY].map(|c| count(mesh, c));
    assert_eq!((creases(&mesh), creases(&build(&model))), ([1, 1], [0, 1]));
    for (written, read) in WITH_A_READER {
        let back = read_back(&export(&mesh, written), read);
        assert_eq!((creases(&back), count(&back, EdgeFlags::MARKED)), ([1, 1], 0), "{written:?}");
    }
    // Without the words that say whose export it is, hard edges are marked edges.
    let text = String::from_utf8(export(&mesh, ExportFormat::Gltf)).unwrap();
    let foreign = text.replace("Edgemesh edge classes", "other");
    let back = read_back(foreign.as_bytes(), Format::Gltf);
    assert_eq!(count(&back, EdgeFlags::MARKED), 10, "two folds and eight at the boundary");
}

/// Two sheets that touch along a fold, which is a feature or not by the threshold.
#[test]
fn stated_features_of_more_than_two_faces_do_not_depend_on_their_angle() {
    for (fold, threshold, expected) in [(20.0_f32, 10.0_f64, [2, 0]), (40.0, 50.0, [0, 2])] {
        let mut positions = vec![[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
        for degrees in [0.0, 180.0 - fold, 180.0, 360.0 - fold] {
            let (sine, cosine) = degrees.to_radians().sin_cos();
            positions.extend([[cosine, sine, 0.0], [cosine, sine, 1.0]]);
        }
        let quads: [&[u32]; 4] = [&[1, 0, 2, 3], &[0, 1, 5, 4], &[1, 0, 6, 7], &[0, 1, 9, 8]];
        let model = Model::from_polygons(&positions, &quads);
        let angle = threshold.to_radians();
        let options = BuildOptions {
            ridge_angle_rad: angle,
            valley_angle_rad: angle,
            ..BuildOptions::default()
        };
        let mesh = build_edge_mesh(&model, &options, &mut Report::default());
        let pairs = |mesh: &EdgeMesh| {
            [EdgeFlags::NON_MANIFOLD, EdgeFlags::PAIRED].map(|class| {
                mesh.records.iter().filter(|record| record.flags().contains(class)).count()
            })
        };
        let others = [expected[1], expected[0]];
        assert_eq!((pairs(&mesh), pairs(&build(&model))), (expected, others), "{fold}");
        for (written, read) in WITH_A_READER {
            let (model, _) = read_model_bytes("back", &export(&mesh, written), read).unwrap();
            assert_eq!(pairs(&build(&model)), expected, "{fold}, {written:?}");
        }
    }
}

#[test]
fn json_reads_back_equal() {
    for (name, model) in samples() {
        let mesh = build(&model);
        let json: Value = serde_json::from_slice(&export(&mesh, ExportFormat::Json)).unwrap();
        assert_eq!(json["name"], NAME, "{name}");
        let positions: Vec<[f32; 3]> = serde_json::from_value(json["positions"].clone()).unwrap();
        assert_eq!(positions, mesh.positions, "{name}");
        let triangles: Vec<[u32; 3]> = serde_json::from_value(json["triangles"].clone()).unwrap();
        assert_eq!(triangles, mesh.triangles, "{name}");
        check_json_edges(&mesh, json["edges"].as_array().unwrap());
        check_json_chains(&mesh, &json);
    }
}

fn check_json_edges(mesh: &EdgeMesh, edges: &[Value]) {
    assert_eq!(edges.len(), mesh.records.len());
    for (edge, record) in edges.iter().zip(&mesh.records) {
        let face = |face: u32| if face == NONE { Value::Null } else { face.into() };
        assert_eq!(edge["vertices"], serde_json::json!([record.v0, record.v1]));
        assert_eq!(edge["faces"], Value::from(vec![face(record.face_a), face(record.face_b)]));
        let words: Vec<Value> = class_names(record.flags()).map(Value::from).collect();
        assert_eq!(edge["classes"], Value::from(words));
        let is_hard = record.flags().intersects(EdgeFlags::ALWAYS_DRAWN);
        assert_eq!((edge["chain"].is_u64(), edge["arc_start"].is_f64()), (is_hard, is_hard));
    }
}

/// Each chain runs along the edges that name it, by their places in it.
fn check_json_chains(mesh: &EdgeMesh, json: &Value) {
    let mut by_chain = BTreeMap::<u64, Vec<(f64, BTreeSet<u64>)>>::new();
    for edge in json["edges"].as_array().unwrap().iter().filter(|edge| edge["chain"].is_u64()) {
        let ends = edge["vertices"].as_array().unwrap().iter().map(|end| end.as_u64().unwrap());
        let entry = (edge["arc_start"].as_f64().unwrap(), ends.collect());
        by_chain.entry(edge["chain"].as_u64().unwrap()).or_default().push(entry);
    }
    let chains = json["chains"].as_array().unwrap();
    assert_eq!((chains.len(), by_chain.len()), (mesh.chains.chains.len(), chains.len()));
    for (chain, mut edges) in chains.iter().zip(by_chain.into_values()) {
        edges.sort_by(|a, b| a.0.total_cmp(&b.0));
        let vertices = chain["vertices"].as_array().unwrap();
        let steps = vertices.windows(2).map(|ends| ends.iter().map(|end| end.as_u64().unwrap()));
        let steps: Vec<BTreeSet<u64>> = steps.map(Iterator::collect).collect();
        assert!(edges.into_iter().map(|(_, ends)| ends).eq(steps), "{chain}");
        assert_eq!(chain["is_loop"], vertices.len() > 2 && vertices.first() == vertices.last());
    }
}

#[test]
fn the_same_mesh_gives_the_same_bytes() {
    for (name, model) in samples() {
        for format in ExportFormat::ALL {
            let once = || export(&build(&model), format);
            assert_eq!(once(), once(), "{name} as {format:?}");
        }
    }
}

/// Far away, and of a size whose squares 32 bits do not hold.
#[test]
fn a_mesh_comes_back_at_its_place() {
    for (origin, size) in [(4.5e6, 1.0), (-3e8, 0.5), (0.0, 1e30), (2e-27, 1e-32)] {
        let mut model = closed_mesh_of_thirds();
        for position in &mut model.positions {
            *position = position.map(|x| origin + x * size);
        }
        let expected = model.positions.clone();
        let mesh = build(&model);
        assert!(!mesh.frame.is_identity(), "{origin} {size}");
        for format in ExportFormat::ALL {
            let found = positions_in(&export(&mesh, format), format);
            assert_eq!(found.len(), expected.len());
            for (found, expected) in found.iter().zip(&expected) {
                for (a, b) in found.iter().zip(expected) {
                    // 32 bits hold the place within the mesh, 64 that of the mesh.
                    let error = (a - b).abs() / (1e-9 * b.abs()).max(1e-7 * size);
                    assert!(error <= 1.0, "{a} for {b} as {format:?}");
                }
            }
        }
    }
}

/// A tetrahedron whose coordinates are no short binary numbers.
fn closed_mesh_of_thirds() -> Model {
    let third = 1.0 / 3.0;
    let corners = [[0., 0., 0.], [third, 0., 0.1], [0., 0.7, third], [third, third, third]];
    Model::from_polygons(&corners, &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[0, 3, 2]])
}

fn positions_in(bytes: &[u8], format: ExportFormat) -> Vec<[f64; 3]> {
    let read = |format| read_model_bytes("back", bytes, format).unwrap().0.positions;
    match format {
        ExportFormat::Glb => decode(bytes).placed().collect(),
        ExportFormat::Gltf => read(Format::Gltf),
        ExportFormat::Ply => read(Format::Ply),
        ExportFormat::Obj => read(Format::Obj),
        ExportFormat::Json => {
            let json: Value = serde_json::from_slice(bytes).unwrap();
            serde_json::from_value(json["positions"].clone()).unwrap()
        }
        other => panic!("{other:?} has no reader here"),
    }
}

/// The edges of a mesh that are contours from an eye, hard ones left out.
fn contours(mesh: &EdgeMesh, eye: Vec3) -> BTreeSet<Edge> {
    let bits = classify_edges(mesh, eye.extend(1.0));
    let records = mesh.records.iter().zip(bits);
    let contours = records.filter(|(record, bits)| {
        bits.contains(LineBits::CONTOUR) && !record.flags().intersects(EdgeFlags::ALWAYS_DRAWN)
    });
    let end = |vertex: u32| mesh.positions[vertex as usize];
    contours.map(|(record, _)| edge([end(record.v0), end(record.v1)])).collect()
}

/// The silhouette edges of a file that are drawn from an eye.
fn drawn(decoded: &DecodedFile, eye: Vec3) -> BTreeSet<Edge> {
    let is_drawn = |(edge, normals): &(&Edge, &[[f32; 3]; 2])| {
        let to_eye = eye - Vec3::from(edge[0].map(f32::from_bits));
        let [a, b] = normals.map(|normal| Vec3::from(normal).dot(to_eye) > 0.0);
        a != b
    };
    decoded.silhouettes.iter().filter(is_drawn).map(|(edge, _)| *edge).collect()
}

proptest! {
    #![proptest_config(config(48))]

    #[test]
    fn gltf_of_any_mesh_reads_back_equal(
        mesh in prop_oneof![closed_mesh(), oriented_mesh(), one_sided_mesh(), soup(3..=5)],
    ) {
        let mesh = build(&mesh.model());
        check_gltf(&mesh, &decode(&export(&mesh, ExportFormat::Glb)));
    }

    #[test]
    fn silhouettes_are_the_contours(
        mesh in prop_oneof![closed_mesh(), one_sided_mesh()],
        eye in [-9.0..9.0_f32, -9.0..9.0_f32, 3.0..9.0_f32],
    ) {
        let mesh = build(&mesh.model());
        let decoded = decode(&export(&mesh, ExportFormat::Glb));
        prop_assert_eq!(drawn(&decoded, eye.into()), contours(&mesh, eye.into()));
    }

    #[test]
    fn classes_of_any_mesh_come_back(
        mesh in prop_oneof![oriented_mesh(), one_sided_mesh(), soup(3..=5)],
    ) {
        let mesh = mesh.build();
        prop_assume!(!mesh.triangles.is_empty());
        check_classes(&mesh);
    }
}
