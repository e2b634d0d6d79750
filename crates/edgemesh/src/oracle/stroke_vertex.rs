//! One vertex of a stroke: quad, caps, and where the brush lies on them.
//!
//! An edge is drawn as 12 vertices: two triangles of the quad, the start cap,
//! the finish cap. Contours take the half quad on the outside, everything else
//! the full quad.
//!
//! The outside of a contour is the side of the spine where its front face is
//! not, which one facing bit tells for sure. The paper asks the projected vertex
//! normal instead (Equation 3), which errs on rough meshes; it is asked here
//! only where there is no front face to ask, for the caps and the texture of
//! full quads.
//!
//! A full quad lies over the faces beside its edge, which can rise toward the
//! eye under it. So its rims take the depth of those faces ([`rise_toward_eye`])
//! where that is nearer than the edge's own, and are not swallowed however wide
//! they are. A half quad lies off the surface and keeps the edge's depth.
//!
//! The brush is laid on in object space (paper, section 4): u begins at the
//! edge's random scalar and grows with the length on the screen, in units of
//! the brush's own length at this width, so that its aspect is kept; v runs
//! from 0 on the outside to 1 on the inside. A cap repeats the column at its end.
//!
//! WGSL twin: `shaders/common/stroke_vertex.wgsl`.

use glam::{Vec2, Vec4};

use super::feature::LineBits;
use super::spine::{MIN_LENGTH_PX, Spine, lerp, project_spine, screen_normal, to_pixels};
use super::stroke_cap::{cap_corner, stroke_cap};
use super::stroke_quad::{half_quad, sign, stroke_quad};

/// Vertices an edge: 6 of the quad, 3 of each cap.
pub const VERTICES_PER_EDGE: u32 = 12;

/// The quad's corners as two triangles.
const QUAD_CORNERS: [u32; 6] = [0, 1, 2, 0, 2, 3];

/// Where vertices go that must not be seen: behind the near plane, as in the
/// paper's section 3.2.
pub const BEHIND: Vec4 = Vec4::new(0.0, 0.0, -1.0, 1.0);

/// A narrow face that looks at the eye by no more than this cosine, 87 degrees
/// off, is seen edge on and lifts no stroke.
pub const EDGE_ON_FACING: f32 = 0.05;

/// A face that looks at the eye by this cosine or more, 78 degrees off, lifts the
/// strokes along it in full.
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
    /// Third vertex of face B; equal to `c0` where there is none.
    pub c3: Vec4,
    /// How squarely faces A and B look at the eye, or away from it: the cosine
    /// of the angle between normal and line of sight, without its sign.
    pub facing: Vec2,
    /// Vertex normal at the start, taken to clip space as a direction.
    pub n0: Vec4,
    /// Vertex normal at the end, likewise.
    pub n1: Vec4,
    /// The random scalar.
    pub r: f32,
}

/// What all strokes of a draw share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StrokeShape {
    /// Size of the picture.
    pub viewport_px: Vec2,
    /// Width of a stroke.
    pub width_px: f32,
    /// Length of the brush texture over its height.
    pub brush_aspect: f32,
}

/// A vertex for the rasterizer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StrokeVertex {
    /// Clip-space position; w is 1, so that everything is linear on the screen.
    pub position: Vec4,
    /// Texture coordinate of the brush.
    pub uv: Vec2,
}

/// Vertex `index` (0 to 11) of the stroke along `edge`.
#[must_use]
pub fn stroke_vertex(
    edge: &ClipEdge,
    shape: &StrokeShape,
    bits: LineBits,
    index: u32,
) -> StrokeVertex {
    let spine = project_spine(edge.c0, edge.c1, shape.viewport_px);
    let hidden = StrokeVertex { position: BEHIND, uv: Vec2::ZERO };
    if spine.p == Vec2::ZERO {
        return hidden;
    }
    let m0 = screen_normal(lerp(edge.c0, edge.c1, spine.t0), edge.n0, shape.viewport_px);
    let m1 = screen_normal(lerp(edge.c0, edge.c1, spine.t1), edge.n1, shape.viewport_px);
    let is_half = bits.contains(LineBits::CONTOUR);
    // p lies left of the edge, and so does face A where it looks at the eye.
    let contour_side = if bits.contains(LineBits::A_FACES) { -1.0 } else { 1.0 };
    let side = |m: Vec2| if is_half { contour_side } else { sign(m.dot(spine.p)) };
    let outside = side(m0);
    let length_px = (spine.s1 - spine.s0).length();
    let u0 = edge.r;
    let u1 = edge.r + outside * length_px / (shape.width_px * shape.brush_aspect);

    let reach_px = if is_half { shape.width_px } else { shape.width_px * 0.5 };
    let rise = |side: f32| {
        if is_half { 0.0 } else { quad_rise(edge, &spine, shape.viewport_px, side, reach_px) }
    };

    if index < 6 {
        let i = QUAD_CORNERS[index as usize];
        let s = if is_half {
            half_quad(&spine, reach_px, outside, i)
        } else {
            stroke_quad(&spine, reach_px, i)
        };
        let is_end = i == 1 || i == 2;
        let rim = if is_half { 1.0 } else { outside * 0.5 + 0.5 };
        let v = if i >= 2 { 1.0 - rim } else { rim };
        let uv = Vec2::new(if is_end { u1 } else { u0 }, v);
        let z = if is_end { spine.z1 } else { spine.z0 };
        return on_screen(s, z + rise(if i >= 2 { 1.0 } else { -1.0 }), uv, shape);
    }
    let is_start = index < 9;
    // A clipped end is no vertex of the mesh, and nobody meets it there.
    if (is_start && spine.t0 > 0.0) || (!is_start && spine.t1 < 1.0) {
        return hidden;
    }
    let m = if is_start { m0 } else { m1 };
    let j = cap_corner(side(m), index % 3);
    let s = if is_start { spine.s0 } else { spine.s1 };
    let z = if is_start { spine.z0 } else { spine.z1 };
    let v_at_spine = if is_half { 1.0 } else { 0.5 };
    let uv = Vec2::new(if is_start { u0 } else { u1 }, if j == 0 { v_at_spine } else { 0.0 });
    let position_px = stroke_cap(s, spine.p, m, side(m), reach_px, j);
    on_screen(position_px, if j == 0 { z } else { z + rise(side(m)) }, uv, shape)
}

/// How much nearer than the edge, in depth, the rim of a full quad must lie on
/// one side: as much as the higher of the two faces.
fn quad_rise(edge: &ClipEdge, spine: &Spine, viewport_px: Vec2, side: f32, reach_px: f32) -> f32 {
    let middle = lerp(edge.c0, edge.c1, (spine.t0 + spine.t1) * 0.5);
    let rise = |apex: Vec4, facing: f32| {
        let apex = in_front(middle, apex);
        rise_toward_eye(spine, apex, facing, viewport_px, side, reach_px)
    };
    rise(edge.c2, edge.facing.x).max(rise(edge.c3, edge.facing.y))
}

/// A point of the face for its third vertex: the vertex itself, or, where it
/// lies behind the near plane, one halfway from the edge's middle to that plane.
fn in_front(middle: Vec4, apex: Vec4) -> Vec4 {
    let middle_distance = middle.w - middle.z;
    let apex_distance = apex.w - apex.z;
    if apex_distance > 0.0 {
        return apex;
    }
    lerp(middle, apex, 0.5 * middle_distance / (middle_distance - apex_distance))
}

/// How much nearer than the edge the face with the point `apex` lies,
/// `reach_px` away from the edge on the side `side` (+1 is the side of p).
///
/// `apex` is a point of the face in front of the near plane. Depth is linear on
/// the screen, so the face's plane gives it exactly; past `apex` it stays what
/// it was there. Zero where the face falls away or lies on the other side, less
/// where it is a narrow wall seen edge on (`facing`, see [`ClipEdge::facing`]).
#[must_use]
pub fn rise_toward_eye(
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

/// How much of a face's rise counts: all of it where the face is seen well or is
/// wide. A face that is both edge on and as narrow as the stroke is a wall: it
/// would lift the rim up to its far end, and a hidden edge through what hides it.
fn lift_share(facing: f32, reaches_wide: f32) -> f32 {
    let seen = (facing - EDGE_ON_FACING) / (LIFTED_FACING - EDGE_ON_FACING);
    let wide = 0.5 * reaches_wide - 1.0;
    seen.max(wide).clamp(0.0, 1.0)
}

fn on_screen(position_px: Vec2, depth: f32, uv: Vec2, shape: &StrokeShape) -> StrokeVertex {
    let xy = position_px / (shape.viewport_px * 0.5);
    StrokeVertex { position: Vec4::new(xy.x, xy.y, depth, 1.0), uv }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHAPE: StrokeShape =
        StrokeShape { viewport_px: Vec2::new(200.0, 100.0), width_px: 4.0, brush_aspect: 8.0 };

    fn edge() -> ClipEdge {
        ClipEdge {
            c0: Vec4::new(0.0, 0.0, 0.5, 1.0),
            c1: Vec4::new(0.4, 0.0, 0.25, 1.0),
            c2: Vec4::new(0.2, 0.4, 0.2, 1.0),
            c3: Vec4::new(0.2, -0.4, 0.2, 1.0),
            facing: Vec2::ONE,
            n0: Vec4::new(0.0, 1.0, 0.0, 0.0),
            n1: Vec4::new(0.0, 1.0, 0.0, 0.0),
            r: 0.25,
        }
    }

    fn pixels(vertex: StrokeVertex) -> [f32; 2] {
        (vertex.position.truncate().truncate() * SHAPE.viewport_px * 0.5).to_array()
    }

    #[test]
    fn a_contour_lies_where_its_front_face_is_not() {
        let rim = |bits| pixels(stroke_vertex(&edge(), &SHAPE, bits, 2));
        assert_eq!(rim(LineBits::CONTOUR | LineBits::A_FACES), [40.0, -4.0]);
        assert_eq!(rim(LineBits::CONTOUR), [40.0, 4.0]);
    }

    #[test]
    fn a_crease_is_centred_and_its_brush_starts_at_r() {
        let corners = [0, 1, 2, 5].map(|i| stroke_vertex(&edge(), &SHAPE, LineBits::empty(), i));
        assert_eq!(corners.map(pixels), [[0., -2.], [40., -2.], [40., 2.], [0., 2.]]);
        // The normal points up: the upper rim is the outside, v = 0.
        assert_eq!(corners.map(|corner| corner.uv.y), [1.0, 1.0, 0.0, 0.0]);
        // 40 px along a brush of 4 x 8 = 32 px: 1.25 repeats.
        assert_eq!(corners.map(|corner| corner.uv.x), [0.25, 1.5, 1.5, 0.25]);
        assert_eq!(corners.map(|corner| corner.position.z), [0.5, 0.25, 0.25, 0.5]);
    }

    #[test]
    fn rims_follow_a_face_that_rises_and_not_one_that_falls() {
        let depth =
            |edge: &ClipEdge, i| stroke_vertex(edge, &SHAPE, LineBits::empty(), i).position.z;
        // The edge's depth beside the apex is 0.375; 20 px away the face lies
        // 0.2 nearer, so 2 px away 0.02.
        let mut rising = edge();
        rising.c2 = Vec4::new(0.2, 0.4, 0.575, 1.0);
        assert!((depth(&rising, 5) - 0.52).abs() < 1e-6, "{}", depth(&rising, 5));
        assert!((depth(&rising, 2) - 0.27).abs() < 1e-6, "{}", depth(&rising, 2));
        assert!((depth(&rising, 0) - 0.5).abs() < 1e-6, "the other side stays");
        // A face that ends after 1 px rises no further than its end.
        rising.c2 = Vec4::new(0.2, 0.02, 0.385, 1.0);
        assert!((depth(&rising, 5) - 0.51).abs() < 1e-5, "{}", depth(&rising, 5));
        // Seen edge on, it lifts nothing; half of it in between.
        rising.facing.x = 0.125;
        assert!((depth(&rising, 5) - 0.505).abs() < 1e-5, "{}", depth(&rising, 5));
        rising.facing.x = 0.01;
        assert!((depth(&rising, 5) - 0.5).abs() < 1e-6, "{}", depth(&rising, 5));
        rising.facing.x = 1.0;
        // Behind the eye, the part in front of the near plane counts: this face
        // goes up by 0.4 toward w = 0.5, and its depth with it.
        rising.c2 = Vec4::new(0.2, 0.8, 0.5, -1.0);
        assert!(depth(&rising, 5) > 0.51, "{}", depth(&rising, 5));
        rising.c2 = Vec4::new(0.2, 0.02, 0.385, 1.0);
        // A half quad lies off the surface.
        let half = stroke_vertex(&rising, &SHAPE, LineBits::CONTOUR, 5);
        assert!((half.position.z - 0.5).abs() < 1e-6);
    }

    #[test]
    fn clipped_ends_have_no_caps_and_hidden_edges_no_vertices() {
        let mut through = edge();
        through.c0 = Vec4::new(0.0, 0.0, 0.5, -1.0);
        for index in 6..9 {
            let vertex = stroke_vertex(&through, &SHAPE, LineBits::empty(), index);
            assert_eq!(vertex.position, BEHIND);
        }
        assert_ne!(stroke_vertex(&through, &SHAPE, LineBits::empty(), 9).position, BEHIND);
        let mut point = edge();
        point.c1 = point.c0;
        for index in 0..VERTICES_PER_EDGE {
            let vertex = stroke_vertex(&point, &SHAPE, LineBits::CONTOUR, index);
            assert_eq!(vertex.position, BEHIND);
        }
    }
}
