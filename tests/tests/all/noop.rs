//! Pipelines and limits on wgpu's noop device, which validates without a GPU.

use edgemesh::build::{BuildOptions, build_edge_mesh};
use edgemesh::edge_mesh::EdgeMesh;
use edgemesh::load::LoadedMesh;
use edgemesh::model::Model;
use edgemesh::report::Report;
use strokes::{DetectionStage, Gpu, Layout, MeshBuffers};
use viewer::picture::renderer::{PictureInput, PictureOptions, PictureRenderer};
use viewer::scene::models::Scene;
use viewer::technique::Technique;
use viewer::technique::core::CoreComponent;
use viewer::technique::library::Library;
use viewer::technique::value::VariableType;

/// A scene of one mesh.
fn scene_of(mesh: &EdgeMesh) -> Scene {
    let (name, report) = ("test".into(), Report::default());
    Scene::of(vec![LoadedMesh::new(name, mesh.clone(), report)])
}

/// All layouts with both detection stages.
pub(crate) fn layouts_and_stages() -> [(Layout, DetectionStage); 6] {
    let layouts = [Layout::Indexed, Layout::Replicated, Layout::Replicated16];
    let both = layouts.map(|layout| {
        [DetectionStage::Compute, DetectionStage::Vertex].map(|stage| (layout, stage))
    });
    let [[a, b], [c, d], [e, f]] = both;
    [a, b, c, d, e, f]
}

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
    let library = Library::shipped();
    let scene = scene_of(&tetrahedron());
    let techniques = library.technique_names().map(|name| {
        let mut technique = library.technique(name).unwrap().0;
        for (pass, setting) in [
            ("hidden", "hidden.render=true"),
            ("silhouette", "silhouette.render=true"),
            ("strokes", "strokes.ends=disks"),
        ] {
            if technique.pass(pass).is_some() {
                technique.set(setting).unwrap();
            }
        }
        technique
    });
    let techniques: Vec<Technique> = techniques.collect();
    let fins = (Layout::FaceNormals, DetectionStage::Vertex);
    for (layout, stage) in layouts_and_stages().into_iter().chain([fins]) {
        for samples in [1, 4] {
            let size = [64, 32];
            let options =
                PictureOptions { size, samples, layout, stage, ..PictureOptions::default() };
            // Techniques share pipelines: each is built once.
            let first = &techniques[0];
            let mut renderer =
                PictureRenderer::new(&gpu, PictureInput::new(&scene, first), &options).unwrap();
            for technique in &techniques {
                renderer
                    .reload(PictureInput::new(&scene, technique), &options)
                    .unwrap_or_else(|error| panic!("{}: {error}", technique.name));
            }
        }
    }
}

/// Each component with its defaults, after passes that draw its inputs.
#[test]
fn every_component_builds_its_pipelines() {
    let gpu = noop(wgpu::Limits::default());
    let library = Library::shipped();
    let scene = scene_of(&tetrahedron());
    let folder = tempfile::tempdir().unwrap();
    let mut count = 0;
    for (name, component) in library.components() {
        let mut text = "[[pass]]\nname = \"before\"\ncomponent = \"render_scene_data\"\n\
            [[pass]]\nname = \"seeds\"\ncomponent = \"flood_seeds\"\n\
            texture = \"<generated>:scene_color\"\nrender_target = \"seeds\"\n\
            [[pass]]\nname = \"it\"\n"
            .to_owned();
        text += &format!("component = \"{name}\"\n");
        for variable in component.variables.iter().filter(|known| known.default.is_none()) {
            let value = match variable.name.as_str() {
                "normal_texture" => "<generated>:scene_normal",
                "depth_texture" => "<generated>:scene_depth",
                "id_texture" => "<generated>:scene_region",
                "texture" if name.contains("flood") || name.contains("wide") => {
                    "<generated>:seeds_color"
                }
                "texture" if variable.kind == VariableType::String => "made",
                "texture" => "<generated>:scene_color",
                "fragment_program" if component.core == CoreComponent::SimpleRender => {
                    "phong:phong"
                }
                "fragment_program" => "copy:copy",
                other => panic!("{name}.{other} has no default, and no value here"),
            };
            text += &format!("{} = \"{value}\"\n", variable.name);
        }
        if ["process_texture", "generate_texture", "edge_detect", "show_ids"]
            .contains(&name.as_str())
        {
            // Their programs read variables of the components that inherit from them, or
            // integers, which no built-in component draws.
            continue;
        }
        let path = folder.path().join("one.toml");
        std::fs::write(&path, text).unwrap();
        let technique = library.technique_file(&path).unwrap_or_else(|m| panic!("{name}: {m}")).0;
        let options = PictureOptions { size: [32; 2], ..PictureOptions::default() };
        PictureRenderer::new(&gpu, PictureInput::new(&scene, &technique), &options)
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        count += 1;
    }
    assert!(count > 35, "{count} components");
}

#[test]
fn a_mesh_without_faces_is_uploaded_too() {
    let gpu = noop(wgpu::Limits::default());
    for (layout, _) in layouts_and_stages() {
        assert!(MeshBuffers::new(&gpu.device, &EdgeMesh::default(), layout).is_ok());
    }
}

#[test]
fn an_adapter_that_binds_next_to_nothing_is_refused_with_the_numbers() {
    let gpu =
        noop(wgpu::Limits { max_storage_buffer_binding_size: 100, ..wgpu::Limits::default() });
    let error = MeshBuffers::new(&gpu.device, &tetrahedron(), Layout::Indexed).unwrap_err();
    assert_eq!((error.what, error.need, error.limit), ("edges", 1280, 100));
    assert!(error.to_string().contains("1280 bytes"), "{error}");
}
