// An edge with its faces in object space, and the same edge in clip space.
#import <common/facing.wgsl>
#import <common/frame.wgsl>
#import <common/stroke_vertex.wgsl>

struct EdgeGeometry {
    p0: vec3f,
    p1: vec3f,
    // Third vertices of face A and face B; equal to p0 if there is no such face.
    p2: vec3f,
    p3: vec3f,
    n0: vec3f,
    n1: vec3f,
    r: f32,
}

fn clip_edge(edge: EdgeGeometry) -> ClipEdge {
    return ClipEdge(
        object.clip_from_object * vec4f(edge.p0, 1.0),
        object.clip_from_object * vec4f(edge.p1, 1.0),
        object.clip_from_object * vec4f(edge.p2, 1.0),
        object.clip_from_object * vec4f(edge.p3, 1.0),
        object.clip_from_normal * vec4f(edge.n0, 0.0),
        object.clip_from_normal * vec4f(edge.n1, 0.0),
        vec2f(
            facing_cosine(edge.p0, edge.p1, edge.p2, object.eye),
            facing_cosine(edge.p0, edge.p1, edge.p3, object.eye),
        ),
        vec2f(
            dot(object.distance, vec4f(edge.p0, 1.0)),
            dot(object.distance, vec4f(edge.p1, 1.0)),
        ),
        edge.r,
    );
}

// The facing of an edge's two faces, from vertices alone: for layouts without planes.
fn faces_of_geometry(edge: EdgeGeometry) -> EdgeFaces {
    let has_a = any(edge.p2 != edge.p0);
    let has_b = any(edge.p3 != edge.p0);
    return EdgeFaces(
        has_b,
        has_a && triangle_faces_eye(edge.p0, edge.p1, edge.p2, object.eye),
        has_b && triangle_faces_eye(edge.p3, edge.p1, edge.p0, object.eye),
    );
}
