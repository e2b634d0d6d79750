// The input of fragment programs that cover a whole target.

struct ScreenVarying {
    // In pixels of the target, at the center of the pixel.
    @builtin(position) position: vec4f,
    // 0 to 1, from the upper left corner.
    @location(0) texcoord: vec2f,
}
