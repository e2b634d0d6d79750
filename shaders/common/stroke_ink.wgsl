// Varyings and ink of all strokes.
#import <common/stroke_style.wgsl>

// Whether strokes have a brush; otherwise they are solid.
override IS_TEXTURED: bool = false;

@group(1) @binding(1) var brush: texture_2d<f32>;
@group(1) @binding(2) var brush_sampler: sampler;

// The input of every fragment shader of strokes.
struct Varying {
    @builtin(position) position: vec4f,
    @location(0) uv: vec2f,
    @location(1) opacity: f32,
}

// The input of fragment shaders that test visibility at the edge; see StrokeVertex.
struct StrokeVarying {
    @builtin(position) position: vec4f,
    @location(0) uv: vec2f,
    @location(1) opacity: f32,
    @location(2) foot: vec3f,
    @location(3) over_px: f32,
}

// v and opacity have 16 bits between expansion and drawing, so they are rounded to 16 bits
// in every case.
fn varying_of(vertex: StrokeVertex) -> StrokeVarying {
    let rounded = unpack2x16unorm(pack2x16unorm(vec2f(vertex.v, vertex.opacity)));
    return StrokeVarying(
        vec4f(vertex.position, 1.0),
        vec2f(vertex.u, rounded.x),
        rounded.y,
        vertex.foot,
        vertex.over_px,
    );
}

// Transparent if a clip plane cuts the fragment away; `position` is in pixels and depth.
fn cut(position: vec4f, color: vec4f) -> vec4f {
    if is_cut_away(world_of(position.xy, position.z)) {
        return vec4f(0.0);
    }
    return color;
}

fn ink(uv: vec2f, opacity: f32) -> vec4f {
    var coverage = opacity;
    if IS_TEXTURED {
        // The brush keeps its aspect, so its size across the stroke is enough. Along the
        // stroke it can be sheared (Figure 9), which must not blur it.
        let per_px = length(vec2f(dpdx(uv.y), dpdy(uv.y)));
        let level = log2(max(per_px * f32(textureDimensions(brush).y), 1.0));
        coverage *= textureSampleLevel(brush, brush_sampler, uv, level).a;
    }
    return stroke.color * coverage;
}
