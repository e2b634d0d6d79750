// Edges as discontinuities of normals (NPRView thesis, section 3.3.1; Card and Mitchell,
// Listing 9).
#import <common/edges.wgsl>
#import <common/screen.wgsl>

struct Params {
    threshold: f32,
    apply_threshold: u32,
    edge_color: vec4f,
    background_color: vec4f,
}

@group(1) @binding(0) var<uniform> params: Params;
@group(1) @binding(1) var normal_texture: texture_2d<f32>;

// Equation 3.7: an edge where the smallest dot product is below the threshold. Without
// apply_threshold, Equation 3.8: 4 minus the sum of the dot products, times the threshold.
@fragment
fn minimum_dot_product(at: ScreenVarying) -> @location(0) vec4f {
    let texel = texel_at(at.texcoord, textureDimensions(normal_texture));
    let products = dot_products(normal_texture, texel);
    var strength = f32(products.x < params.threshold);
    if params.apply_threshold == 0u {
        strength = params.threshold * (4.0 - products.y);
    }
    return line_color(strength, params.edge_color, params.background_color);
}

// Card and Mitchell's five taps: an edge where any product falls below the threshold.
@fragment
fn five_taps(at: ScreenVarying) -> @location(0) vec4f {
    let texel = texel_at(at.texcoord, textureDimensions(normal_texture));
    let center = normal_at(normal_texture, texel);
    var surface = 1.0;
    for (var tap = 0; tap < 4; tap++) {
        let product = dot(center, normal_at(normal_texture, texel + DIAGONALS[tap]));
        // As in the listing: 1 (white) if the product is not below the threshold.
        surface *= f32(product - params.threshold >= 0.0);
    }
    return line_color(1.0 - surface, params.edge_color, params.background_color);
}
