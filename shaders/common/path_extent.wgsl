// The extent of whole strokes, across the seam at which a loop was cut, and the equal
// pieces into which long strokes are cut.
#import <common/path.wgsl>

// A whole stroke, including its part beyond the seam of a loop. Arcs are in pixels times
// ARC_PER_PX; `first` and `last` are segments.
struct Extent {
    start_arc: u32,
    end_arc: u32,
    first: u32,
    last: u32,
    // The segment before the first and the one after the last, or NONE.
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
    let set_index = start.flags >> SET_SHIFT;
    let chain = elements[element_of(start.joint, set_index)];
    let first_joint = header.set_first[set_index] + chain.first - header.layer_first[link_styles[set_index].layer];
    let last_joint = joints[first_joint + (chain.count & ~ON_LOOP) - 1u];
    let first_segment = joints[first_joint].first_point;
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

// The number of equal pieces of a stroke, and the piece that a segment is in.
struct Piece {
    count: f32,
    index: f32,
}

fn piece_of(style: LinkStyleUniform, extent: Extent, index: u32) -> Piece {
    let stroke_px = px_of_arc(extent.end_arc - extent.start_arc);
    if style.max_length_px <= 0.0 || stroke_px <= style.max_length_px {
        return Piece(1.0, 0.0);
    }
    let count = ceil(stroke_px / style.max_length_px);
    var middle_px = 0.5 * (px_of_arc(points[index].arc - extent.start_arc)
        + px_of_arc(points[index + 1u].arc - extent.start_arc));
    // Beyond the seam of a loop, arc lengths start again.
    if middle_px < 0.0 || middle_px > stroke_px {
        middle_px = clamp(middle_px, 0.0, stroke_px);
    }
    return Piece(count, min(floor(middle_px / stroke_px * count), count - 1.0));
}

// In pixels, for a difference of arc lengths, which can be negative.
fn px_of_arc(arc: u32) -> f32 {
    return f32(bitcast<i32>(arc)) / ARC_PER_PX;
}
