// Strokes along the live edges: 12 vertices an instance, pulled by index; the
// quad is 0 to 5, the start cap 6 to 8, the finish cap 9 to 11.
//
//        8                         11
//      . |  5 ----------------- 4  | .
//    7---6  .                   .  9--10       (caps on the outside)
//           0 ----------------- 1
#import <common/frame.wgsl>
#import <common/mesh.wgsl>
#import <common/stroke_vertex.wgsl>

// Whether the brush texture is laid on; without it strokes are solid.
override IS_TEXTURED: bool = false;

// Rust twin: StrokeUniform in crates/strokes/src/stroke.rs.
struct StrokeUniform {
    // Premultiplied.
    color: vec4f,
    width_px: f32,
    // Length of the brush over its height.
    brush_aspect: f32,
    padding: vec2f,
}

@group(1) @binding(0) var<uniform> stroke: StrokeUniform;
@group(1) @binding(1) var brush: texture_2d<f32>;
@group(1) @binding(2) var brush_sampler: sampler;

@group(2) @binding(0) var<storage, read> positions: array<f32>;
@group(2) @binding(1) var<storage, read> normals: array<f32>;
@group(2) @binding(2) var<storage, read> records: array<EdgeRecord>;
@group(2) @binding(3) var<storage, read> live: array<u32>;
// Three vertices a face.
@group(2) @binding(4) var<storage, read> triangles: array<u32>;
@group(2) @binding(5) var<storage, read> planes: array<FacePlane>;

// The cosine between a face's normal and the line of sight to a point of it,
// without its sign.
fn facing_at(point: vec3f, face: u32) -> f32 {
    if face == NONE {
        return 0.0;
    }
    let to_eye = frame.eye.xyz - frame.eye.w * point;
    let distance = length(to_eye);
    return select(abs(dot(planes[face].normal.xyz, to_eye)) / distance, 0.0, distance <= 0.0);
}

// The vertex of a face that is not on the edge; the paper's v3 = v0 where there
// is no face.
fn apex(face: u32, record: EdgeRecord) -> u32 {
    if face == NONE {
        return record.v0;
    }
    for (var corner = 0u; corner < 3u; corner++) {
        let vertex = triangles[3u * face + corner];
        if vertex != record.v0 && vertex != record.v1 {
            return vertex;
        }
    }
    return record.v0;
}

fn clip_of(vertex: u32) -> vec4f {
    return frame.clip_from_world * vec4f(position_of(vertex), 1.0);
}

fn position_of(vertex: u32) -> vec3f {
    let at = 3u * vertex;
    return vec3f(positions[at], positions[at + 1u], positions[at + 2u]);
}

fn normal_of(vertex: u32) -> vec3f {
    let at = 3u * vertex;
    return vec3f(normals[at], normals[at + 1u], normals[at + 2u]);
}

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) uv: vec2f,
}

@vertex
fn stroke_vertices(
    @builtin(vertex_index) vertex_index: u32,
    @builtin(instance_index) instance_index: u32,
) -> Varying {
    let word = live[instance_index];
    let record = records[word & EDGE_INDEX_MASK];
    let p0 = position_of(record.v0);
    let p1 = position_of(record.v1);
    let facing = vec2f(facing_at(p0, record.face_a), facing_at(p0, record.face_b));
    let edge = ClipEdge(
        frame.clip_from_world * vec4f(p0, 1.0),
        frame.clip_from_world * vec4f(p1, 1.0),
        clip_of(apex(record.face_a, record)),
        clip_of(apex(record.face_b, record)),
        facing,
        frame.clip_from_world * vec4f(normal_of(record.v0), 0.0),
        frame.clip_from_world * vec4f(normal_of(record.v1), 0.0),
        edge_random(p0, p1),
    );
    let shape = StrokeShape(frame.viewport_px, stroke.width_px, stroke.brush_aspect);
    let vertex = stroke_vertex(edge, shape, word & (CONTOUR | A_FACES), vertex_index);
    return Varying(vertex.position, vertex.uv);
}

@fragment
fn stroke_fragment(in: Varying) -> @location(0) vec4f {
    if IS_TEXTURED {
        return stroke.color * textureSample(brush, brush_sampler, in.uv).a;
    }
    return stroke.color;
}
