// The edge mesh on the GPU. Rust twins: PackedRecord and ChunkUniform in
// crates/strokes/src/mesh/layout.rs, edge_random in crates/edgemesh/src/edge_mesh/record.rs,
// FacePlane in mesh.rs beside record.rs.

const NONE: u32 = 0xffffffffu;

// 20 bytes per edge. face_a traverses the edge from v0 to v1. face_b can be NONE; both are
// NONE for a line along no edge.
struct PackedRecord {
    v0: u32,
    v1: u32,
    face_a: u32,
    face_b: u32,
    word: u32,
}

struct FacePlane {
    normal: vec4f,
    point: vec4f,
}

struct ChunkUniform {
    face_count: u32,
    edge_count: u32,
    run_count: u32,
    // The most strokes that can be expanded.
    capacity: u32,
    // The chunk's first run among those of the mesh, and the chunk's number.
    first_run: u32,
    chunk_index: u32,
    // The most edges that can be linked.
    node_capacity: u32,
    padding: u32,
}

@group(2) @binding(1) var<uniform> chunk: ChunkUniform;

// The position of 16-bit steps. Rust twin: Quantization in
// crates/edgemesh/src/edge_mesh/replicate.rs.
fn dequantize(steps: vec3f, center: vec3f, step: f32) -> vec3f {
    return center + steps * step;
}

// The edge's random scalar r in [0, 1): a hash of its ends, the same in both directions.
fn edge_random(p0: vec3f, p1: vec3f) -> f32 {
    let bits = pcg(point_hash(p0) + point_hash(p1));
    return f32(bits >> 8u) / 16777216.0;
}

fn point_hash(point: vec3f) -> u32 {
    // -0 becomes 0. Adding 0 would do so too, but can be optimized away.
    let bits = select(bitcast<vec3u>(point), vec3u(0u), point == vec3f(0.0));
    return pcg(pcg(pcg(bits.x) ^ bits.y) ^ bits.z);
}

// The hash PCG-RXS-M-XS (O'Neill 2014).
fn pcg(value: u32) -> u32 {
    let state = value * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}
