// The facing of an edge's two faces, from their planes: the vertex shader that draws every
// edge has no facing bits.
#import <common/edges_indexed.wgsl>

@group(3) @binding(0) var<storage, read> planes: array<FacePlane>;

fn edge_faces(edge: u32) -> EdgeFaces {
    let face_a = records[edge].face_a;
    let face_b = records[edge].face_b;
    return EdgeFaces(face_b != NONE, looks_at_eye(face_a), looks_at_eye(face_b));
}

fn looks_at_eye(face: u32) -> bool {
    return face != NONE && faces_eye(planes[face], object.eye);
}
