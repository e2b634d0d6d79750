// Makes each live edge of a chunk a node of the stroke graph: projected, in the direction of
// its chain, with the edge that follows it.
//
// The successor of a contour is the next contour in the fan of front faces around its end;
// other edges follow the chains of the preprocessor. CPU twins: successor in
// crates/edgemesh/src/oracle/contour_chain.rs, following in layer_chain.rs.
#import <common/edge_source.wgsl>
#import <common/view_runs.wgsl>
#import <common/stroke_graph.wgsl>

// Rust twins: the constants of these names in crates/strokes/src/mesh/link_table.rs.
const SURFACE_END: u32 = 0xffffffffu;
const SURFACE_CUT: u32 = 0xfffffffeu;
const REVERSED: u32 = 0x80000000u;

@group(1) @binding(0) var<uniform> graph: GraphUniform;
@group(3) @binding(0) var<storage, read> live: array<u32>;
@group(3) @binding(1) var<storage, read> runs: array<RunState>;
// Three words per edge: the next half-edge of each of its two, and its successor in the
// preprocessor's chain; see link_table.rs.
@group(3) @binding(2) var<storage, read> links: array<u32>;
@group(3) @binding(3) var<storage, read_write> tallies: array<Tally>;
@group(3) @binding(4) var<storage, read> bases: array<u32>;
@group(3) @binding(5) var<storage, read_write> nodes: array<LinkNode>;

@compute @workgroup_size(GROUP)
fn link_elements(@builtin(global_invocation_id) id: vec3u) {
    let slot = id.x;
    let chunk_count = arrayLength(&tallies);
    let count = min(tallies[chunk.chunk_index].layer_first[MAX_LAYERS], chunk.node_capacity);
    if slot >= count {
        return;
    }
    var layer = 0u;
    while layer + 1u < MAX_LAYERS
        && slot >= tallies[chunk.chunk_index].layer_first[layer + 1u] {
        layer++;
    }
    let base = bases[chunk_count + (MAX_LAYERS + 1u) * chunk.chunk_index + layer];
    let entry = live[slot] & select(~CONTOUR, 0xffffffffu, graph.draws_contours != 0u);
    let edge = entry & EDGE_INDEX_MASK;
    nodes[base + slot - tallies[chunk.chunk_index].layer_first[layer]] = link_node(entry, edge);
}

fn link_node(entry: u32, edge: u32) -> LinkNode {
    let is_contour = (entry & CONTOUR) != 0u;
    let a_faces = (entry & A_FACES) != 0u;
    let chain = links[3u * edge + 2u];
    var following = chain & NO_NODE;
    var is_reversed = (chain & REVERSED) != 0u;
    if is_contour {
        // The front face must be on the left; face A is on the left of v0 to v1.
        following = next_contour(2u * edge + select(1u, 0u, a_faces));
        is_reversed = !a_faces;
    }
    let ends = edge_ends(edge);
    var c0 = object.clip_from_object * vec4f(ends[0], 1.0);
    var c1 = object.clip_from_object * vec4f(ends[1], 1.0);
    if is_reversed {
        let last = c0;
        c0 = c1;
        c1 = last;
    }
    let spine = project_spine(c0, c1, frame.viewport_px, frame.guard_band);
    let is_culled = spine.t0 >= spine.t1;
    return LinkNode(
        spine.s0,
        spine.s1,
        spine.z0,
        spine.z1,
        mesh_edge(edge)
            | (entry & (CONTOUR | BEHIND_SOLID))
            // A contour in a groove of a surface that has an outside is hidden by one of its
            // own faces.
            | select(
                0u,
                BEHIND_SOLID,
                is_contour && object.eye_is_outside != 0u && (edge_word(edge) & GROOVE) != 0u,
            )
            | select(0u, BACKWARD, is_reversed),
        following
            | select(0u, CUT_WHOLE, is_culled)
            | select(0u, CUT_START, is_culled || spine.t0 > 0.0)
            | select(0u, CUT_END, is_culled || spine.t1 < 1.0),
    );
}

// The contour that follows the one with this half-edge, or NO_NODE.
fn next_contour(half_edge: u32) -> u32 {
    var at = link_of(half_edge);
    // A walk meets each half-edge at most once.
    for (var step = 0u; step < arrayLength(&links) && at < SURFACE_CUT; step++) {
        let edge = mesh_edge(at >> 1u);
        let contour = runs[edge / EDGES_PER_RUN].contour;
        let bit = edge % EDGES_PER_RUN;
        if ((select(contour.x, contour.y, bit >= 32u) >> (bit & 31u)) & 1u) != 0u {
            return edge;
        }
        at = link_of(at ^ 1u);
    }
    return NO_NODE;
}

fn link_of(half_edge: u32) -> u32 {
    return links[3u * (half_edge >> 1u) + (half_edge & 1u)];
}

// The index in the mesh of an edge of the chunk, or of its rim.
fn mesh_edge(edge: u32) -> u32 {
    if edge < chunk.edge_count {
        return chunk.first_run * EDGES_PER_RUN + edge;
    }
    return links[3u * edge + 2u];
}
