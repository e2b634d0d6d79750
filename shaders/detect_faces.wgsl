// One facing bit a face, 32 to a word, one word an invocation: a run of faces
// each keeps the cost per invocation small, and needs no atomics.
#import <common/facing.wgsl>
#import <common/frame.wgsl>

@group(2) @binding(0) var<uniform> mesh: MeshUniform;
@group(2) @binding(1) var<storage, read> planes: array<FacePlane>;
@group(2) @binding(2) var<storage, read_write> facing: array<u32>;

@compute @workgroup_size(64)
fn detect_faces(@builtin(global_invocation_id) id: vec3u) {
    let first = id.x * 32u;
    if first >= mesh.face_count {
        return;
    }
    let count = min(32u, mesh.face_count - first);
    var word = 0u;
    for (var bit = 0u; bit < count; bit++) {
        word |= select(0u, 1u << bit, faces_eye(planes[first + bit], frame.eye));
    }
    facing[id.x] = word;
}
