// The edges of a mesh in the replicated layout of McGuire and Hughes (section 3.1), 16-bit
// integers, read as words from the first of an edge's four copies.
#import <common/edge_geometry.wgsl>
#import <common/feature.wgsl>

@group(2) @binding(2) var<storage, read> words: array<u32>;

const WORDS_PER_EDGE: u32 = 40u;

fn edge_word(edge: u32) -> u32 {
    return word_of_24_bits(words[WORDS_PER_EDGE * edge + 9u] >> 8u);
}

// The two ends of an edge, in object space.
fn edge_ends(edge: u32) -> array<vec3f, 2> {
    let at = WORDS_PER_EDGE * edge;
    return array<vec3f, 2>(position_at(at, 0u), position_at(at, 3u));
}

fn edge_geometry(edge: u32) -> EdgeGeometry {
    let at = WORDS_PER_EDGE * edge;
    return EdgeGeometry(
        position_at(at, 0u),
        position_at(at, 3u),
        position_at(at, 6u),
        position_at(at, 9u),
        normal_at(at, 12u),
        normal_at(at, 15u),
        f32((words[at + 9u] & 0xffu) >> 2u) / 64.0,
    );
}

fn position_at(at: u32, first: u32) -> vec3f {
    return dequantize(steps_at(at, first), object.center, object.step);
}

fn normal_at(at: u32, first: u32) -> vec3f {
    return steps_at(at, first) / 32767.0;
}

// Three consecutive 16-bit integers of an edge vertex.
fn steps_at(at: u32, first: u32) -> vec3f {
    return vec3f(step_at(at, first), step_at(at, first + 1u), step_at(at, first + 2u));
}

fn step_at(at: u32, index: u32) -> f32 {
    // Moves the wanted half to the top, then shifts it back with its sign.
    let word = words[at + index / 2u];
    return f32(bitcast<i32>(word << (16u * (1u - index % 2u))) >> 16u);
}
