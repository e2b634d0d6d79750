//! Edges marked by hand: one at a time, or the shortest path between two vertices.
//!
//! A mark changes the mesh at once, so that it is drawn. Saving writes it to the side file of
//! the model, which is read with the model.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use edgemesh::build::{BuildOptions, set_marks};
use edgemesh::edge_mesh::{EdgeFlags, EdgeMesh};
use edgemesh::format::whole_file::write_file;
use edgemesh::load::{LoadError, SideMarks, marks_text, read_marks, side_file};
use glam::{DVec2, DVec3};

use super::navigation::Canvas;
use super::picking::hit;
use super::viewpoint::Viewpoint;
use crate::error::Error;
use crate::scene::models::Scene;

/// The state of marking.
#[derive(Debug, Default)]
pub(crate) struct Marking {
    /// Whether clicks mark edges.
    pub(crate) is_on: bool,
    /// The start of the next path: a model and one of its vertices.
    from: Option<(usize, u32)>,
    /// Unsaved changes, in order.
    changes: Vec<MarkChange>,
}

/// Edges of a model that were marked or unmarked, as pairs of mesh vertices.
#[derive(Debug, Clone, PartialEq, Eq)]
struct MarkChange {
    model: usize,
    pairs: Vec<[u32; 2]>,
    is_marked: bool,
}

/// An edge under the pointer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PickedEdge {
    /// Index of the object.
    pub(crate) object: usize,
    /// Index of the object's model.
    pub(crate) model: usize,
    /// The two mesh vertices.
    pub(crate) edge: [u32; 2],
    /// The vertex nearer to the pointer.
    pub(crate) vertex: u32,
    /// The ends in the picture, in points.
    pub(crate) ends: [DVec2; 2],
}

/// The edge nearest to a position, among those of the triangle under it.
#[must_use]
pub(crate) fn edge_under(
    scene: &Scene,
    view: &Viewpoint,
    canvas: &Canvas,
    position: DVec2,
) -> Option<PickedEdge> {
    let (start, direction) = canvas.ray(view, position);
    let hit = hit(scene, start, direction)?;
    let object = scene.objects.get(hit.object)?;
    let mesh = &scene.models[object.model].mesh;
    let corners = *mesh.triangles.get(hit.triangle)?;
    let place = |vertex: u32| {
        let at = object.world_from_object.transform_point3(position_of(mesh, vertex));
        canvas.pixel_of(view, scene.frame.to_file(at))
    };
    let places = [place(corners[0])?, place(corners[1])?, place(corners[2])?];
    let sides = (0..3).map(|at| {
        let other = (at + 1) % 3;
        let ends = [places[at], places[other]];
        let is_second = position.distance(ends[1]) < position.distance(ends[0]);
        let edge = [corners[at], corners[other]];
        let picked = PickedEdge {
            object: hit.object,
            model: object.model,
            edge,
            vertex: edge[usize::from(is_second)],
            ends,
        };
        (distance_to_segment(position, ends), picked)
    });
    sides.min_by(|one, other| one.0.total_cmp(&other.0)).map(|(_, picked)| picked)
}

fn position_of(mesh: &EdgeMesh, vertex: u32) -> DVec3 {
    DVec3::from(mesh.positions[vertex as usize].map(f64::from))
}

fn distance_to_segment(at: DVec2, [a, b]: [DVec2; 2]) -> f64 {
    let along = b - a;
    let share = (at - a).dot(along) / along.length_squared().max(f64::MIN_POSITIVE);
    at.distance(a + along * share.clamp(0.0, 1.0))
}

impl Marking {
    /// Forgets all changes, for other models.
    pub(crate) fn forget(&mut self) {
        self.from = None;
        self.changes.clear();
    }

    /// Whether there are unsaved changes.
    #[must_use]
    pub(crate) const fn has_changes(&self) -> bool {
        !self.changes.is_empty()
    }

    /// Marks an edge, or removes its mark.
    pub(crate) fn toggle(&mut self, scene: &mut Arc<Scene>, picked: &PickedEdge) {
        let mesh = &scene.models[picked.model].mesh;
        let is_marked = !is_marked(mesh, picked.edge);
        self.from = Some((picked.model, picked.vertex));
        self.change(scene, picked.model, vec![picked.edge], is_marked);
    }

    /// Marks the shortest path along edges from the vertex clicked last. Returns the number
    /// of edges on it; `None` if there is no path.
    pub(crate) fn mark_path(
        &mut self,
        scene: &mut Arc<Scene>,
        picked: &PickedEdge,
    ) -> Option<usize> {
        let from = self.from.replace((picked.model, picked.vertex));
        let (_, start) = from.filter(|(model, _)| *model == picked.model)?;
        let mesh = &scene.models[picked.model].mesh;
        let path = shortest_path(mesh, start, picked.vertex)?;
        let pairs: Vec<[u32; 2]> = path.windows(2).map(|pair| [pair[0], pair[1]]).collect();
        let count = pairs.len();
        self.change(scene, picked.model, pairs, true);
        Some(count)
    }

    fn change(
        &mut self,
        scene: &mut Arc<Scene>,
        model: usize,
        mut pairs: Vec<[u32; 2]>,
        is_marked: bool,
    ) {
        let mesh = &scene.models[model].mesh;
        pairs.retain(|pair| self::is_marked(mesh, *pair) != is_marked);
        if !pairs.is_empty() {
            let change = MarkChange { model, pairs, is_marked };
            apply(scene, &change);
            self.changes.push(change);
        }
    }

    /// Undoes the last change.
    pub(crate) fn undo(&mut self, scene: &mut Arc<Scene>) {
        if let Some(change) = self.changes.pop() {
            apply(scene, &MarkChange { is_marked: !change.is_marked, ..change });
        }
    }

    /// Writes the changes to the side files of the models, or to `marks` if it is given.
    /// Returns the files that were written.
    ///
    /// # Errors
    /// [`Error::MarksWithoutFile`], or if a side file cannot be read or written.
    pub(crate) fn save(
        &mut self,
        scene: &Scene,
        marks: Option<&Path>,
    ) -> Result<Vec<PathBuf>, Error> {
        let mut by_model: BTreeMap<usize, Vec<&MarkChange>> = BTreeMap::new();
        for change in &self.changes {
            by_model.entry(change.model).or_default().push(change);
        }
        let mut written = Vec::new();
        for (model, changes) in by_model {
            let loaded = &scene.models[model];
            let source = loaded
                .source
                .as_ref()
                .ok_or_else(|| Error::MarksWithoutFile { model: loaded.name.clone() })?;
            let path = marks.map_or_else(|| side_file(&source.path), Path::to_owned);
            let mut side = match path.is_file() {
                true => read_marks(&path).map_err(LoadError::from)?,
                false => SideMarks::default(),
            };
            for change in changes {
                for pair in &change.pairs {
                    let [a, b] = pair.map(|vertex| source.file_vertices[vertex as usize]);
                    note(&mut side, [a.min(b), a.max(b)], change.is_marked);
                }
            }
            write_file(&path, marks_text(&side).as_bytes())?;
            written.push(path);
        }
        self.changes.clear();
        Ok(written)
    }
}

/// Adds a pair to the marks of a side file.
fn note(side: &mut SideMarks, pair: [u32; 2], is_marked: bool) {
    let has = |pairs: &[[u32; 2]]| pairs.contains(&pair) || pairs.contains(&[pair[1], pair[0]]);
    let remove = |pairs: &mut Vec<[u32; 2]>| {
        pairs.retain(|known| *known != pair && *known != [pair[1], pair[0]]);
    };
    if is_marked {
        remove(&mut side.unmarked);
        side.marked.push(pair);
    } else if has(&side.marked) {
        remove(&mut side.marked);
    } else {
        // The model's own file marks it.
        side.unmarked.push(pair);
    }
}

fn apply(scene: &mut Arc<Scene>, change: &MarkChange) {
    // A renderer may still hold the scene before the change.
    let mesh = &mut Arc::make_mut(scene).models[change.model].mesh;
    set_marks(mesh, &change.pairs, change.is_marked, &BuildOptions::default());
}

fn is_marked(mesh: &EdgeMesh, [a, b]: [u32; 2]) -> bool {
    let is_it = |v0: u32, v1: u32| [v0, v1] == [a, b] || [v0, v1] == [b, a];
    mesh.records
        .iter()
        .any(|record| is_it(record.v0, record.v1) && record.flags().contains(EdgeFlags::MARKED))
}

/// The vertices of the shortest path between two vertices along edges that are no diagonals
/// (Dijkstra 1959).
fn shortest_path(mesh: &EdgeMesh, start: u32, end: u32) -> Option<Vec<u32>> {
    let mut neighbors: Vec<Vec<u32>> = vec![Vec::new(); mesh.positions.len()];
    for record in mesh.records.iter().filter(|r| !r.flags().contains(EdgeFlags::DIAGONAL)) {
        neighbors[record.v0 as usize].push(record.v1);
        neighbors[record.v1 as usize].push(record.v0);
    }
    let mut before = vec![u32::MAX; mesh.positions.len()];
    let mut lengths = vec![f64::INFINITY; mesh.positions.len()];
    lengths[start as usize] = 0.0;
    // Lengths as bits: positive numbers and their bits have the same order.
    let mut open = BinaryHeap::from([Reverse((0_u64, start))]);
    while let Some(Reverse((bits, vertex))) = open.pop() {
        if vertex == end {
            let back =
                |vertex: &u32| Some(before[*vertex as usize]).filter(|&before| before != u32::MAX);
            let mut path: Vec<u32> = std::iter::successors(Some(end), back).collect();
            path.reverse();
            return Some(path);
        }
        let length = f64::from_bits(bits);
        if length > lengths[vertex as usize] {
            continue;
        }
        for &next in &neighbors[vertex as usize] {
            let step = position_of(mesh, vertex).distance(position_of(mesh, next));
            let reached = length + step;
            if reached < lengths[next as usize] {
                lengths[next as usize] = reached;
                before[next as usize] = vertex;
                open.push(Reverse((reached.to_bits(), next)));
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use edgemesh::load::{LoadOptions, NoProgress};

    use super::*;
    use crate::scene::scene_file::SceneObject;

    /// A strip of two squares, seen from the front, with a line at its left edge.
    const STRIP: &str = "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\n\
                         f 1 2 5 4\nf 2 3 6 5\nl 1 4\n";

    fn load(path: &Path) -> Arc<Scene> {
        let object = SceneObject::plain(path);
        let scene = Scene::load(&[object], &LoadOptions::default(), &NoProgress);
        Arc::new(scene.unwrap_or_else(|error| panic!("{error}")))
    }

    fn marked(scene: &Scene) -> Vec<[u32; 2]> {
        let records = &scene.models[0].mesh.records;
        let marked = records.iter().filter(|record| record.flags().contains(EdgeFlags::MARKED));
        marked.map(|record| [record.v0.min(record.v1), record.v0.max(record.v1)]).collect()
    }

    #[test]
    fn what_is_marked_by_hand_is_read_again() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("strip.obj");
        std::fs::write(&path, STRIP).unwrap();
        let mut scene = load(&path);
        assert_eq!(marked(&scene), [[0, 3]], "the line of the file");
        let view = Viewpoint {
            eye: DVec3::new(1.0, 0.5, 4.0),
            target: DVec3::new(1.0, 0.5, 0.0),
            up: DVec3::Y,
            fov_y_deg: 40.0,
            is_orthographic: false,
        };
        let canvas = Canvas { size: DVec2::new(400.0, 400.0) };
        let at = |x: f64, y: f64| canvas.pixel_of(&view, DVec3::new(x, y, 0.0)).unwrap();
        let pick =
            |scene: &Scene, x: f64, y: f64| edge_under(scene, &view, &canvas, at(x, y)).unwrap();
        let mut marking = Marking::default();
        // The edge between the squares, near its upper end.
        let middle = pick(&scene, 0.99, 0.7);
        assert_eq!((middle.edge.iter().min(), middle.vertex), (Some(&1), 4));
        marking.toggle(&mut scene, &middle);
        assert_eq!(marked(&scene), [[0, 3], [1, 4]]);
        // From there along the upper rim to the right.
        let end = pick(&scene, 1.95, 0.98);
        assert_eq!(end.vertex, 5);
        assert_eq!(marking.mark_path(&mut scene, &end), Some(1));
        assert_eq!(marked(&scene), [[0, 3], [1, 4], [4, 5]]);
        marking.undo(&mut scene);
        assert_eq!(marked(&scene), [[0, 3], [1, 4]]);
        // The line of the file loses its mark.
        let left = pick(&scene, 0.01, 0.6);
        marking.toggle(&mut scene, &left);
        assert_eq!(marked(&scene), [[1, 4]]);
        let written = marking.save(&scene, None).unwrap();
        assert_eq!(written, [side_file(&path)]);
        assert!(!marking.has_changes());
        assert_eq!(marked(&load(&path)), [[1, 4]], "the preprocessor reads them");
        // And back again.
        marking.toggle(&mut scene, &left);
        marking.toggle(&mut scene, &middle);
        marking.save(&scene, None).unwrap();
        assert_eq!(marked(&load(&path)), [[0, 3]]);
        assert!(edge_under(&scene, &view, &canvas, DVec2::ZERO).is_none(), "beside the model");
    }

    #[test]
    fn paths_are_the_shortest_and_go_around_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("strip.obj");
        std::fs::write(&path, [STRIP, "v 9 9 9\nv 9 9 8\nv 9 8 9\nf 7 8 9\n"].concat()).unwrap();
        let scene = load(&path);
        let mesh = &scene.models[0].mesh;
        assert_eq!(shortest_path(mesh, 0, 5).map(|path| path.len()), Some(4), "no diagonals");
        assert_eq!(shortest_path(mesh, 2, 2), Some(vec![2]));
        assert_eq!(shortest_path(mesh, 0, 7), None, "it is another part");
    }
}
