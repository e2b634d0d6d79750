//! The same picture from every layout of the edges, by both paths of detection,
//! and from a mesh in chunks.

use edgemesh::build::{BuildOptions, build_edge_mesh};
use edgemesh::edge_mesh::{EdgeMesh, FacePlane, Quantization, replicate_16};
use edgemesh::format::read::read_model;
use edgemesh::model::Model;
use edgemesh::report::Report;
use edgemesh::view::Camera;
use glam::{DVec3, Vec3};
use image::RgbaImage;
use strokes::{DetectionStage, Gpu, Layout, MeshBuffers};
use testkit::locate::{left_out, shared};
use viewer::picture::renderer::PictureOptions;
use viewer::technique::Technique;

use crate::easel::Easel;
use crate::gpu_device::{gpu, gpu_with_limits};
use crate::gpu_render::{own_model, technique};
use crate::gpu_twin::Detector;
use crate::noop::layouts_and_stages;
use crate::own_models::own_models;

/// Meshes on a device, drawn in several ways.
struct Pictures<'a>(Easel<'a>);

impl<'a> Pictures<'a> {
    fn on<'m>(gpu: &'a Gpu, meshes: impl IntoIterator<Item = &'m EdgeMesh>) -> Self {
        Self(Easel::new(gpu, meshes))
    }

    /// The project's own models by their place in [`own_models`].
    fn own_models_on(gpu: &'a Gpu) -> Self {
        Self::on(gpu, own_models().iter().map(|(_, mesh)| mesh))
    }

    fn picture(
        &mut self,
        mesh: usize,
        technique: &Technique,
        (layout, stage): (Layout, DetectionStage),
    ) -> RgbaImage {
        let options = PictureOptions { size: [256; 2], layout, stage, ..PictureOptions::default() };
        let camera = self.0.default_view(mesh);
        self.0.picture(mesh, &camera, technique, &options)
    }
}

/// The largest difference of a channel.
fn difference(a: &RgbaImage, b: &RgbaImage) -> u8 {
    a.as_raw().iter().zip(b.as_raw()).map(|(a, b)| a.abs_diff(*b)).max().unwrap()
}

/// Techniques that use every kind of line, several layers, and hidden lines.
fn techniques() -> Vec<Technique> {
    let settings: [&[&str]; 7] = [
        &[],
        &["strokes.ends=disks", "strokes.width=6", "ridge.placement=inside"],
        &["contour.placement=inside", "strokes.width=5"],
        &["strokes.placement=centred", "strokes.width=7", "hidden.render=true"],
        &["strokes.kind=thin", "contour.kind=fin", "contour.width=5"],
        &["hidden.render=true", "hidden.color=#0000ff", "boundary.color=#ff0000"],
        &[
            "strokes.ridge_angle=10",
            "strokes.valley_angle=60",
            "ridge.color=#00a000",
            "strokes.width=0.05",
            "strokes.width_unit=model",
        ],
    ];
    settings.map(|settings| technique("ink", settings)).into()
}

#[test]
fn all_layouts_and_stages_draw_the_same() {
    let mut pictures_of = Pictures::own_models_on(gpu());
    let models = own_models();
    for (at, technique) in techniques().iter().enumerate() {
        for (model, (name, _)) in models.iter().enumerate() {
            let pictures =
                layouts_and_stages().map(|how| pictures_of.picture(model, technique, how));
            let [indexed, others @ ..] = &pictures;
            for (other, (layout, stage)) in others.iter().zip(&layouts_and_stages()[1..]) {
                if *layout != Layout::Replicated16 {
                    assert_eq!(
                        difference(indexed, other),
                        0,
                        "{name}, technique {at}: {layout:?} {stage:?}"
                    );
                }
            }
            // At 16 bits both paths draw what is there at 16 bits.
            assert_eq!(
                difference(&pictures[4], &pictures[5]),
                0,
                "{name}, technique {at}: 16 bits"
            );
        }
    }
}

/// A brush lets what lies under it through, and the paper's passes draw all quads
/// before all caps: the same ink in another order, rounded otherwise.
#[test]
fn textured_strokes_differ_by_their_order_at_most() {
    let names = ["bracket", "torus_knot"];
    let mut pictures_of = Pictures::on(gpu(), &names.map(own_model));
    let technique = technique("pen", &["strokes.width=8"]);
    for (model, name) in names.into_iter().enumerate() {
        let indexed =
            pictures_of.picture(model, &technique, (Layout::Indexed, DetectionStage::Compute));
        for how in layouts_and_stages().into_iter().filter(|how| how.0 != Layout::Replicated16) {
            let apart = difference(&indexed, &pictures_of.picture(model, &technique, how));
            let most = if how == (Layout::Replicated, DetectionStage::Vertex) { 4 } else { 0 };
            assert!(apart <= most, "{name}, {how:?}: {apart}");
        }
    }
}

/// The 16-bit layout draws the mesh of its own rounded positions.
#[test]
fn sixteen_bits_draw_their_own_positions() {
    let models = own_models();
    let rounded: Vec<EdgeMesh> = models.iter().map(|(_, mesh)| at_16_bits(mesh)).collect();
    let mut sixteen = Pictures::own_models_on(gpu());
    let mut exact = Pictures::on(gpu(), &rounded);
    let technique = technique("ink", &[]);
    for (model, (name, _)) in models.iter().enumerate() {
        let exact = exact.picture(model, &technique, (Layout::Indexed, DetectionStage::Compute));
        let how = (Layout::Replicated16, DetectionStage::Compute);
        let sixteen = sixteen.picture(model, &technique, how);
        let wrong = exact
            .pixels()
            .zip(sixteen.pixels())
            .filter(|(a, b)| a.0[0].abs_diff(b.0[0]) > 32)
            .count();
        // Face normals and caps come from normals of 16 bits.
        assert!(wrong <= 6, "{name}: {wrong} pixels");
    }
}

/// A mesh whose positions are those of its 16-bit layout, with the planes of its faces.
fn at_16_bits(mesh: &EdgeMesh) -> EdgeMesh {
    let quantization = Quantization::of(&mesh.bounds);
    let mut rounded = mesh.clone();
    for position in &mut rounded.positions {
        *position = quantization.dequantize(quantization.quantize(*position));
    }
    for (plane, triangle) in rounded.face_planes.iter_mut().zip(&rounded.triangles) {
        let corners = triangle.map(|vertex| Vec3::from(rounded.positions[vertex as usize]));
        let [a, b, c] = corners.map(|corner| corner.as_dvec3());
        let normal = (b - a).cross(c - a).normalize_or_zero().as_vec3();
        let (normal, point) = (normal.extend(0.0).into(), corners[0].extend(1.0).into());
        *plane = FacePlane { normal, point };
    }
    rounded
}

/// Meshes that one binding cannot hold are drawn in chunks: the same bytes.
#[test]
fn chunks_draw_the_picture_of_the_whole() {
    // The project's models are small: these bindings take a few hundred edges.
    let small = gpu_with_limits(|limits| limits.max_storage_buffer_binding_size = 1 << 15);
    let mut at_once = Pictures::own_models_on(gpu());
    let mut in_chunks = Pictures::own_models_on(&small);
    let pen = technique("pen", &["strokes.width=6"]);
    let models = own_models();
    for (at, technique) in techniques().iter().chain([&pen]).enumerate() {
        for (model, (name, _)) in models.iter().enumerate() {
            for how in layouts_and_stages() {
                let whole = at_once.picture(model, technique, how);
                let chunks = in_chunks.picture(model, technique, how);
                // The paper's passes, chunk by chunk, are another order of the ink.
                let is_reordered = how.1 == DetectionStage::Vertex && how.0 != Layout::Indexed;
                let most = if is_reordered && at == techniques().len() { 4 } else { 0 };
                let apart = difference(&whole, &chunks);
                assert!(apart <= most, "{name}, technique {at}, {how:?}: {apart}");
            }
        }
    }
}

/// The same with bindings of one mebibyte, where the real meshes are there.
#[test]
fn large_meshes_in_bindings_of_a_mebibyte() {
    let small = gpu_with_limits(|limits| limits.max_storage_buffer_binding_size = 1 << 20);
    let Some(folder) = shared() else { return left_out("meshes in chunks", 3) };
    let names = ["stanford-bunny.obj", "rocker-arm.obj", "fandisk.obj"];
    let meshes = names.map(|name| {
        let (model, mut report) = read_model(&folder.join("models").join(name)).unwrap();
        let mesh = build_edge_mesh(&model, &BuildOptions::default(), &mut report);
        let buffers = MeshBuffers::new(&small.device, &mesh, Layout::Indexed).unwrap();
        assert_eq!(buffers.chunk_count() > 1, mesh.triangles.len() > 32_768, "{name}");
        mesh
    });
    let how = (Layout::Indexed, DetectionStage::Compute);
    let mut at_once = Pictures::on(gpu(), &meshes);
    let mut in_chunks = Pictures::on(&small, &meshes);
    for technique in [technique("ink", &[]), technique("pen", &["hidden.render=true"])] {
        for (model, name) in names.into_iter().enumerate() {
            let whole = at_once.picture(model, &technique, how);
            assert_eq!(difference(&whole, &in_chunks.picture(model, &technique, how)), 0, "{name}");
        }
    }
}

/// Linked strokes are made of what the layouts have in common.
#[test]
fn linked_strokes_are_the_same_in_every_layout_and_in_chunks() {
    let small = gpu_with_limits(|limits| limits.max_storage_buffer_binding_size = 1 << 19);
    let techniques = [
        technique("pen", &["strokes.linked=true", "strokes.width=5", "strokes.taper=20"]),
        technique(
            "charcoal",
            &["strokes.linked=true", "ridge.width=3", "hidden.render=true", "hidden.linked=true"],
        ),
    ];
    let mut at_once = Pictures::own_models_on(gpu());
    let mut in_chunks = Pictures::own_models_on(&small);
    let models = own_models();
    for technique in &techniques {
        for (model, (name, _)) in models.iter().enumerate() {
            let how = |layout| (layout, DetectionStage::Compute);
            let indexed = at_once.picture(model, technique, how(Layout::Indexed));
            let replicated = at_once.picture(model, technique, how(Layout::Replicated));
            assert_eq!(difference(&indexed, &replicated), 0, "{name}");
            let chunks = in_chunks.picture(model, technique, how(Layout::Replicated));
            assert_eq!(difference(&indexed, &chunks), 0, "{name} in chunks");
        }
    }
}

/// Views with more strokes than there is room for: the rest comes from the list.
#[test]
fn strokes_without_room_are_drawn_all_the_same() {
    // Room for 273 strokes a chunk.
    let crowded = gpu_with_limits(|limits| limits.max_storage_buffer_binding_size = 1 << 17);
    let mesh = own_model("torus_knot");
    let (mut roomy, mut crowded) = (Pictures::on(gpu(), [&mesh]), Pictures::on(&crowded, [&mesh]));
    for technique in techniques() {
        let how = (Layout::Indexed, DetectionStage::Compute);
        let whole = roomy.picture(0, &technique, how);
        assert_eq!(difference(&whole, &crowded.picture(0, &technique, how)), 0);
    }
}

/// Clusters of faces are passed over by the positions that are drawn: at 16 bits
/// those are the rounded ones, whose faces can look another way.
#[test]
fn clusters_at_16_bits_are_those_of_the_rounded_faces() {
    let mesh = fine_ball(90);
    let views = (0..12).map(|step| {
        let angle = f64::from(step) * 0.53;
        DVec3::new(angle.cos(), (angle * 1.7).sin(), angle.sin()) * 4.0
    });
    let mut detector = Detector::new(Layout::Replicated16);
    for eye in views {
        let view = Camera { eye, target: DVec3::ZERO, ..Camera::default_view(&mesh.bounds) }
            .view(&mesh.bounds, 1.0);
        let (_, _, live) = detector.detect(&mesh, &view, &technique("ink", &[]));
        let quantization = Quantization::of(&mesh.bounds);
        let vertices = replicate_16(&mesh);
        let contours = vertices.iter().step_by(4).enumerate().filter(|(_, vertex)| {
            let corner = |steps| Vec3::from(quantization.dequantize(steps)).as_dvec3();
            let [v0, v1, v2, v3] = [vertex.v0, vertex.v1, vertex.v2, vertex.v3].map(corner);
            let to_eye = view.eye.truncate().as_dvec3() - v0;
            let cosine = |normal: DVec3| normal.normalize_or_zero().dot(to_eye) / to_eye.length();
            let a = cosine((v1 - v0).cross(v2 - v0));
            let b = cosine((v3 - v0).cross(v1 - v0));
            // Within this the shader's 32 bits are free to differ.
            (a > 0.0) != (b > 0.0) && a.abs().min(b.abs()) > 2e-3
        });
        let contours: Vec<usize> = contours.map(|(edge, _)| edge).collect();
        let found: Vec<usize> = live
            .iter()
            .filter(|&&entry| entry >> 31 == 1)
            .map(|&entry| (entry & 0x1fff_ffff) as usize)
            .collect();
        let missing = contours.iter().filter(|edge| found.binary_search(edge).is_err()).count();
        assert!(contours.len() > 100 && missing == 0, "{missing} of {} missing", contours.len());
    }
}

/// A ball of many small faces, and a face so far away that 16 bits are coarse.
fn fine_ball(rings: u16) -> EdgeMesh {
    let around = 2 * rings;
    let point = |ring: u16, step: u16| {
        let theta = std::f32::consts::PI * f32::from(ring) / f32::from(rings);
        let phi = std::f32::consts::TAU * f32::from(step) / f32::from(around);
        [theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin()]
    };
    let mut positions: Vec<[f32; 3]> =
        (0..=rings).flat_map(|ring| (0..around).map(move |step| point(ring, step))).collect();
    let far = u32::try_from(positions.len()).unwrap();
    let far_face = [far, far + 1, far + 2];
    positions.extend([[150.0, 0.0, 0.0], [150.0, 1.0, 0.0], [150.0, 0.0, 1.0]]);
    let corner =
        |ring: u16, step: u16| u32::from(ring) * u32::from(around) + u32::from(step % around);
    let polygons: Vec<[u32; 4]> = (0..rings)
        .flat_map(|ring| {
            (0..around).map(move |step| {
                [
                    corner(ring, step),
                    corner(ring, step + 1),
                    corner(ring + 1, step + 1),
                    corner(ring + 1, step),
                ]
            })
        })
        .collect();
    let mut polygons: Vec<&[u32]> = polygons.iter().map(|polygon| &polygon[..]).collect();
    polygons.push(&far_face);
    let model = Model::from_polygons(&positions, &polygons);
    build_edge_mesh(&model, &BuildOptions::default(), &mut Report::default())
}
