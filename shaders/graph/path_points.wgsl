// Places the points of paths, evenly spaced. Each is the average of the path around it, up
// to the next corner, so that the zigzag of a fine mesh becomes a smooth line.
#import <common/path_grid.wgsl>
#import <common/path_visibility.wgsl>
#import <common/path_wobble.wgsl>

// The largest part of a loop that is averaged on each side of a point.
const LOOP_PART: f32 = 0.125;

// On shorter chains, nearly visible points are not bridged.
const LEAST_BRIDGED_PX: f32 = 100.0;

@compute @workgroup_size(GROUP)
fn place_points(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= header.point_count {
        return;
    }
    points[id.x] = point_of(id.x);
}

fn point_of(index: u32) -> PathPoint {
    let joint = joint_of_point(index);
    let set_index = set_of(joint);
    let element = element_of(joint, set_index);
    let here = elements[element];
    let grid = grid_of(element, joint, set_index);
    let rank = index - joints[joint].first_point;
    let is_start = grid.has_start && rank == 0u;
    let step = grid.first + rank - u32(grid.has_start);
    let is_end = !is_start && step >= grid.end;
    let length_px = length_of(element);
    let arc = here.arc - elements[here.first].arc;
    var along_px = select(0.0, length_px, is_end);
    if !is_start && !is_end {
        along_px = (f32(arc_of_step(step, grid)) - f32(arc)) / ARC_PER_PX;
    }
    let t = clamp(along_px / max(length_px, 1e-6), 0.0, 1.0);

    let step_px = step_of(set_index);
    let far_px = FOLD_STEPS * step_px;
    var back = walk_back(element, joint, t, far_px);
    var ahead = walk_ahead(element, joint, t, far_px);
    let direction = unit(ahead.place - back.place, here.s1 - here.s0);
    let exact = vec3f(mix(here.s0, here.s1, t), mix(here.z0, here.z1, t));
    // Near folds, more is averaged, so that a path does not go back and forth.
    let fold_px = min(back.fold_px, ahead.fold_px);
    var wanted_px = clamp(far_px + step_px - fold_px, step_px, far_px);
    let chain_px = grid.chain / ARC_PER_PX;
    if (here.count & ON_LOOP) != 0u {
        // The average of all of a small loop would be its middle.
        wanted_px = min(wanted_px, LOOP_PART * chain_px);
    }
    let half_px = min(wanted_px, min(back.length_px, ahead.length_px));
    var averaged = exact;
    if half_px > 0.01 {
        back = walk_back(element, joint, t, half_px);
        ahead = walk_ahead(element, joint, t, half_px);
        averaged = (back.sum + ahead.sum) / (back.length_px + ahead.length_px);
    }
    let on_contour = (here.edge & CONTOUR) != 0u;
    // A solid hides such an edge from everywhere outside; but near a fold, the average
    // includes places in front of the surface.
    var seen = select(SEEN_NOT, SEEN_ALMOST, on_contour && half_px > 2.0 * step_px);
    if (here.edge & BEHIND_SOLID) == 0u {
        seen = visibility_at(exact.xy, exact.z, direction, on_contour, set_index);
    }
    let across = vec2f(-direction.y, direction.x);
    return PathPoint(
        averaged.xy,
        across * wobble_at(averaged.xy, averaged.z, set_index),
        averaged.z,
        0u,
        joint,
        flags_of(element, joint, is_start, is_end)
            | select(0u, POINT_IS_VISIBLE, seen == SEEN)
            | select(0u, POINT_IS_GRAZED, seen == SEEN_ALMOST && chain_px > LEAST_BRIDGED_PX)
            | select(0u, POINT_ON_CONTOUR, on_contour)
            | (set_index << SET_SHIFT),
        vec2f(0.0, 1.0),
        0u,
        0u,
    );
}

// The joint of a point, by binary search: the last one whose first point is not after it.
fn joint_of_point(index: u32) -> u32 {
    var low = 0u;
    var high = header.joint_count;
    while high - low > 1u {
        let middle = (low + high) / 2u;
        if joints[middle].first_point <= index {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

fn flags_of(element: u32, joint: u32, is_start: bool, is_end: bool) -> u32 {
    let here = elements[element];
    let kind = joints[joint].kind;
    let first_kind = joints[joint + here.first - element].kind;
    // If strokes are cut at the place where the loop was cut, there is no seam.
    let is_seam = (first_kind & (BREAK | SPLIT)) == 0u;
    if is_start {
        let at_first = element == here.first;
        let starts = (kind & BREAK) != 0u || at_first;
        return select(0u, POINT_STARTS, starts)
            | select(0u, POINT_SPLITS, (kind & SPLIT) != 0u)
            | select(0u, POINT_IS_CORNER, (kind & CORNER) != 0u)
            | select(0u, POINT_ON_SEAM, at_first && is_seam);
    }
    if is_end {
        let is_broken = behind(element) == NONE;
        return POINT_ENDS | select(0u, POINT_ON_SEAM, !is_broken && is_seam);
    }
    return 0u;
}

struct Walk {
    // The integral of place and depth along the way.
    sum: vec3f,
    length_px: f32,
    // The end of the walk.
    place: vec2f,
    // Distance to the nearest fold.
    fold_px: f32,
}

// Adds a part of an element to a walk; `part` and `to` are fractions of the element.
fn walked(so_far: Walk, element: u32, part: f32, to: f32, taken_px: f32) -> Walk {
    let here = elements[element];
    let middle = 0.5 * (part + to);
    var walk = so_far;
    walk.sum += taken_px * vec3f(mix(here.s0, here.s1, middle), mix(here.z0, here.z1, middle));
    walk.length_px += taken_px;
    walk.place = mix(here.s0, here.s1, to);
    return walk;
}

fn walk_back(element: u32, joint: u32, t: f32, reach_px: f32) -> Walk {
    var at = element;
    var part = t;
    var walk = Walk(vec3f(0.0), 0.0, vec2f(0.0), 1e9);
    for (var count = 0u; count < MOST_ELEMENTS; count++) {
        let length_px = part * length_of(at);
        let taken_px = min(length_px, reach_px - walk.length_px);
        let to = part * (1.0 - taken_px / max(length_px, 1e-6));
        walk = walked(walk, at, part, to, taken_px);
        if walk.length_px >= reach_px {
            break;
        }
        let kind = joints[joint + at - element].kind;
        if (kind & KEPT) != 0u {
            break;
        }
        walk.fold_px = select(walk.fold_px, min(walk.fold_px, walk.length_px), (kind & FOLD) != 0u);
        let other = before(at);
        if other == NONE || other == element {
            break;
        }
        at = other;
        part = 1.0;
    }
    return walk;
}

fn walk_ahead(element: u32, joint: u32, t: f32, reach_px: f32) -> Walk {
    var at = element;
    var part = t;
    var walk = Walk(vec3f(0.0), 0.0, vec2f(0.0), 1e9);
    for (var count = 0u; count < MOST_ELEMENTS; count++) {
        let length_px = (1.0 - part) * length_of(at);
        let taken_px = min(length_px, reach_px - walk.length_px);
        let to = part + (1.0 - part) * taken_px / max(length_px, 1e-6);
        walk = walked(walk, at, part, to, taken_px);
        if walk.length_px >= reach_px {
            break;
        }
        let other = behind(at);
        if other == NONE || other == element {
            break;
        }
        let kind = joints[joint + other - element].kind;
        if (kind & KEPT) != 0u {
            break;
        }
        walk.fold_px = select(walk.fold_px, min(walk.fold_px, walk.length_px), (kind & FOLD) != 0u);
        at = other;
        part = 0.0;
    }
    return walk;
}

fn unit(vector: vec2f, otherwise: vec2f) -> vec2f {
    let chosen = select(otherwise, vector, dot(vector, vector) > 1e-12);
    let length_px = length(chosen);
    return select(vec2f(1.0, 0.0), chosen / length_px, length_px > 0.0);
}
