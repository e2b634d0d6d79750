// Fragments of strokes where the scene has transparent surfaces: fainter behind these.
//
// The depth test knows the opaque surfaces alone. The nearest transparent surface is pushed
// away from the eye as these are, so its own strokes are not behind it.
#import <common/stroke_ink.wgsl>
#import <common/glass_depth.wgsl>

@fragment
fn behind_glass_of_pixels(in: Varying) -> @location(0) vec4f {
    return cut(in.position, ink(in.uv, in.opacity)) * seen_share(in.position, 0u);
}

@fragment
fn behind_glass_of_samples(
    in: Varying,
    @builtin(sample_index) sample: u32,
) -> @location(0) vec4f {
    return cut(in.position, ink(in.uv, in.opacity)) * seen_share(in.position, sample);
}

fn seen_share(position: vec4f, sample: u32) -> f32 {
    let is_behind = position.z < glass_depth_at(vec2i(position.xy), sample);
    return select(1.0, stroke.behind_glass, is_behind);
}
