//! The shaders against their CPU twins, over random and adversarial data.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use edgemesh::build::{BuildOptions, build_edge_mesh};
use edgemesh::edge_mesh::{
    EdgeFlags, EdgeMesh, EdgeWord, FacePlane, NormalCone, cone_facing, edge_random,
};
use edgemesh::index::NONE;
use edgemesh::line::{ClassTable, LineClass, LineKind, Parameterization, Placement};
use edgemesh::oracle::spine::{Spine, lerp, project_spine, screen_normal};
use edgemesh::oracle::stroke_segment::{ClipEdge, StrokeShape};
use edgemesh::oracle::stroke_vertex::stroke_vertex;
use edgemesh::report::Report;
use edgemesh::view::{
    Camera, EdgeFaces, Line, LineBits, View, classify_edge, classify_lines, count_features,
    eye_is_outside, faces_eye, facing_bits,
};
use glam::{DMat4, DVec3, Vec2, Vec3, Vec4};
use strokes::{
    Layout, MeshBuffers, MeshInstance, Renderer, RendererOptions, SceneView, Tally, TargetFormats,
    Targets,
};
use testkit::wgsl_fn::run_wgsl;
use viewer::technique::Technique;

use crate::gpu_device::gpu;
use crate::gpu_render::{drawing_style_of, technique};
use crate::own_models::own_models;
use crate::random::Random;

#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct FacingInput {
    plane: FacePlane,
    eye: [f32; 4],
}

#[test]
fn facing_bits_agree_except_within_rounding() {
    let mut random = Random(1);
    let inputs: Vec<FacingInput> = (0..20_000)
        .map(|case| {
            let point = random.vec3() * if case % 3 == 0 { 1000.0 } else { 1.0 };
            let normal = random.vec3().normalize_or(Vec3::X);
            let mut eye = random.vec3().extend(f32::from(u8::from(case % 2 == 0)));
            if case % 5 == 0 {
                // An eye nearly in the plane.
                let tangent = normal.any_orthonormal_vector();
                eye = (point + tangent * random.signed() + normal * random.signed() * 1e-6)
                    .extend(1.0);
            }
            FacingInput {
                plane: FacePlane {
                    normal: normal.extend(0.0).into(),
                    point: point.extend(1.0).into(),
                },
                eye: eye.into(),
            }
        })
        .collect();
    let body = "#import <common/facing.wgsl>
        struct Input { plane: FacePlane, eye: vec4f }
        alias Output = u32;
        fn run(input: Input) -> Output { return u32(faces_eye(input.plane, input.eye)); }";
    let outputs: Vec<u32> = run_wgsl(gpu(), body, &inputs);
    let mut differing = 0;
    for (input, &gpu_bit) in inputs.iter().zip(&outputs) {
        let eye = Vec4::from(input.eye);
        if faces_eye(&input.plane, eye) == (gpu_bit != 0) {
            continue;
        }
        let to_eye = eye.truncate() - eye.w * Vec4::from(input.plane.point).truncate();
        let value = Vec4::from(input.plane.normal).truncate().dot(to_eye);
        // Three products and two sums of this size round to within this.
        assert!(value.abs() <= 1e-6 * to_eye.length(), "{value} of {}", to_eye.length());
        differing += 1;
    }
    assert!(differing < 100, "{differing} of {} differ", inputs.len());
}

#[test]
fn facing_from_corners_is_the_same_from_both_sides_of_an_edge() {
    #[derive(Clone, Copy, Pod, Zeroable)]
    #[repr(C)]
    struct Input {
        corners: [[f32; 4]; 3],
        eye: [f32; 4],
    }
    let mut random = Random(7);
    let inputs: Vec<Input> = (0..10_000)
        .map(|case| {
            let scale = [1.0, 1e-15, 1e15][case % 3];
            let corners = [0; 3].map(|_| (random.vec3() * scale).extend(1.0).to_array());
            let eye = (random.vec3() * scale * 0.7).extend(1.0).to_array();
            Input { corners, eye }
        })
        .collect();
    let body = "#import <common/facing.wgsl>
        struct Input { corners: array<vec4f, 3>, eye: vec4f }
        alias Output = u32;
        fn run(input: Input) -> Output {
            let a = input.corners[0].xyz;
            let b = input.corners[1].xyz;
            let c = input.corners[2].xyz;
            return u32(triangle_faces_eye(a, b, c, input.eye))
                | (u32(triangle_faces_eye(b, c, a, input.eye)) << 1u)
                | (u32(triangle_faces_eye(c, a, b, input.eye)) << 2u);
        }";
    let outputs: Vec<u32> = run_wgsl(gpu(), body, &inputs);
    let mut facing = 0;
    for (input, output) in inputs.iter().zip(outputs) {
        assert!(output == 0 || output == 7, "corners in another order: {output:03b}");
        let [a, b, c] = input.corners.map(|corner| Vec4::from(corner).truncate().as_dvec3());
        let eye = Vec4::from(input.eye).truncate().as_dvec3();
        let (normal, to_eye) = ((b - a).cross(c - a), eye - a);
        let cosine = normal.dot(to_eye) / (normal.length() * to_eye.length());
        assert!((cosine > 0.0) == (output == 7) || cosine.abs() < 1e-5, "{cosine}");
        facing += u32::from(output == 7);
    }
    assert!((3000..7000).contains(&facing), "{facing} of 10000 look at the eye");
}

#[test]
fn classification_agrees_in_every_case() {
    #[derive(Clone, Copy, Pod, Zeroable)]
    #[repr(C)]
    struct Input {
        word: u32,
        bits: u32,
        // The table begins at a multiple of 16 bytes in WGSL.
        padding: [u32; 2],
        table: ClassTable,
    }
    let tables = [
        ClassTable::all_in_one(),
        ClassTable::new(|class| Some(class as u32)),
        ClassTable::new(|class| (class as u32 % 2 == 1).then_some(class as u32 / 2)),
        ClassTable { ridge_steps: 100, valley_steps: 4000, ..ClassTable::all_in_one() },
        ClassTable { keeps_hidden: 1, ..ClassTable::all_in_one() },
    ];
    let creases = [0, 99 << 10, 100 << 10, 4000 << 10 | 1 << 23, 3999 << 10 | 1 << 23];
    let inputs: Vec<Input> = tables
        .into_iter()
        .flat_map(|table| {
            (0..EdgeFlags::all().bits() + 1).flat_map(move |flags| {
                (0..16).map(move |bits| {
                    let word = flags | creases[(flags + bits) as usize % creases.len()];
                    Input { word, bits, padding: [0; 2], table }
                })
            })
        })
        .collect();
    let body = "#import <common/feature.wgsl>
        struct Input { word: u32, bits: u32, padding: vec2u, table: ClassTable }
        struct Output { bits: u32, layer: u32 }
        fn run(input: Input) -> Output {
            let faces = EdgeFaces((input.bits & 1u) != 0u, (input.bits & 2u) != 0u,
                (input.bits & 4u) != 0u);
            let line = classify_edge(input.word, faces, input.table, (input.bits & 8u) != 0u);
            return Output(line.bits, line.layer);
        }";
    let outputs: Vec<[u32; 2]> = run_wgsl(gpu(), body, &inputs);
    for (Input { word, bits, table, .. }, [got, layer]) in inputs.iter().zip(outputs) {
        let faces =
            EdgeFaces { has_b: bits & 1 != 0, a_faces: bits & 2 != 0, b_faces: bits & 4 != 0 };
        let want = classify_edge(EdgeWord(*word), faces, table, bits & 8 != 0);
        assert_eq!(LineBits::from_bits(got), Some(want.bits), "{word:x} {bits:04b}");
        assert_eq!(layer, want.layer, "{word:x} {bits:04b} {table:?}");
    }
}

#[test]
fn cones_claim_what_their_twins_claim() {
    #[derive(Clone, Copy, Pod, Zeroable)]
    #[repr(C)]
    struct Input {
        cone: NormalCone,
        eye: [f32; 4],
    }
    let mut random = Random(11);
    let inputs: Vec<Input> = (0..10_000)
        .map(|case| {
            let axis = random.vec3().normalize_or(Vec3::X).to_array();
            let center = random.vec3().to_array();
            let cone = NormalCone {
                center,
                radius: 0.2 * random.unit(),
                axis,
                cosine: 0.1 + 0.9 * random.unit(),
            };
            let far = if case % 2 == 0 { 1.0 } else { 10.0 };
            Input {
                cone,
                eye: (random.vec3() * far).extend(f32::from(u8::from(case % 3 != 0))).into(),
            }
        })
        .collect();
    let body = "#import <common/normal_cone.wgsl>
        struct Input { cone: NormalCone, eye: vec4f }
        alias Output = u32;
        fn run(input: Input) -> Output { return cone_facing(input.cone, input.eye); }";
    let outputs: Vec<u32> = run_wgsl(gpu(), body, &inputs);
    let differing = inputs
        .iter()
        .zip(&outputs)
        .filter(|(input, output)| cone_facing(&input.cone, input.eye.into()) as u32 != **output);
    assert!(differing.count() <= 5, "within rounding of the bound");
    assert!(outputs.iter().filter(|&&claim| claim != 0).count() > 1000);
}

#[test]
fn random_scalars_are_equal_to_the_bit() {
    let mut random = Random(2);
    let mut ends = vec![[Vec4::ZERO, Vec4::ONE], [Vec4::splat(-0.0), Vec4::ONE]];
    ends.extend((0..5000).map(|_| [random.vec3().extend(0.0), random.vec3().extend(0.0)]));
    let body = "#import <common/mesh.wgsl>
        struct Input { p0: vec4f, p1: vec4f }
        alias Output = f32;
        fn run(input: Input) -> Output { return edge_random(input.p0.xyz, input.p1.xyz); }";
    let outputs: Vec<f32> = run_wgsl(gpu(), body, &ends);
    for ([p0, p1], got) in ends.iter().zip(outputs) {
        let want = edge_random(p0.truncate(), p1.truncate());
        assert_eq!(got.to_bits(), want.to_bits(), "{p0} {p1}");
    }
}

#[derive(Debug, Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct StrokeInput {
    c: [[f32; 4]; 4],
    n: [[f32; 4]; 2],
    viewport_px: [f32; 2],
    facing: [f32; 2],
    fade: [f32; 2],
    distance: [f32; 2],
    width: f32,
    r: f32,
    mirror: f32,
    bits: u32,
    kind: u32,
    placement: u32,
    parameterization: u32,
    is_world_width: u32,
}

/// The largest number of vertices of an edge.
const MOST_VERTICES: usize = LineKind::QuadAndDisks.vertex_count() as usize;

#[derive(Debug, Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct StrokeOutput {
    vertices: [[f32; 10]; MOST_VERTICES],
}

const KINDS: [LineKind; 5] =
    [LineKind::Thin, LineKind::Quad, LineKind::QuadAndCaps, LineKind::QuadAndDisks, LineKind::Fin];

const PLACEMENTS: [Placement; 4] =
    [Placement::Centered, Placement::Outside, Placement::Inside, Placement::Automatic];

impl StrokeInput {
    fn edge(&self) -> ClipEdge {
        let [c0, c1, c2, c3] = self.c.map(Vec4::from);
        let [n0, n1] = self.n.map(Vec4::from);
        let (facing, distance) = (self.facing.into(), self.distance.into());
        ClipEdge { c0, c1, c2, c3, n0, n1, facing, distance, r: self.r }
    }

    fn shape(&self) -> StrokeShape {
        let parameterizations = [Parameterization::ObjectSpace, Parameterization::ScreenSpace];
        StrokeShape {
            viewport_px: self.viewport_px.into(),
            origin_px: Vec2::new(13.0, -7.0),
            fade: self.fade.into(),
            width: self.width,
            px_per_unit: 300.0,
            brush_aspect: 8.0,
            mirror: self.mirror,
            kind: KINDS[self.kind as usize],
            placement: PLACEMENTS[self.placement as usize],
            parameterization: parameterizations[self.parameterization as usize],
            is_world_width: self.is_world_width != 0,
            guard_band: edgemesh::view::WHOLE_BAND,
        }
    }
}

/// Edges of all kinds: in the picture, far outside it, through the eye plane, along the line
/// of sight, without length, exactly on the clip planes.
fn stroke_inputs() -> Vec<StrokeInput> {
    let mut random = Random(3);
    let point = |kind: usize, random: &mut Random| -> Vec4 {
        let w = match kind % 4 {
            0 => random.unit() + 0.5,
            1 => random.signed() * 2.0,
            2 => 0.1 + 1e-4 * random.signed(),
            _ => 1.0,
        };
        let spread = if kind.is_multiple_of(7) { 1000.0 } else { 1.5 };
        let xy = Vec2::new(random.signed(), random.signed()) * spread;
        // The near plane lies at w = 0.1, as a finite projection has it.
        let z = 0.1 * (10.0 - w) / 9.9;
        Vec4::new(xy.x, xy.y, if kind % 4 == 3 { random.unit() } else { z }, w)
    };
    (0..16_000)
        .map(|case| {
            let c0 = point(case, &mut random);
            let mut c1 = point(case / 3, &mut random);
            if case % 11 == 0 {
                c1 = c0;
            } else if case % 13 == 0 {
                c1 = c0 * Vec4::new(2.0, 2.0, 1.0, 2.0);
            } else if case % 3 == 0 {
                c1 = c0 + Vec4::new(0.01 * random.signed(), 0.01 * random.signed(), 0.0, 0.0);
            }
            let c2 = point(case, &mut random);
            let c3 = if case % 5 == 0 { c0 } else { point(case + 1, &mut random) };
            let n0 = random.vec3().extend(0.3 * random.signed());
            let n1 = if case % 9 == 0 { Vec4::ZERO } else { random.vec3().extend(0.0) };
            let bits = [0, 1 << 31, 3 << 30, 1 << 30][case % 4];
            let is_world_width = u32::from(case % 17 == 0);
            let fades = case % 19 == 0;
            StrokeInput {
                c: [c0, c1, c2, c3].map(|vector: Vec4| vector.to_array()),
                n: [n0, n1].map(|vector: Vec4| vector.to_array()),
                viewport_px: if case % 2 == 0 { [640.0, 480.0] } else { [256.0, 256.0] },
                facing: [random.unit(), 0.4 * random.unit()],
                fade: if fades { [0.5, 2.5] } else { [0.0; 2] },
                distance: [3.0 * random.unit(), 3.0 * random.unit()],
                width: (1.0 + 9.0 * random.unit()) * if is_world_width == 1 { 0.01 } else { 1.0 },
                r: random.unit(),
                mirror: if case % 23 == 0 { -1.0 } else { 1.0 },
                bits,
                kind: u32::try_from(case / 4 % KINDS.len()).unwrap(),
                placement: u32::try_from(case / 5 % PLACEMENTS.len()).unwrap(),
                parameterization: u32::from(case % 29 > 14),
                is_world_width,
            }
        })
        .collect()
}

const STROKE_BODY: &str = "#import <common/stroke_vertex.wgsl>
    struct Input {
        c: array<vec4f, 4>,
        n: array<vec4f, 2>,
        viewport_px: vec2f,
        facing: vec2f,
        fade: vec2f,
        distance: vec2f,
        width: f32,
        r: f32,
        mirror: f32,
        bits: u32,
        kind: u32,
        placement: u32,
        parameterization: u32,
        is_world_width: u32,
    }
    struct Output { vertices: array<array<f32, 10>, 24> }
    fn run(input: Input) -> Output {
        let edge = ClipEdge(input.c[0], input.c[1], input.c[2], input.c[3], input.n[0], input.n[1],
            input.facing, input.distance, input.r);
        let shape = StrokeShape(input.viewport_px, vec2f(13.0, -7.0), input.fade, input.width,
            300.0, 8.0, input.mirror, input.kind, input.placement, input.parameterization,
            input.is_world_width != 0u, vec4f(-4.0, 4.0, -4.0, 4.0));
        let counts = array<u32, 5>(2u, 4u, 10u, 24u, 4u);
        var output: Output;
        for (var i = 0u; i < counts[input.kind]; i++) {
            let vertex = stroke_vertex(edge, shape, input.bits, i);
            let position = vertex.position;
            output.vertices[i] = array<f32, 10>(
                position.x, position.y, position.z, vertex.u, vertex.v, vertex.opacity,
                vertex.foot.x, vertex.foot.y, vertex.foot.z, vertex.over_px);
        }
        return output;
    }";

#[test]
fn stroke_vertices_agree_and_are_always_finite() {
    let inputs = stroke_inputs();
    let outputs: Vec<StrokeOutput> = run_wgsl(gpu(), STROKE_BODY, &inputs);
    let (mut compared, mut unclear) = (0, 0);
    for (case, (input, output)) in inputs.iter().zip(&outputs).enumerate() {
        let (edge, shape) = (input.edge(), input.shape());
        let spine = project_spine(edge.c0, edge.c1, shape.viewport_px, shape.guard_band);
        let length_px = (spine.s1 - spine.s0).length();
        // If an edge is as short as rounding errors, or its normal points along it or at the
        // eye, its direction or its side is undefined.
        let is_clear = spine.p == Vec2::ZERO && length_px < 1e-6 || length_px > 0.05;
        for corner in 0..shape.kind.vertex_count() {
            let bits = LineBits::from_bits_truncate(input.bits);
            let want = stroke_vertex(&edge, &shape, bits, corner);
            let [x, y, z, u, v, opacity, foot @ .., over_px] = output.vertices[corner as usize];
            let (got, foot) = (Vec3::new(x, y, z), Vec3::from(foot));
            let is_finite = got.is_finite()
                && foot.is_finite()
                && [u, v, opacity, over_px].iter().all(|value| value.is_finite());
            assert!(is_finite, "case {case}: {got} {u} {v} {opacity}");
            let apart = (got - want.position).truncate() * shape.viewport_px * 0.5;
            let is_equal = apart.length() < 0.02 * (1.0 + got.truncate().length() * 1e-3)
                && (got.z - want.position.z).abs() < 1e-3
                && (v - want.v).abs() < 1e-3
                && (opacity - want.opacity).abs() < 1e-3
                && (foot - want.foot).truncate().length() < 0.02 * (1.0 + foot.length() * 1e-3)
                && (foot.z - want.foot.z).abs() < 1e-3
                && (over_px - want.over_px).abs() < 0.02
                && (u - want.u).abs() < 1e-2 * (1.0 + want.u.abs() * 1e-2);
            compared += 1;
            if !is_equal {
                assert!(
                    !is_clear || is_side_unclear(&edge, &spine, &shape),
                    "case {case}, vertex {corner} of {shape:?}: {got} {u} {v} {opacity} against {want:?}, \
                     length {length_px}"
                );
                unclear += 1;
            }
        }
    }
    assert!(unclear * 100 < compared, "{unclear} of {compared} are unclear");
}

/// The noise of an unsteady hand is bounded, differs by seed, and is continuous in place and
/// wavelength.
#[test]
fn noise_is_smooth_in_place_and_wavelength() {
    #[derive(Clone, Copy, Pod, Zeroable)]
    #[repr(C)]
    struct Input {
        position: [f32; 3],
        wavelength: f32,
        seed: [u32; 4],
    }
    let mut random = Random(3);
    let inputs: Vec<Input> = (0..20_000_u32)
        .map(|case| Input {
            position: (random.vec3() * 20.0).into(),
            // Half of them at or just below a power of two.
            wavelength: if case % 2 == 0 { 2.0 } else { 0.3 + random.unit() * 5.0 },
            seed: [case % 3; 4],
        })
        .collect();
    let body = "#import <common/noise.wgsl>
        struct Input { position: vec3f, wavelength: f32, seed: vec4u }
        struct Output { here: f32, beside: f32, longer: f32, other: f32 }
        fn run(input: Input) -> Output {
            let beside = input.position + vec3f(0.0005, -0.0005, 0.0005) * input.wavelength;
            return Output(
                noise_of(input.position, input.wavelength, input.seed.x),
                noise_of(beside, input.wavelength, input.seed.x),
                noise_of(input.position, input.wavelength * 0.9999, input.seed.x),
                noise_of(input.position, input.wavelength, input.seed.x + 7u),
            );
        }";
    let outputs: Vec<[f32; 4]> = run_wgsl(gpu(), body, &inputs);
    let mut spread = 0;
    let mut apart = 0;
    for [here, beside, longer, other] in outputs {
        assert!(here.abs() <= 1.0, "{here}");
        assert!((here - beside).abs() < 0.01, "{here} and {beside} a thousandth apart");
        assert!((here - longer).abs() < 0.01, "{here} and {longer}: a jump between octaves");
        spread += i32::from(here.abs() > 0.3);
        apart += i32::from((here - other).abs() > 0.1);
    }
    assert!(spread > 3000 && apart > 10_000, "{spread} far from zero, {apart} by another seed");
}

/// Whether a vertex normal points so nearly along the edge that rounding decides its side,
/// or the edge is so near 45 degrees that rounding decides whether it is mostly vertical.
fn is_side_unclear(edge: &ClipEdge, spine: &Spine, shape: &StrokeShape) -> bool {
    let along = spine.s1 - spine.s0;
    let is_diagonal = (along.x.abs() - along.y.abs()).abs() < 1e-3 * along.length();
    let is_along = [(spine.t0, edge.n0), (spine.t1, edge.n1)].into_iter().any(|(t, normal)| {
        let m = screen_normal(lerp(edge.c0, edge.c1, t), normal, shape.viewport_px);
        m.dot(spine.p).abs() < 1e-4
    });
    is_along || is_diagonal && shape.parameterization == Parameterization::ScreenSpace
}

/// Cameras around a mesh, one of them inside it.
fn cameras(mesh: &EdgeMesh) -> Vec<Camera> {
    let default = Camera::default_view(&mesh.bounds);
    let directions =
        [DVec3::X, DVec3::new(-1.0, 0.3, 0.6), DVec3::new(0.1, -1.0, 0.2), DVec3::Z * 0.01];
    let mut cameras: Vec<Camera> = directions
        .into_iter()
        .map(|direction| {
            let eye = default.target + direction * mesh.bounds.radius() * 3.0;
            Camera { eye, ..default }
        })
        .collect();
    cameras.push(Camera { is_orthographic: true, ..default });
    cameras.push(default);
    cameras
}

/// Detects lines on the GPU, in one layout.
pub(crate) struct Detector {
    renderer: Renderer,
}

impl Detector {
    pub(crate) fn new(layout: Layout) -> Self {
        let options = RendererOptions { layout, ..RendererOptions::new(TargetFormats::new(1)) };
        Self { renderer: Renderer::new(gpu(), options).unwrap() }
    }

    /// The facing bits, the counts, and the live list from the GPU.
    pub(crate) fn detect(
        &mut self,
        mesh: &EdgeMesh,
        view: &View,
        technique: &Technique,
    ) -> (Vec<u32>, Tally, Vec<u32>) {
        let gpu = gpu();
        let RendererOptions { layout, formats, .. } = *self.renderer.options();
        let style = self.renderer.prepare(gpu, &drawing_style_of(technique, mesh)).unwrap();
        let buffers = Arc::new(MeshBuffers::new(&gpu.device, mesh, layout).unwrap());
        let instance = MeshInstance::new(&buffers, DMat4::IDENTITY);
        let mut scene = SceneView::new(gpu, vec![instance], vec![style]);
        let targets = Targets::new(&gpu.device, [16, 16], formats);
        // Twice: the second frame reuses the static edges of the first.
        for _ in 0..2 {
            self.renderer.render(gpu, &targets, &mut scene, view, [0.0; 4], None).unwrap();
        }
        let object = &scene.drawing.objects()[0];
        let facing = object.read_facing(gpu, 0).unwrap();
        (facing, object.read_tally(gpu).unwrap(), object.read_live(gpu, 0).unwrap())
    }
}

#[test]
fn live_edges_and_counts_equal_the_oracles() {
    let techniques: [&[&str]; 4] = [
        &[],
        &["ridge.width=3", "boundary.render=false", "valley.color=#ff0000"],
        &["hidden.render=true", "contour.width=4"],
        &["strokes.ridge_angle=5", "strokes.valley_angle=70", "contour.render=false"],
    ];
    let mut detector = Detector::new(Layout::Indexed);
    for (name, mesh) in own_models() {
        for (camera, settings) in cameras(&mesh).iter().zip(techniques.iter().cycle()) {
            let view = camera.view(&mesh.bounds, 1.0);
            let technique = technique("ink", settings);
            let style = drawing_style_of(&technique, &mesh);
            let outside = eye_is_outside(view.eye, mesh.bounds.min.into(), mesh.bounds.max.into());
            let lines = classify_lines(&mesh, view.eye, &style.class_table(), outside);
            let (facing, tally, live) = detector.detect(&mesh, &view, &technique);
            let bits = facing_bits(&mesh, view.eye);
            let is_same = (0..bits.len())
                .all(|face| bits[face] == (facing[face / 32] >> (face % 32) & 1 == 1));
            assert!(is_same, "{name}: facing bits from {}", camera.eye);
            let counts = count_features(&mesh, view.eye);
            let (found, wanted) = (tally.features(), counts);
            assert_eq!(found[LineClass::Contour], wanted[LineClass::Contour], "{name}");
            if style.thresholds.is_none() {
                assert_eq!(found, wanted, "{name}");
            }
            let mut want = Vec::new();
            for layer in 0..u32::try_from(style.layers.len()).unwrap() {
                let of_layer = (0..).zip(&lines).filter(|(_, line)| line.layer == layer);
                want.extend(
                    of_layer.map(|(edge, line): (u32, &Line)| {
                        edge | (line.bits - LineBits::DRAWN).bits()
                    }),
                );
            }
            assert_eq!(live, want, "{name}: by layer, in the order of the records");
        }
    }
}

/// A replicated edge decides from its own vertices: the same list, except at faces that are
/// edge-on within rounding.
#[test]
fn replicated_edges_find_the_same_lines() {
    let (mut lines, mut differing) = (0, 0);
    let [mut indexed, mut replicated] = [Layout::Indexed, Layout::Replicated].map(Detector::new);
    for (name, mesh) in own_models() {
        for camera in cameras(&mesh) {
            let view = camera.view(&mesh.bounds, 1.0);
            let technique = technique("ink", &[]);
            let (_, counts, want) = indexed.detect(&mesh, &view, &technique);
            let (_, tally, live) = replicated.detect(&mesh, &view, &technique);
            let edge_on = |face: u32| {
                let plane = &mesh.face_planes[face as usize];
                let to_eye = view.eye.truncate() - view.eye.w * Vec4::from(plane.point).truncate();
                let cosine = Vec4::from(plane.normal).truncate().dot(to_eye) / to_eye.length();
                cosine.abs() < 1e-5
            };
            let of_edge = |entry: u32| (entry & 0x1fff_ffff, entry);
            let want: std::collections::BTreeMap<u32, u32> =
                want.into_iter().map(of_edge).collect();
            let live: std::collections::BTreeMap<u32, u32> =
                live.into_iter().map(of_edge).collect();
            lines += want.len();
            for edge in
                want.keys().chain(live.keys()).filter(|edge| want.get(edge) != live.get(edge))
            {
                let record = &mesh.records[*edge as usize];
                let faces = [record.face_a, record.face_b].into_iter().filter(|&face| face != NONE);
                assert!(faces.into_iter().any(edge_on), "{name}: edge {edge}");
                differing += 1;
            }
            if differing == 0 {
                assert_eq!(tally, counts, "{name}");
            }
        }
    }
    assert!(lines > 5000 && differing * 1000 < lines, "{differing} of {lines} differ");
}

#[test]
fn a_mesh_without_edges_draws_nothing() {
    let mesh = build_edge_mesh(
        &edgemesh::model::Model::from_polygons(&[[0.0; 3]; 3], &[&[0, 1, 2]]),
        &BuildOptions::default(),
        &mut Report::default(),
    );
    let view = Camera::default_view(&mesh.bounds).view(&mesh.bounds, 1.0);
    let mut detector = Detector::new(Layout::Indexed);
    let (_, tally, live) = detector.detect(&mesh, &view, &technique("ink", &[]));
    assert_eq!((tally.stroke_count, live.len()), (0, 0));
}
