// The facing of an edge's two faces, from the edge's four vertices.
#import <common/edge_source.wgsl>

fn edge_faces(edge: u32) -> EdgeFaces {
    return faces_of_geometry(edge_geometry(edge));
}
