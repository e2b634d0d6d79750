// How the strokes of each linked draw look. Rust twin: LinkStyleUniform in
// crates/strokes/src/graph/path.rs.
#import <common/object_limits.wgsl>
#import <common/frame.wgsl>

struct LinkStyleUniform {
    layer: u32,
    // 0 what is visible, 1 what is hidden, 2 silhouettes.
    visibility: u32,
    placement: u32,
    // 1 where the width is in units of the world, 0 in pixels.
    is_world_width: u32,
    width: f32,
    // Pixels between points along a path, and half of what is averaged there.
    step_px: f32,
    // Strokes are cut where they turn more than this cosine says.
    corner_cosine: f32,
    is_cut_where_hidden: u32,
    join: u32,
    end: u32,
    // Negative for the width.
    min_length_px: f32,
    max_length_px: f32,
    // Length of the brush over its height.
    brush_aspect: f32,
    // 1 where the brush is stretched to the stroke, 0 where it is tiled.
    is_stretched: u32,
    fade: vec2f,
    // Over how many pixels a stroke grows to its width, and shrinks again.
    taper_px: vec2f,
    overshoot_px: f32,
    // How far lines leave their path, at a wavelength and at that of a trembling hand.
    wobble_px: f32,
    wobble_length_px: f32,
    jitter_px: f32,
    // Ink and gap in pixels; 0 and 0 for whole lines.
    dash_px: vec2f,
    // Along a stroke, evenly, what is left of its width and of its opacity.
    width_curve: array<vec4f, 2>,
    opacity_curve: array<vec4f, 2>,
    seed: f32,
    padding: f32,
}

const HIDDEN_STROKES: u32 = 1u;
const SILHOUETTE_STROKES: u32 = 2u;

@group(1) @binding(0) var<uniform> link_styles: array<LinkStyleUniform, MAX_STROKE_SETS>;
