// Draws ribbons as coverage.
//
// Each is a box around its center line. The coverage of a fragment follows from its distance
// to that line, so that sides, joins and ends are smooth without samples. Where the segments
// of a draw overlap, the larger coverage counts (the blend is a maximum), so that no pixel is
// covered twice, at any width and turn.
//
//        +-----------------------------+
//        |   .---------------------.   |  across
//        |  (   a ------------> b   )  |    ^
//        |   '---------------------'   |    '-> along
//        +-----------------------------+
//
// The visibility of a stroke was tested along its line. In addition, a surface well in front
// of the line hides a fragment, so that a wide stroke ends where another body begins.
#import <common/frame.wgsl>
#import <common/fill_depth.wgsl>
#import <common/glass_depth.wgsl>
#import <common/stroke_style.wgsl>
#import <common/stroke_graph.wgsl>

// Rust twin: MITRE_LIMIT in crates/strokes/src/style/link_style.rs.
const MITRE_LIMIT: f32 = 4.0;

// Both segments of a join cover the pixels on the line that halves its angle.
const SHARED_PX: f32 = 0.5;

override IS_TEXTURED: bool = false;

// Whether surfaces of the scene are transparent.
override HAS_GLASS: bool = false;

@group(1) @binding(1) var brush: texture_2d<f32>;
@group(1) @binding(2) var brush_sampler: sampler;
@group(3) @binding(0) var<storage, read> ribbons: array<Ribbon>;

struct RibbonVarying {
    @builtin(position) position: vec4f,
    // From the start of the segment, in pixels; across is positive on the left.
    @location(0) along_across: vec2f,
    @location(1) @interpolate(flat) length_px: f32,
    @location(2) @interpolate(flat) half_width_px: vec2f,
    @location(3) @interpolate(flat) u_and_opacity: vec4f,
    @location(4) @interpolate(flat) joins: vec4f,
    @location(5) @interpolate(flat) ends: u32,
    @location(6) @interpolate(flat) dash_and_ink: vec3f,
    // Depth of the line at both ends, and near_px of the ribbon.
    @location(7) @interpolate(flat) depth_and_near: vec3f,
}

@vertex
fn ribbon_vertex(@builtin(vertex_index) vertex: u32) -> RibbonVarying {
    let ribbon = ribbons[vertex / 4u];
    var out = RibbonVarying();
    out.ends = ribbon.ends;
    if ribbon.ends == NOT_DRAWN {
        return out;
    }
    let along = ribbon.b - ribbon.a;
    out.length_px = length(along);
    let direction = along / out.length_px;
    out.half_width_px = ribbon.half_width;
    out.depth_and_near = vec3f(ribbon.depth, ribbon.near_px);
    out.dash_and_ink = vec3f(ribbon.dash, ribbon.ink);
    out.u_and_opacity = vec4f(ribbon.u, unpack2x16unorm(ribbon.opacity));
    out.joins = vec4f(ribbon.join0, ribbon.join1);
    let side = (ribbon.ends >> 8u) & 3u;
    let corner = vertex % 4u;
    let at_end = corner == 1u || corner == 2u;
    let on_left = corner >= 2u;
    let half_width = max(out.half_width_px.x, out.half_width_px.y);
    // One-sided strokes have their whole width on one side.
    let reach = half_width * select(2.0, 1.0, side == 0u);
    let kind = select(ribbon.ends & 15u, (ribbon.ends >> 4u) & 15u, at_end);
    let join = select(out.joins.xy, out.joins.zw, at_end);
    let beyond = 1.0 + overhang(kind, reach, join);
    let is_empty = side != 0u && on_left == (side == 1u);
    let across = select(reach + 1.0, 1.0, is_empty) * select(-1.0, 1.0, on_left);
    out.along_across = vec2f(select(-beyond, out.length_px + beyond, at_end), across);
    let place = ribbon.a + out.along_across.x * direction
        + across * vec2f(-direction.y, direction.x);
    out.position = vec4f(place / (0.5 * frame.viewport_px), 0.5, 1.0);
    return out;
}

// How far a segment extends beyond its end, in pixels.
fn overhang(kind: u32, reach: f32, join: vec2f) -> f32 {
    if kind == ENDS_FLAT {
        return 0.0;
    }
    if kind == ENDS_POINTED {
        return 2.0 * reach;
    }
    if kind == ENDS_ROUND || kind == ENDS_AROUND || kind == JOINS_LOOSELY {
        return reach;
    }
    // Up to the line that halves the angle, on its outer side.
    let outer = (reach + 1.0) * abs(join.y) / max(join.x, 1e-3);
    return min(outer, select(reach, MITRE_LIMIT * reach, kind == JOINS_MITRED));
}

@fragment
fn ribbon_fragment(in: RibbonVarying) -> @location(0) vec4f {
    let along = in.along_across.x;
    let t = clamp(along / in.length_px, 0.0, 1.0);
    let at_end = along > 0.5 * in.length_px;
    // Distance beyond the nearer end; negative on the segment.
    let beyond = select(-along, along - in.length_px, at_end);
    let kind = select(in.ends & 15u, (in.ends >> 4u) & 15u, at_end);
    let side = (in.ends >> 8u) & 3u;
    let half_width = mix(in.half_width_px.x, in.half_width_px.y, t);
    let reach = half_width * select(2.0, 1.0, side == 0u);
    // Positive on the side of one-sided strokes.
    let across = in.along_across.y * select(1.0, -1.0, side == 1u);

    var off = abs(across);
    var coverage = 1.0;
    var widest = reach;
    // Where a one-sided stroke begins, as a distance from its line: not 0 in a point or disk.
    var nearest_off = 0.0;
    if beyond > 0.0 {
        if kind == ENDS_FLAT {
            coverage = 0.0;
        } else if kind == ENDS_POINTED {
            let gone = 0.5 * beyond * select(0.5, 1.0, side == 0u);
            widest = max(reach - gone, 0.0);
            nearest_off = select(gone, 0.0, side == 0u);
        } else if kind == ENDS_ROUND && side != 0u {
            // A half disk over the width, beside the line.
            let chord = sqrt(max(half_width * half_width - beyond * beyond, 0.0));
            nearest_off = half_width - chord;
            widest = half_width + chord;
            coverage = clamp(half_width - beyond + 0.5, 0.0, 1.0);
        } else if kind != JOINS_MITRED || is_past_limit(in.joins, at_end) {
            off = length(vec2f(beyond, across));
        }
    }
    if kind == ENDS_FLAT {
        coverage = clamp(0.5 - beyond, 0.0, 1.0);
    }
    // The part of the pixel between the two sides.
    if side == 0u {
        coverage *= clamp(0.5 + widest - off, 0.0, 1.0) - clamp(0.5 - widest - off, 0.0, 1.0);
    } else {
        let outer = select(across, off, beyond > 0.0);
        let outermost = min(across + 0.5, across + widest - outer);
        coverage *= clamp(outermost - max(across - 0.5, nearest_off), 0.0, 1.0);
    }
    let join = select(in.joins.xy, in.joins.zw, at_end);
    if kind == JOINS_LOOSELY && beyond > 0.0 && side != 0u {
        // A one-sided stroke goes around the outside of a turn only.
        let turns_left = (join.y > 0.0) == at_end;
        coverage *= f32(turns_left == (side == 1u));
    } else if kind == JOINS_ROUND || kind == JOINS_MITRED {
        let from_joint = vec2f(along - select(0.0, in.length_px, at_end), in.along_across.y);
        let past = dot(from_joint, join) * select(-1.0, 1.0, at_end);
        coverage *= f32(past <= SHARED_PX);
    }
    if in.dash_and_ink.z < 1.0 {
        // Place and pixel size in periods of the dashes.
        let per_px = abs(in.dash_and_ink.y - in.dash_and_ink.x) / in.length_px;
        let phase = fract(in.dash_and_ink.x + per_px * along);
        let from_middle = abs(phase - 0.5 * in.dash_and_ink.z);
        // The dash of the next period can be nearer.
        let nearest = min(from_middle, 1.0 - from_middle);
        coverage *= clamp((0.5 * in.dash_and_ink.z - nearest) / max(per_px, 1e-6) + 0.5, 0.0, 1.0);
    }
    let depth = mix(in.depth_and_near.x, in.depth_and_near.y, t);
    if is_cut_away(world_of(in.position.xy, depth)) {
        coverage = 0.0;
    }
    if in.depth_and_near.z > 0.0 && coverage > 0.0 {
        let pixel = vec2i(in.position.xy);
        coverage *= share_in_front(depth, in.depth_and_near.z, filled_depths(pixel));
        if HAS_GLASS {
            let seen = share_in_front(depth, in.depth_and_near.z, glass_depths(pixel));
            coverage *= mix(stroke.behind_glass, 1.0, seen);
        }
    }
    let opacity = mix(in.u_and_opacity.z, in.u_and_opacity.w, t);
    coverage *= opacity;
    if IS_TEXTURED {
        let u = mix(in.u_and_opacity.x, in.u_and_opacity.y, t);
        let signed_off = off * sign(in.along_across.y);
        // Row 0 of the brush is the outer rim, on the right of the direction.
        var v = 0.5 + 0.5 * signed_off / max(half_width, 1e-3);
        if side != 0u {
            let from_spine = off / max(reach, 1e-3);
            v = select(1.0 - from_spine, from_spine, (in.ends & IS_INSIDE) != 0u);
        }
        let rows = f32(textureDimensions(brush).y);
        let level = log2(max(rows / max(2.0 * half_width, 1e-3), 1.0));
        coverage *= textureSampleLevel(brush, brush_sampler, vec2f(u, v), level).a;
    }
    return vec4f(coverage);
}

// The share of a pixel's samples whose surface is at most near_px in front of a depth.
fn share_in_front(depth: f32, near_px: f32, surface: vec4f) -> f32 {
    let here = distance_of(depth);
    let nearest = here - near_px / px_per_unit_at(here);
    // Without a surface, this is the far end of the scene.
    let behind = vec4f(
        f32(distance_of(surface.x) >= nearest),
        f32(distance_of(surface.y) >= nearest),
        f32(distance_of(surface.z) >= nearest),
        f32(distance_of(surface.w) >= nearest),
    );
    return dot(behind, vec4f(0.25));
}

fn is_past_limit(joins: vec4f, at_end: bool) -> bool {
    let join = select(joins.xy, joins.zw, at_end);
    return join.x * MITRE_LIMIT < 1.0;
}
