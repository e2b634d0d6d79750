// Which corner of a stroke an edge vertex stands for.
#import <common/stroke_classified.wgsl>

// The paper draws quads first and the caps in passes behind them, from the same
// four vertices an edge. `part` is the pass: 0 the quad, then one triangle of an
// end each.
fn corner_of_part(part: u32, i: u32) -> u32 {
    if part == 0u {
        return i;
    }
    return corner_of(6u + 3u * (part - 1u) + i);
}
