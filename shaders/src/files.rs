//! The shader files, embedded.

/// A file: its path from the shader folder, and its text.
pub type EmbeddedFile = (&'static str, &'static str);

macro_rules! embedded {
    ($path:literal) => {
        ($path, include_str!(concat!("../", $path)))
    };
}

/// What others import: files without entry points.
pub const COMMON: &[EmbeddedFile] = &[
    embedded!("common/draw_arguments.wgsl"),
    embedded!("common/edge_geometry.wgsl"),
    embedded!("common/edges.wgsl"),
    embedded!("common/edges_indexed.wgsl"),
    embedded!("common/edges_replicated.wgsl"),
    embedded!("common/edges_replicated_16.wgsl"),
    embedded!("common/encode.wgsl"),
    embedded!("common/faces_indexed.wgsl"),
    embedded!("common/faces_planes.wgsl"),
    embedded!("common/faces_replicated.wgsl"),
    embedded!("common/facing.wgsl"),
    embedded!("common/feature.wgsl"),
    embedded!("common/fill_depth_of_pixels.wgsl"),
    embedded!("common/fill_depth_of_samples.wgsl"),
    embedded!("common/fill_object_of_none.wgsl"),
    embedded!("common/fill_object_of_pixels.wgsl"),
    embedded!("common/fill_object_of_samples.wgsl"),
    embedded!("common/frame.wgsl"),
    embedded!("common/glass_depth_of_pixels.wgsl"),
    embedded!("common/glass_depth_of_samples.wgsl"),
    embedded!("common/light.wgsl"),
    embedded!("common/line_class.wgsl"),
    embedded!("common/mesh.wgsl"),
    embedded!("common/noise.wgsl"),
    embedded!("common/normal_cone.wgsl"),
    embedded!("common/object_limits.wgsl"),
    embedded!("common/path.wgsl"),
    embedded!("common/path_extent.wgsl"),
    embedded!("common/path_grid.wgsl"),
    embedded!("common/link_style.wgsl"),
    embedded!("common/path_visibility.wgsl"),
    embedded!("common/path_wobble.wgsl"),
    embedded!("common/replicated_corner.wgsl"),
    embedded!("common/scan.wgsl"),
    embedded!("common/screen.wgsl"),
    embedded!("common/silhouette.wgsl"),
    embedded!("common/sobel.wgsl"),
    embedded!("common/spine.wgsl"),
    embedded!("common/stroke_cap.wgsl"),
    embedded!("common/stroke_classified.wgsl"),
    embedded!("common/stroke_graph.wgsl"),
    embedded!("common/stroke_ink.wgsl"),
    embedded!("common/stroke_quad.wgsl"),
    embedded!("common/stroke_segment.wgsl"),
    embedded!("common/stroke_style.wgsl"),
    embedded!("common/stroke_vertex.wgsl"),
    embedded!("common/surface.wgsl"),
    embedded!("common/taps.wgsl"),
    embedded!("common/view_runs.wgsl"),
];

/// What the crate `strokes` draws with.
pub const STROKES: &[EmbeddedFile] = &[
    embedded!("detect_edges.wgsl"),
    embedded!("detect_faces.wgsl"),
    embedded!("expand_strokes.wgsl"),
    embedded!("fill.wgsl"),
    embedded!("graph/composite.wgsl"),
    embedded!("graph/link_bases.wgsl"),
    embedded!("graph/link_chains.wgsl"),
    embedded!("graph/link_elements.wgsl"),
    embedded!("graph/path_joints.wgsl"),
    embedded!("graph/path_points.wgsl"),
    embedded!("graph/path_ribbons.wgsl"),
    embedded!("graph/path_strokes.wgsl"),
    embedded!("graph/ribbon.wgsl"),
    embedded!("stroke_all.wgsl"),
    embedded!("stroke_expanded.wgsl"),
    embedded!("stroke_face_normals.wgsl"),
    embedded!("stroke_listed.wgsl"),
    embedded!("glass_layer.wgsl"),
    embedded!("glass_sum.wgsl"),
    embedded!("stroke_behind_glass.wgsl"),
    embedded!("stroke_over_surface.wgsl"),
    embedded!("stroke_replicated.wgsl"),
    embedded!("stroke_replicated_16.wgsl"),
];

/// What the crate `viewer` draws with: the programs of techniques, and the window.
pub const PROGRAMS: &[EmbeddedFile] = &[
    embedded!("programs/antialias.wgsl"),
    embedded!("programs/cartoon.wgsl"),
    embedded!("programs/composite.wgsl"),
    embedded!("programs/copy.wgsl"),
    embedded!("programs/copy_depth.wgsl"),
    embedded!("programs/copy_depth_of_samples.wgsl"),
    embedded!("programs/depth.wgsl"),
    embedded!("programs/depth_shade.wgsl"),
    embedded!("programs/edge_chiang.wgsl"),
    embedded!("programs/edge_combined.wgsl"),
    embedded!("programs/edge_depth.wgsl"),
    embedded!("programs/edge_depth_5_taps.wgsl"),
    embedded!("programs/edge_ids.wgsl"),
    embedded!("programs/edge_normals.wgsl"),
    embedded!("programs/edge_planes.wgsl"),
    embedded!("programs/flat.wgsl"),
    embedded!("programs/flood.wgsl"),
    embedded!("programs/gooch.wgsl"),
    embedded!("programs/hatching.wgsl"),
    embedded!("programs/ids.wgsl"),
    embedded!("programs/laplacian_of_gaussian.wgsl"),
    embedded!("programs/morphology.wgsl"),
    embedded!("programs/noise.wgsl"),
    embedded!("programs/normals.wgsl"),
    embedded!("programs/paper.wgsl"),
    embedded!("programs/phong.wgsl"),
    embedded!("programs/scene_data.wgsl"),
    embedded!("programs/screen.wgsl"),
    embedded!("programs/show_ids.wgsl"),
    embedded!("programs/show_texture.wgsl"),
    embedded!("programs/sobel.wgsl"),
    embedded!("programs/surface.wgsl"),
    embedded!("programs/toon.wgsl"),
    embedded!("programs/unlit.wgsl"),
    embedded!("programs/wide_lines.wgsl"),
    embedded!("programs/zero_crossings.wgsl"),
    embedded!("window.wgsl"),
];

/// All files.
pub fn all() -> impl Iterator<Item = &'static EmbeddedFile> {
    COMMON.iter().chain(STROKES).chain(PROGRAMS)
}

/// The text of a file, by its path from the shader folder.
///
/// Five paths are placeholders that shaders import and a caller of
/// [`ShaderSource::embedded_with`](crate::ShaderSource::embedded_with) puts a file in;
/// here they stand for the usual one.
#[must_use]
pub fn text(path: &str) -> Option<&'static str> {
    let path = match path {
        "common/edge_source.wgsl" => "common/edges_indexed.wgsl",
        "common/edge_faces.wgsl" => "common/faces_indexed.wgsl",
        "common/fill_depth.wgsl" => "common/fill_depth_of_pixels.wgsl",
        "common/fill_object.wgsl" => "common/fill_object_of_pixels.wgsl",
        "common/glass_depth.wgsl" => "common/glass_depth_of_pixels.wgsl",
        _ => path,
    };
    all().find(|(known, _)| *known == path).map(|(_, text)| *text)
}
