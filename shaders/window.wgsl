// The picture in the window, one texel per pixel, over white.

// Whether the window's target takes linear values and converts them to sRGB.
override IS_LINEAR: bool = false;

@group(0) @binding(0) var picture: texture_2d<f32>;

struct PictureVarying {
    @builtin(position) position: vec4f,
    // In texels; whole numbers are corners of texels.
    @location(0) place: vec2f,
}

@vertex
fn window_vertex(@builtin(vertex_index) vertex: u32) -> PictureVarying {
    // One triangle over the whole viewport.
    let corner = vec2f(f32((vertex << 1u) & 2u), f32(vertex & 2u));
    let size = vec2f(textureDimensions(picture));
    return PictureVarying(
        vec4f(2.0 * corner.x - 1.0, 1.0 - 2.0 * corner.y, 0.5, 1.0),
        corner * size,
    );
}

fn linear_from_srgb(color: vec3f) -> vec3f {
    let low = color / 12.92;
    let high = pow((color + 0.055) / 1.055, vec3f(2.4));
    return select(high, low, color <= vec3f(0.04045));
}

@fragment
fn window_fragment(in: PictureVarying) -> @location(0) vec4f {
    let texel = textureLoad(picture, vec2i(in.place), 0);
    let color = texel.rgb + 1.0 - texel.a;
    if IS_LINEAR {
        return vec4f(linear_from_srgb(color), 1.0);
    }
    return vec4f(color, 1.0);
}
