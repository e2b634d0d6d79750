//! The chains of the GPU against those of the CPU: the same edges in the same order, in
//! every layout, in chunks, and mirrored.

use std::sync::Arc;

use edgemesh::build::{BuildOptions, build_edge_mesh};
use edgemesh::edge_mesh::{EdgeMesh, FaceEdges, StaticLinks};
use edgemesh::format::read::read_model;
use edgemesh::line::{LineClass, NO_LAYER};
use edgemesh::model::Model;
use edgemesh::oracle::layer_chain::{LayerChain, LayerLinks};
use edgemesh::report::Report;
use edgemesh::view::{Camera, Line, LineBits};
use glam::{DMat4, DVec3};
use strokes::layouts::{BACKWARD, CUT_END, CUT_START, CUT_WHOLE, NO_NODE, ON_LOOP};
use strokes::{
    DrawingStyle, Gpu, GraphReadback, Layer, Layout, LinkStyle, MeshBuffers, MeshInstance,
    MeshOptions, Renderer, RendererOptions, SceneView, StrokeStyle, TargetFormats, Targets,
    read_texels,
};
use testkit::locate::{left_out, shared};

use crate::gpu_device::{gpu, gpu_with_limits};
use crate::gpu_render::own_model;
use crate::layer_chains::{VIEWS, check_chain, eye};
use crate::own_models::own_models;

/// Linked strokes, contours apart from everything else.
fn linked_look() -> DrawingStyle {
    let style = StrokeStyle { link: Some(LinkStyle::default()), ..StrokeStyle::default() };
    let layer = |classes| Layer { classes, visible: Some(style.clone()), hidden: None };
    let others = LineClass::ALL.into_iter().filter(|class| *class != LineClass::Contour);
    DrawingStyle {
        fill_color: Some([1.0; 4]),
        layers: vec![layer(vec![LineClass::Contour]), layer(others.collect())],
        ..DrawingStyle::default()
    }
}

/// A renderer of linked strokes.
fn renderer(gpu: &Gpu, layout: Layout) -> Renderer {
    let options = RendererOptions { layout, ..RendererOptions::new(TargetFormats::new(1)) };
    Renderer::new(gpu, options).unwrap()
}

/// A mesh in a layout, with its renderer.
struct Linker<'a> {
    gpu: &'a Gpu,
    mesh: &'a EdgeMesh,
    renderer: &'a mut Renderer,
    targets: Targets,
    scene: SceneView,
    faces: FaceEdges,
    links: StaticLinks,
}

impl<'a> Linker<'a> {
    fn new(gpu: &'a Gpu, mesh: &'a EdgeMesh, renderer: &'a mut Renderer) -> Self {
        let RendererOptions { layout, formats, .. } = *renderer.options();
        let style = renderer.prepare(gpu, &linked_look()).unwrap();
        let options = MeshOptions { layout, links: true, ..MeshOptions::default() };
        let buffers = Arc::new(MeshBuffers::new(&gpu.device, mesh, options).unwrap());
        let instance = MeshInstance::new(&buffers, DMat4::IDENTITY);
        let scene = SceneView::new(gpu, vec![instance], vec![style]);
        let targets = Targets::new(&gpu.device, [16, 16], formats);
        let (faces, links) = (FaceEdges::of(mesh), StaticLinks::of(mesh));
        Self { gpu, mesh, renderer, targets, scene, faces, links }
    }

    fn graph(&mut self, camera: &Camera) -> GraphReadback {
        let view = camera.view(&self.mesh.bounds, 1.0);
        self.renderer
            .render(self.gpu, &self.targets, &mut self.scene, &view, [0.0; 4], None)
            .unwrap();
        self.scene.drawing.objects()[0].read_graph(self.gpu).unwrap().unwrap()
    }

    /// Checks the graph of a view against that of the CPU; returns the number of contours.
    fn check(&mut self, name: &str, camera: &Camera) -> usize {
        let graph = self.graph(camera);
        let drawn = self.scene.drawing.objects()[0].read_tally(self.gpu).unwrap().stroke_count;
        assert_eq!(graph.header.node_count, drawn, "{name}: nodes and drawn edges");
        let lines = lines_of(self.mesh, &graph);
        let (mesh, faces, links, lines) = (self.mesh, &self.faces, &self.links, &lines);
        let linking = LayerLinks { mesh, faces, links, lines, draws_contours: true };
        let want: Vec<LayerChain> = (0..2).flat_map(|layer| linking.chains(layer)).collect();
        let found = chains_of(&graph);
        for (chain, wanted) in found.iter().zip(&want) {
            let edges: Vec<(u32, bool)> =
                wanted.elements.iter().map(|element| (element.edge, element.is_reversed)).collect();
            assert_eq!((&chain.edges, chain.is_closed), (&edges, wanted.is_closed), "{name}");
            check_chain(&linking, wanted);
        }
        assert_eq!(found.len(), want.len(), "{name}");
        assert_eq!(found.len(), graph.header.chain_count as usize, "{name}");
        check_geometry(name, &graph);
        lines.iter().filter(|line| line.bits.contains(LineBits::CONTOUR)).count()
    }
}

/// The line of each record, from the nodes.
fn lines_of(mesh: &EdgeMesh, graph: &GraphReadback) -> Vec<Line> {
    let mut lines = vec![Line { bits: LineBits::empty(), layer: NO_LAYER }; mesh.records.len()];
    for (at, node) in (0_u32..).zip(&graph.nodes) {
        let layer = graph.layer_of_node(at);
        let is_backward = node.edge & BACKWARD != 0;
        let mut bits = LineBits::DRAWN;
        bits.set(LineBits::CONTOUR, node.edge & LineBits::CONTOUR.bits() != 0);
        bits.set(LineBits::A_FACES, !is_backward);
        let edge = (node.edge & NO_NODE) as usize;
        assert!(lines[edge].bits.is_empty(), "edge {edge} has two nodes");
        lines[edge] = Line { bits, layer: u32::try_from(layer).unwrap() };
    }
    lines
}

struct FoundChain {
    edges: Vec<(u32, bool)>,
    is_closed: bool,
}

/// The chains, from the elements.
fn chains_of(graph: &GraphReadback) -> Vec<FoundChain> {
    let mut chains: Vec<FoundChain> = Vec::new();
    for (at, element) in (0_u32..).zip(&graph.elements) {
        if element.first == at {
            let is_closed = element.count & ON_LOOP != 0;
            chains.push(FoundChain { edges: Vec::new(), is_closed });
        }
        let node = &graph.nodes[element.node as usize];
        let chain = chains.last_mut().unwrap();
        chain.edges.push((node.edge & NO_NODE, node.edge & BACKWARD != 0));
        assert!(
            chain.edges.len() <= (element.count & !ON_LOOP) as usize,
            "a chain is longer than its count"
        );
    }
    chains
}

/// Each element ends where the next begins, to the bit, and arc lengths add up.
fn check_geometry(name: &str, graph: &GraphReadback) {
    for (at, pair) in graph.elements.windows(2).enumerate() {
        let [node, next] = [0, 1].map(|of| &graph.nodes[pair[of].node as usize]);
        let length = f64::from(node.s1[0] - node.s0[0]).hypot(f64::from(node.s1[1] - node.s0[1]));
        let arc = f64::from(pair[1].arc.wrapping_sub(pair[0].arc)) / 1024.0;
        assert!((arc - length).abs() <= 1e-3 + 1e-6 * length, "{name}: {arc} of {length} px");
        if pair[1].first == u32::try_from(at + 1).unwrap() {
            continue;
        }
        let is_clipped = node.next & (CUT_END | CUT_WHOLE) != 0 || next.next & CUT_START != 0;
        assert!(is_clipped || node.s1 == next.s0, "{name}: a gap at element {at}");
        assert_eq!(node.next & NO_NODE, pair[1].node, "{name}: the order of elements and links");
    }
}

fn camera_of(mesh: &EdgeMesh, view: u32) -> Camera {
    Camera { eye: eye(mesh, view), ..Camera::default_view(&mesh.bounds) }
}

#[test]
fn chains_of_own_models_equal_those_of_the_cpu() {
    let mut renderer = renderer(gpu(), Layout::Indexed);
    for (name, mesh) in own_models() {
        let mut linker = Linker::new(gpu(), &mesh, &mut renderer);
        for view in (0..VIEWS).step_by(5) {
            linker.check(&name, &camera_of(&mesh, view));
        }
    }
}

/// More than a thousand views of real models, some of them awkward.
#[test]
fn chains_of_real_models_are_the_cpus() {
    let names = [
        "models/cow.obj",
        "models/fandisk.obj",
        "models/rocker-arm.obj",
        "models/spot.obj",
        "models/stanford-bunny.obj",
        "models/suzanne.obj",
        "models/teapot.obj",
        "corpus/obj/meshoptimizer/pirate.obj",
        "corpus/obj/assimp/WusonOBJ.obj",
    ];
    let Some(folder) = shared() else { return left_out("chains of real models", names.len()) };
    let mut contours = 0;
    let mut renderer = renderer(gpu(), Layout::Indexed);
    for name in names {
        let (model, mut report) = read_model(&folder.join(name)).unwrap();
        let mesh = build_edge_mesh(&model, &BuildOptions::default(), &mut report);
        let mut linker = Linker::new(gpu(), &mesh, &mut renderer);
        for view in 0..VIEWS {
            contours += linker.check(name, &camera_of(&mesh, view));
        }
    }
    assert!(contours > 1_000_000, "{contours} contours");
}

/// The other layouts, and bindings that hold a few hundred replicated edges each.
#[test]
fn chains_are_the_same_in_every_layout_and_across_chunks() {
    let small = gpu_with_limits(|limits| limits.max_storage_buffer_binding_size = 600_000);
    let mut chunks = 0;
    for (gpu, layout, is_cut) in [
        (gpu(), Layout::Replicated, false),
        (gpu(), Layout::Replicated16, false),
        (&small, Layout::Replicated, true),
    ] {
        let mut renderer = renderer(gpu, layout);
        for (name, mesh) in own_models() {
            let mut linker = Linker::new(gpu, &mesh, &mut renderer);
            for view in [3, 40, 77, 101] {
                linker.check(&name, &camera_of(&mesh, view));
                let chunk_count = linker.scene.instances[0].mesh().chunk_count();
                chunks += if is_cut { chunk_count } else { 0 };
            }
        }
    }
    assert!(chunks > 50, "{chunks} chunks");
}

#[test]
fn chains_of_a_real_model_run_across_chunks() {
    let small = gpu_with_limits(|limits| limits.max_storage_buffer_binding_size = 1 << 23);
    let Some(folder) = shared() else { return left_out("a real model in chunks", 1) };
    let (model, mut report) = read_model(&folder.join("models/stanford-bunny.obj")).unwrap();
    let mesh = build_edge_mesh(&model, &BuildOptions::default(), &mut report);
    let mut renderer = renderer(&small, Layout::Replicated);
    let mut linker = Linker::new(&small, &mesh, &mut renderer);
    assert!(linker.scene.instances[0].mesh().chunk_count() > 3, "in chunks");
    for view in [5, 50, 100] {
        linker.check("bunny", &camera_of(&mesh, view));
    }
}

/// An umbrella with thousands of ribs, and a one-sided band.
#[test]
fn hubs_and_bands_without_sides_are_linked_as_on_the_cpu() {
    let ribs = 3000_u32;
    let rim = (0..ribs).map(|rib| {
        let angle = f64::from(rib) / f64::from(ribs) * std::f64::consts::TAU;
        // Up and down, so that many ribs are contours seen from the side.
        let height = if rib % 2 == 0 { 0.3 } else { -0.3 };
        #[expect(clippy::cast_possible_truncation, reason = "a test")]
        [angle.cos(), height, angle.sin()].map(|x| x as f32)
    });
    let positions: Vec<[f32; 3]> = rim.chain([[0.0, 0.0, 0.0]]).collect();
    let faces: Vec<[u32; 3]> = (0..ribs).map(|rib| [rib, ribs, (rib + 1) % ribs]).collect();
    check_faces("umbrella", &positions, &faces);

    let around = |at: u32| {
        let angle = f64::from(at) / 40.0 * std::f64::consts::TAU;
        [-0.4, 0.4].map(|out: f64| {
            let radius = 1.0 + out * (angle / 2.0).cos();
            #[expect(clippy::cast_possible_truncation, reason = "a test")]
            [radius * angle.cos(), radius * angle.sin(), out * (angle / 2.0).sin()]
                .map(|x| x as f32)
        })
    };
    let positions: Vec<[f32; 3]> = (0..40).flat_map(around).collect();
    let quads = (0..40_u32).map(|at| {
        let [c, d] = if at == 39 { [1, 0] } else { [2 * at + 2, 2 * at + 3] };
        [[2 * at, 2 * at + 1, d], [2 * at, d, c]]
    });
    check_faces("band", &positions, &quads.flatten().collect::<Vec<_>>());
}

fn check_faces(name: &str, positions: &[[f32; 3]], faces: &[[u32; 3]]) {
    let polygons: Vec<&[u32]> = faces.iter().map(|face| &face[..]).collect();
    let model = Model::from_polygons(positions, &polygons);
    let mesh = build_edge_mesh(&model, &BuildOptions::default(), &mut Report::default());
    let mut renderer = renderer(gpu(), Layout::Indexed);
    let mut linker = Linker::new(gpu(), &mesh, &mut renderer);
    let contours: usize =
        (0..VIEWS).step_by(9).map(|view| linker.check(name, &camera_of(&mesh, view))).sum();
    assert!(contours > 10, "{name}: {contours} contours");
}

/// A mirror keeps the front faces and so the chains.
#[test]
fn mirrored_objects_have_the_same_chains() {
    let mesh = own_model("torus_knot");
    let camera = camera_of(&mesh, 17);
    let mut renderer = renderer(gpu(), Layout::Indexed);
    let mut linker = Linker::new(gpu(), &mesh, &mut renderer);
    let straight = linker.graph(&camera);
    let center = DMat4::from_translation(mesh.bounds.center());
    let mirror = DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    linker.scene.instances[0].world_from_object = center * mirror * center.inverse();
    let mut seen = camera;
    seen.eye.x = 2.0 * mesh.bounds.center().x - camera.eye.x;
    let mirrored = linker.graph(&seen);
    assert_eq!(straight.elements.len(), mirrored.elements.len());
    linker.check("mirrored", &seen);
}

#[test]
fn the_same_view_gives_the_same_bytes() {
    let mesh = own_model("torus_knot");
    let camera = camera_of(&mesh, 9);
    let mut renderer = renderer(gpu(), Layout::Indexed);
    let mut linker = Linker::new(gpu(), &mesh, &mut renderer);
    let first = linker.graph(&camera);
    linker.graph(&camera_of(&mesh, 60));
    let again = linker.graph(&camera);
    assert_eq!((first.nodes, first.elements), (again.nodes, again.elements));
}

/// Edges without room for linking are drawn one by one, with as much ink.
#[test]
fn what_finds_no_room_is_drawn_edge_by_edge() {
    let crowded = gpu_with_limits(|limits| limits.max_storage_buffer_binding_size = 1 << 16);
    let mesh = own_model("torus_knot");
    let camera = Camera::default_view(&mesh.bounds);
    let ink = |gpu: &Gpu| {
        let mut renderer = renderer(gpu, Layout::Indexed);
        let mut linker = Linker::new(gpu, &mesh, &mut renderer);
        linker.targets = Targets::new(&gpu.device, [256; 2], TargetFormats::new(1));
        let view = camera.view(&mesh.bounds, 1.0);
        linker
            .renderer
            .render(gpu, &linker.targets, &mut linker.scene, &view, [1.0; 4], None)
            .unwrap();
        let texels: Vec<[u8; 4]> = read_texels(gpu, linker.targets.picture()).unwrap();
        let count =
            linker.scene.drawing.objects()[0].read_graph(gpu).unwrap().unwrap().header.node_count;
        let drawn = linker.scene.drawing.objects()[0].read_tally(gpu).unwrap().stroke_count;
        (texels.iter().map(|texel| 255 - u32::from(texel[0])).sum::<u32>(), drawn - count)
    };
    let ((whole, left), (crowded, left_out)) = (ink(gpu()), ink(&crowded));
    assert!(left == 0 && left_out > 0, "{left} and {left_out} edges without room");
    assert!(whole.abs_diff(crowded) * 20 < whole, "{whole} and {crowded} of ink");
}
