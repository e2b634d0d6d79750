// The paths of an object's linked draws: the chains of their layers, element by element.
#import <common/feature.wgsl>
#import <common/mesh.wgsl>
#import <common/stroke_graph.wgsl>
#import <common/link_style.wgsl>

@group(3) @binding(0) var<storage, read_write> header: GraphHeader;
@group(3) @binding(2) var<storage, read_write> elements: array<Element>;
@group(3) @binding(3) var<storage, read_write> joints: array<Joint>;
@group(3) @binding(5) var<storage, read_write> points: array<PathPoint>;
@group(3) @binding(6) var<storage, read_write> strokes: array<Stroke>;
@group(3) @binding(7) var<storage, read_write> ribbons: array<Ribbon>;

// Joints that turn by more than 25 degrees can be corners, which keep their place.
const KEPT_COSINE: f32 = 0.906;

// A path that turns by more than 120 degrees turns back.
const CUSP_COSINE: f32 = -0.5;

// A turn must persist over this many steps to be a corner and not a fold of the mesh.
const FOLD_STEPS: f32 = 4.0;

// The most elements that are read to measure a turn or an average. If edges are hundredths
// of a pixel long, part of the distance is enough.
const MOST_ELEMENTS: u32 = 96u;

// The stroke set that a joint belongs to.
fn set_of(joint: u32) -> u32 {
    var set_index = 0u;
    while set_index + 1u < MAX_STROKE_SETS && joint >= header.set_first[set_index + 1u] {
        set_index++;
    }
    return set_index;
}

// The element that begins at a joint.
fn element_of(joint: u32, set_index: u32) -> u32 {
    return header.layer_first[link_styles[set_index].layer] + joint - header.set_first[set_index];
}

// The previous element, or NONE if the chain begins here or is clipped.
fn before(element: u32) -> u32 {
    let here = elements[element];
    var other = element - 1u;
    if element == here.first {
        if (here.count & ON_LOOP) == 0u {
            return NONE;
        }
        other = here.first + (here.count & ~ON_LOOP) - 1u;
    }
    let is_cut = (here.next & CUT_START) != 0u || (elements[other].next & CUT_END) != 0u;
    return select(other, NONE, is_cut);
}

// The next element, or NONE.
fn behind(element: u32) -> u32 {
    let here = elements[element];
    var other = element + 1u;
    if other == here.first + (here.count & ~ON_LOOP) {
        if (here.count & ON_LOOP) == 0u {
            return NONE;
        }
        other = here.first;
    }
    let is_cut = (here.next & CUT_END) != 0u || (elements[other].next & CUT_START) != 0u;
    return select(other, NONE, is_cut);
}

// The place of a point with its wobble.
fn drawn_place(index: u32) -> vec2f {
    return points[index].position + points[index].offset;
}

fn length_of(element: u32) -> f32 {
    return distance(elements[element].s0, elements[element].s1);
}

// Arc length of a whole chain, in pixels times ARC_PER_PX.
fn chain_arc(element: u32) -> u32 {
    let first = elements[element].first;
    let last = first + (elements[element].count & ~ON_LOOP) - 1u;
    return elements[last].arc - elements[first].arc + u32(round(length_of(last) * ARC_PER_PX));
}

// Pixels between the points of a stroke set's paths; more if the buffer cannot hold all.
fn step_of(set_index: u32) -> f32 {
    let room = f32(header.point_capacity - min(2u * header.joint_count, header.point_capacity));
    let total_px = f32(header.sets_per_layer) * header.total_px;
    return max(link_styles[set_index].step_px, total_px / max(room, 1.0));
}
