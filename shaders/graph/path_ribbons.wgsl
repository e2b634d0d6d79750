// Turns the segments of strokes into ribbons, with their width, their place along the brush,
// and their joins.
//
// The line that halves the angle of a join separates its two segments. If one of them is too
// short to reach that line, both are round and overlap; the larger coverage counts.
#import <common/path_extent.wgsl>
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

fn ribbon_of(index: u32) -> Ribbon {
    let here = points[index];
    let next = points[index + 1u];
    let set_index = here.flags >> SET_SHIFT;
    let style = link_styles[set_index];
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
    let part = piece_of(style, extent, index);
    // In pixels from the start of the stroke.
    let from_start = px_of_arc(here.arc - extent.start_arc);
    let whole_px = px_of_arc(next.arc - here.arc);
    var arcs = from_start + here.cut * whole_px;

    let other = neighbors_of(style, extent, part, index);
    let is_ring = extent.is_closed && part.count == 1.0;
    let side = side_of(style, here.flags);
    let start = meeting_of(style, index, direction, length_px, widest_px, 0u, other.x);
    let finish = meeting_of(style, index, direction, length_px, widest_px, 1u, other.y);

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
    let is_even = is_ring && total_px > style.taper_px.x + style.taper_px.y;
    let least_px = widest_px * select(1.0, 3.0, is_ring);
    for (var end = 0u; end < 2u; end++) {
        let depth = mix(here.depth, next.depth, select(here.cut.x, here.cut.y, end == 1u));
        let taper = select(taper_of(style, arcs[end] - range.x, total_px), 1.0, is_even);
        let t = (arcs[end] - range.x) / total_px;
        half_widths[end] =
            0.5 * width_of(style, depth) * taper * curve_at(link_styles[set_index].width_curve, t);
        opacities[end] = opacity_of(style, depth) * fade_of_short(style, total_px, least_px)
            * curve_at(link_styles[set_index].opacity_curve, t);
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
        // Outside a contour there is none of its own surface; under other strokes it can
        // rise.
        let is_beside = (side & 3u) != 0u && (side & (IS_INSIDE >> 8u)) == 0u;
        ribbon.near_px = select(6.0 * widest_px + 12.0, widest_px + 4.0, is_beside);
    }
    ribbon.ink = 1.0;
    if period_px > 0.0 {
        // A whole number of dashes, one of them in the middle.
        let periods = max(round(total_px / period_px), 1.0);
        ribbon.ink = style.dash_px.x / period_px;
        ribbon.dash = (arcs - 0.5 * (range.x + range.y)) * periods / total_px
            + 0.5 * ribbon.ink;
    }
    ribbon.opacity = pack2x16unorm(opacities);
    ribbon.join0 = start.join;
    ribbon.join1 = finish.join;
    ribbon.ends = start.kind | (finish.kind << 4u) | (side << 8u);
    return ribbon;
}

// The segments before and after one, or NONE at the ends of its stroke or of its piece of a
// long stroke.
fn neighbors_of(style: LinkStyleUniform, extent: Extent, part: Piece, index: u32) -> vec2u {
    var other = vec2u(
        select(index - 1u, extent.before_first, index == extent.first),
        select(index + 1u, extent.behind_last, index == extent.last),
    );
    for (var end = 0u; end < 2u; end++) {
        if part.count > 1.0 && other[end] != NONE
            && piece_of(style, extent, other[end]).index != part.index {
            other[end] = NONE;
        }
    }
    return other;
}

// The start or end of a segment.
struct Meeting {
    kind: u32,
    // Unit vector of half of the turn there, along and across the segment.
    join: vec2f,
}

// `end` is 0 for the start and 1 for the end; `other` is the segment that it meets there.
fn meeting_of(
    style: LinkStyleUniform,
    index: u32,
    direction: vec2f,
    length_px: f32,
    width_px: f32,
    end: u32,
    other: u32,
) -> Meeting {
    let here = points[index];
    var meeting = Meeting(style.end, vec2f(1.0, 0.0));
    let is_whole = select(here.cut.y == 1.0, here.cut.x == 0.0, end == 0u);
    if !is_whole {
        // Hidden from here on, though the stroke can continue.
        meeting.kind = select(ENDS_FLAT, style.end, style.is_cut_where_hidden != 0u);
        return meeting;
    }
    if other == NONE {
        let splits = (points[index + end].flags & POINT_SPLITS) != 0u;
        let is_beside = (side_of(style, here.flags) & 3u) != 0u;
        if splits && is_beside && style.end == ENDS_ROUND {
            meeting.kind = ENDS_AROUND;
        }
        return meeting;
    }
    let of_other = drawn_place(other + 1u) - drawn_place(other);
    let other_px = length(of_other);
    let join = direction + of_other / max(other_px, 1e-6);
    if dot(join, join) <= 1e-3 {
        // At a turn of 180 degrees both segments end.
        meeting.kind = ENDS_ROUND;
        return meeting;
    }
    let across = vec2f(-direction.y, direction.x);
    meeting.join = normalize(vec2f(dot(join, direction), dot(join, across)));
    // The distance from the joint to the inner corner of the turn.
    let inner_px = (width_px + 1.0) * abs(meeting.join.y) / max(meeting.join.x, 1e-3);
    var shortest_px = min(length_px, other_px);
    // The joint as the last point before it and the first after it, which differ only where
    // a loop was cut.
    let ends_at = select(index + 1u, other + 1u, end == 0u);
    let begins_at = select(other, index, end == 0u);
    let is_corner = (points[begins_at].flags & POINT_IS_CORNER) != 0u;
    if shortest_px < inner_px && is_corner {
        shortest_px =
            min(straight_before(ends_at, inner_px), straight_behind(begins_at, inner_px));
    }
    meeting.kind = select(JOINS_ROUND + style.join, JOINS_LOOSELY, shortest_px < inner_px);
    return meeting;
}

// The length of the path back from a corner until it turns again, or wanted_px if that is
// reached first.
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
    while length_px < wanted_px && (points[at].flags & POINT_ENDS) == 0u
        && at + 1u < header.point_count {
        at += 1u;
        length_px += distance(drawn_place(at - 1u), drawn_place(at));
        if (points[at].flags & POINT_IS_CORNER) != 0u {
            break;
        }
    }
    return length_px;
}

// Interpolates eight even values; t is the place along a stroke, 0 to 1.
fn curve_at(curve: array<vec4f, 2>, t: f32) -> f32 {
    let at = clamp(t, 0.0, 1.0) * 7.0;
    let first = min(u32(at), 6u);
    var values = curve;
    let low = values[first / 4u][first % 4u];
    let high = values[(first + 1u) / 4u][(first + 1u) % 4u];
    return mix(low, high, at - f32(first));
}

fn width_of(style: LinkStyleUniform, depth: f32) -> f32 {
    if style.is_world_width == 0u {
        return style.width;
    }
    // Near the eye a width grows without bound.
    return min(style.width * px_per_unit_at(distance_of(depth)), frame.picture_px.y);
}

fn taper_of(style: LinkStyleUniform, arc_px: f32, total_px: f32) -> f32 {
    // If the two tapers do not fit, both are shortened.
    let fit = min(1.0, total_px / max(style.taper_px.x + style.taper_px.y, 1e-3));
    let taper_px = style.taper_px * fit;
    let grown = select(arc_px / max(taper_px.x, 1e-3), 1.0, taper_px.x <= 0.0);
    let left = select((total_px - arc_px) / max(taper_px.y, 1e-3), 1.0, taper_px.y <= 0.0);
    return clamp(min(grown, left), 0.0, 1.0);
}

fn opacity_of(style: LinkStyleUniform, depth: f32) -> f32 {
    if style.fade.x == style.fade.y {
        return 1.0;
    }
    let faded = (distance_of(depth) - style.fade.x) / (style.fade.y - style.fade.x);
    return 1.0 - clamp(faded, 0.0, 1.0);
}

fn fade_of_short(style: LinkStyleUniform, total_px: f32, width_px: f32) -> f32 {
    let least_px = select(style.min_length_px, width_px, style.min_length_px < 0.0);
    return clamp(2.0 * total_px / max(least_px, 1e-3) - 1.0, 0.0, 1.0);
}

// u at both ends: the brush is stretched to the stroke, or repeated a whole number of times,
// fixed at the middle of the stroke. A stroke shorter than the brush has a part of it; a
// closed stroke has all of it.
fn brush_of(
    style: LinkStyleUniform,
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

// 0 if centered, 1 if right of its direction, 2 if left; with IS_INSIDE >> 8 if inside.
fn side_of(style: LinkStyleUniform, flags: u32) -> u32 {
    let on_contour = (flags & POINT_ON_CONTOUR) != 0u;
    let is_outside = style.placement == OUTSIDE || (style.placement == AUTOMATIC && on_contour);
    if !is_outside && style.placement != INSIDE {
        return 0u;
    }
    // The front face of a contour is on its left, unless the object is mirrored.
    let side = select(2u, 1u, is_outside == (object.mirror > 0.0));
    return side | select(IS_INSIDE >> 8u, 0u, is_outside);
}
