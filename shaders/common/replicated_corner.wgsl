// The corner of a stroke that a replicated edge vertex stands for.
#import <common/stroke_classified.wgsl>

// McGuire and Hughes draw the quads first and the caps in later passes, from the same four
// vertices per edge. `part` is the pass: 0 for the quad, then one for each triangle of an
// end.
fn corner_of_part(part: u32, i: u32) -> u32 {
    if part == 0u {
        return i;
    }
    return corner_of(6u + 3u * (part - 1u) + i);
}
