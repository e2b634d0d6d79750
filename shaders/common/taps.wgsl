// Neighbors of a texel; beyond the rim of a texture, its outermost texels repeat.

// The cross of the thesis (Figure 3.5): left, right, below, above.
const CROSS: array<vec2i, 4> = array(vec2i(-1, 0), vec2i(1, 0), vec2i(0, 1), vec2i(0, -1));

// Card and Mitchell's diagonal taps (Listings 9 and 10): down right, down left, up left,
// up right.
const DIAGONALS: array<vec2i, 4> =
    array(vec2i(1, 1), vec2i(-1, 1), vec2i(-1, -1), vec2i(1, -1));

// The nearest texel inside a texture of this size.
fn within(texel: vec2i, size: vec2u) -> vec2i {
    return clamp(texel, vec2i(0), vec2i(size) - 1);
}

// The texel at a texture coordinate.
fn texel_at(texcoord: vec2f, size: vec2u) -> vec2i {
    return within(vec2i(floor(texcoord * vec2f(size))), size);
}
