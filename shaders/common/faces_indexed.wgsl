// The facing of an edge's two faces, from the facing bits of detect_faces.wgsl.
#import <common/facing.wgsl>
#import <common/feature.wgsl>

@group(2) @binding(2) var<storage, read> records: array<PackedRecord>;
@group(3) @binding(0) var<storage, read> facing: array<u32>;

fn edge_word(edge: u32) -> u32 {
    return records[edge].word;
}

fn edge_faces(edge: u32) -> EdgeFaces {
    let face_a = records[edge].face_a;
    let face_b = records[edge].face_b;
    return EdgeFaces(face_b != NONE, looks_at_eye(face_a), looks_at_eye(face_b));
}

fn looks_at_eye(face: u32) -> bool {
    // A line along no edge has no faces.
    return face != NONE && (facing[face >> 5u] & (1u << (face & 31u))) != 0u;
}
