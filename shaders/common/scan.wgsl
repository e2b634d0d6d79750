// An exclusive scan of the sums of runs, in one workgroup, so that a large dispatch waits at
// no barrier. Both components of a sum are scanned.

const SCAN_WIDTH: u32 = 256u;
var<workgroup> lane_sums: array<vec2u, SCAN_WIDTH>;

@group(3) @binding(4) var<storage, read_write> sums: array<vec2u>;

// Replaces each of the first `count` sums by the total of those before it; returns the total
// of all to every lane.
fn scan_sums(lane: u32, count: u32) -> vec2u {
    let part = (count + SCAN_WIDTH - 1u) / SCAN_WIDTH;
    let first = min(lane * part, count);
    let last = min(first + part, count);
    var sum = vec2u(0u);
    for (var at = first; at < last; at++) {
        sum += sums[at];
    }
    lane_sums[lane] = sum;
    workgroupBarrier();
    if lane == 0u {
        var total = vec2u(0u);
        for (var other = 0u; other < SCAN_WIDTH; other++) {
            total += lane_sums[other];
            lane_sums[other] = total;
        }
    }
    workgroupBarrier();
    var base = lane_sums[lane] - sum;
    for (var at = first; at < last; at++) {
        let count_here = sums[at];
        sums[at] = base;
        base += count_here;
    }
    return lane_sums[SCAN_WIDTH - 1u];
}
