// The first node of each layer of each chunk, and the workgroup counts of the passes that
// follow. One invocation is enough, because layers and chunks are few.
#import <common/view_runs.wgsl>
#import <common/stroke_graph.wgsl>

@group(1) @binding(0) var<uniform> graph: GraphUniform;
@group(3) @binding(0) var<storage, read_write> header: GraphHeader;
@group(3) @binding(1) var<storage, read_write> tallies: array<Tally>;
// The most nodes of each chunk; then the first node of each layer, chunk by chunk.
@group(3) @binding(2) var<storage, read_write> bases: array<u32>;
@group(3) @binding(3) var<storage, read_write> arguments: array<u32>;

@compute @workgroup_size(1)
fn link_bases() {
    var nodes = 0u;
    for (var layer = 0u; layer <= MAX_LAYERS; layer++) {
        header.layer_first[layer] = nodes;
        if layer == MAX_LAYERS {
            break;
        }
        for (var chunk = 0u; chunk < graph.chunk_count; chunk++) {
            let most = bases[chunk];
            let first = min(tallies[chunk].layer_first[layer], most);
            let end = min(tallies[chunk].layer_first[layer + 1u], most);
            bases[graph.chunk_count + (MAX_LAYERS + 1u) * chunk + layer] = nodes;
            nodes += end - first;
        }
    }
    for (var chunk = 0u; chunk < graph.chunk_count; chunk++) {
        let count = min(tallies[chunk].layer_first[MAX_LAYERS], bases[chunk]);
        set_groups(CHUNK_GROUPS + 3u * chunk, count, GROUP);
    }
    var joint_count = 0u;
    for (var set_index = 0u; set_index <= MAX_STROKE_SETS; set_index++) {
        header.set_first[set_index] = joint_count;
        if set_index < graph.set_count && graph.sets[set_index].is_linked != 0u {
            let layer = graph.sets[set_index].layer;
            joint_count += header.layer_first[layer + 1u] - header.layer_first[layer];
            joint_count = min(joint_count, graph.joint_capacity);
        }
    }
    header.node_count = nodes;
    header.joint_count = joint_count;
    header.point_capacity = graph.point_capacity;
    header.sets_per_layer = graph.sets_per_layer;
    for (var round = 0u; round < MAX_LINK_ROUNDS; round++) {
        atomicStore(&header.changed[round], 0u);
    }
    set_groups(NODE_GROUPS, nodes, GROUP);
    set_groups(NODE_SUM_GROUPS, nodes, GROUP * ITEMS_PER_SUM);
    set_groups(JOINT_GROUPS, joint_count, GROUP);
    set_groups(JOINT_SUM_GROUPS, joint_count, GROUP * ITEMS_PER_SUM);
}

fn set_groups(at: u32, count: u32, per_group: u32) {
    arguments[at] = (count + per_group - 1u) / per_group;
    arguments[at + 1u] = 1u;
    arguments[at + 2u] = 1u;
}
