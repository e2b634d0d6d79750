// The paths of the linked draws of an object: the chains of their layers, element by
// element.
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

// Joints that turn more than this keep their place: 25 degrees.
const KEPT_COSINE: f32 = 0.906;

// What turns more than this turns back: 120 degrees.
const CUSP_COSINE: f32 = -0.5;

// Corners are told apart from folds of the mesh over so many steps.
const FOLD_STEPS: f32 = 4.0;

// So many elements at most are looked at to measure a turn or an average: where edges
// are hundredths of a pixel, a part of the distance will do.
const MOST_ELEMENTS: u32 = 96u;

// The draw that an element of a path belongs to.
fn set_of(joint: u32) -> u32 {
    var set_index = 0u;
    while set_index + 1u < MAX_STROKE_SETS && joint >= header.set_first[set_index + 1u] {
        set_index++;
    }
    return set_index;
}

// The element of a chain at a place of a path.
fn element_of(joint: u32, set_index: u32) -> u32 {
    return header.layer_first[link_styles[set_index].layer] + joint - header.set_first[set_index];
}

// The element before one, or NONE where its chain begins or is clipped.
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

// The element behind one, or NONE.
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

// Where the line of a point is drawn.
fn drawn_place(index: u32) -> vec2f {
    return points[index].position + points[index].offset;
}

fn length_of(element: u32) -> f32 {
    return distance(elements[element].s0, elements[element].s1);
}

// Arc length of a whole chain, in ARC_PER_PX of a pixel.
fn chain_arc(element: u32) -> u32 {
    let first = elements[element].first;
    let last = first + (elements[element].count & ~ON_LOOP) - 1u;
    return elements[last].arc - elements[first].arc + u32(round(length_of(last) * ARC_PER_PX));
}

// Pixels between the points of a draw's paths: more where there would be no room for
// all of them.
fn step_of(set_index: u32) -> f32 {
    let room = f32(header.point_capacity - min(2u * header.joint_count, header.point_capacity));
    let total_px = f32(header.sets_per_layer) * header.total_px;
    return max(link_styles[set_index].step_px, total_px / max(room, 1.0));
}
