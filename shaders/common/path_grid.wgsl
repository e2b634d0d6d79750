// The points of a path that lie on one element: at its ends, if they are kept, and on a grid
// of even steps along the whole chain.
#import <common/path.wgsl>

struct Grid {
    // Whether the element has a point at its start, and one at its end.
    has_start: bool,
    has_end: bool,
    // Its points of the grid: from `first` to the one before `end`.
    first: u32,
    end: u32,
    // Arc length of the whole chain, in pixels times ARC_PER_PX, and its number of steps.
    chain: f32,
    steps: f32,
}

fn grid_of(element: u32, joint: u32, set_index: u32) -> Grid {
    let here = elements[element];
    let chain = f32(chain_arc(element));
    let steps = max(1.0, round(chain / (step_of(set_index) * ARC_PER_PX)));
    let next = behind(element);
    let count = here.count & ~ON_LOOP;
    // Loops are cut at their first element.
    let has_start = (joints[joint].kind & KEPT) != 0u || element == here.first;
    let has_end = next == NONE || element + 1u == here.first + count;
    let arc = here.arc - elements[here.first].arc;
    let length_arc = u32(round(length_of(element) * ARC_PER_PX));
    var begin = arc;
    var until = arc + length_arc;
    // Points closer than this to a kept one are left out: the pair would have no reliable
    // direction.
    let clear = u32(0.5 * step_of(set_index) * ARC_PER_PX);
    if has_start {
        begin += clear;
    }
    if has_end || (joints[joint + next - element].kind & KEPT) != 0u {
        until -= min(clear, until);
    }
    var grid = Grid(has_start, has_end, 0u, 0u, chain, steps);
    grid.first = max(first_step(begin, grid), 1u);
    grid.end = max(first_step(until, grid), grid.first);
    return grid;
}

fn arc_of_step(step: u32, grid: Grid) -> u32 {
    return u32(f32(step) * grid.chain / grid.steps);
}

// The first step at or after an arc length.
fn first_step(arc: u32, grid: Grid) -> u32 {
    var step = u32(f32(arc) * grid.steps / max(grid.chain, 1.0));
    // After rounding, at most one off.
    if step > 0u && arc_of_step(step - 1u, grid) >= arc {
        step -= 1u;
    }
    if arc_of_step(step, grid) < arc {
        step += 1u;
    }
    return step;
}
