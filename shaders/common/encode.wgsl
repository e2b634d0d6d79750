// Normals and ids as colors.

// A direction as a color: each axis from -1..1 to 0..1 (NPRView thesis, section 3.3.1).
fn rgb_of_normal(normal: vec3f) -> vec3f {
    return 0.5 * normal + 0.5;
}

fn normal_of_rgb(rgb: vec3f) -> vec3f {
    return 2.0 * rgb - 1.0;
}

// A distinct 24-bit color for each integer from 1 to 2^24 - 1; 0 is black. Colors are
// distinct because the factor is odd, which makes the product invertible.
fn rgb_of_id(id: u32) -> vec3f {
    let bits = (id * 0x9e3779u) & 0xffffffu;
    return vec3f(vec3u(bits >> 16u, bits >> 8u, bits) & vec3u(0xffu)) / 255.0;
}
