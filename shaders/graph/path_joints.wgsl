// Finds the corners of paths, and counts the points on each element.
//
// Mesh contours zigzag from edge to edge, so a turn is measured over some pixels on both
// sides, and only the sharpest joint within them is a corner. Corners keep their place;
// between them, a path gets evenly spaced points, whatever the size of the edges. Contours
// also fold back on themselves for a few pixels: a turn over one step that is no turn over
// four is such a fold, not a corner.
//
//   edges    /\/\_/\/\/\|      measured over the step, one corner
//                       |
//   points   .  .  .  .  .     every 4 px, the corner exactly
//                        .
#import <common/path_grid.wgsl>
#import <common/scan.wgsl>

@group(3) @binding(8) var<storage, read_write> arguments: array<u32>;

@compute @workgroup_size(GROUP)
fn measure_turns(@builtin(global_invocation_id) id: vec3u) {
    let joint = id.x;
    if joint >= header.joint_count {
        return;
    }
    let set_index = set_of(joint);
    let element = element_of(joint, set_index);
    let step_px = step_of(set_index);
    let near = turn_cosine(element, step_px);
    joints[joint].kind = 0u;
    joints[joint].cosine = near;
    if near < KEPT_COSINE {
        var far = turn_cosine(element, FOLD_STEPS * step_px);
        if far < KEPT_COSINE && near < CUSP_COSINE {
            // A path that turns back has a corner there, unless it turns again soon.
            far = turn_cosine(element, 2.0 * FOLD_STEPS * step_px);
        }
        joints[joint].cosine = max(near, far);
        joints[joint].kind = select(0u, FOLD, far >= KEPT_COSINE);
    }
}

fn turn_cosine(element: u32, reach_px: f32) -> f32 {
    let here = elements[element].s0;
    let back = here - place_before(element, reach_px);
    let ahead = place_ahead(element, reach_px) - here;
    let lengths = length(back) * length(ahead);
    if lengths <= 0.0 {
        return 1.0;
    }
    return dot(back, ahead) / lengths;
}

// The place reach_px before the start of an element, or the start of its path.
fn place_before(element: u32, reach_px: f32) -> vec2f {
    var left = reach_px;
    var at = element;
    for (var count = 0u; count < MOST_ELEMENTS; count++) {
        let other = before(at);
        if other == NONE || other == element {
            break;
        }
        at = other;
        let length_px = length_of(at);
        if length_px >= left {
            return mix(elements[at].s1, elements[at].s0, left / length_px);
        }
        left -= length_px;
    }
    return elements[at].s0;
}

fn place_ahead(element: u32, reach_px: f32) -> vec2f {
    var left = reach_px;
    var at = element;
    for (var count = 0u; count < MOST_ELEMENTS; count++) {
        let length_px = length_of(at);
        if length_px >= left {
            return mix(elements[at].s0, elements[at].s1, left / length_px);
        }
        left -= length_px;
        let other = behind(at);
        if other == NONE || other == element {
            break;
        }
        at = other;
    }
    return elements[at].s1;
}

@compute @workgroup_size(GROUP)
fn find_corners(@builtin(global_invocation_id) id: vec3u) {
    let joint = id.x;
    if joint >= header.joint_count {
        return;
    }
    let set_index = set_of(joint);
    let element = element_of(joint, set_index);
    var kind = joints[joint].kind;
    if before(element) == NONE {
        kind |= BREAK;
    } else if is_corner(element, joint, step_of(set_index)) {
        kind |= CORNER;
        // A contour that turns back has a cusp, where another stroke begins.
        let is_cusp = joints[joint].cosine < CUSP_COSINE
            && (elements[element].edge & CONTOUR) != 0u;
        if joints[joint].cosine < link_styles[set_index].corner_cosine || is_cusp {
            kind |= SPLIT;
        }
    }
    joints[joint].kind = kind;
}

// Whether a joint turns more than all others within reach; the first of two equal ones does.
fn is_corner(element: u32, joint: u32, reach_px: f32) -> bool {
    let cosine = joints[joint].cosine;
    if cosine >= KEPT_COSINE {
        return false;
    }
    var left = reach_px;
    var at = element;
    for (var count = 0u; count < MOST_ELEMENTS; count++) {
        at = before(at);
        if at == NONE || at == element {
            break;
        }
        left -= length_of(at);
        if left < 0.0 {
            break;
        }
        if joints[joint + at - element].cosine <= cosine {
            return false;
        }
    }
    left = reach_px;
    at = element;
    for (var count = 0u; count < MOST_ELEMENTS; count++) {
        left -= length_of(at);
        at = behind(at);
        if left < 0.0 || at == NONE || at == element {
            break;
        }
        if joints[joint + at - element].cosine < cosine {
            return false;
        }
    }
    return true;
}

// The number of points of an element: one at its start if it is kept, those of the grid along
// the chain, and one at its end if the path ends there.
fn count_points(joint: u32) -> u32 {
    let set_index = set_of(joint);
    let element = element_of(joint, set_index);
    if (elements[element].next & CUT_WHOLE) != 0u {
        return 0u;
    }
    let grid = grid_of(element, joint, set_index);
    return u32(grid.has_start) + u32(grid.has_end) + grid.end - grid.first;
}

@compute @workgroup_size(GROUP)
fn sum_points(@builtin(global_invocation_id) id: vec3u) {
    let first = id.x * ITEMS_PER_SUM;
    if first >= header.joint_count {
        return;
    }
    var sum = 0u;
    for (var joint = first; joint < min(first + ITEMS_PER_SUM, header.joint_count); joint++) {
        let count = count_points(joint);
        joints[joint].point_count = count;
        sum += count;
    }
    sums[id.x] = vec2u(sum, 0u);
}

@compute @workgroup_size(SCAN_WIDTH)
fn scan_points(@builtin(local_invocation_index) lane: u32) {
    let total = scan_sums(lane, (header.joint_count + ITEMS_PER_SUM - 1u) / ITEMS_PER_SUM);
    if lane == 0u {
        header.point_count = min(total.x, header.point_capacity);
    }
}

@compute @workgroup_size(GROUP)
fn write_points(@builtin(global_invocation_id) id: vec3u) {
    let first = id.x * ITEMS_PER_SUM;
    if first >= header.joint_count {
        return;
    }
    var base = sums[id.x].x;
    for (var joint = first; joint < min(first + ITEMS_PER_SUM, header.joint_count); joint++) {
        joints[joint].first_point = base;
        base += joints[joint].point_count;
    }
}

// Sets the workgroup counts of the passes over points, and the ribbons of each draw.
@compute @workgroup_size(MAX_STROKE_SETS)
fn finish_points(@builtin(local_invocation_index) set_index: u32) {
    if set_index == 0u {
        set_groups(POINT_GROUPS, header.point_count, GROUP);
        set_groups(POINT_SUM_GROUPS, header.point_count, GROUP * ITEMS_PER_SUM);
    }
    let first = point_at(header.set_first[set_index]);
    let at = RIBBON_DRAWS + 5u * set_index;
    arguments[at] = 6u * (point_at(header.set_first[set_index + 1u]) - first);
    arguments[at + 1u] = 1u;
    arguments[at + 2u] = 6u * first;
    arguments[at + 3u] = 0u;
    arguments[at + 4u] = 0u;
}

fn point_at(joint: u32) -> u32 {
    if joint >= header.joint_count {
        return header.point_count;
    }
    return min(joints[joint].first_point, header.point_count);
}

fn set_groups(at: u32, count: u32, per_group: u32) {
    arguments[at] = (count + per_group - 1u) / per_group;
    arguments[at + 1u] = 1u;
    arguments[at + 2u] = 1u;
}
