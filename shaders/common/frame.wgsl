// What one view needs, the same for every pass. Rust twin: FrameUniform in
// crates/strokes/src/frame.rs.

struct FrameUniform {
    // Takes world positions to clip space; depth 1 near, 0 far.
    clip_from_world: mat4x4f,
    // The eye with w = 1, or the direction to the viewer with w = 0.
    eye: vec4f,
    viewport_px: vec2f,
    padding: vec2f,
}

@group(0) @binding(0) var<uniform> frame: FrameUniform;
