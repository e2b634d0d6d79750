// Finds the starts and ends of strokes along their paths.
//
// A mesh contour runs alternately a little in front of and a little behind the smooth surface
// that the mesh approximates. So points that a very close surface hides (grazed points)
// count as visible between visible ones, and a single visible point counts as hidden. The
// place where visibility changes between two points is found by bisection.
#import <common/path_visibility.wgsl>
#import <common/scan.wgsl>

const HALVINGS: u32 = 4u;

// The most points that are searched on each side of a grazed one.
const BRIDGE: u32 = 6u;

// Whether a point is drawn.
fn is_drawn(index: u32) -> bool {
    let set_index = points[index].flags >> SET_SHIFT;
    return is_seen(index) != (link_styles[set_index].visibility == HIDDEN_STROKES);
}

fn is_seen(index: u32) -> bool {
    let flags = points[index].flags;
    if (flags & POINT_IS_VISIBLE) != 0u {
        let before = (flags & POINT_STARTS) == 0u && is_open(index - 1u);
        let behind = (flags & POINT_ENDS) == 0u && is_open(index + 1u);
        let is_whole = (flags & (POINT_STARTS | POINT_ENDS)) == (POINT_STARTS | POINT_ENDS);
        return before || behind || is_whole;
    }
    if (flags & POINT_IS_GRAZED) == 0u {
        return false;
    }
    // Bridged if only grazed points lie between it and a visible one, on both sides.
    var at = index;
    var is_bridged = false;
    for (var step = 0u; step < BRIDGE && !is_bridged; step++) {
        if (points[at].flags & POINT_STARTS) != 0u {
            return false;
        }
        at -= 1u;
        is_bridged = (points[at].flags & POINT_IS_VISIBLE) != 0u;
        if !is_bridged && (points[at].flags & POINT_IS_GRAZED) == 0u {
            return false;
        }
    }
    if !is_bridged {
        return false;
    }
    at = index;
    for (var step = 0u; step < BRIDGE; step++) {
        if (points[at].flags & POINT_ENDS) != 0u {
            return false;
        }
        at += 1u;
        if (points[at].flags & POINT_IS_VISIBLE) != 0u {
            return true;
        }
        if (points[at].flags & POINT_IS_GRAZED) == 0u {
            return false;
        }
    }
    return false;
}

// Whether a visible point next to this one is not alone.
fn is_open(index: u32) -> bool {
    return (points[index].flags & (POINT_IS_VISIBLE | POINT_IS_GRAZED)) != 0u;
}

struct Segment {
    exists: bool,
    // Whether its two points are drawn.
    is_drawn0: bool,
    is_drawn1: bool,
    // Whether strokes are cut where they are hidden.
    is_cut: bool,
    starts_stroke: bool,
    ends_stroke: bool,
}

fn segment_at(index: u32) -> Segment {
    var segment = Segment();
    let flags = points[index].flags;
    if (flags & POINT_ENDS) != 0u || index + 1u >= header.point_count {
        return segment;
    }
    let next = points[index + 1u].flags;
    segment.exists = true;
    segment.is_drawn0 = is_drawn(index);
    segment.is_drawn1 = is_drawn(index + 1u);
    let is_cut = link_styles[flags >> SET_SHIFT].is_cut_where_hidden != 0u;
    segment.is_cut = is_cut;
    let is_touched = segment.is_drawn0 || segment.is_drawn1 || !is_cut;
    segment.starts_stroke = is_touched && ((flags & (POINT_STARTS | POINT_SPLITS)) != 0u
        || (is_cut && !segment.is_drawn0));
    segment.ends_stroke = is_touched && ((next & (POINT_ENDS | POINT_SPLITS)) != 0u
        || (is_cut && !segment.is_drawn1));
    return segment;
}

// Arc length of a segment, in pixels times ARC_PER_PX.
fn segment_arc(index: u32) -> u32 {
    let is_segment = (points[index].flags & POINT_ENDS) == 0u && index + 1u < header.point_count;
    if !is_segment {
        return 0u;
    }
    let length_px = distance(drawn_place(index), drawn_place(index + 1u));
    return u32(round(length_px * ARC_PER_PX));
}

// The place on a segment where visibility changes, as a fraction.
fn cut_of(index: u32, is_drawn0: bool) -> f32 {
    let a = points[index];
    let b = points[index + 1u];
    let set_index = a.flags >> SET_SHIFT;
    let on_contour = (a.flags & POINT_ON_CONTOUR) != 0u;
    let along = b.position - a.position;
    let direction = along / max(length(along), 1e-6);
    var low = 0.0;
    var high = 1.0;
    for (var halving = 0u; halving < HALVINGS; halving++) {
        let t = 0.5 * (low + high);
        let place = mix(a.position, b.position, t);
        let seen = visibility_at(place, mix(a.depth, b.depth, t), direction, on_contour, set_index);
        let is_like_start = ((seen == SEEN) != (link_styles[set_index].visibility == HIDDEN_STROKES)) == is_drawn0;
        low = select(low, t, is_like_start);
        high = select(t, high, is_like_start);
    }
    return 0.5 * (low + high);
}

@compute @workgroup_size(GROUP)
fn sum_strokes(@builtin(global_invocation_id) id: vec3u) {
    let first = id.x * ITEMS_PER_SUM;
    if first >= header.point_count {
        return;
    }
    var sum = vec2u(0u);
    for (var index = first; index < min(first + ITEMS_PER_SUM, header.point_count); index++) {
        let segment = segment_at(index);
        sum += vec2u(u32(segment.starts_stroke), segment_arc(index));
        var cut = select(vec2f(1.0, 0.0), vec2f(0.0, 1.0), segment.is_drawn0 && segment.exists);
        if segment.exists && segment.is_drawn0 != segment.is_drawn1 {
            let at = cut_of(index, segment.is_drawn0);
            cut = select(vec2f(at, 1.0), vec2f(0.0, at), segment.is_drawn0);
        }
        points[index].cut = cut;
    }
    sums[id.x] = sum;
}

@compute @workgroup_size(SCAN_WIDTH)
fn scan_strokes(@builtin(local_invocation_index) lane: u32) {
    let total = scan_sums(lane, (header.point_count + ITEMS_PER_SUM - 1u) / ITEMS_PER_SUM);
    if lane == 0u {
        header.stroke_count = total.x;
    }
}

@compute @workgroup_size(GROUP)
fn write_strokes(@builtin(global_invocation_id) id: vec3u) {
    let first = id.x * ITEMS_PER_SUM;
    if first >= header.point_count {
        return;
    }
    // The number of strokes that began so far minus 1; wraps if there are none.
    var stroke = sums[id.x].x - 1u;
    var arc = sums[id.x].y;
    for (var index = first; index < min(first + ITEMS_PER_SUM, header.point_count); index++) {
        let segment = segment_at(index);
        let length_arc = segment_arc(index);
        if segment.starts_stroke {
            stroke += 1u;
            strokes[stroke].first = index;
            let t = select(0.0, points[index].cut.x, segment.is_cut);
            strokes[stroke].start_arc = arc + u32(t * f32(length_arc));
        }
        if segment.ends_stroke {
            strokes[stroke].last = index;
            let t = select(1.0, points[index].cut.y, segment.is_cut);
            strokes[stroke].end_arc = arc + u32(t * f32(length_arc));
        }
        points[index].stroke = stroke;
        points[index].arc = arc;
        arc += length_arc;
    }
}
