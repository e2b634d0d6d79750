// Orders nodes with successors into chains by pointer jumping (Wyllie 1979): after k rounds,
// each node has searched 4^k steps ahead.
//
// The anchor of an open chain is its last node, that of a loop its smallest node. Every node
// learns its anchor and the steps to it, so one set of rounds finds the chains, the order in
// each, and the place where each loop is cut.
//
//   anchor    tail                    smallest
//   open      a -> b -> c             c: 0 steps, b: 1, a: 2 and no node before it
//   loop      a -> b -> c -> a        a: 0 steps, c: 1, b: 2 = count - 1
//
// After a round in which nothing changed, later rounds only copy. CPU twin, by walking:
// LayerLinks::chains in crates/edgemesh/src/oracle/layer_chain.rs.
// Rejected: two sets of rounds, one to find where loops are cut and one for the order.
#import <common/feature.wgsl>
#import <common/stroke_graph.wgsl>
#import <common/scan.wgsl>

// x is the number of the round, counted from 0.
@group(1) @binding(0) var<uniform> round_number: vec4u;
@group(3) @binding(0) var<storage, read_write> header: GraphHeader;
@group(3) @binding(1) var<storage, read_write> nodes: array<LinkNode>;
@group(3) @binding(2) var<storage, read_write> elements: array<Element>;
// The previous node of each node plus 1, or 0.
@group(3) @binding(3) var<storage, read_write> previous: array<u32>;
@group(3) @binding(5) var<storage, read_write> state: array<ChainState>;
@group(3) @binding(6) var<storage, read_write> next_state: array<ChainState>;
@group(3) @binding(7) var<storage, read_write> chains: array<Chain>;

// Replaces the next edge of each node by its node.
@compute @workgroup_size(GROUP)
fn resolve_links(@builtin(global_invocation_id) id: vec3u) {
    let node = id.x;
    if node >= header.node_count {
        return;
    }
    var layer = 0u;
    while layer + 1u < MAX_LAYERS && node >= header.layer_first[layer + 1u] {
        layer++;
    }
    let word = nodes[node].next;
    let is_contour = (nodes[node].edge & CONTOUR) != 0u;
    let following = find_node(
        word & NO_NODE, is_contour, header.layer_first[layer], header.layer_first[layer + 1u],
    );
    nodes[node].next = (word & ~NO_NODE) | following;
    var first = ChainState(node, node, 0u, 0u);
    if following != NO_NODE {
        previous[following] = node + 1u;
        first = ChainState(following, node | ON_LOOP, 0u, 1u);
    }
    state[node] = first;
}

// The node of an edge, by binary search in a layer, whose nodes are sorted by edge.
// Contours are followed only by contours, other edges only by other edges.
fn find_node(edge: u32, is_contour: bool, first: u32, end: u32) -> u32 {
    if edge == NO_NODE {
        return NO_NODE;
    }
    var low = first;
    var high = end;
    while low < high {
        let middle = (low + high) / 2u;
        if (nodes[middle].edge & EDGE_INDEX_MASK) < edge {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    if low == end || (nodes[low].edge & EDGE_INDEX_MASK) != edge {
        return NO_NODE;
    }
    let follows_contours = (nodes[low].edge & CONTOUR) != 0u;
    return select(NO_NODE, low, follows_contours == is_contour);
}

@compute @workgroup_size(GROUP)
fn jump_chains(@builtin(global_invocation_id) id: vec3u) {
    let node = id.x;
    if node >= header.node_count {
        return;
    }
    var known = state[node];
    let is_done = round_number.x > 0u && atomicLoad(&header.changed[round_number.x - 1u]) == 0u;
    if !is_done {
        let anchor = known.anchor;
        for (var hop = 0u; hop < 3u; hop++) {
            let further = state[known.jump];
            if further.anchor < known.anchor {
                known.anchor = further.anchor;
                known.distance = known.reach + further.distance;
            }
            known.jump = further.jump;
            known.reach += further.reach;
        }
        if known.anchor != anchor {
            atomicStore(&header.changed[round_number.x], 1u);
        }
    }
    next_state[node] = known;
}

// The number of elements of the chain that begins at a node; 0 if none does.
fn chain_length(node: u32) -> u32 {
    let known = state[node];
    if (known.anchor & ON_LOOP) == 0u {
        return select(0u, known.distance + 1u, previous[node] == 0u);
    }
    if (known.anchor & ~ON_LOOP) != node {
        return 0u;
    }
    return state[nodes[node].next & NO_NODE].distance + 1u;
}

@compute @workgroup_size(GROUP)
fn sum_chains(@builtin(global_invocation_id) id: vec3u) {
    let first = id.x * ITEMS_PER_SUM;
    if first >= header.node_count {
        return;
    }
    var sum = vec2u(0u);
    for (var node = first; node < min(first + ITEMS_PER_SUM, header.node_count); node++) {
        let count = chain_length(node);
        sum += vec2u(count, u32(count > 0u));
    }
    sums[id.x] = sum;
}

@compute @workgroup_size(SCAN_WIDTH)
fn scan_chains(@builtin(local_invocation_index) lane: u32) {
    let total = scan_sums(lane, (header.node_count + ITEMS_PER_SUM - 1u) / ITEMS_PER_SUM);
    if lane == 0u {
        header.chain_count = total.y;
    }
}

@compute @workgroup_size(GROUP)
fn place_chains(@builtin(global_invocation_id) id: vec3u) {
    let first = id.x * ITEMS_PER_SUM;
    if first >= header.node_count {
        return;
    }
    var base = sums[id.x].x;
    for (var node = first; node < min(first + ITEMS_PER_SUM, header.node_count); node++) {
        let count = chain_length(node);
        if count > 0u {
            chains[state[node].anchor & ~ON_LOOP] = Chain(base, count);
            base += count;
        }
    }
}

@compute @workgroup_size(GROUP)
fn place_elements(@builtin(global_invocation_id) id: vec3u) {
    let node = id.x;
    if node >= header.node_count {
        return;
    }
    let known = state[node];
    let on_loop = known.anchor & ON_LOOP;
    let chain = chains[known.anchor & ~ON_LOOP];
    var rank = chain.count - 1u - known.distance;
    if on_loop != 0u {
        rank = select(chain.count - known.distance, 0u, known.distance == 0u);
    }
    let linked = nodes[node];
    elements[chain.first + rank] = Element(
        linked.s0, linked.s1, linked.z0, linked.z1, linked.edge, linked.next,
        chain.first, chain.count | on_loop, 0u, node,
    );
}

// In pixels times ARC_PER_PX; 0 if the element is clipped as a whole.
fn arc_length(element: u32) -> u32 {
    return u32(round(distance(elements[element].s0, elements[element].s1) * ARC_PER_PX));
}

@compute @workgroup_size(GROUP)
fn sum_arcs(@builtin(global_invocation_id) id: vec3u) {
    let first = id.x * ITEMS_PER_SUM;
    if first >= header.node_count {
        return;
    }
    var sum = 0u;
    for (var at = first; at < min(first + ITEMS_PER_SUM, header.node_count); at++) {
        sum += arc_length(at);
    }
    sums[id.x] = vec2u(sum, sum / u32(ARC_PER_PX));
}

@compute @workgroup_size(SCAN_WIDTH)
fn scan_arcs(@builtin(local_invocation_index) lane: u32) {
    let total = scan_sums(lane, (header.node_count + ITEMS_PER_SUM - 1u) / ITEMS_PER_SUM);
    if lane == 0u {
        header.total_px = f32(total.y);
    }
}

@compute @workgroup_size(GROUP)
fn write_arcs(@builtin(global_invocation_id) id: vec3u) {
    let first = id.x * ITEMS_PER_SUM;
    if first >= header.node_count {
        return;
    }
    var arc = sums[id.x].x;
    for (var at = first; at < min(first + ITEMS_PER_SUM, header.node_count); at++) {
        elements[at].arc = arc;
        arc += arc_length(at);
    }
}
