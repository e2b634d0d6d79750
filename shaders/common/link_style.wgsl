// The style of each linked draw. Rust twin: LinkStyleUniform in
// crates/strokes/src/graph/path.rs.
#import <common/object_limits.wgsl>
#import <common/frame.wgsl>

struct LinkStyleUniform {
    layer: u32,
    // 0 visible lines, 1 hidden lines, 2 silhouettes.
    visibility: u32,
    placement: u32,
    // 1 if the width is in world units, 0 if in pixels.
    is_world_width: u32,
    width: f32,
    // Pixels between the points of a path; the path is averaged over as much on each side.
    step_px: f32,
    // Strokes are cut at turns whose cosine is less.
    corner_cosine: f32,
    is_cut_where_hidden: u32,
    join: u32,
    end: u32,
    // Negative for the width of the stroke.
    min_length_px: f32,
    max_length_px: f32,
    // Length of the brush divided by its height.
    brush_aspect: f32,
    // 1 if the brush is stretched to the stroke, 0 if it is tiled.
    is_stretched: u32,
    // Distances from the eye at which strokes begin and finish fading.
    fade: vec2f,
    // Lengths over which a stroke grows at its start and shrinks at its end.
    taper_px: vec2f,
    overshoot_px: f32,
    // Amplitudes of the wobble, at its wavelength, and of the jitter, at a fixed one.
    wobble_px: f32,
    wobble_length_px: f32,
    jitter_px: f32,
    // Dash and gap; 0 and 0 for solid lines.
    dash_px: vec2f,
    // Factors of the width and of the opacity, at eight even places along a stroke.
    width_curve: array<vec4f, 2>,
    opacity_curve: array<vec4f, 2>,
    seed: f32,
    padding: f32,
}

const HIDDEN_STROKES: u32 = 1u;
const SILHOUETTE_STROKES: u32 = 2u;

@group(1) @binding(0) var<uniform> link_styles: array<LinkStyleUniform, MAX_STROKE_SETS>;
