//! The shaders against their CPU twins, over random and adversarial data.

use bytemuck::{Pod, Zeroable};
use edgemesh::build::{BuildOptions, build_edge_mesh};
use edgemesh::camera::Camera;
use edgemesh::edge_mesh::{EdgeMesh, FacePlane};
use edgemesh::oracle::facing::faces_eye;
use edgemesh::oracle::feature::{LineBits, classify_edge};
use edgemesh::oracle::spine::project_spine;
use edgemesh::oracle::stroke_vertex::{ClipEdge, StrokeShape, VERTICES_PER_EDGE, stroke_vertex};
use edgemesh::oracle::{classify_edges, count_features, facing_bits};
use edgemesh::read::read_model;
use edgemesh::record::{EdgeFlags, edge_random};
use edgemesh::report::Report;
use glam::{DVec3, Vec2, Vec3, Vec4};
use strokes::frame::FrameUniform;
use strokes::gpu::Gpu;
use strokes::mesh_buffers::{MeshBuffers, Tally};
use strokes::readback::read_buffer;
use strokes::renderer::Renderer;
use strokes::targets::Targets;
use testkit::locate::workspace_root;
use testkit::wgsl_fn::run_wgsl;
use viewer::technique::Technique;

use crate::gpu_device::gpu;

/// Numbers from a fixed seed (Marsaglia's xorshift), the same on every machine.
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        f32::from(u16::try_from(self.0 >> 48).unwrap()) / 65535.0
    }

    fn signed(&mut self) -> f32 {
        2.0 * self.unit() - 1.0
    }

    fn vec3(&mut self) -> Vec3 {
        Vec3::new(self.signed(), self.signed(), self.signed())
    }
}

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
                // Nearly in the plane.
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
fn classification_agrees_in_every_case() {
    #[derive(Clone, Copy, Pod, Zeroable)]
    #[repr(C)]
    struct Input {
        flags: u32,
        bits: u32,
    }
    let inputs: Vec<Input> = (0..EdgeFlags::all().bits() + 1)
        .flat_map(|flags| (0..16).map(move |bits| Input { flags, bits }))
        .collect();
    let body = "#import <common/feature.wgsl>
        struct Input { flags: u32, bits: u32 }
        alias Output = u32;
        fn run(input: Input) -> Output {
            return classify_edge(input.flags, (input.bits & 1u) != 0u, (input.bits & 2u) != 0u,
                (input.bits & 4u) != 0u, (input.bits & 8u) != 0u);
        }";
    let outputs: Vec<u32> = run_wgsl(gpu(), body, &inputs);
    for (Input { flags, bits }, got) in inputs.iter().zip(outputs) {
        let flags = EdgeFlags::from_bits(*flags).unwrap();
        let want = classify_edge(flags, bits & 1 != 0, bits & 2 != 0, bits & 4 != 0, bits & 8 != 0);
        assert_eq!(LineBits::from_bits(got), Some(want), "{flags:?} {bits:04b}");
    }
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
    width_px: f32,
    r: f32,
    bits: u32,
    padding: u32,
    facing: [f32; 2],
}

#[derive(Debug, Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct StrokeOutput {
    vertices: [[f32; 8]; 12],
}

/// Edges of all kinds: in the picture, far out of it, through the eye plane,
/// along the line of sight, of no length, at the planes themselves.
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
    (0..8000)
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
            StrokeInput {
                c: [c0, c1, c2, c3].map(|vector: Vec4| vector.to_array()),
                n: [n0, n1].map(|vector: Vec4| vector.to_array()),
                viewport_px: if case % 2 == 0 { [640.0, 480.0] } else { [256.0, 256.0] },
                width_px: 1.0 + 9.0 * random.unit(),
                r: random.unit(),
                bits,
                padding: 0,
                facing: [random.unit(), 0.4 * random.unit()],
            }
        })
        .collect()
}

const STROKE_BODY: &str = "#import <common/stroke_vertex.wgsl>
    struct Input {
        c: array<vec4f, 4>,
        n: array<vec4f, 2>,
        viewport_px: vec2f,
        width_px: f32,
        r: f32,
        bits: u32,
        padding: u32,
        facing: vec2f,
    }
    struct Vertex { position: vec4f, uv: vec2f, padding: vec2f }
    struct Output { vertices: array<Vertex, 12> }
    fn run(input: Input) -> Output {
        let edge = ClipEdge(input.c[0], input.c[1], input.c[2], input.c[3], input.facing, input.n[0], input.n[1], input.r);
        let shape = StrokeShape(input.viewport_px, input.width_px, 8.0);
        var output: Output;
        for (var i = 0u; i < 12u; i++) {
            let vertex = stroke_vertex(edge, shape, input.bits, i);
            output.vertices[i] = Vertex(vertex.position, vertex.uv, vec2f(0.0));
        }
        return output;
    }";

#[test]
fn stroke_vertices_agree_and_are_always_finite() {
    let inputs = stroke_inputs();
    let outputs: Vec<StrokeOutput> = run_wgsl(gpu(), STROKE_BODY, &inputs);
    let (mut compared, mut unclear) = (0, 0);
    for (case, (input, output)) in inputs.iter().zip(&outputs).enumerate() {
        let [c0, c1, c2, c3] = input.c.map(Vec4::from);
        let [n0, n1] = input.n.map(Vec4::from);
        let edge = ClipEdge { c0, c1, c2, c3, facing: input.facing.into(), n0, n1, r: input.r };
        let viewport_px = Vec2::from(input.viewport_px);
        let shape = StrokeShape { viewport_px, width_px: input.width_px, brush_aspect: 8.0 };
        let spine = project_spine(c0, c1, viewport_px);
        let length_px = (spine.s1 - spine.s0).length();
        // Where an edge is as short as rounding, or its normal points along it
        // or at the eye, its direction or its side is anybody's guess.
        let is_clear = spine.p == Vec2::ZERO && length_px < 1e-6 || length_px > 0.05;
        for index in 0..VERTICES_PER_EDGE {
            let bits = LineBits::from_bits_truncate(input.bits);
            let want = stroke_vertex(&edge, &shape, bits, index);
            let [x, y, z, w, u, v, ..] = output.vertices[index as usize];
            let got = Vec4::new(x, y, z, w);
            assert!(got.is_finite() && u.is_finite() && v.is_finite(), "case {case}: {got}");
            let moved_px =
                ((got - want.position).truncate().truncate() * viewport_px * 0.5).length();
            let is_equal = moved_px < 0.02
                && (got.z - want.position.z).abs() < 1e-3
                && (Vec2::new(u, v) - want.uv).abs().max_element() < 1e-2;
            compared += 1;
            if !is_equal {
                assert!(
                    !is_clear || is_side_unclear(&edge, &spine, viewport_px),
                    "case {case}, vertex {index}: {got} against {want:?}, length {length_px}"
                );
                unclear += 1;
            }
        }
    }
    assert!(unclear * 200 < compared, "{unclear} of {compared} are unclear");
}

/// Whether a vertex normal points so nearly along the edge that its side is
/// within rounding.
fn is_side_unclear(
    edge: &ClipEdge,
    spine: &edgemesh::oracle::spine::Spine,
    viewport_px: Vec2,
) -> bool {
    use edgemesh::oracle::spine::{lerp, screen_normal};
    [(spine.t0, edge.n0), (spine.t1, edge.n1)].into_iter().any(|(t, normal)| {
        let m = screen_normal(lerp(edge.c0, edge.c1, t), normal, viewport_px);
        m.dot(spine.p).abs() < 1e-4
    })
}

/// The project's own models.
pub(crate) fn own_models() -> Vec<(String, EdgeMesh)> {
    let mut paths: Vec<_> = std::fs::read_dir(workspace_root().join("models"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|end| end == "obj"))
        .collect();
    paths.sort();
    assert!(paths.len() >= 4, "the project's own models are there");
    paths
        .into_iter()
        .map(|path| {
            let (model, mut report) = read_model(&path).unwrap();
            let mesh = build_edge_mesh(&model, &BuildOptions::default(), &mut report);
            (path.file_stem().unwrap().to_string_lossy().into_owned(), mesh)
        })
        .collect()
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

fn detect(gpu: &Gpu, mesh: &EdgeMesh, view: &FrameUniform) -> (Vec<u32>, Tally, Vec<u32>) {
    let renderer = Renderer::new(gpu, &Technique::by_name("ink").unwrap().look(), 1).unwrap();
    let buffers = MeshBuffers::new(&gpu.device, mesh).unwrap();
    let draw = renderer.mesh_draw(&gpu.device, buffers);
    let targets = Targets::new(&gpu.device, [16, 16], 1);
    let meshes = [draw];
    renderer.render(gpu, &targets, view, &meshes, None);
    let buffers = &meshes[0].buffers;
    let tally: Tally = read_buffer(gpu, buffers.tally(), 1).unwrap()[0];
    let live = read_buffer(gpu, buffers.live(), tally.instance_count as usize).unwrap();
    let words = mesh.triangles.len().div_ceil(32);
    (read_buffer(gpu, buffers.facing(), words).unwrap(), tally, live)
}

#[test]
fn live_edges_and_counts_equal_the_oracles() {
    for (name, mesh) in own_models() {
        for camera in cameras(&mesh) {
            let view = camera.view(&mesh.bounds, 1.0);
            let uniform = FrameUniform::new(&view, Vec2::splat(16.0));
            let (facing, tally, live) = detect(gpu(), &mesh, &uniform);
            let bits = facing_bits(&mesh, view.eye);
            let is_same = (0..bits.len())
                .all(|face| bits[face] == (facing[face / 32] >> (face % 32) & 1 == 1));
            assert!(is_same, "{name}: facing bits from {}", camera.eye);
            assert_eq!(tally.features(), count_features(&mesh, view.eye), "{name}");
            let carried = LineBits::CONTOUR | LineBits::A_FACES;
            let want: Vec<u32> = (0..)
                .zip(classify_edges(&mesh, view.eye))
                .filter(|(_, bits)| bits.contains(LineBits::DRAWN))
                .map(|(edge, bits): (u32, LineBits)| edge | (bits & carried).bits())
                .collect();
            assert_eq!(live, want, "{name}: in the order of the records");
        }
    }
}

#[test]
fn a_mesh_without_edges_draws_nothing() {
    let mesh = build_edge_mesh(
        &edgemesh::model::Model::from_polygons(&[[0.0; 3]; 3], &[&[0, 1, 2]]),
        &BuildOptions::default(),
        &mut Report::default(),
    );
    let view = Camera::default_view(&mesh.bounds).view(&mesh.bounds, 1.0);
    let (_, tally, live) = detect(gpu(), &mesh, &FrameUniform::new(&view, Vec2::splat(16.0)));
    assert_eq!((tally.instance_count, live.len()), (0, 0));
}
