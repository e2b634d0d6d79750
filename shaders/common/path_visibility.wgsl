// Whether a place on a path is to be seen, by the depth of what was filled.
//
// Creases ask where they are: the fill is pushed back behind them. A contour asks
// beside itself, off the surface that it bounds, as its fragments do where strokes are
// not linked (stroke_over_surface.wgsl). Half of the samples of a pixel decide.
//
// Where a part of a picture is drawn, the depth is that of the whole, in larger pixels:
// so all parts agree on where a stroke begins and ends.
#import <common/path.wgsl>
#import <common/silhouette.wgsl>
#import <common/fill_depth.wgsl>
#import <common/fill_object.wgsl>

// Rust twin: FOOT_PX in crates/edgemesh/src/oracle/stroke_vertex.rs.
const FOOT_PX: f32 = 2.5;

// As far inside an object is surely its own surface.
const INSIDE_PX: f32 = 1.5;

// What hides a place so few pixels in front of it may be the surface that it is on.
const GRAZED_PX: f32 = 12.0;

const SEEN: u32 = 0u;
const SEEN_ALMOST: u32 = 1u;
const SEEN_NOT: u32 = 2u;

// `direction` is that of the path there, of unit length.
fn visibility_at(
    place: vec2f,
    depth: f32,
    direction: vec2f,
    on_contour: bool,
    set_index: u32,
) -> u32 {
    // A contour's front is on its left, but in a mirror.
    let pixel_px = filled_pixel_px();
    let outward = pixel_px * object.mirror * vec2f(direction.y, -direction.x);
    let foot = place + select(vec2f(0.0), outward * FOOT_PX, on_contour);
    if !is_in_picture(foot) {
        // Beyond the picture nothing is known to hide it.
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

// How many pixels of the picture one of the depth is.
fn filled_pixel_px() -> f32 {
    return frame.picture_px.y / vec2f(filled_size()).y;
}

fn is_in_picture(place: vec2f) -> bool {
    return all(abs(place + middle_px()) < 0.5 * frame.picture_px);
}

// The pixel of the depth at a place in pixels from the middle of what is drawn, y up.
fn pixel_of(place: vec2f) -> vec2i {
    let from_middle = place + middle_px();
    let at = vec2f(from_middle.x, -from_middle.y) + 0.5 * frame.picture_px;
    let size = vec2f(filled_size());
    return clamp(vec2i(floor(at / (frame.picture_px / size))), vec2i(0), vec2i(size) - 1);
}
