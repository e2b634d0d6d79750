// The edges of a mesh in the replicated layout of McGuire and Hughes (section 3.1), 32-bit
// floats, read as words from the first of an edge's four copies.
#import <common/edge_geometry.wgsl>

@group(2) @binding(2) var<storage, read> words: array<u32>;

const WORDS_PER_EDGE: u32 = 80u;

fn edge_word(edge: u32) -> u32 {
    return words[WORDS_PER_EDGE * edge + 19u] >> 2u;
}

// The two ends of an edge, in object space.
fn edge_ends(edge: u32) -> array<vec3f, 2> {
    let at = WORDS_PER_EDGE * edge;
    return array<vec3f, 2>(vector_at(at), vector_at(at + 3u));
}

fn edge_geometry(edge: u32) -> EdgeGeometry {
    let at = WORDS_PER_EDGE * edge;
    return EdgeGeometry(
        vector_at(at),
        vector_at(at + 3u),
        vector_at(at + 6u),
        vector_at(at + 9u),
        vector_at(at + 12u),
        vector_at(at + 15u),
        bitcast<f32>(words[at + 18u]),
    );
}

fn vector_at(at: u32) -> vec3f {
    return bitcast<vec3f>(vec3u(words[at], words[at + 1u], words[at + 2u]));
}
