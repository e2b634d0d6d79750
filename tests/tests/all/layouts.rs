//! Structs and constants that Rust and WGSL both write down.

use std::collections::BTreeMap;
use std::mem::offset_of;

use edgemesh::edge_mesh::FacePlane;
use edgemesh::oracle::feature::LineBits;
use edgemesh::oracle::spine::{GUARD_BAND, MIN_LENGTH_PX};
use edgemesh::oracle::stroke_vertex::{EDGE_ON_FACING, LIFTED_FACING, VERTICES_PER_EDGE};
use edgemesh::record::{EdgeFlags, EdgeRecord};
use strokes::fill::FillUniform;
use strokes::frame::FrameUniform;
use strokes::mesh_buffers::{EDGES_PER_RUN, MeshUniform, Tally};
use strokes::shader::ShaderSource;
use strokes::stroke::StrokeUniform;

use crate::shaders::shader_files;

/// Size, and each field's offset.
type Layout = (usize, Vec<(String, usize)>);

macro_rules! layout {
    ($type:ident { $($field:ident),+ }) => {
        (
            stringify!($type).to_owned(),
            (
                size_of::<$type>(),
                vec![$((stringify!($field).to_owned(), offset_of!($type, $field))),+],
            ),
        )
    };
}

fn rust_layouts() -> BTreeMap<String, Layout> {
    BTreeMap::from([
        layout!(FrameUniform { clip_from_world, eye, viewport_px, padding }),
        layout!(MeshUniform { face_count, edge_count, run_count, padding, box_min, box_max }),
        layout!(FacePlane { normal, point }),
        layout!(EdgeRecord { v0, v1, face_a, face_b, flags }),
        layout!(Tally {
            vertex_count,
            instance_count,
            first_vertex,
            first_instance,
            contour,
            ridge,
            valley,
            boundary,
            marked,
            material,
            smoothing
        }),
        layout!(FillUniform { color }),
        layout!(StrokeUniform { color, width_px, brush_aspect, padding }),
    ])
}

fn modules() -> Vec<(String, naga::Module)> {
    shader_files()
        .into_keys()
        .map(|path| {
            let module = ShaderSource::embedded(&path).unwrap().validate().unwrap();
            (path, module)
        })
        .collect()
}

/// The struct in a buffer, or the struct that an array in a buffer holds.
fn struct_in_buffer(
    module: &naga::Module,
    variable: &naga::GlobalVariable,
) -> Option<(String, Layout)> {
    use naga::AddressSpace::{Storage, Uniform};
    if !matches!(variable.space, Storage { .. } | Uniform) {
        return None;
    }
    let mut ty = &module.types[variable.ty];
    if let naga::TypeInner::Array { base, stride, .. } = ty.inner {
        ty = &module.types[base];
        if let naga::TypeInner::Struct { span, .. } = ty.inner {
            assert_eq!(stride, span, "elements of {:?} lie without gaps", ty.name);
        }
    }
    let naga::TypeInner::Struct { members, span } = &ty.inner else { return None };
    let fields = members
        .iter()
        .map(|member| (member.name.clone().unwrap(), member.offset as usize))
        .collect();
    Some((ty.name.clone().unwrap(), (*span as usize, fields)))
}

#[test]
fn structs_in_buffers_are_laid_out_alike_and_found_on_both_sides() {
    let mut in_wgsl = BTreeMap::new();
    for (path, module) in modules() {
        for (_, variable) in module.global_variables.iter() {
            if let Some((name, layout)) = struct_in_buffer(&module, variable) {
                let known = in_wgsl.entry(name).or_insert_with(|| layout.clone());
                assert_eq!(*known, layout, "{path}");
            }
        }
    }
    assert_eq!(in_wgsl, rust_layouts());
}

#[test]
fn constants_are_equal_and_found_on_both_sides() {
    let float = |value: f32| u64::from(value.to_bits());
    let mut expected = BTreeMap::from([
        ("NONE", u64::from(edgemesh::index::NONE)),
        ("EDGES_PER_RUN", EDGES_PER_RUN.into()),
        ("GUARD_BAND", float(GUARD_BAND)),
        ("MIN_LENGTH_PX", float(MIN_LENGTH_PX)),
        ("EDGE_ON_FACING", float(EDGE_ON_FACING)),
        ("LIFTED_FACING", float(LIFTED_FACING)),
        ("ALWAYS_DRAWN", EdgeFlags::ALWAYS_DRAWN.bits().into()),
        ("EDGE_INDEX_MASK", edgemesh::index::MAX_INDEX as u64),
    ]);
    expected.extend(EdgeFlags::all().iter_names().map(|(name, bits)| (name, bits.bits().into())));
    expected.extend(LineBits::all().iter_names().map(|(name, bits)| (name, bits.bits().into())));
    // Constants of one side only: how the shader works inside.
    let own = ["BEHIND", "SCAN_WIDTH"];
    let mut found = BTreeMap::new();
    for (path, module) in modules() {
        for (_, constant) in module.constants.iter() {
            let name = constant.name.clone().unwrap_or_default();
            if own.contains(&name.as_str()) {
                continue;
            }
            let naga::Expression::Literal(literal) = module.global_expressions[constant.init]
            else {
                panic!("{path}: {name} is no number")
            };
            let value = match literal {
                naga::Literal::U32(value) => u64::from(value),
                naga::Literal::F32(value) => float(value),
                other => panic!("{path}: {name} is {other:?}"),
            };
            found.insert(name, value);
        }
    }
    // EdgeFlags and LineBits overlap with nothing else by name.
    let found: BTreeMap<&str, u64> = found.iter().map(|(name, value)| (&**name, *value)).collect();
    assert_eq!(found, expected);
    let detect = &shader_files()["detect_edges.wgsl"];
    assert!(detect.contains(&format!("tally.vertex_count = {VERTICES_PER_EDGE}u;")));
}
