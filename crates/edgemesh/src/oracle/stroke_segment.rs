//! An edge as a stroke on the screen: the values that its vertices share.
//!
//! The outside of a contour is the side of the spine without its front face, which a facing bit
//! tells exactly. The paper uses the projected vertex normal (Equation 3), which errs on rough
//! meshes; here it serves only strokes without a front face.
//!
//! A stroke lies over the faces beside its edge, which can rise toward the eye under it. So its
//! sides take the depth of those faces (`rise_toward_eye`) where that is nearer than the depth of
//! the edge, and the faces do not hide them, however wide they are. Outside of a contour there is
//! no face. Over the surface that a contour bounds, which rises further behind those faces, strokes
//! are visible where their edge is (`shaders/stroke_over_surface.wgsl`).
//!
//! The brush has one of the two parameterizations of the paper (section 4). In object space, u
//! begins at the random scalar of the edge and grows with the length on the screen; in screen
//! space, it is the position on the screen, right or up, from the origin of the object. In both
//! cases u is in lengths of the brush at this width, which keeps its aspect, and is reversed with
//! the outside, so that strokes run around a silhouette in one direction. Across, v runs from 0 on
//! the outside to 1 on the inside.
//!
//! A cap of a full quad repeats the column at its end. Along a half quad, u maps directly to the
//! inside and is stretched over caps and quad on the outside:
//!
//! ```text
//!   u0 . - - a - - . - - - b - - - . - - c - - . u1       (Figure 9)
//!        ` .       |               |       . `
//!            ` . u0|_______________|u1 . `
//! ```
//!
//! WGSL twin: `shaders/common/stroke_segment.wgsl`.

use glam::{Vec2, Vec4};

use super::spine::{MIN_LENGTH_PX, Spine, lerp, project_spine, screen_normal};
use super::stroke_cap::{cap_fills_gap, stroke_cap};
use super::stroke_quad::{quad_offsets, stroke_sign};
use crate::line::{LineKind, Parameterization, Placement};
use crate::view::{LineBits, to_pixels};

/// The cosine between normal and line of sight up to which a narrow face is seen edge on and lifts
/// no stroke: 87 degrees.
pub const EDGE_ON_FACING: f32 = 0.05;

/// The cosine between normal and line of sight from which a face lifts the strokes along it fully:
/// 78 degrees.
pub const LIFTED_FACING: f32 = 0.2;

/// An edge in clip space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClipEdge {
    /// Start.
    pub c0: Vec4,
    /// End.
    pub c1: Vec4,
    /// Third vertex of face A.
    pub c2: Vec4,
    /// Third vertex of face B; `c0` without a face B.
    pub c3: Vec4,
    /// Vertex normal at the start, in clip space, as a direction.
    pub n0: Vec4,
    /// Vertex normal at the end, in clip space, as a direction.
    pub n1: Vec4,
    /// For faces A and B, the absolute cosine of the angle between normal and line of sight.
    pub facing: Vec2,
    /// Distances of start and end from the eye, along the direction of sight.
    pub distance: Vec2,
    /// The random scalar of the edge, 0 to 1.
    pub r: f32,
}

/// The parameters that all strokes of a draw share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StrokeShape {
    /// Size of the picture, in pixels.
    pub viewport_px: Vec2,
    /// The origin of the object on the screen, in pixels from the middle of the picture.
    pub origin_px: Vec2,
    /// The distances at which strokes begin to fade and vanish; equal for strokes that never fade.
    pub fade: Vec2,
    /// Width of a stroke, in pixels or units of the world.
    pub width: f32,
    /// Pixels per unit of the world at w = 1.
    pub px_per_unit: f32,
    /// Length of the brush texture divided by its height.
    pub brush_aspect: f32,
    /// -1 if the transform of the object mirrors, otherwise 1.
    pub mirror: f32,
    /// The kind of line.
    pub kind: LineKind,
    /// The placement on the spine.
    pub placement: Placement,
    /// The parameterization of the brush.
    pub parameterization: Parameterization,
    /// Whether the width is in units of the world instead of pixels.
    pub is_world_width: bool,
    /// The guard band: left, right, bottom and top, at w = 1.
    pub guard_band: Vec4,
}

/// A stroke on the screen. Its near side has the paper's corners 0 and 1, its far side corners 2
/// and 3.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Segment {
    /// The projected edge.
    pub spine: Spine,
    /// Whether anything is drawn.
    pub is_drawn: bool,
    /// Projected vertex normal at the start, of unit length or zero.
    pub m0: Vec2,
    /// Projected vertex normal at the end, of unit length or zero.
    pub m1: Vec2,
    /// The outside of a contour: +1 for the side of p, -1 for the other side; 0 for other lines.
    pub outside: f32,
    /// Offset of the near side along p, at start and end, in pixels.
    pub near_px: Vec2,
    /// Offset of the far side along p, at start and end, in pixels.
    pub far_px: Vec2,
    /// Depth of the near side above that of the spine, toward the eye.
    pub near_rise: f32,
    /// Depth of the far side above that of the spine, toward the eye.
    pub far_rise: f32,
    /// The side of the caps at start and end: +1 is the side of p.
    pub cap_side: Vec2,
    /// u of the spine and the near side, at start and end.
    pub u: Vec2,
    /// u of the far side, at start and end.
    pub u_far: Vec2,
    /// v of the near side.
    pub v_near: f32,
    /// v of the far side.
    pub v_far: f32,
    /// v of the spine.
    pub v_spine: f32,
    /// Opacity after fading, 0 to 1, at start and end.
    pub opacity: Vec2,
}

/// Computes the stroke along `edge`.
#[must_use]
pub fn stroke_segment(edge: &ClipEdge, shape: &StrokeShape, bits: LineBits) -> Segment {
    let spine = project_spine(edge.c0, edge.c1, shape.viewport_px, shape.guard_band);
    let mut segment = Segment { spine, is_drawn: spine.p != Vec2::ZERO, ..Segment::default() };
    if !segment.is_drawn {
        return segment;
    }
    let [a, b] = [spine.t0, spine.t1].map(|t| lerp(edge.c0, edge.c1, t));
    segment.m0 = screen_normal(a, edge.n0, shape.viewport_px);
    segment.m1 = screen_normal(b, edge.n1, shape.viewport_px);
    let side = outside_of(&segment, shape, bits);
    segment.outside = if bits.contains(LineBits::CONTOUR) { side } else { 0.0 };
    let placement = placement_of(shape, bits);
    let width_px = Vec2::new(width_at(a, shape), width_at(b, shape));
    let [start_px, end_px] =
        width_px.to_array().map(|width_px| quad_offsets(placement, side, width_px));
    segment.near_px = Vec2::new(start_px.x, end_px.x);
    segment.far_px = Vec2::new(start_px.y, end_px.y);
    let distance_at = |t: f32| edge.distance.x * (1.0 - t) + edge.distance.y * t;
    segment.opacity = Vec2::new(spine.t0, spine.t1).map(|t| opacity_at(distance_at(t), shape));
    segment.u = stroke_u(&spine, shape, side, 0.5 * (width_px.x + width_px.y), edge.r);
    segment.u_far = segment.u;
    if placement == Placement::Centered {
        segment.v_far = 0.5 - 0.5 * side;
        segment.v_near = 1.0 - segment.v_far;
        segment.v_spine = 0.5;
        let side_of = |m: Vec2| stroke_sign(m.dot(spine.p));
        segment.cap_side = Vec2::new(side_of(segment.m0), side_of(segment.m1));
        segment.near_rise = quad_rise(edge, &spine, shape.viewport_px, segment.near_px);
    } else {
        segment.v_far = if placement == Placement::Inside { 1.0 } else { 0.0 };
        segment.v_near = 1.0 - segment.v_far;
        segment.v_spine = segment.v_near;
        segment.cap_side = Vec2::splat(stroke_sign(end_px.y));
        if shape.kind == LineKind::QuadAndCaps {
            segment.u_far = stretched_u(&segment);
        }
    }
    // No face lies outside of a contour.
    if placement != Placement::Outside || !bits.contains(LineBits::CONTOUR) {
        segment.far_rise = quad_rise(edge, &spine, shape.viewport_px, segment.far_px);
    }
    segment
}

/// +1 if the outside is the side of p, otherwise -1.
fn outside_of(segment: &Segment, shape: &StrokeShape, bits: LineBits) -> f32 {
    if bits.contains(LineBits::CONTOUR) {
        // p points left of the edge, where face A lies if it looks at the eye.
        let side = if bits.contains(LineBits::A_FACES) { -1.0 } else { 1.0 };
        return side * shape.mirror;
    }
    stroke_sign(segment.m0.dot(segment.spine.p))
}

fn placement_of(shape: &StrokeShape, bits: LineBits) -> Placement {
    match shape.placement {
        Placement::Automatic if bits.contains(LineBits::CONTOUR) => Placement::Outside,
        Placement::Automatic => Placement::Centered,
        chosen => chosen,
    }
}

/// The width in pixels at a point of the edge.
pub(super) fn width_at(clip: Vec4, shape: &StrokeShape) -> f32 {
    if !shape.is_world_width {
        return shape.width;
    }
    // Close to the eye the width is unbounded; more than the picture is never seen.
    (shape.width * shape.px_per_unit / clip.w).min(shape.viewport_px.y)
}

/// The opacity of a stroke at a distance from the eye, after fading.
pub(super) fn opacity_at(distance: f32, shape: &StrokeShape) -> f32 {
    let [start, end] = shape.fade.to_array();
    if start >= end {
        return 1.0;
    }
    ((end - distance) / (end - start)).clamp(0.0, 1.0)
}

/// u at start and end (section 4). The paper's w is the line width times the sign of the outside.
/// To keep the aspect of the brush, lengths are divided by the width, not multiplied.
pub(super) fn stroke_u(
    spine: &Spine,
    shape: &StrokeShape,
    side: f32,
    width_px: f32,
    r: f32,
) -> Vec2 {
    let along = spine.s1 - spine.s0;
    let w = side / (width_px * shape.brush_aspect);
    match shape.parameterization {
        Parameterization::ObjectSpace => Vec2::new(r, r + w * along.length()),
        // A mostly vertical edge.
        Parameterization::ScreenSpace if along.y.abs() > along.x.abs() => {
            w * (Vec2::new(spine.s0.y, spine.s1.y) - shape.origin_px.y)
        }
        Parameterization::ScreenSpace => {
            w * (Vec2::new(spine.s0.x, spine.s1.x) - shape.origin_px.x)
        }
    }
}

/// u at the far corners of a half quad, whose brush is stretched over its caps (Figure 9).
fn stretched_u(segment: &Segment) -> Vec2 {
    let spine = &segment.spine;
    let cap = |m, far_px, is_cut, forward| {
        if is_cut { 0.0 } else { cap_length(spine.p, m, far_px, forward) }
    };
    let a = cap(segment.m0, segment.far_px.x, spine.t0 > 0.0, -1.0);
    let b = (spine.s1 - spine.s0).length();
    let c = cap(segment.m1, segment.far_px.y, spine.t1 < 1.0, 1.0);
    let run = segment.u.y - segment.u.x;
    segment.u.x + run * Vec2::new(a, a + b) / (a + b + c)
}

/// The length from the rim of the quad to the tip of its cap; 0 without a cap.
fn cap_length(p: Vec2, m: Vec2, far_px: f32, forward: f32) -> f32 {
    let side = stroke_sign(far_px);
    if !cap_fills_gap(p, m, side, forward) {
        return 0.0;
    }
    let tip = stroke_cap(Vec2::ZERO, p, m, side, far_px.abs(), 2);
    (tip - p * far_px).length()
}

/// The rise of a side of a stroke toward the eye, in depth: that of the higher of the two faces.
/// `side_px` is its offset along p at start and end.
fn quad_rise(edge: &ClipEdge, spine: &Spine, viewport_px: Vec2, side_px: Vec2) -> f32 {
    let side = stroke_sign(side_px.x + side_px.y);
    let reach_px = side_px.abs().max_element();
    let middle = lerp(edge.c0, edge.c1, (spine.t0 + spine.t1) * 0.5);
    let rise = |apex: Vec4, facing: f32| {
        let apex = in_front(middle, apex);
        rise_toward_eye(spine, apex, facing, viewport_px, side, reach_px)
    };
    rise(edge.c2, edge.facing.x).max(rise(edge.c3, edge.facing.y))
}

/// A point of a face in front of the near plane: its third vertex `apex`, or, if that lies behind
/// the plane, the point halfway from the middle of the edge to the plane.
fn in_front(middle: Vec4, apex: Vec4) -> Vec4 {
    let middle_distance = middle.w - middle.z;
    let apex_distance = apex.w - apex.z;
    if apex_distance > 0.0 {
        return apex;
    }
    lerp(middle, apex, 0.5 * middle_distance / (middle_distance - apex_distance))
}

/// The rise of a face toward the eye above the edge, in depth, `reach_px` away from the edge on the
/// side `side` (+1 is the side of p).
///
/// `apex` is a point of the face in front of the near plane. Depth is linear on the screen, so the
/// plane of the face gives it exactly; past `apex` it stays constant. Zero if the face falls away
/// or lies on the other side; reduced if it is a narrow wall seen edge on ([`ClipEdge::facing`]).
#[must_use]
fn rise_toward_eye(
    spine: &Spine,
    apex: Vec4,
    facing: f32,
    viewport_px: Vec2,
    side: f32,
    reach_px: f32,
) -> f32 {
    if apex.w <= 0.0 {
        return 0.0;
    }
    let along = spine.s1 - spine.s0;
    let to_apex = to_pixels(apex, viewport_px) - spine.s0;
    let distance_px = to_apex.dot(spine.p) * side;
    if distance_px < MIN_LENGTH_PX {
        return 0.0;
    }
    let t = to_apex.dot(along) / along.dot(along);
    let edge_depth = spine.z0 + (spine.z1 - spine.z0) * t;
    let rise = apex.z / apex.w - edge_depth;
    let share = lift_share(facing, distance_px / reach_px);
    (rise * (reach_px / distance_px).min(1.0) * share).max(0.0)
}

/// The fraction of the rise of a face that counts: 1 if the face is wide or turned to the eye. A
/// face seen edge on and as narrow as the stroke is a wall: it would lift the rim to its far end,
/// and a hidden edge through the surface that hides it.
fn lift_share(facing: f32, reaches_wide: f32) -> f32 {
    let seen = (facing - EDGE_ON_FACING) / (LIFTED_FACING - EDGE_ON_FACING);
    let wide = 0.5 * reaches_wide - 1.0;
    seen.max(wide).clamp(0.0, 1.0)
}
