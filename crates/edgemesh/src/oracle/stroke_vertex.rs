//! One vertex of a stroke: of a thin line, a quad, a cap, a half disk or a fin.
//!
//! ```text
//!        6                          9
//!      . |  3 ----------------- 2   | .
//!    5---4  .                   .   7--8        caps: 4 to 6 and 7 to 9
//!           0 ----------------- 1               half disks: 4 to 13 and 14 to 23,
//!                                               the middle first
//! ```
//!
//! Fins are those of Card and Mitchell (Listing 1): a quad on the edge with its far side pushed out
//! along the vertex normals, by a thickness that grows with the distance so that it looks constant.
//! Seen along its normals a fin has no width, as they note.
//!
//! Rejected: their test of face normals against the line of sight to each vertex, in which the two
//! ends of an edge can disagree. Fins stand on the edges that [`crate::view::classify_edge`] draws.
//! These include all boundaries, as the negated second normal does in their method.
//!
//! WGSL twin: `shaders/common/stroke_vertex.wgsl`.

use glam::{Vec2, Vec3, Vec4};

use super::spine::{MIN_LENGTH_PX, lerp, project_spine, screen_normal};
use super::stroke_cap::{cap_corner, cap_fills_gap, half_disk, stroke_cap};
use super::stroke_quad::stroke_sign;
use super::stroke_segment::{
    ClipEdge, Segment, StrokeShape, opacity_at, stroke_segment, stroke_u, width_at,
};
use crate::line::{CAP_VERTICES, DISK_STEPS, DISK_VERTICES, LineKind};
use crate::view::LineBits;

/// The position of culled vertices, behind the near plane (paper, section 3.2).
const BEHIND: Vec3 = Vec3::new(0.0, 0.0, -1.0);

/// The distance of the visibility test of a contour from its edge, in pixels. So far outside, no
/// sample of the pixel shows the surface of the contour; one pixel more, by which the fill is
/// pushed back, keeps edges hidden by what lies closely before them.
pub const FOOT_PX: f32 = 2.5;

/// A vertex for the rasterizer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StrokeVertex {
    /// Position in clip space with w = 1, so that interpolation is linear on the screen.
    pub position: Vec3,
    /// Coordinate along the brush, in lengths of the brush.
    pub u: f32,
    /// Coordinate across the brush, 0 outside to 1 inside.
    pub v: f32,
    /// Opacity after fading, 0 to 1.
    pub opacity: f32,
    /// The point that decides whether a contour is visible: [`FOOT_PX`] beside it, off the surface,
    /// in pixels from the middle of the picture, with the depth of the edge.
    pub foot: Vec3,
    /// Distance over the surface that a contour bounds, in pixels; negative off the surface, 0 for
    /// other lines.
    pub over_px: f32,
}

/// A culled vertex. WGSL twin: `culled_vertex`.
const CULLED: StrokeVertex =
    StrokeVertex { position: BEHIND, u: 0.0, v: 0.0, opacity: 0.0, foot: Vec3::ZERO, over_px: 0.0 };

/// Computes vertex `corner` of the stroke along `edge`; `corner` is below
/// [`LineKind::vertex_count`].
#[must_use]
pub fn stroke_vertex(
    edge: &ClipEdge,
    shape: &StrokeShape,
    bits: LineBits,
    corner: u32,
) -> StrokeVertex {
    if shape.kind == LineKind::Fin {
        return fin_vertex(edge, shape, corner);
    }
    segment_vertex(&stroke_segment(edge, shape, bits), shape, corner)
}

/// Computes vertex `corner` of a stroke.
#[must_use]
pub fn segment_vertex(segment: &Segment, shape: &StrokeShape, corner: u32) -> StrokeVertex {
    let spine = &segment.spine;
    if !segment.is_drawn {
        return CULLED;
    }
    if shape.kind == LineKind::Thin {
        return at_end(segment, shape, corner == 1, Vec2::ZERO, 0.0, 0.5);
    }
    if corner < 4 {
        let is_end = corner == 1 || corner == 2;
        if corner < 2 {
            let offset = spine.p * of_end(segment.near_px, is_end);
            return at_end(segment, shape, is_end, offset, segment.near_rise, segment.v_near);
        }
        let offset = spine.p * of_end(segment.far_px, is_end);
        let vertex = at_end(segment, shape, is_end, offset, segment.far_rise, segment.v_far);
        return StrokeVertex { u: of_end(segment.u_far, is_end), ..vertex };
    }
    let has_caps = shape.kind == LineKind::QuadAndCaps;
    let per_end = if has_caps { CAP_VERTICES } else { DISK_VERTICES };
    let is_end = corner >= 4 + per_end;
    // A clipped end is no vertex of the mesh, and nobody meets it there.
    if if is_end { spine.t1 < 1.0 } else { spine.t0 > 0.0 } {
        return CULLED;
    }
    let i = (corner - 4) % per_end;
    if has_caps {
        cap_vertex(segment, shape, is_end, i)
    } else {
        disk_vertex(segment, shape, is_end, i)
    }
}

fn cap_vertex(segment: &Segment, shape: &StrokeShape, is_end: bool, i: u32) -> StrokeVertex {
    let side = of_end(segment.cap_side, is_end);
    let (m, forward) = if is_end { (segment.m1, 1.0) } else { (segment.m0, -1.0) };
    let j = cap_corner(side, i);
    // A cap that is left out has no area. Behind the near plane it would take rasterizers off their
    // fast path for the whole draw.
    if j == 0 || !cap_fills_gap(segment.spine.p, m, side, forward) {
        return at_end(segment, shape, is_end, Vec2::ZERO, 0.0, segment.v_spine);
    }
    let far_px = of_end(segment.far_px, is_end);
    let offset = stroke_cap(Vec2::ZERO, segment.spine.p, m, side, far_px.abs(), j);
    let is_far = (far_px < 0.0) == (side < 0.0);
    let (rise, v, u) = if is_far {
        (segment.far_rise, segment.v_far, segment.u_far)
    } else {
        (segment.near_rise, segment.v_near, segment.u)
    };
    let vertex = at_end(segment, shape, is_end, offset, rise, v);
    if j == 1 { StrokeVertex { u: of_end(u, is_end), ..vertex } } else { vertex }
}

fn disk_vertex(segment: &Segment, shape: &StrokeShape, is_end: bool, i: u32) -> StrokeVertex {
    if i == 0 {
        return at_end(segment, shape, is_end, Vec2::ZERO, 0.0, segment.v_spine);
    }
    let [near_px, far_px] = [segment.near_px, segment.far_px].map(|side| of_end(side, is_end));
    let left_px = near_px.max(far_px).max(0.0);
    let right_px = (-near_px.min(far_px)).max(0.0);
    let forward = if is_end { 1.0 } else { -1.0 };
    let offset = half_disk(segment.spine.p, forward, left_px, right_px, i - 1);
    let is_left = 2 * (i - 1) < DISK_STEPS;
    let is_far = (far_px > 0.0) == is_left;
    let rise = if is_far { segment.far_rise } else { segment.near_rise };
    let v = if is_far { segment.v_far } else { segment.v_near };
    at_end(segment, shape, is_end, offset, rise, v)
}

/// A vertex `offset_px` from one end of the spine.
fn at_end(
    segment: &Segment,
    shape: &StrokeShape,
    is_end: bool,
    offset_px: Vec2,
    rise: f32,
    v: f32,
) -> StrokeVertex {
    let spine = &segment.spine;
    let (s, z) = if is_end { (spine.s1, spine.z1) } else { (spine.s0, spine.z0) };
    let outward = spine.p * segment.outside;
    StrokeVertex {
        position: ((s + offset_px) / (shape.viewport_px * 0.5)).extend(z + rise),
        u: of_end(segment.u, is_end),
        v,
        opacity: of_end(segment.opacity, is_end),
        foot: (s + outward * FOOT_PX).extend(z),
        over_px: -offset_px.dot(outward),
    }
}

fn of_end(values: Vec2, is_end: bool) -> f32 {
    if is_end { values.y } else { values.x }
}

/// Corner `corner` (0 to 3) of a fin: 2 and 3 are pushed out.
fn fin_vertex(edge: &ClipEdge, shape: &StrokeShape, corner: u32) -> StrokeVertex {
    let spine = project_spine(edge.c0, edge.c1, shape.viewport_px, shape.guard_band);
    if spine.p == Vec2::ZERO {
        return CULLED;
    }
    let [start, end] = [spine.t0, spine.t1].map(|t| lerp(edge.c0, edge.c1, t));
    let tip = |foot: Vec4, t: f32| foot + lerp(edge.n0, edge.n1, t) * fin_height(foot, shape);
    let (start_tip, end_tip) = (tip(start, spine.t0), tip(end, spine.t1));
    // A fin that reaches behind the near plane has no position on the screen.
    if [start_tip, end_tip].iter().any(|tip| tip.w - tip.z <= 0.0) {
        return CULLED;
    }
    let clip = [start, end, end_tip, start_tip][corner as usize % 4];
    let is_end = corner == 1 || corner == 2;
    let side = stroke_sign(screen_normal(start, edge.n0, shape.viewport_px).dot(spine.p));
    let width_px = width_at(start, shape).max(MIN_LENGTH_PX);
    let t = if is_end { spine.t1 } else { spine.t0 };
    StrokeVertex {
        position: clip.truncate() / clip.w,
        u: of_end(stroke_u(&spine, shape, side, width_px, edge.r), is_end),
        v: if corner >= 2 { 0.0 } else { 1.0 },
        opacity: opacity_at(edge.distance.x * (1.0 - t) + edge.distance.y * t, shape),
        ..CULLED
    }
}

/// The height of a fin, in units of the world.
fn fin_height(clip: Vec4, shape: &StrokeShape) -> f32 {
    if shape.is_world_width {
        return shape.width;
    }
    shape.width * clip.w / shape.px_per_unit
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::line::{Parameterization, Placement};

    const SHAPE: StrokeShape = StrokeShape {
        viewport_px: Vec2::new(200.0, 100.0),
        origin_px: Vec2::ZERO,
        fade: Vec2::ZERO,
        width: 4.0,
        px_per_unit: 50.0,
        brush_aspect: 8.0,
        mirror: 1.0,
        kind: LineKind::QuadAndCaps,
        placement: Placement::Automatic,
        parameterization: Parameterization::ObjectSpace,
        is_world_width: false,
        guard_band: crate::view::WHOLE_BAND,
    };

    fn edge() -> ClipEdge {
        ClipEdge {
            c0: Vec4::new(0.0, 0.0, 0.5, 1.0),
            c1: Vec4::new(0.4, 0.0, 0.25, 1.0),
            c2: Vec4::new(0.2, 0.4, 0.2, 1.0),
            c3: Vec4::new(0.2, -0.4, 0.2, 1.0),
            n0: Vec4::new(0.0, 1.0, 0.0, 0.0),
            n1: Vec4::new(0.0, 1.0, 0.0, 0.0),
            facing: Vec2::ONE,
            distance: Vec2::new(2.0, 4.0),
            r: 0.25,
        }
    }

    fn vertex(shape: &StrokeShape, bits: LineBits, corner: u32) -> StrokeVertex {
        stroke_vertex(&edge(), shape, bits, corner)
    }

    fn pixels(vertex: StrokeVertex) -> [f32; 2] {
        let px = vertex.position.truncate() * SHAPE.viewport_px * 0.5;
        px.to_array().map(|coordinate| (coordinate * 1e3).round() / 1e3)
    }

    #[test]
    fn a_contour_lies_where_its_front_face_is_not() {
        let rim = |shape: &StrokeShape, bits| pixels(vertex(shape, bits, 2));
        assert_eq!(rim(&SHAPE, LineBits::CONTOUR | LineBits::A_FACES), [40.0, -4.0]);
        assert_eq!(rim(&SHAPE, LineBits::CONTOUR), [40.0, 4.0]);
        let mirrored = StrokeShape { mirror: -1.0, ..SHAPE };
        assert_eq!(rim(&mirrored, LineBits::CONTOUR), [40.0, -4.0]);
        let inside = StrokeShape { placement: Placement::Inside, ..SHAPE };
        assert_eq!(rim(&inside, LineBits::CONTOUR), [40.0, -4.0]);
        let centered = StrokeShape { placement: Placement::Centered, ..SHAPE };
        assert_eq!(rim(&centered, LineBits::CONTOUR), [40.0, 2.0]);
    }

    #[test]
    fn a_crease_is_centered_and_its_brush_starts_at_r() {
        let corners = [0, 1, 2, 3].map(|corner| vertex(&SHAPE, LineBits::empty(), corner));
        assert_eq!(corners.map(pixels), [[0., -2.], [40., -2.], [40., 2.], [0., 2.]]);
        // The normal points up: the upper rim is the outside, v = 0.
        assert_eq!(corners.map(|corner| corner.v), [1.0, 1.0, 0.0, 0.0]);
        // 40 px along a brush of 4 x 8 = 32 px: 1.25 repeats.
        assert_eq!(corners.map(|corner| corner.u), [0.25, 1.5, 1.5, 0.25]);
        assert_eq!(corners.map(|corner| corner.position.z), [0.5, 0.25, 0.25, 0.5]);
    }

    #[test]
    fn the_screen_parameterization_is_the_place_from_the_origin() {
        let origin_px = Vec2::new(-8.0, 3.0);
        let parameterization = Parameterization::ScreenSpace;
        let shape = StrokeShape { origin_px, parameterization, ..SHAPE };
        let u = |edge: &ClipEdge| {
            [0, 1].map(|corner| stroke_vertex(edge, &shape, LineBits::empty(), corner).u)
        };
        assert_eq!(u(&edge()), [8.0 / 32.0, 48.0 / 32.0], "along x");
        // Mostly vertical, and the outside on the right: up counts backward.
        let c1 = Vec4::new(0.0, 0.8, 0.25, 1.0);
        let upright = ClipEdge { c1, n0: Vec4::X, n1: Vec4::X, ..edge() };
        assert_eq!(u(&upright), [3.0 / 32.0, -37.0 / 32.0], "along y");
    }

    /// Figure 9: outside, caps and quad share the brush by their lengths.
    #[test]
    fn the_brush_of_a_half_quad_is_stretched_over_its_caps() {
        let mut leaning = edge();
        // Both normals lean out by 45 degrees; p is up and the outside too.
        leaning.n0 = Vec4::new(-0.5, 1.0, 0.0, 0.0);
        leaning.n1 = Vec4::new(0.5, 1.0, 0.0, 0.0);
        let vertex = |corner| stroke_vertex(&leaning, &SHAPE, LineBits::CONTOUR, corner);
        let cap = (4.0_f32 * std::f32::consts::FRAC_1_SQRT_2).hypot(4.0 - 8.0_f32.sqrt());
        let whole = 40.0 + 2.0 * cap;
        let run = 40.0 / 32.0;
        let close = |got: f32, want: f32| assert!((got - want).abs() < 1e-4, "{got} {want}");
        close(vertex(0).u, 0.25);
        close(vertex(1).u, 0.25 + run);
        close(vertex(3).u, 0.25 + run * cap / whole);
        close(vertex(2).u, 0.25 + run * (cap + 40.0) / whole);
        // Caps: spine, rim, tip.
        close(vertex(4).u, 0.25);
        close(vertex(5).u, vertex(3).u);
        close(vertex(6).u, 0.25);
        close(vertex(9).u, 0.25 + run);
        assert_eq!([4, 5, 6].map(|corner| vertex(corner).v), [1.0, 0.0, 0.0]);
    }

    #[test]
    fn widths_of_the_world_shrink_and_strokes_fade_with_the_distance() {
        let shape =
            StrokeShape { is_world_width: true, width: 0.2, fade: Vec2::new(2.0, 6.0), ..SHAPE };
        let mut far = edge();
        far.c1 = Vec4::new(0.8, 0.0, 0.5, 2.0);
        let corner = |corner| stroke_vertex(&far, &shape, LineBits::empty(), corner);
        // 0.2 units at 50 px a unit: 10 px, and 5 px at twice the distance.
        assert_eq!(pixels(corner(3)), [0.0, 5.0]);
        assert_eq!(pixels(corner(2)), [40.0, 2.5]);
        assert_eq!([corner(0).opacity, corner(1).opacity], [1.0, 0.5]);
    }

    #[test]
    fn contours_know_how_far_they_lie_over_their_surface() {
        let shape = StrokeShape { placement: Placement::Centered, ..SHAPE };
        // Without A_FACES the outside is the side of p: up.
        let corners = [0, 3].map(|corner| vertex(&shape, LineBits::CONTOUR, corner));
        assert_eq!(corners.map(|corner| corner.over_px), [2.0, -2.0]);
        assert_eq!(corners.map(|corner| corner.foot), [Vec3::new(0.0, FOOT_PX, 0.5); 2]);
        let facing = LineBits::CONTOUR | LineBits::A_FACES;
        let corners = [1, 2].map(|corner| vertex(&shape, facing, corner));
        assert_eq!(corners.map(|corner| corner.over_px), [-2.0, 2.0]);
        assert_eq!(corners.map(|corner| corner.foot), [Vec3::new(40.0, -FOOT_PX, 0.25); 2]);
        let crease = [0, 3].map(|corner| vertex(&shape, LineBits::empty(), corner));
        assert_eq!(crease.map(|corner| corner.over_px), [0.0; 2]);
    }

    #[test]
    fn half_disks_round_the_ends() {
        let shape = StrokeShape { kind: LineKind::QuadAndDisks, ..SHAPE };
        let ring = |first: u32| {
            [first, first + 1, first + 1 + DISK_STEPS / 2, first + 1 + DISK_STEPS]
                .map(|corner| pixels(vertex(&shape, LineBits::empty(), corner)))
        };
        assert_eq!(ring(4), [[0., 0.], [0., 2.], [-2., 0.], [0., -2.]]);
        assert_eq!(ring(4 + DISK_VERTICES), [[40., 0.], [40., 2.], [42., 0.], [40., -2.]]);
    }

    #[test]
    fn fins_stand_on_the_edge_along_the_normals() {
        let shape = StrokeShape { kind: LineKind::Fin, ..SHAPE };
        let corners = [0, 1, 2, 3].map(|corner| vertex(&shape, LineBits::CONTOUR, corner));
        // 4 px are 0.08 units of the world; the normal's clip unit is 50 px high.
        assert_eq!(corners.map(pixels), [[0., 0.], [40., 0.], [40., 4.], [0., 4.]]);
    }

    #[test]
    fn rims_follow_a_face_that_rises_and_not_one_that_falls() {
        let depth = |edge: &ClipEdge, corner| {
            stroke_vertex(edge, &SHAPE, LineBits::empty(), corner).position.z
        };
        // The edge's depth beside the apex is 0.375; 20 px away the face lies
        // 0.2 nearer, so 2 px away 0.02.
        let mut rising = edge();
        rising.c2 = Vec4::new(0.2, 0.4, 0.575, 1.0);
        assert!((depth(&rising, 3) - 0.52).abs() < 1e-6, "{}", depth(&rising, 3));
        assert!((depth(&rising, 2) - 0.27).abs() < 1e-6, "{}", depth(&rising, 2));
        assert!((depth(&rising, 0) - 0.5).abs() < 1e-6, "the other side stays");
        // A face that ends after 1 px rises no further than its end.
        rising.c2 = Vec4::new(0.2, 0.02, 0.385, 1.0);
        assert!((depth(&rising, 3) - 0.51).abs() < 1e-5, "{}", depth(&rising, 3));
        // Seen edge on, it lifts nothing; half of it in between.
        rising.facing.x = 0.125;
        assert!((depth(&rising, 3) - 0.505).abs() < 1e-5, "{}", depth(&rising, 3));
        rising.facing.x = 0.01;
        assert!((depth(&rising, 3) - 0.5).abs() < 1e-6, "{}", depth(&rising, 3));
        rising.facing.x = 1.0;
        // Behind the eye, the part in front of the near plane counts: this face
        // goes up by 0.4 toward w = 0.5, and its depth with it.
        rising.c2 = Vec4::new(0.2, 0.8, 0.5, -1.0);
        assert!(depth(&rising, 3) > 0.51, "{}", depth(&rising, 3));
        rising.c2 = Vec4::new(0.2, 0.02, 0.385, 1.0);
        // A half quad of a contour lies off the surface, inside of one on it.
        let half = stroke_vertex(&rising, &SHAPE, LineBits::CONTOUR, 3);
        assert!((half.position.z - 0.5).abs() < 1e-6);
        let inside = StrokeShape { placement: Placement::Inside, ..SHAPE };
        let bits = LineBits::CONTOUR;
        let corner = stroke_vertex(&ClipEdge { c3: rising.c2, ..rising }, &inside, bits, 3);
        assert!(corner.position.y < 0.0 && (corner.position.z - 0.5).abs() < 1e-6, "below");
    }

    #[test]
    fn clipped_ends_have_no_caps_and_hidden_edges_no_vertices() {
        let mut through = edge();
        through.c0 = Vec4::new(0.0, 0.0, 0.5, -1.0);
        // At both ends the normal leans out, so that there are caps to be left out.
        (through.n0, through.n1) = (Vec4::new(0.5, 1.0, 0.0, 0.0), Vec4::new(-0.5, 1.0, 0.0, 0.0));
        for kind in [LineKind::QuadAndCaps, LineKind::QuadAndDisks] {
            let shape = StrokeShape { kind, ..SHAPE };
            let per_end = (kind.vertex_count() - 4) / 2;
            for corner in 4..4 + 2 * per_end {
                let vertex = stroke_vertex(&through, &shape, LineBits::empty(), corner);
                assert_eq!(vertex.position == BEHIND, corner < 4 + per_end, "{corner}");
            }
        }
        let point = ClipEdge { c1: edge().c0, ..edge() };
        for kind in [LineKind::Thin, LineKind::QuadAndCaps, LineKind::QuadAndDisks, LineKind::Fin] {
            let shape = StrokeShape { kind, ..SHAPE };
            for corner in 0..kind.vertex_count() {
                let vertex = stroke_vertex(&point, &shape, LineBits::CONTOUR, corner);
                assert_eq!(vertex.position, BEHIND);
            }
        }
    }

    #[test]
    fn indices_use_every_vertex() {
        for kind in [LineKind::Thin, LineKind::Quad, LineKind::QuadAndCaps, LineKind::QuadAndDisks]
        {
            let indices = kind.indices();
            assert!((0..kind.vertex_count()).all(|vertex| indices.contains(&vertex)), "{kind:?}");
            assert!(indices.iter().all(|&vertex| vertex < kind.vertex_count()));
        }
    }
}
