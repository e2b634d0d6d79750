// One facing bit per face (McGuire and Hughes, Equation 1). Each invocation writes one
// word of 32 faces, so no atomics are needed; for most words, one test of the cone of
// normals is enough.
#import <common/facing.wgsl>
#import <common/frame.wgsl>
#import <common/normal_cone.wgsl>

@group(2) @binding(2) var<storage, read> planes: array<FacePlane>;
@group(2) @binding(3) var<storage, read> cones: array<NormalCone>;
@group(3) @binding(0) var<storage, read_write> facing: array<u32>;

@compute @workgroup_size(64)
fn detect_faces(@builtin(global_invocation_id) id: vec3u) {
    let first = id.x * 32u;
    if first >= chunk.face_count {
        return;
    }
    let count = min(32u, chunk.face_count - first);
    let all = select((1u << count) - 1u, 0xffffffffu, count == 32u);
    let whole = cone_facing(cones[id.x], object.eye);
    if whole != MIXED {
        facing[id.x] = select(0u, all, whole == ALL_FACE);
        return;
    }
    var word = 0u;
    for (var bit = 0u; bit < count; bit++) {
        word |= select(0u, 1u << bit, faces_eye(planes[first + bit], object.eye));
    }
    facing[id.x] = word;
}
