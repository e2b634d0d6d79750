// Neighbors of a texel, those of the rim standing for what lies beyond.

// The cross of the thesis (Figure 3.5): left, right, below, above.
const CROSS: array<vec2i, 4> = array(vec2i(-1, 0), vec2i(1, 0), vec2i(0, 1), vec2i(0, -1));

// Card and Mitchell's diagonal taps (Listings 9 and 10): down right, down left, up left,
// up right.
const DIAGONALS: array<vec2i, 4> =
    array(vec2i(1, 1), vec2i(-1, 1), vec2i(-1, -1), vec2i(1, -1));

// A texel within a texture of a size.
fn within(texel: vec2i, size: vec2u) -> vec2i {
    return clamp(texel, vec2i(0), vec2i(size) - 1);
}

// The texel of a texture of some size at a place of the target.
fn texel_at(texcoord: vec2f, size: vec2u) -> vec2i {
    return within(vec2i(floor(texcoord * vec2f(size))), size);
}
