//! Cuts a mesh into chunks whose buffers an adapter can bind.
//!
//! A chunk has consecutive records with the faces and vertices that they need, numbered anew;
//! faces and vertices between two chunks are in both. A face has the same bits in every chunk,
//! so a contour that runs from one chunk into the next does not break, and chunks drawn in order
//! give the picture of the whole. Cuts are between runs of edges, so that the run states of a
//! view are one list for all chunks.
//!
//! Rejected: cutting by space. Strokes would be drawn in another order, which shows where
//! translucent ones cross.

use std::borrow::Cow;
use std::ops::Range;

use edgemesh::edge_mesh::{EdgeMesh, EdgeRecord, FacePlane};
use edgemesh::index::{NONE, to_u32};

use crate::mesh::layout::{EDGES_PER_RUN, PackedRecord};

/// A part of a mesh.
#[derive(Debug)]
pub(crate) struct Chunk<'a> {
    /// The range of its records in the mesh.
    pub(crate) edges: Range<usize>,
    pub(crate) records: Vec<PackedRecord>,
    pub(crate) positions: Cow<'a, [[f32; 3]]>,
    pub(crate) normals: Cow<'a, [[f32; 3]]>,
    pub(crate) triangles: Cow<'a, [[u32; 3]]>,
    pub(crate) planes: Cow<'a, [FacePlane]>,
}

/// The most that one chunk can hold: at least a run of edges with its faces and vertices.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ChunkLimits {
    pub(crate) edges: usize,
    pub(crate) faces: usize,
    pub(crate) vertices: usize,
}

impl ChunkLimits {
    /// Whether `mesh` fits into one chunk.
    fn hold(&self, mesh: &EdgeMesh) -> bool {
        mesh.records.len() <= self.edges
            && mesh.triangles.len() <= self.faces
            && mesh.positions.len() <= self.vertices
    }
}

/// Cuts `mesh` into one chunk or more.
pub(crate) fn chunks<'a>(mesh: &'a EdgeMesh, limits: &ChunkLimits) -> Vec<Chunk<'a>> {
    if limits.hold(mesh) {
        return vec![Chunk {
            edges: 0..mesh.records.len(),
            records: mesh.records.iter().map(packed).collect(),
            positions: (&mesh.positions).into(),
            normals: (&mesh.vertex_normals).into(),
            triangles: (&mesh.triangles).into(),
            planes: (&mesh.face_planes).into(),
        }];
    }
    let mut cutter = Cutter::new(mesh);
    let mut first = 0;
    for (index, run) in mesh.records.chunks(EDGES_PER_RUN as usize).enumerate() {
        let at = index * EDGES_PER_RUN as usize;
        let (faces, vertices) = cutter.count_new(run);
        let is_full = at + run.len() - first > limits.edges
            || cutter.faces.taken.len() + faces > limits.faces
            || cutter.vertices.taken.len() + vertices > limits.vertices;
        if is_full && at > first {
            cutter.cut(first..at);
            first = at;
        }
        run.iter().for_each(|record| cutter.take(record));
    }
    cutter.cut(first..mesh.records.len());
    cutter.chunks
}

fn packed(record: &EdgeRecord) -> PackedRecord {
    let EdgeRecord { v0, v1, face_a, face_b, word } = *record;
    PackedRecord { v0, v1, face_a, face_b, word }
}

/// The faces or vertices of a chunk, in the order in which they were taken.
struct Subset {
    /// The index in the chunk of each one of the mesh, or [`NONE`].
    places: Vec<u32>,
    taken: Vec<u32>,
}

impl Subset {
    fn new(count: usize) -> Self {
        Self { places: vec![NONE; count], taken: Vec::new() }
    }

    fn has(&self, item: u32) -> bool {
        self.places[item as usize] != NONE
    }

    fn take(&mut self, item: u32) -> bool {
        let is_new = !self.has(item);
        if is_new {
            self.places[item as usize] = to_u32(self.taken.len());
            self.taken.push(item);
        }
        is_new
    }

    fn place(&self, item: u32) -> u32 {
        if item == NONE { NONE } else { self.places[item as usize] }
    }

    fn clear(&mut self) {
        for item in self.taken.drain(..) {
            self.places[item as usize] = NONE;
        }
    }

    fn pick<T: Copy>(&self, items: &[T]) -> Vec<T> {
        self.taken.iter().map(|&item| items[item as usize]).collect()
    }
}

struct Cutter<'a> {
    mesh: &'a EdgeMesh,
    faces: Subset,
    vertices: Subset,
    chunks: Vec<Chunk<'a>>,
}

impl<'a> Cutter<'a> {
    fn new(mesh: &'a EdgeMesh) -> Self {
        Self {
            mesh,
            faces: Subset::new(mesh.triangles.len()),
            vertices: Subset::new(mesh.positions.len()),
            chunks: Vec::new(),
        }
    }

    /// How many faces and vertices a run of edges adds.
    fn count_new(&self, run: &[EdgeRecord]) -> (usize, usize) {
        let mut faces: Vec<u32> = run
            .iter()
            .flat_map(|record| [record.face_a, record.face_b])
            .filter(|&face| face != NONE && !self.faces.has(face))
            .collect();
        faces.sort_unstable();
        faces.dedup();
        let corners = faces.iter().flat_map(|&face| self.mesh.triangles[face as usize]);
        let mut vertices: Vec<u32> = corners
            .chain(run.iter().flat_map(|record| [record.v0, record.v1]))
            .filter(|&vertex| !self.vertices.has(vertex))
            .collect();
        vertices.sort_unstable();
        vertices.dedup();
        (faces.len(), vertices.len())
    }

    fn take(&mut self, record: &EdgeRecord) {
        for face in [record.face_a, record.face_b] {
            if face != NONE && self.faces.take(face) {
                for vertex in self.mesh.triangles[face as usize] {
                    self.vertices.take(vertex);
                }
            }
        }
        self.vertices.take(record.v0);
        self.vertices.take(record.v1);
    }

    fn cut(&mut self, edges: Range<usize>) {
        let renumber = |record: &EdgeRecord| EdgeRecord {
            v0: self.vertices.place(record.v0),
            v1: self.vertices.place(record.v1),
            face_a: self.faces.place(record.face_a),
            face_b: self.faces.place(record.face_b),
            word: record.word,
        };
        let triangles = self.faces.pick(&self.mesh.triangles).into_iter();
        self.chunks.push(Chunk {
            records: self.mesh.records[edges.clone()]
                .iter()
                .map(|record| packed(&renumber(record)))
                .collect(),
            positions: self.vertices.pick(&self.mesh.positions).into(),
            normals: self.vertices.pick(&self.mesh.vertex_normals).into(),
            triangles: triangles
                .map(|triangle| triangle.map(|vertex| self.vertices.place(vertex)))
                .collect(),
            planes: self.faces.pick(&self.mesh.face_planes).into(),
            edges,
        });
        self.faces.clear();
        self.vertices.clear();
    }
}

#[cfg(test)]
mod tests {
    use edgemesh::build::{BuildOptions, build_edge_mesh};
    use edgemesh::model::Model;
    use edgemesh::report::Report;

    use super::*;

    fn strip() -> EdgeMesh {
        let positions: Vec<[f32; 3]> =
            (0..240_u8).map(|at| [f32::from(at / 2), f32::from(at % 2), 0.0]).collect();
        let polygons: Vec<[u32; 3]> = (0..238)
            .map(|at| if at % 2 == 0 { [at, at + 2, at + 1] } else { [at, at + 1, at + 2] })
            .collect();
        let polygons: Vec<&[u32]> = polygons.iter().map(|polygon| &polygon[..]).collect();
        let model = Model::from_polygons(&positions, &polygons);
        build_edge_mesh(&model, &BuildOptions::default(), &mut Report::default())
    }

    #[test]
    fn chunks_have_every_edge_once_with_its_own_faces() {
        let mesh = strip();
        let limits = ChunkLimits { edges: 150, faces: 128, vertices: 256 };
        let chunks = chunks(&mesh, &limits);
        assert!(chunks.len() > 3);
        let mut next = 0;
        for chunk in &chunks {
            assert_eq!(chunk.edges.start, next);
            next = chunk.edges.end;
            assert_eq!(chunk.edges.start % EDGES_PER_RUN as usize, 0);
            assert!(chunk.records.len() <= 150 && chunk.positions.len() <= 256);
            assert!(chunk.triangles.len() <= 128 && chunk.planes.len() == chunk.triangles.len());
            for (local, edge) in chunk.records.iter().zip(chunk.edges.clone()) {
                let record = &mesh.records[edge];
                let corner = |vertex: u32| mesh.positions[vertex as usize];
                assert_eq!(chunk.positions[local.v0 as usize], corner(record.v0));
                assert_eq!(chunk.positions[local.v1 as usize], corner(record.v1));
                for (local, face) in [(local.face_a, record.face_a), (local.face_b, record.face_b)]
                {
                    assert_eq!(local == NONE, face == NONE);
                    if face != NONE {
                        let corners = chunk.triangles[local as usize]
                            .map(|vertex| chunk.positions[vertex as usize]);
                        assert_eq!(corners, mesh.triangles[face as usize].map(corner));
                    }
                }
            }
        }
        assert_eq!(next, mesh.records.len());
    }

    #[test]
    fn a_mesh_that_fits_is_one_chunk_and_not_copied() {
        let mesh = strip();
        let limits = ChunkLimits { edges: 1000, faces: 1000, vertices: 1000 };
        let chunks = chunks(&mesh, &limits);
        assert!(matches!(&chunks[..], [Chunk { positions: Cow::Borrowed(_), .. }]));
    }
}
