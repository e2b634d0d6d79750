// The coverage of up to four draws of strokes, laid over the picture once: overlaps
// within a draw are no darker than one stroke.

// Rust twin: CompositeUniform in crates/strokes/src/graph/coverage.rs.
struct CompositeUniform {
    // Premultiplied, in the order in which they are laid.
    colors: array<vec4f, 4>,
}

@group(0) @binding(0) var<uniform> composite: CompositeUniform;
@group(0) @binding(1) var coverage: texture_2d<f32>;

@vertex
fn composite_vertex(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4f {
    // One triangle over the whole picture.
    let corner = vec2f(f32((vertex << 1u) & 2u), f32(vertex & 2u));
    return vec4f(2.0 * corner - 1.0, 0.5, 1.0);
}

@fragment
fn composite_fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let covered = textureLoad(coverage, vec2i(position.xy), 0);
    if all(covered == vec4f(0.0)) {
        discard;
    }
    var color = vec4f(0.0);
    for (var channel = 0u; channel < 4u; channel++) {
        let ink = composite.colors[channel] * covered[channel];
        color = ink + color * (1.0 - ink.a);
    }
    return color;
}
