// Segments of strokes, ready to be drawn: with their width, their place along the
// brush, and how they join their neighbours.
//
// A join belongs to each of its segments up to the line that halves its angle. Where one
// of them is too short to reach that line, both are round there and overlap: the larger
// coverage counts.
#import <common/path.wgsl>
#import <common/stroke_quad.wgsl>

@compute @workgroup_size(GROUP)
fn write_ribbons(@builtin(global_invocation_id) id: vec3u) {
    let index = id.x;
    if index >= header.point_count {
        return;
    }
    var ribbon = Ribbon();
    ribbon.ends = NOT_DRAWN;
    let here = points[index];
    let is_segment = (here.flags & POINT_ENDS) == 0u && index + 1u < header.point_count;
    if is_segment && here.cut.x < here.cut.y {
        ribbon = ribbon_of(index);
    }
    ribbons[index] = ribbon;
}

// A stroke as a whole, with what lies beyond the seam of a loop.
struct Extent {
    start_arc: u32,
    end_arc: u32,
    first: u32,
    last: u32,
    // The segment before the first and the one behind the last, or NONE.
    before_first: u32,
    behind_last: u32,
    is_closed: bool,
}

fn extent_of(stroke_index: u32) -> Extent {
    let stroke = strokes[stroke_index];
    var extent = Extent(
        stroke.start_arc, stroke.end_arc, stroke.first, stroke.last, NONE, NONE, false,
    );
    let start = points[stroke.first];
    let end = points[stroke.last + 1u];
    let draw = start.flags >> DRAW_SHIFT;
    let chain = elements[element_of(start.path, draw)];
    let first_path = header.draw_first[draw] + chain.first - header.layer_first[paths[draw].layer];
    let last_joint = joints[first_path + (chain.count & ~ON_LOOP) - 1u];
    let first_segment = joints[first_path].first_point;
    let last_segment = last_joint.first_point + last_joint.point_count - 2u;
    let begins_on_seam = stroke.first == first_segment
        && (start.flags & POINT_ON_SEAM) != 0u && stroke.start_arc == start.arc;
    if begins_on_seam {
        let partner = points[last_segment].stroke;
        let end_arc = points[last_segment + 1u].arc;
        let meets = strokes[partner].last == last_segment && strokes[partner].end_arc == end_arc;
        if partner == stroke_index && meets {
            extent.is_closed = true;
        } else if meets {
            extent.start_arc = start.arc - (end_arc - strokes[partner].start_arc);
        }
        extent.before_first = select(NONE, last_segment, meets);
    }
    let ends_on_seam = stroke.last == last_segment
        && (end.flags & POINT_ON_SEAM) != 0u && stroke.end_arc == end.arc;
    if ends_on_seam {
        let partner = points[first_segment].stroke;
        let meets = strokes[partner].first == first_segment
            && strokes[partner].start_arc == points[first_segment].arc;
        if meets && partner != stroke_index {
            extent.end_arc = end.arc + strokes[partner].end_arc - points[first_segment].arc;
        }
        extent.behind_last = select(NONE, first_segment, meets);
    }
    return extent;
}

fn ribbon_of(index: u32) -> Ribbon {
    let here = points[index];
    let next = points[index + 1u];
    let draw = here.flags >> DRAW_SHIFT;
    let style = paths[draw];
    let extent = extent_of(here.stroke);
    var a = mix(drawn_place(index), drawn_place(index + 1u), here.cut.x);
    var b = mix(drawn_place(index), drawn_place(index + 1u), here.cut.y);
    let along = b - a;
    let length_px = length(along);
    var ribbon = Ribbon();
    ribbon.ends = NOT_DRAWN;
    if length_px < 1e-4 {
        return ribbon;
    }
    let direction = along / length_px;
    let widest_px = width_of(style, points[extent.first].depth);
    let part = part_of(style, extent, index);
    // From where the stroke begins.
    let from_start = px_of_arc(here.arc - extent.start_arc);
    let whole_px = px_of_arc(next.arc - here.arc);
    var arcs = from_start + here.cut * whole_px;

    // The directions of the segments before and behind, where the stroke has such.
    var ends = vec2u(style.end);
    var joins = array<vec2f, 2>(vec2f(1.0, 0.0), vec2f(1.0, 0.0));
    var other = vec2u(
        select(index - 1u, extent.before_first, index == extent.first),
        select(index + 1u, extent.behind_last, index == extent.last),
    );
    // Where one part of a long stroke ends another begins.
    for (var side = 0u; side < 2u; side++) {
        if part.count > 1.0 && other[side] != NONE
            && part_of(style, extent, other[side]).index != part.index {
            other[side] = NONE;
        }
    }
    let is_ring = extent.is_closed && part.count == 1.0;
    let beside = side_of(style, here.flags) & 3u;
    for (var side = 0u; side < 2u; side++) {
        let splits = (points[index + side].flags & POINT_SPLITS) != 0u;
        if splits && ends[side] == ENDS_ROUND && beside != 0u {
            ends[side] = ENDS_AROUND;
        }
        let is_whole = select(here.cut.y == 1.0, here.cut.x == 0.0, side == 0u);
        if !is_whole {
            // Hidden from here on; the stroke itself may go on.
            ends[side] = select(ENDS_FLAT, style.end, style.is_cut_where_hidden != 0u);
        } else if other[side] != NONE {
            let of_other = drawn_place(other[side] + 1u) - drawn_place(other[side]);
            let other_px = length(of_other);
            let join = direction + of_other / max(other_px, 1e-6);
            // A turn on the spot is an end of both.
            if dot(join, join) > 1e-3 {
                ends[side] = JOINS_ROUND + style.join;
                let across = vec2f(-direction.y, direction.x);
                joins[side] = normalize(vec2f(dot(join, direction), dot(join, across)));
                // As far as the inner side of the turn lies before the joint.
                let inner_px =
                    (widest_px + 1.0) * abs(joins[side].y) / max(joins[side].x, 1e-3);
                var shortest_px = min(length_px, other_px);
                // The two points of the joint; one, but where a loop was cut.
                let ends_at = select(index + 1u, other[side] + 1u, side == 0u);
                let begins_at = select(other[side], index, side == 0u);
                let is_corner = (points[begins_at].flags & POINT_IS_CORNER) != 0u;
                if shortest_px < inner_px && is_corner {
                    shortest_px = min(
                        straight_before(ends_at, inner_px),
                        straight_behind(begins_at, inner_px),
                    );
                }
                if shortest_px < inner_px {
                    ends[side] = JOINS_LOOSELY;
                }
            } else {
                ends[side] = ENDS_ROUND;
            }
        }
    }

    let stroke_px = px_of_arc(extent.end_arc - extent.start_arc);
    var range = vec2f(part.index, part.index + 1.0) * stroke_px / part.count;
    let begins = other.x == NONE && here.cut.x == 0.0;
    let finishes = other.y == NONE && here.cut.y == 1.0;
    if begins {
        a -= direction * style.overshoot_px;
        arcs.x -= style.overshoot_px;
    }
    if finishes {
        b += direction * style.overshoot_px;
        arcs.y += style.overshoot_px;
    }
    if !is_ring {
        range += vec2f(-style.overshoot_px, style.overshoot_px);
    }
    let total_px = max(range.y - range.x, 1e-3);
    var half_widths = vec2f(0.0);
    var opacities = vec2f(0.0);
    for (var side = 0u; side < 2u; side++) {
        let depth = mix(here.depth, next.depth, select(here.cut.x, here.cut.y, side == 1u));
        let is_even = is_ring && total_px > style.taper_px.x + style.taper_px.y;
        let taper = select(taper_of(style, arcs[side] - range.x, total_px), 1.0, is_even);
        let t = (arcs[side] - range.x) / total_px;
        half_widths[side] =
            0.5 * width_of(style, depth) * taper * curve_at(paths[draw].width_curve, t);
        opacities[side] = opacity_of(style, depth) * fade_of_short(style, total_px, widest_px * select(1.0, 3.0, is_ring))
            * curve_at(paths[draw].opacity_curve, t);
    }
    if max(opacities.x, opacities.y) <= 0.0 {
        return ribbon;
    }
    ribbon.a = a;
    ribbon.b = b;
    ribbon.u = brush_of(style, arcs, range, widest_px, is_ring);
    ribbon.half_width = half_widths;
    let period_px = style.dash_px.x + style.dash_px.y;
    ribbon.depth = vec2f(
        mix(here.depth, next.depth, here.cut.x), mix(here.depth, next.depth, here.cut.y),
    );
    if style.visibility != HIDDEN_STROKES {
        // Beside a contour lies none of its own surface; under other strokes it may rise.
        let is_beside = beside != 0u && (side_of(style, here.flags) & (IS_INSIDE >> 8u)) == 0u;
        ribbon.near_px = select(6.0 * widest_px + 12.0, widest_px + 4.0, is_beside);
    }
    ribbon.ink = 1.0;
    if period_px > 0.0 {
        // Whole dashes, one of them in the middle.
        let periods = max(round(total_px / period_px), 1.0);
        ribbon.ink = style.dash_px.x / period_px;
        ribbon.dash = (arcs - 0.5 * (range.x + range.y)) * periods / total_px
            + 0.5 * ribbon.ink;
    }
    ribbon.opacity = pack2x16unorm(opacities);
    ribbon.join0 = joins[0];
    ribbon.join1 = joins[1];
    ribbon.ends = ends.x | (ends.y << 4u) | (side_of(style, here.flags) << 8u);
    return ribbon;
}

// Of how many equal parts of a stroke a segment is in which.
struct Part {
    count: f32,
    index: f32,
}

fn part_of(style: PathUniform, extent: Extent, index: u32) -> Part {
    let stroke_px = px_of_arc(extent.end_arc - extent.start_arc);
    if style.max_length_px <= 0.0 || stroke_px <= style.max_length_px {
        return Part(1.0, 0.0);
    }
    let count = ceil(stroke_px / style.max_length_px);
    var middle_px = 0.5 * (px_of_arc(points[index].arc - extent.start_arc)
        + px_of_arc(points[index + 1u].arc - extent.start_arc));
    // Beyond the seam of a loop arc lengths start again.
    if middle_px < 0.0 || middle_px > stroke_px {
        middle_px = clamp(middle_px, 0.0, stroke_px);
    }
    return Part(count, min(floor(middle_px / stroke_px * count), count - 1.0));
}

// A value between eight even ones, at 0 to 1 along a stroke.
fn curve_at(curve: array<vec4f, 2>, t: f32) -> f32 {
    let at = clamp(t, 0.0, 1.0) * 7.0;
    let first = min(u32(at), 6u);
    var values = curve;
    let low = values[first / 4u][first % 4u];
    let high = values[(first + 1u) / 4u][(first + 1u) % 4u];
    return mix(low, high, at - f32(first));
}

// Of a difference of arc lengths, which may be negative.
fn px_of_arc(arc: u32) -> f32 {
    return f32(bitcast<i32>(arc)) / ARC_PER_PX;
}

// How far the path goes back from a corner until it turns again, as far as is wanted.
fn straight_before(joint: u32, wanted_px: f32) -> f32 {
    var length_px = 0.0;
    var at = joint;
    while length_px < wanted_px && (points[at].flags & POINT_STARTS) == 0u {
        at -= 1u;
        length_px += distance(drawn_place(at), drawn_place(at + 1u));
        if (points[at].flags & POINT_IS_CORNER) != 0u {
            break;
        }
    }
    return length_px;
}

fn straight_behind(joint: u32, wanted_px: f32) -> f32 {
    var length_px = 0.0;
    var at = joint;
    while length_px < wanted_px && (points[at].flags & POINT_ENDS) == 0u {
        at += 1u;
        length_px += distance(drawn_place(at - 1u), drawn_place(at));
        if (points[at].flags & POINT_IS_CORNER) != 0u {
            break;
        }
    }
    return length_px;
}

fn width_of(style: PathUniform, depth: f32) -> f32 {
    if style.is_world_width == 0u {
        return style.width;
    }
    let clip_w = dot(frame.projection.zw, vec2f(distance_of(depth), 1.0));
    return style.width * frame.px_per_unit / clip_w;
}

fn taper_of(style: PathUniform, arc_px: f32, total_px: f32) -> f32 {
    // Where both do not fit, both are shorter.
    let fit = min(1.0, total_px / max(style.taper_px.x + style.taper_px.y, 1e-3));
    let taper_px = style.taper_px * fit;
    let grown = select(arc_px / max(taper_px.x, 1e-3), 1.0, taper_px.x <= 0.0);
    let left = select((total_px - arc_px) / max(taper_px.y, 1e-3), 1.0, taper_px.y <= 0.0);
    return clamp(min(grown, left), 0.0, 1.0);
}

fn opacity_of(style: PathUniform, depth: f32) -> f32 {
    if style.fade.x == style.fade.y {
        return 1.0;
    }
    let faded = (distance_of(depth) - style.fade.x) / (style.fade.y - style.fade.x);
    return 1.0 - clamp(faded, 0.0, 1.0);
}

fn fade_of_short(style: PathUniform, total_px: f32, width_px: f32) -> f32 {
    let least_px = select(style.min_length_px, width_px, style.min_length_px < 0.0);
    return clamp(2.0 * total_px / max(least_px, 1e-3) - 1.0, 0.0, 1.0);
}

// Along the brush at both ends: stretched to the stroke; or whole repeats of it, held
// where the stroke has its middle. A short stroke has a part of the brush, but a ring
// has a whole one.
fn brush_of(
    style: PathUniform,
    arcs: vec2f,
    range: vec2f,
    width_px: f32,
    is_ring: bool,
) -> vec2f {
    let total_px = max(range.y - range.x, 1e-3);
    if style.is_stretched != 0u {
        return (arcs - range.x) / total_px;
    }
    let fitting = total_px / max(width_px * style.brush_aspect, 1e-3);
    let whole = max(round(fitting), 1.0);
    let repeats = select(whole, fitting, fitting < 1.0 && !is_ring);
    return (arcs - 0.5 * (range.x + range.y)) * repeats / total_px;
}

// 0 for centred, 1 for right of its direction, 2 for left; and where it is inside.
fn side_of(style: PathUniform, flags: u32) -> u32 {
    let on_contour = (flags & POINT_ON_CONTOUR) != 0u;
    let is_outside = style.placement == OUTSIDE || (style.placement == AUTOMATIC && on_contour);
    if !is_outside && style.placement != INSIDE {
        return 0u;
    }
    // A contour's front is on its left, but in a mirror.
    let side = select(2u, 1u, is_outside == (object.mirror > 0.0));
    return side | select(IS_INSIDE >> 8u, 0u, is_outside);
}
