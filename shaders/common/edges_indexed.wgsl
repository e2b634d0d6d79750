// The edges of a mesh in the indexed layout: 20 bytes per edge; positions and normals are
// shared.
#import <common/edge_geometry.wgsl>

@group(2) @binding(2) var<storage, read> records: array<PackedRecord>;
@group(2) @binding(3) var<storage, read> positions: array<f32>;
@group(2) @binding(4) var<storage, read> normals: array<f32>;
// Three vertices per face.
@group(2) @binding(5) var<storage, read> triangles: array<u32>;

fn edge_word(edge: u32) -> u32 {
    return records[edge].word;
}

// The two ends of an edge, in object space.
fn edge_ends(edge: u32) -> array<vec3f, 2> {
    let record = records[edge];
    return array<vec3f, 2>(position_of(record.v0), position_of(record.v1));
}

fn edge_geometry(edge: u32) -> EdgeGeometry {
    let record = records[edge];
    let p0 = position_of(record.v0);
    let p1 = position_of(record.v1);
    return EdgeGeometry(
        p0,
        p1,
        position_of(apex(record.face_a, record)),
        position_of(apex(record.face_b, record)),
        normal_of(record.v0),
        normal_of(record.v1),
        edge_random(p0, p1),
    );
}

// The vertex of a face that is not on the edge; v0 if there is no face, as in the paper.
fn apex(face: u32, record: PackedRecord) -> u32 {
    if face == NONE {
        return record.v0;
    }
    // The sum of all three minus the two on the edge.
    return triangles[3u * face] + triangles[3u * face + 1u] + triangles[3u * face + 2u]
        - record.v0 - record.v1;
}

fn position_of(vertex: u32) -> vec3f {
    let at = 3u * vertex;
    return vec3f(positions[at], positions[at + 1u], positions[at + 2u]);
}

fn normal_of(vertex: u32) -> vec3f {
    let at = 3u * vertex;
    return vec3f(normals[at], normals[at + 1u], normals[at + 2u]);
}
