//! The lines of one frame, with their position along the brush in every parameterization.
//!
//! All parameterizations are sampled on the same lines: the edges that linked strokes cover.
//! In the paper's two, u comes from the CPU twin of the stroke shader; along linked strokes,
//! from the ribbons that the GPU made.

use edgemesh::edge_mesh::{EdgeMesh, edge_random};
use edgemesh::line::{LineKind, Parameterization, Placement};
use edgemesh::oracle::stroke_segment::{ClipEdge, StrokeShape, stroke_segment};
use edgemesh::view::{LineBits, View};
use glam::{Vec2, Vec3, Vec4};
use strokes::{Element, GraphReadback, Ribbon};

/// A stretch of a line between two places where u is known.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stretch {
    /// Length in pixels.
    pub(crate) length_px: f32,
    /// Repeats of the brush at the start and at the end.
    pub(crate) u: [f32; 2],
    /// Index of the layer.
    pub(crate) layer: usize,
    /// Whether the next stretch begins at the end of this one.
    pub(crate) is_followed: bool,
}

/// An edge that can be found again in the next frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Track {
    /// Index of the edge record.
    pub(crate) edge: u32,
    /// Index of the layer.
    pub(crate) layer: usize,
    /// Length on the screen in pixels.
    pub(crate) length_px: f32,
    /// Repeats of the brush at the middle.
    pub(crate) u: f32,
}

/// The lines of a frame in one parameterization.
#[derive(Debug, Clone, Default)]
pub(crate) struct FrameLines {
    /// All stretches, in order.
    pub(crate) stretches: Vec<Stretch>,
    /// The edges, in the order of the records.
    pub(crate) tracks: Vec<Track>,
}

/// The frame to sample.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FrameSource<'a> {
    /// The mesh.
    pub(crate) mesh: &'a EdgeMesh,
    /// The view.
    pub(crate) view: &'a View,
    /// Size of the picture in pixels.
    pub(crate) viewport_px: Vec2,
    /// Width of the strokes in pixels.
    pub(crate) width_px: f32,
    /// Length of the brush divided by its height.
    pub(crate) brush_aspect: f32,
    /// The linked strokes of the GPU.
    pub(crate) graph: &'a GraphReadback,
}

impl FrameSource<'_> {
    /// The lines with u along linked strokes.
    #[must_use]
    pub(crate) fn chained(&self) -> FrameLines {
        let graph = self.graph;
        let mut lines = FrameLines::default();
        for (at, ribbon) in graph.ribbons.iter().enumerate().filter(|(_, r)| r.is_drawn()) {
            let point = &graph.points[at];
            let next = graph.ribbons.get(at + 1).filter(|next| next.is_drawn());
            let [a, b] = [Vec2::from(ribbon.a), Vec2::from(ribbon.b)];
            lines.stretches.push(Stretch {
                length_px: a.distance(b),
                u: ribbon.u,
                layer: graph.layer_of(point.joint),
                is_followed: next.is_some_and(|next| Vec2::from(next.a).distance(b) < 0.01),
            });
        }
        for (ribbon, element) in self.covered() {
            let element = &graph.elements[element];
            let middle = (Vec2::from(element.s0) + Vec2::from(element.s1)) / 2.0;
            let [a, b] = [Vec2::from(ribbon.a), Vec2::from(ribbon.b)];
            let along = (middle - a).dot(b - a) / a.distance_squared(b);
            let t = along.clamp(0.0, 1.0);
            lines.tracks.push(Track {
                edge: element.record(),
                layer: graph.layer_of_node(element.node),
                length_px: Vec2::from(element.s0).distance(element.s1.into()),
                u: ribbon.u[0] * (1.0 - t) + ribbon.u[1] * t,
            });
        }
        lines.tracks.sort_unstable_by_key(|track| track.edge);
        lines.tracks.dedup_by_key(|track| track.edge);
        lines
    }

    /// The same lines, edge by edge, in one of the paper's parameterizations.
    #[must_use]
    pub(crate) fn edge_by_edge(&self, parameterization: Parameterization) -> FrameLines {
        let graph = self.graph;
        let mut is_covered = vec![false; graph.elements.len()];
        self.covered().for_each(|(_, element)| is_covered[element] = true);
        let mut lines = FrameLines::default();
        for (at, element) in graph.elements.iter().enumerate().filter(|(at, _)| is_covered[*at]) {
            let length_px = Vec2::from(element.s0).distance(element.s1.into());
            let Some(u) = self.u_of(element, parameterization) else { continue };
            let layer = graph.layer_of_node(element.node);
            let is_last = at + 1 == (element.first + element.chain_length()) as usize;
            let is_followed = !is_last && is_covered.get(at + 1) == Some(&true);
            lines.stretches.push(Stretch { length_px, u, layer, is_followed });
            let edge = element.record();
            lines.tracks.push(Track { edge, layer, length_px, u: 0.5 * (u[0] + u[1]) });
        }
        lines.tracks.sort_unstable_by_key(|track| track.edge);
        lines
    }

    /// The drawn ribbons with the elements that each covers.
    fn covered(&self) -> impl Iterator<Item = (&Ribbon, usize)> {
        let graph = self.graph;
        let drawn = graph.ribbons.iter().enumerate().filter(|(_, ribbon)| ribbon.is_drawn());
        drawn.flat_map(move |(at, ribbon)| {
            let joints = graph.points[at].joint..=graph.points[at + 1].joint;
            joints.map(move |joint| (ribbon, graph.element_of(joint)))
        })
    }

    /// u at both ends of an edge, in the direction of its chain.
    fn u_of(&self, element: &Element, parameterization: Parameterization) -> Option<[f32; 2]> {
        let record = &self.mesh.records[element.record() as usize];
        let at = |vertex: u32| Vec3::from(self.mesh.positions[vertex as usize]);
        let normal = |vertex: u32| Vec3::from(self.mesh.vertex_normals[vertex as usize]);
        let clip = |point: Vec4| self.view.clip_from_world * point;
        let [p0, p1] = [at(record.v0), at(record.v1)];
        let edge = ClipEdge {
            c0: clip(p0.extend(1.0)),
            c1: clip(p1.extend(1.0)),
            c2: clip(p0.extend(1.0)),
            c3: clip(p0.extend(1.0)),
            n0: clip(normal(record.v0).extend(0.0)),
            n1: clip(normal(record.v1).extend(0.0)),
            facing: Vec2::ONE,
            distance: Vec2::ONE,
            r: edge_random(p0, p1),
        };
        let is_backward = element.is_backward();
        let mut bits = LineBits::empty();
        bits.set(LineBits::CONTOUR, element.edge & LineBits::CONTOUR.bits() != 0);
        bits.set(LineBits::A_FACES, !is_backward);
        let segment = stroke_segment(&edge, &self.shape(parameterization), bits);
        let u = segment.u.to_array();
        segment.is_drawn.then_some(if is_backward { [u[1], u[0]] } else { u })
    }

    fn shape(&self, parameterization: Parameterization) -> StrokeShape {
        let origin = self.view.clip_from_world * Vec4::W;
        let origin_px = edgemesh::view::to_pixels(origin, self.viewport_px);
        StrokeShape {
            viewport_px: self.viewport_px,
            origin_px: if origin.w > f32::EPSILON { origin_px } else { Vec2::ZERO },
            fade: Vec2::ZERO,
            width: self.width_px,
            // Widths are in pixels.
            px_per_unit: 1.0,
            brush_aspect: self.brush_aspect,
            mirror: 1.0,
            kind: LineKind::Quad,
            placement: Placement::Automatic,
            parameterization,
            is_world_width: false,
            guard_band: edgemesh::view::WHOLE_BAND,
        }
    }
}
