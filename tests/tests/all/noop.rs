//! Pipelines and limits on wgpu's noop device: all of its checks and no GPU.

use edgemesh::build::{BuildOptions, build_edge_mesh};
use edgemesh::edge_mesh::EdgeMesh;
use edgemesh::model::Model;
use edgemesh::report::Report;
use strokes::gpu::Gpu;
use strokes::mesh_buffers::MeshBuffers;
use strokes::renderer::Renderer;
use viewer::technique::{TECHNIQUES, Technique};

fn noop(limits: wgpu::Limits) -> Gpu {
    let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor {
        required_limits: limits,
        ..wgpu::DeviceDescriptor::default()
    });
    Gpu { info: device.adapter_info(), device, queue }
}

fn tetrahedron() -> EdgeMesh {
    let corners = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]];
    let model = Model::from_polygons(&corners, &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[0, 3, 2]]);
    build_edge_mesh(&model, &BuildOptions::default(), &mut Report::default())
}

#[test]
fn every_technique_builds_its_pipelines_within_the_default_limits() {
    let gpu = noop(wgpu::Limits::default());
    for (name, _) in TECHNIQUES {
        for samples in [1, 4] {
            let look = Technique::by_name(name).unwrap().look();
            let renderer = Renderer::new(&gpu, &look, samples).unwrap();
            let buffers = MeshBuffers::new(&gpu.device, &tetrahedron()).unwrap();
            let _ = renderer.mesh_draw(&gpu.device, buffers);
        }
    }
}

#[test]
fn a_mesh_without_faces_is_uploaded_too() {
    let gpu = noop(wgpu::Limits::default());
    assert!(MeshBuffers::new(&gpu.device, &EdgeMesh::default()).is_ok());
}

#[test]
fn a_mesh_beyond_the_limits_is_refused_with_the_numbers() {
    let gpu =
        noop(wgpu::Limits { max_storage_buffer_binding_size: 100, ..wgpu::Limits::default() });
    let error = MeshBuffers::new(&gpu.device, &tetrahedron()).unwrap_err();
    assert_eq!((error.what, error.need, error.limit), ("face planes", 128, 100));
    assert!(error.to_string().contains("128 bytes"), "{error}");
}
