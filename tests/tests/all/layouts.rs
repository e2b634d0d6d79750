//! Structs and constants that Rust and WGSL both define.

use std::collections::BTreeMap;
use std::mem::offset_of;

use edgemesh::edge_mesh::{
    CONCAVE, CONCAVE_16, CONE_MARGIN, CREASE_SHIFT, CREASE_SHIFT_16, CREASE_STEPS, ConeFacing,
    EdgeFlags, EdgeVertex, EdgeVertex16, FacePlane, NormalCone, STEPS_PER_STEP_16,
};
use edgemesh::line::{
    CAP_VERTICES, DISK_STEPS, DISK_VERTICES, LineClass, LineKind, MAX_LINE_CLASSES, NO_LAYER,
    Parameterization, Placement,
};
use edgemesh::oracle::spine::MIN_LENGTH_PX;
use edgemesh::oracle::stroke_segment::{EDGE_ON_FACING, LIFTED_FACING};
use edgemesh::oracle::stroke_vertex::FOOT_PX;
use edgemesh::view::LineBits;
use edgemesh_shaders::ShaderSource;
use strokes::layouts::{
    ARC_PER_PX, BACKWARD, CUT_END, CUT_START, CUT_WHOLE, Chain, ChainState, ChunkUniform,
    CompositeUniform, DetectUniform, DrawArguments, EDGES_PER_RUN, FillUniform, GraphUniform,
    ITEMS_PER_SUM, Joint, LinkStyleUniform, MAX_LAYERS, MAX_LINK_ROUNDS, MAX_STROKE_SETS,
    MITRE_LIMIT, NO_NODE, NO_OBJECT, NOT_DRAWN, ON_LOOP, ObjectUniform, PackedRecord, REVERSED,
    RunState, SURFACE_CUT, SURFACE_END, StrokeUniform, Visibility, arguments,
};
use strokes::{
    Element, End, FrameUniform, GraphHeader, Join, LinkNode, MAX_CLIP_PLANES, PathPoint, Ribbon,
    Stroke, Tally,
};
use viewer::pass_graph::{MaterialUniform, SurfaceRange};

use crate::shaders::shader_files;

/// The size, and the offset of each field, in bytes.
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
    let mut layouts = scene_layouts();
    layouts.extend(mesh_layouts());
    layouts.extend(view_layouts());
    layouts.extend(graph_layouts());
    layouts.extend(link_style_layouts());
    layouts
}

/// Structs of scenes and surfaces.
fn scene_layouts() -> BTreeMap<String, Layout> {
    BTreeMap::from([
        layout!(FrameUniform {
            viewport_px,
            px_per_unit,
            clip_plane_count,
            projection,
            picture_px,
            corner_px,
            guard_band,
            world_from_clip,
            eye,
            sight,
            right,
            up,
            light,
            light_color,
            scene_radius,
            depth_range,
            padding,
            clip_planes
        }),
        layout!(ObjectUniform {
            clip_from_object,
            object_from_clip,
            clip_from_normal,
            eye,
            distance,
            origin_px,
            mirror,
            eye_is_outside,
            center,
            step,
            world_from_object,
            world_from_normal
        }),
        layout!(SurfaceRange {
            material,
            object_region,
            material_region,
            group_region,
            has_texcoords,
            padding
        }),
        layout!(MaterialUniform { ambient, diffuse, specular }),
        layout!(FillUniform { color }),
    ])
}

/// Structs of meshes and styles.
fn mesh_layouts() -> BTreeMap<String, Layout> {
    BTreeMap::from([
        layout!(ChunkUniform {
            face_count,
            edge_count,
            run_count,
            capacity,
            first_run,
            chunk_index,
            node_capacity,
            padding
        }),
        layout!(FacePlane { normal, point }),
        layout!(NormalCone { center, radius, axis, cosine }),
        layout!(PackedRecord { v0, v1, face_a, face_b, word }),
        layout!(StrokeUniform {
            color,
            fade,
            width,
            brush_aspect,
            kind,
            placement,
            parameterization,
            is_world_width,
            layer,
            set_index,
            index_count,
            shows_hidden,
            behind_glass,
            unused,
            padding,
            classes
        }),
    ])
}

/// Structs of detection.
fn view_layouts() -> BTreeMap<String, Layout> {
    BTreeMap::from([
        layout!(DetectUniform { classes, layer_count, set_count, padding, sets }),
        layout!(RunState { static_edges, solid, live, contour, has_clash, padding }),
        layout!(Tally { stroke_count, features, layer_first }),
        layout!(DrawArguments {
            index_count,
            instance_count,
            first_index,
            base_vertex,
            first_instance,
            groups_x,
            groups_y,
            groups_z,
            vertex_count,
            rest_instance_count,
            first_vertex,
            rest_first_instance,
            first,
            expanded,
            padding
        }),
    ])
}

/// Structs of the stroke graph.
fn graph_layouts() -> BTreeMap<String, Layout> {
    BTreeMap::from([
        layout!(GraphUniform {
            chunk_count,
            set_count,
            joint_capacity,
            point_capacity,
            draws_contours,
            sets_per_layer,
            padding,
            sets
        }),
        layout!(GraphHeader {
            node_count,
            joint_count,
            point_count,
            stroke_count,
            chain_count,
            total_px,
            point_capacity,
            sets_per_layer,
            layer_first,
            set_first,
            changed
        }),
        layout!(LinkNode { s0, s1, z0, z1, edge, next }),
        layout!(ChainState { jump, anchor, distance, reach }),
        layout!(Chain { first, count }),
        layout!(Element { s0, s1, z0, z1, edge, next, first, count, arc, node }),
        layout!(Joint { cosine, kind, point_count, first_point }),
        layout!(PathPoint { position, offset, depth, arc, joint, flags, cut, stroke, padding }),
        layout!(Stroke { first, last, start_arc, end_arc }),
        layout!(Ribbon {
            a,
            b,
            u,
            half_width,
            join0,
            join1,
            dash,
            depth,
            ink,
            opacity,
            ends,
            near_px
        }),
    ])
}

/// Structs of linked strokes' styles.
fn link_style_layouts() -> BTreeMap<String, Layout> {
    BTreeMap::from([
        layout!(LinkStyleUniform {
            layer,
            visibility,
            placement,
            is_world_width,
            width,
            step_px,
            corner_cosine,
            is_cut_where_hidden,
            join,
            end,
            min_length_px,
            max_length_px,
            brush_aspect,
            is_stretched,
            fade,
            taper_px,
            overshoot_px,
            wobble_px,
            wobble_length_px,
            jitter_px,
            dash_px,
            width_curve,
            opacity_curve,
            seed,
            padding
        }),
        layout!(CompositeUniform { colors }),
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
    // Rust writes the padding after the last field as a field.
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
                // Parameters of techniques are bound by name and have no Rust twin.
                if name == "Params" {
                    continue;
                }
                let known = in_wgsl.entry(name).or_insert_with(|| layout.clone());
                assert_eq!(*known, layout, "{path}");
            }
        }
    }
    assert_eq!(in_wgsl, rust_layouts());
}

/// Constants that only a shader has.
const OF_SHADERS: [&str; 44] = [
    "CROSS",
    "DIAGONALS",
    "NOWHERE",
    "PI",
    "BEHIND",
    "SCAN_WIDTH",
    "EXPAND_WIDTH",
    "WORDS_PER_EDGE",
    "START_PX",
    "OWN_REACH",
    "SAME_DEPTH",
    "GROUP",
    "BREAK",
    "CORNER",
    "SPLIT",
    "POINT_STARTS",
    "POINT_ENDS",
    "POINT_SPLITS",
    "POINT_IS_VISIBLE",
    "POINT_ON_CONTOUR",
    "POINT_ON_SEAM",
    "SET_SHIFT",
    "IS_INSIDE",
    "KEPT_COSINE",
    "MOST_ELEMENTS",
    "HALVINGS",
    "JITTER_LENGTH_PX",
    "FOLD",
    "KEPT",
    "FOLD_STEPS",
    "ENDS_AROUND",
    "POINT_IS_CORNER",
    "LOOP_PART",
    "LEAST_BRIDGED_PX",
    "SHARED_PX",
    "JOINS_LOOSELY",
    "CUSP_COSINE",
    "BRIDGE",
    "GRAZED_PX",
    "SEEN",
    "SEEN_ALMOST",
    "SEEN_NOT",
    "POINT_IS_GRAZED",
    "INSIDE_PX",
];

/// The value of a constant expression: a literal, or sums and products of whole numbers.
fn number(module: &naga::Module, at: naga::Handle<naga::Expression>) -> Option<naga::Literal> {
    use naga::{BinaryOperator, Expression, Literal};
    match module.global_expressions[at] {
        Expression::Literal(literal) => Some(literal),
        Expression::Constant(constant) => number(module, module.constants[constant].init),
        Expression::Binary { op, left, right } => {
            let sides = (number(module, left)?, number(module, right)?);
            let (Literal::U32(left), Literal::U32(right)) = sides else { return None };
            match op {
                BinaryOperator::Add => Some(Literal::U32(left + right)),
                BinaryOperator::Multiply => Some(Literal::U32(left * right)),
                _ => None,
            }
        }
        _ => None,
    }
}

/// The constants that both sides must define, from the shaders.
fn constants_of_shaders() -> BTreeMap<String, u64> {
    let float = |value: f32| u64::from(value.to_bits());
    let mut found = BTreeMap::new();
    for (path, module) in modules() {
        for (_, constant) in module.constants.iter() {
            let name = constant.name.clone().unwrap_or_default();
            if OF_SHADERS.contains(&name.as_str()) {
                continue;
            }
            let value = match number(&module, constant.init) {
                Some(naga::Literal::U32(value)) => u64::from(value),
                Some(naga::Literal::F32(value)) => float(value),
                other => panic!("{path}: {name} is {other:?}"),
            };
            found.insert(name, value);
        }
    }
    found
}

/// Those of the stroke graph.
fn graph_constants() -> BTreeMap<&'static str, u64> {
    let float = |value: f32| u64::from(value.to_bits());
    BTreeMap::from([
        ("ITEMS_PER_SUM", ITEMS_PER_SUM.into()),
        ("NOT_DRAWN", NOT_DRAWN.into()),
        ("BACKWARD", BACKWARD.into()),
        ("NO_NODE", NO_NODE.into()),
        ("CUT_START", CUT_START.into()),
        ("CUT_END", CUT_END.into()),
        ("CUT_WHOLE", CUT_WHOLE.into()),
        ("MAX_LINK_ROUNDS", MAX_LINK_ROUNDS as u64),
        ("NODE_GROUPS", arguments::NODE_GROUPS.into()),
        ("NODE_SUM_GROUPS", arguments::NODE_SUM_GROUPS.into()),
        ("JOINT_GROUPS", arguments::JOINT_GROUPS.into()),
        ("JOINT_SUM_GROUPS", arguments::JOINT_SUM_GROUPS.into()),
        ("POINT_GROUPS", arguments::POINT_GROUPS.into()),
        ("POINT_SUM_GROUPS", arguments::POINT_SUM_GROUPS.into()),
        ("RIBBON_DRAWS", arguments::RIBBON_DRAWS.into()),
        ("CHUNK_GROUPS", arguments::CHUNK_GROUPS.into()),
        ("ON_LOOP", ON_LOOP.into()),
        ("ARC_PER_PX", float(ARC_PER_PX)),
        ("MITRE_LIMIT", float(MITRE_LIMIT)),
        ("ENDS_ROUND", End::Round as u64),
        ("ENDS_FLAT", End::Flat as u64),
        ("ENDS_POINTED", End::Pointed as u64),
        ("JOINS_ROUND", 3 + Join::Round as u64),
        ("JOINS_MITRED", 3 + Join::Mitred as u64),
        ("HIDDEN_STROKES", Visibility::Hidden as u64),
        ("SILHOUETTE_STROKES", Visibility::Silhouette as u64),
        ("SURFACE_END", SURFACE_END.into()),
        ("SURFACE_CUT", SURFACE_CUT.into()),
        ("REVERSED", REVERSED.into()),
    ])
}

#[test]
fn constants_are_equal_and_found_on_both_sides() {
    let float = |value: f32| u64::from(value.to_bits());
    let mut expected: BTreeMap<&str, u64> = BTreeMap::from([
        ("NONE", u64::from(edgemesh::index::NONE)),
        ("EDGES_PER_RUN", EDGES_PER_RUN.into()),
        ("MAX_CLIP_PLANES", MAX_CLIP_PLANES as u64),
        ("MAX_LAYERS", MAX_LAYERS as u64),
        ("MAX_STROKE_SETS", MAX_STROKE_SETS as u64),
        ("NO_LAYER", NO_LAYER.into()),
        ("LINE_CLASS_COUNT", LineClass::COUNT as u64),
        ("MAX_LINE_CLASSES", MAX_LINE_CLASSES as u64),
        ("NO_OBJECT", NO_OBJECT.into()),
        ("MIN_LENGTH_PX", float(MIN_LENGTH_PX)),
        ("EDGE_ON_FACING", float(EDGE_ON_FACING)),
        ("LIFTED_FACING", float(LIFTED_FACING)),
        ("CONE_MARGIN", float(CONE_MARGIN)),
        ("CREASE_SHIFT", CREASE_SHIFT.into()),
        ("CREASE_STEPS", CREASE_STEPS.into()),
        ("CONCAVE", CONCAVE.into()),
        ("CONCAVE_16", CONCAVE_16.into()),
        ("STEPS_PER_STEP_16", STEPS_PER_STEP_16.into()),
        ("CREASE_SHIFT_16", CREASE_SHIFT_16.into()),
        ("DISK_STEPS", DISK_STEPS.into()),
        ("FOOT_PX", float(FOOT_PX)),
        ("CAP_VERTICES", CAP_VERTICES.into()),
        ("DISK_VERTICES", DISK_VERTICES.into()),
        ("CENTERED", Placement::Centered as u64),
        ("OUTSIDE", Placement::Outside as u64),
        ("INSIDE", Placement::Inside as u64),
        ("AUTOMATIC", Placement::Automatic as u64),
        ("THIN", LineKind::Thin as u64),
        ("QUAD", LineKind::Quad as u64),
        ("QUAD_AND_CAPS", LineKind::QuadAndCaps as u64),
        ("QUAD_AND_DISKS", LineKind::QuadAndDisks as u64),
        ("FIN", LineKind::Fin as u64),
        ("OBJECT_SPACE", Parameterization::ObjectSpace as u64),
        ("SCREEN_SPACE", Parameterization::ScreenSpace as u64),
        ("EDGE_INDEX_MASK", u64::from(!LineBits::all().bits() | LineBits::DRAWN.bits())),
    ]);
    expected.extend(graph_constants());
    let classes = LineClass::ALL
        .map(|class| (format!("CLASS_{}", class.name().to_uppercase()), u64::from(class as u32)));
    expected.extend(classes.iter().map(|(name, number)| (&**name, *number)));
    let facing = [ConeFacing::Mixed, ConeFacing::AllFace, ConeFacing::AllAway];
    expected.extend(["MIXED", "ALL_FACE", "ALL_AWAY"].into_iter().zip(facing.map(|f| f as u64)));
    expected.extend(EdgeFlags::all().iter_names().map(|(name, bits)| (name, bits.bits().into())));
    expected.extend(LineBits::all().iter_names().map(|(name, bits)| (name, bits.bits().into())));
    let found = constants_of_shaders();
    // No other constants have names of EdgeFlags and LineBits.
    let found: BTreeMap<&str, u64> = found.iter().map(|(name, value)| (&**name, *value)).collect();
    assert_eq!(found, expected);
}

/// The word offsets of fields of vertices and records in the shaders.
#[test]
fn replicated_layouts_are_read_where_they_are_written() {
    let words = |field: usize| field / 4;
    assert_eq!(words(size_of::<EdgeVertex>()) * 4, 80);
    assert_eq!(words(size_of::<EdgeVertex16>()) * 4, 40);
    let fields = [
        offset_of!(EdgeVertex, v0),
        offset_of!(EdgeVertex, v1),
        offset_of!(EdgeVertex, v2),
        offset_of!(EdgeVertex, v3),
        offset_of!(EdgeVertex, n0),
        offset_of!(EdgeVertex, n1),
        offset_of!(EdgeVertex, r),
        offset_of!(EdgeVertex, corner_and_flags),
    ];
    assert_eq!(fields.map(words), [0, 3, 6, 9, 12, 15, 18, 19]);
    let halves = [
        offset_of!(EdgeVertex16, v0),
        offset_of!(EdgeVertex16, v1),
        offset_of!(EdgeVertex16, v2),
        offset_of!(EdgeVertex16, v3),
        offset_of!(EdgeVertex16, n0),
        offset_of!(EdgeVertex16, n1),
        offset_of!(EdgeVertex16, corner_and_random),
    ];
    assert_eq!(halves.map(|at| at / 2), [0, 3, 6, 9, 12, 15, 18]);
}
