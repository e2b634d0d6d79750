//! Small meshes of many kinds, for tests of the file.

use crate::build::{BuildOptions, build_edge_mesh};
use crate::edge_mesh::EdgeMesh;
use crate::format::read::{Format, read_model_bytes};
use crate::index::NONE;
use crate::model::{Attributes, Corner, Material, Model, Texture, TextureSource};
use crate::report::Report;

/// A mesh with its name and the report of its build.
#[derive(Debug, Default)]
pub(super) struct Sample {
    pub(super) name: &'static str,
    pub(super) mesh: EdgeMesh,
    pub(super) report: Report,
}

impl Sample {
    fn of_model(name: &'static str, model: &Model, mut report: Report) -> Self {
        let mesh = build_edge_mesh(model, &BuildOptions::default(), &mut report);
        Self { name, mesh, report }
    }

    fn of_polygons(name: &'static str, positions: &[[f32; 3]], polygons: &[&[u32]]) -> Self {
        Self::of_model(name, &Model::from_polygons(positions, polygons), Report::default())
    }

    fn of_obj(name: &'static str, text: &str) -> Self {
        let (model, report) = read_model_bytes(name, text.as_bytes(), Format::Obj).unwrap();
        Self::of_model(name, &model, report)
    }
}

pub(super) fn triangle() -> Sample {
    Sample::of_polygons("triangle", &[[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]], &[&[0, 1, 2]])
}

fn cube() -> Sample {
    let positions: Vec<[f32; 3]> =
        (0..8_u8).map(|k| [k & 1, k >> 1 & 1, k >> 2].map(f32::from)).collect();
    let quads: [&[u32]; 6] =
        [&[0, 2, 3, 1], &[4, 5, 7, 6], &[0, 1, 5, 4], &[2, 6, 7, 3], &[0, 4, 6, 2], &[1, 3, 7, 5]];
    Sample::of_polygons("cube", &positions, &quads)
}

/// A wavy sheet of `side` times `side` quads.
pub(super) fn sheet(side: u16) -> Sample {
    let points = (0..=side).flat_map(|y| (0..=side).map(move |x| [x, y].map(f32::from)));
    let positions: Vec<[f32; 3]> = points.map(|[x, y]| [x, y, (x * 0.9).sin() * y]).collect();
    let row = u32::from(side) + 1;
    let first = (0..row - 1).flat_map(|y| (0..row - 1).map(move |x| y * row + x));
    let quads: Vec<[u32; 4]> = first.map(|at| [at, at + 1, at + row + 1, at + row]).collect();
    let polygons: Vec<&[u32]> = quads.iter().map(<[u32; 4]>::as_slice).collect();
    Sample::of_polygons("sheet", &positions, &polygons)
}

/// An octahedron whose tip is pushed inward.
fn dented() -> Sample {
    let positions =
        [[1., 0., 0.], [-1., 0., 0.], [0., 1., 0.], [0., -1., 0.], [0., 0., -0.5], [0., 0., -1.]];
    let faces: [&[u32]; 8] = [
        &[0, 2, 4],
        &[2, 1, 4],
        &[1, 3, 4],
        &[3, 0, 4],
        &[2, 0, 5],
        &[1, 2, 5],
        &[3, 1, 5],
        &[0, 3, 5],
    ];
    Sample::of_polygons("dented", &positions, &faces)
}

fn moebius_strip() -> Sample {
    let positions: Vec<[f32; 3]> = (0..16_u8)
        .map(|k| {
            let (y, x) = (std::f32::consts::TAU * f32::from(k / 2) / 8.0).sin_cos();
            let (lift, spread) = (std::f32::consts::PI * f32::from(k / 2) / 8.0).sin_cos();
            let side = f32::from(k % 2) - 0.5;
            [(2.0 + side * spread) * x, (2.0 + side * spread) * y, side * lift]
        })
        .collect();
    let strip = |k: u32| [2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1];
    let quads: Vec<[u32; 4]> = (0..7).map(strip).chain([[14, 1, 0, 15]]).collect();
    let polygons: Vec<&[u32]> = quads.iter().map(<[u32; 4]>::as_slice).collect();
    Sample::of_polygons("strip", &positions, &polygons)
}

fn bow_tie() -> Sample {
    let positions = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [-1., 0., 1.], [-1., 0., -1.]];
    Sample::of_polygons("bow tie", &positions, &[&[0, 1, 2], &[0, 3, 4]])
}

/// Faces between random points, with edges of many faces, both windings and duplicates.
fn soup() -> Sample {
    let mut state = 1_u32;
    let mut random = || {
        state = state.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
        state >> 28
    };
    let small = |number: u32| f32::from(u8::try_from(number).unwrap());
    let positions: Vec<[f32; 3]> =
        (0..16).map(|_| [random(), random(), random()].map(small)).collect();
    let faces: Vec<[u32; 3]> = (0..200).map(|_| [random(), random(), random()]).collect();
    let polygons: Vec<&[u32]> = faces.iter().map(<[u32; 3]>::as_slice).collect();
    Sample::of_polygons("soup", &positions, &polygons)
}

/// Materials, groups, segments and an n-gon, far from the origin, with faults that give
/// warnings and repairs.
fn materials() -> Sample {
    let text = "mtllib none.mtl\n\
        v 9000000 0 0\nv 9000001 0 0\nv 9000001 1 0\nv 9000000 1 0\nv 9000000 0 1\nv nan 0 0\n\
        v 9000000.5 0.1 0\n\
        usemtl red\ns 1\nf 1 2 7 3 4\nusemtl blue\ns 2\nf 2 5 1\nf 1 4 5\nf 4 3 5\nf 2 3 5\n\
        f 1 1 2\nf 1 2 6\nf 2 5 1\nl 1 3\nl 4 2\ncurv 0 1 1 2\n";
    Sample::of_obj("materials.obj", text)
}

fn lines() -> Sample {
    Sample::of_obj("lines.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2 3\n")
}

/// Three materials with pictures, two of which share one, and an empty one; two groups; colors;
/// texture coordinates for some of the faces.
pub(super) fn textured() -> Sample {
    let positions = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.], [0., 0., 1.]];
    let mut model = Model::from_polygons(&positions, &[]);
    model.texcoords = vec![[0.25, 0.75]];
    model.groups = vec!["a".into(), "ö\n".into()];
    model.colors = vec![[1.0, 0.5, 0.0, 0.25], [0.0, 0.2, 1.0, 1.0]];
    model.colors.resize(positions.len(), [0.5; 4]);
    let picture = |name: &str, bytes: &[u8]| {
        Some(Texture { name: name.into(), source: TextureSource::Bytes(bytes.into()) })
    };
    let bark = Material {
        name: "bark".into(),
        ambient: Some([0.1, 0.2, 0.3]),
        diffuse: Some([0.1, 1.0 / 3.0, 1e-40]),
        specular: Some([f32::MAX, -0.0, 1.0]),
        shininess: Some(f32::INFINITY),
        opacity: Some(0.7),
        diffuse_texture: picture("bark.png", b"\x89PNG\r\n\x1a\nbark"),
    };
    let leaf = Material {
        diffuse: None,
        opacity: None,
        diffuse_texture: picture("leaf.jpg", b"\xff\xd8\xffleaf"),
        ..bark.clone()
    };
    let twig = Material { name: "twig".into(), ..bark.clone() };
    model.materials = vec![Material::default(), bark, leaf, twig];
    for (corners, material, group, texcoord) in [
        ([0, 1, 2], NONE, NONE, NONE),
        ([0, 2, 3], 1, 0, 0),
        ([1, 0, 4], 1, 0, NONE),
        ([2, 1, 4], 3, 1, 0),
    ] {
        model.set_attributes(Attributes { material, group, ..Attributes::default() });
        let corners = corners.map(|corner| Corner { texcoord, ..Corner::at(corner) });
        model.push_polygon(&corners, 0);
    }
    Sample::of_model("textured", &model, Report::default())
}

/// All samples.
pub(super) fn samples() -> Vec<Sample> {
    vec![
        Sample::default(),
        triangle(),
        cube(),
        sheet(5),
        dented(),
        moebius_strip(),
        bow_tie(),
        soup(),
        materials(),
        lines(),
        textured(),
    ]
}
