// What programs over a whole target are given.

struct ScreenVarying {
    // In pixels, at their middles.
    @builtin(position) position: vec4f,
    // 0 to 1, from the upper left corner.
    @location(0) texcoord: vec2f,
}
