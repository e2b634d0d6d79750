// Finds the edges to draw and lists them in the order of the records: each
// invocation counts the live edges of a run, one workgroup scans the counts,
// each invocation writes its run from its base on.
//
// No racing appends: the list, and with it the picture, is the same every time.
// No barriers over all edges either: software drivers run those slowly, and
// runs that are scanned by one small workgroup need next to none.
#import <common/feature.wgsl>
#import <common/frame.wgsl>
#import <common/mesh.wgsl>

// Edges an invocation looks at. Rust twin: EDGES_PER_RUN in mesh_buffers.rs.
const EDGES_PER_RUN: u32 = 64u;

// The arguments of the indirect draw, and the view's counts. Rust twin: Tally
// in crates/strokes/src/mesh_buffers.rs.
struct Tally {
    vertex_count: u32,
    instance_count: u32,
    first_vertex: u32,
    first_instance: u32,
    contour: atomic<u32>,
    ridge: atomic<u32>,
    valley: atomic<u32>,
    boundary: atomic<u32>,
    marked: atomic<u32>,
    material: atomic<u32>,
    smoothing: atomic<u32>,
}

@group(2) @binding(0) var<uniform> mesh: MeshUniform;
@group(2) @binding(1) var<storage, read> records: array<EdgeRecord>;
@group(2) @binding(2) var<storage, read> facing: array<u32>;
@group(2) @binding(3) var<storage, read_write> runs: array<u32>;
@group(2) @binding(4) var<storage, read_write> live: array<u32>;
@group(2) @binding(5) var<storage, read_write> tally: Tally;

fn looks_at_eye(face: u32) -> bool {
    // A line that is no edge of a face has none that could look anywhere.
    return face != NONE && (facing[face >> 5u] & (1u << (face & 31u))) != 0u;
}

fn line_bits(record: EdgeRecord, is_outside: bool) -> u32 {
    let has_b = record.face_b != NONE;
    let b_faces = looks_at_eye(record.face_b);
    let a_faces = looks_at_eye(record.face_a);
    return classify_edge(record.flags, has_b, a_faces, b_faces, is_outside);
}

// Whether the view's eye lies outside of this mesh's box.
fn is_seen_from_outside() -> bool {
    return eye_is_outside(frame.eye, mesh.box_min.xyz, mesh.box_max.xyz);
}

// The first edge of a run, and the one behind its last.
fn edges_of(run: u32) -> vec2u {
    let first = run * EDGES_PER_RUN;
    return vec2u(first, min(first + EDGES_PER_RUN, mesh.edge_count));
}

@compute @workgroup_size(64)
fn count_runs(@builtin(global_invocation_id) id: vec3u) {
    let run = id.x;
    if run >= mesh.run_count {
        return;
    }
    let edges = edges_of(run);
    let is_outside = is_seen_from_outside();
    var live_count = 0u;
    var contour = 0u;
    var ridge = 0u;
    var valley = 0u;
    var boundary = 0u;
    var marked = 0u;
    var material = 0u;
    var smoothing = 0u;
    for (var edge = edges.x; edge < edges.y; edge++) {
        let record = records[edge];
        let bits = line_bits(record, is_outside);
        live_count += u32((bits & DRAWN) != 0u);
        if (record.flags & NON_MANIFOLD) != 0u {
            continue;
        }
        contour += u32((bits & CONTOUR) != 0u);
        ridge += u32((record.flags & RIDGE) != 0u);
        valley += u32((record.flags & VALLEY) != 0u);
        boundary += u32((record.flags & BOUNDARY) != 0u);
        marked += u32((record.flags & MARKED) != 0u);
        material += u32((record.flags & MATERIAL) != 0u);
        smoothing += u32((record.flags & SMOOTHING) != 0u);
    }
    runs[run] = live_count;
    // Sums of whole numbers: the same in any order.
    if contour > 0u { atomicAdd(&tally.contour, contour); }
    if ridge > 0u { atomicAdd(&tally.ridge, ridge); }
    if valley > 0u { atomicAdd(&tally.valley, valley); }
    if boundary > 0u { atomicAdd(&tally.boundary, boundary); }
    if marked > 0u { atomicAdd(&tally.marked, marked); }
    if material > 0u { atomicAdd(&tally.material, material); }
    if smoothing > 0u { atomicAdd(&tally.smoothing, smoothing); }
}

const SCAN_WIDTH: u32 = 256u;
var<workgroup> sums: array<u32, SCAN_WIDTH>;

// One workgroup: turns the counts into bases, and sets the draw's arguments.
@compute @workgroup_size(SCAN_WIDTH)
fn scan_runs(@builtin(local_invocation_index) lane: u32) {
    let chunk = (mesh.run_count + SCAN_WIDTH - 1u) / SCAN_WIDTH;
    let first = min(lane * chunk, mesh.run_count);
    let last = min(first + chunk, mesh.run_count);
    var sum = 0u;
    for (var run = first; run < last; run++) {
        sum += runs[run];
    }
    sums[lane] = sum;
    workgroupBarrier();
    if lane == 0u {
        var base = 0u;
        for (var other = 0u; other < SCAN_WIDTH; other++) {
            let count = sums[other];
            sums[other] = base;
            base += count;
        }
        tally.vertex_count = 12u;
        tally.instance_count = base;
        tally.first_vertex = 0u;
        tally.first_instance = 0u;
    }
    workgroupBarrier();
    var base = sums[lane];
    for (var run = first; run < last; run++) {
        let count = runs[run];
        runs[run] = base;
        base += count;
    }
}

@compute @workgroup_size(64)
fn write_runs(@builtin(global_invocation_id) id: vec3u) {
    let run = id.x;
    if run >= mesh.run_count {
        return;
    }
    let edges = edges_of(run);
    let is_outside = is_seen_from_outside();
    var place = runs[run];
    for (var edge = edges.x; edge < edges.y; edge++) {
        let bits = line_bits(records[edge], is_outside);
        if (bits & DRAWN) != 0u {
            live[place] = edge | (bits & (CONTOUR | A_FACES));
            place++;
        }
    }
}
