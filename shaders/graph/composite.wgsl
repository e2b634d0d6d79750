// Lays the coverage of up to four draws of strokes over the picture, so that overlaps within
// a draw are no darker than one stroke.

// Rust twin: CompositeUniform in crates/strokes/src/draw/coverage.rs.
struct CompositeUniform {
    // Premultiplied, in drawing order.
    colors: array<vec4f, 4>,
}

// Channels in use.
override CHANNEL_COUNT: u32 = 4u;

@group(0) @binding(0) var<uniform> composite: CompositeUniform;
@group(0) @binding(1) var coverage: texture_2d<f32>;

@vertex
fn composite_vertex(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4f {
    // One triangle over the whole picture.
    let corner = vec2f(f32((vertex << 1u) & 2u), f32(vertex & 2u));
    return vec4f(2.0 * corner - 1.0, 0.5, 1.0);
}

fn over(above: vec4f, below: vec4f) -> vec4f {
    return above + below * (1.0 - above.a);
}

@fragment
fn composite_fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let covered = textureLoad(coverage, vec2i(position.xy), 0);
    var color = composite.colors[0] * covered.x;
    if CHANNEL_COUNT > 1u {
        color = over(composite.colors[1] * covered.y, color);
    }
    if CHANNEL_COUNT > 2u {
        color = over(composite.colors[2] * covered.z, color);
    }
    if CHANNEL_COUNT > 3u {
        color = over(composite.colors[3] * covered.w, color);
    }
    return color;
}
