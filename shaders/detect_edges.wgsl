// Finds the edges to draw and lists them by layer, then by record: each invocation
// marks and counts the live edges of a run, one workgroup scans the counts, and each
// invocation writes its run.
//
// A view looks only for contours: the edges that are drawn in every view are found once
// (find_static), and runs whose faces all face one way are skipped.
//
// Rejected: appending with atomics, which changes the order of the list and with it the
// picture. Rejected: barriers over all edges, which are slow on software drivers.
#import <common/edge_faces.wgsl>
#import <common/frame.wgsl>
#import <common/normal_cone.wgsl>
#import <common/draw_arguments.wgsl>
#import <common/view_runs.wgsl>

// Rust twin: DetectUniform in crates/strokes/src/view/detect.rs.
struct DetectUniform {
    classes: ClassTable,
    layer_count: u32,
    set_count: u32,
    padding: vec2u,
    sets: array<DetectedSet, MAX_STROKE_SETS>,
}

// A stroke set, as detection needs it.
struct DetectedSet {
    layer: u32,
    indices_per_edge: u32,
    // 1 if its strokes are drawn from the live list and never expanded.
    is_listed: u32,
    // 1 if its strokes are linked.
    is_linked: u32,
}

@group(1) @binding(0) var<uniform> detect: DetectUniform;
@group(2) @binding(6) var<storage, read> run_cones: array<NormalCone>;
// The runs of all chunks, one chunk after another; `tallies` has one element per chunk.
@group(3) @binding(1) var<storage, read_write> runs: array<RunState>;
// Live edges of each run, layer by layer; after scan_runs, their places in the list.
@group(3) @binding(2) var<storage, read_write> counts: array<u32>;
@group(3) @binding(3) var<storage, read_write> live: array<u32>;
@group(3) @binding(4) var<storage, read_write> tallies: array<Tally>;
@group(3) @binding(5) var<storage, read_write> draws: array<DrawArguments, MAX_STROKE_SETS>;

fn line_of(edge: u32) -> Line {
    let faces = edge_faces(edge);
    return classify_edge(edge_word(edge), faces, detect.classes, object.eye_is_outside != 0u);
}

// The first edge of a run, and the one after its last.
fn edges_of(run: u32) -> vec2u {
    let first = run * EDGES_PER_RUN;
    return vec2u(first, min(first + EDGES_PER_RUN, chunk.edge_count));
}

// The bit of edge k of a run.
fn bit_of(k: u32) -> vec2u {
    return select(vec2u(0u, 1u << (k & 31u)), vec2u(1u << k, 0u), k < 32u);
}

// Finds the edges that are drawn in every view. Runs once, and again when the classes or
// thresholds change.
@compute @workgroup_size(64)
fn find_static(@builtin(global_invocation_id) id: vec3u) {
    let run = id.x;
    if run >= chunk.run_count {
        return;
    }
    let edges = edges_of(run);
    let table = detect.classes;
    var state = RunState();
    var counts_of_run = array<u32, LINE_CLASS_COUNT>();
    for (var edge = edges.x; edge < edges.y; edge++) {
        let word = edge_word(edge);
        let bit = bit_of(edge - edges.x);
        let classes = static_classes(word, table);
        if (classes & table.drawn) != 0u {
            state.static_edges |= bit;
            state.solid |= select(vec2u(0u), bit, (word & SOLID) != 0u);
        }
        state.has_clash |= select(0u, 1u, (word & CLASH) != 0u);
        if (word & (NON_MANIFOLD | PAIRED)) != 0u {
            continue;
        }
        for (var class_index = 0u; class_index < LINE_CLASS_COUNT; class_index++) {
            counts_of_run[class_index] += (classes >> class_index) & 1u;
        }
    }
    runs[chunk.first_run + run] = state;
    // Sums of integers are the same in any order.
    for (var class_index = 0u; class_index < LINE_CLASS_COUNT; class_index++) {
        let count = counts_of_run[class_index];
        if count > 0u {
            atomicAdd(&tallies[chunk.chunk_index].features[class_index], count);
        }
    }
}

@compute @workgroup_size(64)
fn count_runs(@builtin(global_invocation_id) id: vec3u) {
    let run = id.x;
    if run >= chunk.run_count {
        return;
    }
    let at = chunk.first_run + run;
    var bits = LiveBits(runs[at].static_edges, vec2u(0u));
    let whole = cone_facing(run_cones[run], object.eye);
    if whole == MIXED || runs[at].has_clash != 0u {
        bits = look_at_each(run);
    } else if whole == ALL_AWAY && object.eye_is_outside != 0u && detect.classes.keeps_hidden == 0u {
        bits.live &= ~runs[at].solid;
    }
    let live_bits = bits.live;
    runs[at].live = live_bits;
    runs[at].contour = bits.contour;
    if detect.layer_count == 1u {
        counts[run] = countOneBits(live_bits.x) + countOneBits(live_bits.y);
    } else {
        count_layers(run, live_bits);
    }
}

struct LiveBits {
    live: vec2u,
    contour: vec2u,
}

// The live edges of a run that can have contours, one bit each.
fn look_at_each(run: u32) -> LiveBits {
    let edges = edges_of(run);
    var found = LiveBits();
    var contour = 0u;
    for (var edge = edges.x; edge < edges.y; edge++) {
        let bits = line_of(edge).bits;
        let bit = bit_of(edge - edges.x);
        found.live |= select(vec2u(0u), bit, (bits & DRAWN) != 0u);
        if (bits & CONTOUR) != 0u {
            found.contour |= bit;
            contour += select(0u, 1u, (edge_word(edge) & PAIRED) == 0u);
        }
    }
    if contour > 0u { atomicAdd(&tallies[chunk.chunk_index].features[CLASS_CONTOUR], contour); }
    return found;
}

fn count_layers(run: u32, live_bits: vec2u) {
    var of_layer = array<u32, MAX_LAYERS>();
    for (var half = 0u; half < 2u; half++) {
        var rest = live_bits[half];
        while rest != 0u {
            let edge = run * EDGES_PER_RUN + 32u * half + countTrailingZeros(rest);
            of_layer[min(line_of(edge).layer, MAX_LAYERS - 1u)] += 1u;
            rest &= rest - 1u;
        }
    }
    for (var layer = 0u; layer < detect.layer_count; layer++) {
        counts[layer * chunk.run_count + run] = of_layer[layer];
    }
}

const SCAN_WIDTH: u32 = 256u;
var<workgroup> sums: array<u32, SCAN_WIDTH>;

// One workgroup: replaces the counts by places in the list, and sets the draw arguments.
@compute @workgroup_size(SCAN_WIDTH)
fn scan_runs(@builtin(local_invocation_index) lane: u32) {
    let size = detect.layer_count * chunk.run_count;
    let part = (size + SCAN_WIDTH - 1u) / SCAN_WIDTH;
    let first = min(lane * part, size);
    let last = min(first + part, size);
    var sum = 0u;
    for (var at = first; at < last; at++) {
        sum += counts[at];
    }
    sums[lane] = sum;
    workgroupBarrier();
    if lane == 0u {
        var total = 0u;
        for (var other = 0u; other < SCAN_WIDTH; other++) {
            let count = sums[other];
            sums[other] = total;
            total += count;
        }
        tallies[chunk.chunk_index].stroke_count = total;
    }
    workgroupBarrier();
    var base = sums[lane];
    for (var at = first; at < last; at++) {
        let count = counts[at];
        counts[at] = base;
        base += count;
    }
    storageBarrier();
    if lane < detect.set_count {
        set_arguments(lane);
    }
    if lane <= MAX_LAYERS {
        tallies[chunk.chunk_index].layer_first[lane] = first_of(lane);
    }
}

// Where the edges of a layer begin in the list.
fn first_of(layer: u32) -> u32 {
    if layer >= detect.layer_count {
        return tallies[chunk.chunk_index].stroke_count;
    }
    return counts[layer * chunk.run_count];
}

const EXPAND_WIDTH: u32 = 64u;

fn set_arguments(set_index: u32) {
    let stroke_set = detect.sets[set_index];
    let first = first_of(stroke_set.layer);
    let count = first_of(stroke_set.layer + 1u) - first;
    let expanded = select(min(count, chunk.capacity), 0u, stroke_set.is_listed != 0u);
    // Linked edges are not drawn one by one.
    let linked = min(first + count, chunk.node_capacity) - min(first, chunk.node_capacity);
    let done = select(expanded, linked, stroke_set.is_linked != 0u);
    let indices_per_edge = stroke_set.indices_per_edge;
    draws[set_index] = DrawArguments(
        indices_per_edge * expanded, 1u, 0u, 0u, 0u,
        (expanded + EXPAND_WIDTH - 1u) / EXPAND_WIDTH, 1u, 1u,
        indices_per_edge * (count - done), 1u, indices_per_edge * done, 0u,
        first, expanded, vec2u(0u),
    );
}

@compute @workgroup_size(64)
fn write_runs(@builtin(global_invocation_id) id: vec3u) {
    let run = id.x;
    if run >= chunk.run_count {
        return;
    }
    var place = array<u32, MAX_LAYERS>();
    for (var layer = 0u; layer < detect.layer_count; layer++) {
        place[layer] = counts[layer * chunk.run_count + run];
    }
    let live_bits = runs[chunk.first_run + run].live;
    for (var half = 0u; half < 2u; half++) {
        var rest = live_bits[half];
        while rest != 0u {
            let edge = run * EDGES_PER_RUN + 32u * half + countTrailingZeros(rest);
            let line = line_of(edge);
            let layer = min(line.layer, MAX_LAYERS - 1u);
            live[place[layer]] = edge | (line.bits & ~(DRAWN | EDGE_INDEX_MASK));
            place[layer] += 1u;
            rest &= rest - 1u;
        }
    }
}
