// What detectors measure at a texel, by the formulas of the NPRView thesis (section 3.3).
// Textures are passed as arguments, so that one detector can measure several of them.
#import <common/encode.wgsl>
#import <common/frame.wgsl>
#import <common/taps.wgsl>

fn normal_at(normals: texture_2d<f32>, texel: vec2i) -> vec3f {
    return normal_of_rgb(textureLoad(normals, within(texel, textureDimensions(normals)), 0).rgb);
}

// Eye-space depth from the depth buffer: Equation 3.11, for the current projection.
fn distance_at(depths: texture_depth_2d, texel: vec2i) -> f32 {
    return distance_of(textureLoad(depths, within(texel, textureDimensions(depths)), 0));
}

// The smallest dot product of the normal with those of the four neighbors, and the sum of
// all four (thesis, Equations 3.7 and 3.8).
fn dot_products(normals: texture_2d<f32>, texel: vec2i) -> vec2f {
    let center = normal_at(normals, texel);
    var least = 1.0e9;
    var sum = 0.0;
    for (var tap = 0; tap < 4; tap++) {
        let product = dot(center, normal_at(normals, texel + CROSS[tap]));
        least = min(least, product);
        sum += product;
    }
    return vec2f(least, sum);
}

// The largest difference in depth from a neighbor (thesis, Equation 3.12).
fn depth_delta(depths: texture_depth_2d, texel: vec2i) -> f32 {
    let center = distance_at(depths, texel);
    var most = 0.0;
    for (var tap = 0; tap < 4; tap++) {
        most = max(most, abs(center - distance_at(depths, texel + CROSS[tap])));
    }
    return most;
}

// The absolute Laplacian of the depth (thesis, Equation 3.13).
fn depth_laplacian(depths: texture_depth_2d, texel: vec2i) -> f32 {
    var sum = -4.0 * distance_at(depths, texel);
    for (var tap = 0; tap < 4; tap++) {
        sum += distance_at(depths, texel + CROSS[tap]);
    }
    return abs(sum);
}

// Whether a neighbor belongs to another region (thesis, section 3.3.3).
fn regions_differ(ids: texture_2d<f32>, texel: vec2i) -> bool {
    let size = textureDimensions(ids);
    let center = textureLoad(ids, within(texel, size), 0).rgb;
    var differ = false;
    for (var tap = 0; tap < 4; tap++) {
        differ |= any(center != textureLoad(ids, within(texel + CROSS[tap], size), 0).rgb);
    }
    return differ;
}

// The point at a texel, in world space.
fn world_at(depths: texture_depth_2d, texel: vec2i) -> vec3f {
    let size = textureDimensions(depths);
    let inside = within(texel, size);
    let depth = textureLoad(depths, inside, 0);
    let place_px = (vec2f(inside) + 0.5) * frame.viewport_px / vec2f(size);
    return world_of(place_px, depth);
}

// The largest distance of a neighbor from the plane through a texel, in pixels. On a
// plane, however steep, it is zero but for rounding. Each of two neighbors has a distance
// from the other's plane; the smaller one counts, so that both sides of a step are edges
// and a smooth bend is not. The border with the background is always an edge.
fn plane_distance_px(
    depths: texture_depth_2d,
    normals: texture_2d<f32>,
    texel: vec2i,
) -> f32 {
    let size = textureDimensions(depths);
    let is_background = textureLoad(depths, within(texel, size), 0) <= 0.0;
    let center = world_at(depths, texel);
    let normal = unit_normal_at(normals, texel);
    let unit_px = px_per_unit_at(distance_at(depths, texel)) * f32(size.y) / frame.viewport_px.y;
    var most = 0.0;
    for (var tap = 0; tap < 4; tap++) {
        let other = texel + CROSS[tap];
        let is_other_background = textureLoad(depths, within(other, size), 0) <= 0.0;
        if is_background || is_other_background {
            most = max(most, select(0.0, 1.0e9, is_background != is_other_background));
            continue;
        }
        let step = world_at(depths, other) - center;
        let own = abs(dot(normal, step));
        let others = abs(dot(unit_normal_at(normals, other), step));
        most = max(most, unit_px * min(own, others));
    }
    return most;
}

fn unit_normal_at(normals: texture_2d<f32>, texel: vec2i) -> vec3f {
    let normal = normal_at(normals, texel);
    let length = length(normal);
    return select(vec3f(0.0), normal / length, length > 0.0);
}

// A mix of two colors with straight alpha; the result is premultiplied.
fn line_color(strength: f32, line: vec4f, background: vec4f) -> vec4f {
    let color = mix(background, line, clamp(strength, 0.0, 1.0));
    return vec4f(color.rgb * color.a, color.a);
}
