// How a view sees the faces of an edge, from its own four vertices.
#import <common/edge_source.wgsl>

fn edge_faces(edge: u32) -> EdgeFaces {
    return faces_of_geometry(edge_geometry(edge));
}
