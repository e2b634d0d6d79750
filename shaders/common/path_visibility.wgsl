// Whether a place on a path is visible, from the depth of the fill.
//
// Creases are tested where they are, because the fill is pushed back behind them. Contours
// are tested beside the edge, off the surface that they bound, as the fragments of strokes
// that are not linked are (stroke_over_surface.wgsl). Half of the samples of a pixel
// decide.
//
// In a tile, the depth is that of the whole picture, in larger pixels, so that all tiles
// agree on where a stroke begins and ends.
#import <common/path.wgsl>
#import <common/silhouette.wgsl>
#import <common/fill_depth.wgsl>
#import <common/fill_object.wgsl>

// Rust twin: FOOT_PX in crates/edgemesh/src/oracle/stroke_vertex.rs.
const FOOT_PX: f32 = 2.5;

// This far inside a contour lies the object's own surface.
const INSIDE_PX: f32 = 1.5;

// A surface that hides a place and lies less than this in front of it can be its own.
const GRAZED_PX: f32 = 12.0;

const SEEN: u32 = 0u;
const SEEN_ALMOST: u32 = 1u;
const SEEN_NOT: u32 = 2u;

// `place` is in pixels from the middle of the tile, y up; `direction` is the unit direction
// of the path there.
fn visibility_at(
    place: vec2f,
    depth: f32,
    direction: vec2f,
    on_contour: bool,
    set_index: u32,
) -> u32 {
    // The front face of a contour is on its left, unless the object is mirrored.
    let pixel_px = filled_pixel_px();
    let outward = pixel_px * object.mirror * vec2f(direction.y, -direction.x);
    let foot = place + select(vec2f(0.0), outward * FOOT_PX, on_contour);
    if !is_in_picture(foot) {
        // Outside the picture there is no depth that could hide it.
        return SEEN;
    }
    let filled = filled_depths(pixel_of(foot));
    let in_front = vec4u(vec4f(depth) >= filled);
    if in_front.x + in_front.y + in_front.z + in_front.w < 2u {
        let nearest = distance_of(max(max(filled.x, filled.y), max(filled.z, filled.w)));
        let here = distance_of(depth);
        let before_px = (here - nearest) * px_per_unit_at(here);
        return select(SEEN_NOT, SEEN_ALMOST, before_px < GRAZED_PX * pixel_px);
    }
    if link_styles[set_index].visibility != SILHOUETTE_STROKES {
        return SEEN;
    }
    let own = filled_object(pixel_of(place - outward * INSIDE_PX));
    let is_around = own != NO_OBJECT && own != filled_object(pixel_of(foot));
    return select(SEEN_NOT, SEEN, is_around);
}

// The size of a pixel of the depth, in pixels of the picture.
fn filled_pixel_px() -> f32 {
    return frame.picture_px.y / vec2f(filled_size()).y;
}

fn is_in_picture(place: vec2f) -> bool {
    return all(abs(place + middle_px()) < 0.5 * frame.picture_px);
}

// The pixel of the depth at a place in pixels from the middle of the tile, y up.
fn pixel_of(place: vec2f) -> vec2i {
    let from_middle = place + middle_px();
    let at = vec2f(from_middle.x, -from_middle.y) + 0.5 * frame.picture_px;
    let size = vec2f(filled_size());
    return clamp(vec2i(floor(at / (frame.picture_px / size))), vec2i(0), vec2i(size) - 1);
}
