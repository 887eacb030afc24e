// Finds the twins from the triangles, as src/mesh/adjacency.rs, with a hash table of edges. Then finds out whether
// vertices have several fans. Where an edge is in the table depends on the device; no result depends on it.
#import mesh

const WORKGROUP_SIZE: u32 = 256u;

// Words of `counters`.
const EDGES: u32 = 0u;
const BOUNDARY: u32 = 1u;
const NON_MANIFOLD: u32 = 2u;
const INCONSISTENT: u32 = 3u;
// Corners that are in another fan of their vertex than the one that was walked.
const UNWALKED: u32 = 4u;
const COUNTERS: u32 = 5u;

struct Params {
    half_edges: u32,
    vertices: u32,
    // Words of the table: more than there are edges.
    slots: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> triangles: array<u32>;
@group(0) @binding(2) var<storage, read_write> twins: array<u32>;
// For each vertex 1 plus one of the half-edges that start at it, the last that the device writes; 0 if there is none.
@group(0) @binding(3) var<storage, read_write> corners: array<atomic<u32>>;
// For each edge 1 plus its first half-edge, in the order of the device, and its state in the two highest bits. An empty
// slot is 0.
@group(0) @binding(4) var<storage, read_write> table: array<atomic<u32>>;
@group(0) @binding(5) var<storage, read_write> counters: array<atomic<u32>>;

// States of an edge.
const SINGLE: u32 = 0u;
const PAIRED: u32 = 1u;
const SAME_DIRECTION: u32 = 2u;
// Three half-edges or more, or two in one triangle.
const MANY: u32 = 3u;
const STATE_BIT: u32 = 30u;

var<workgroup> sums: array<atomic<u32>, COUNTERS>;

fn ends(h: u32) -> vec2u {
    let u = triangles[h];
    let v = triangles[next(h)];
    return vec2u(min(u, v), max(u, v));
}

// Whether the triangle of `h` has another half-edge between the same vertices.
fn is_folded(h: u32) -> bool {
    let apex = triangles[prev(h)];
    return apex == triangles[h] || apex == triangles[next(h)];
}

// Slots that follow each other are tried first, so many; then others.
const NEAR: u32 = 8u;

// The slot of an edge at a try. The first slot is in the part of the table that belongs to the smaller vertex, so that
// neighbours are near each other. A vertex with many triangles fills its part; its other edges are all over the table.
fn slot_of(ends: vec2u, count: u32) -> u32 {
    let hash = ends.y * 0x9e3779b9u;
    let part = params.slots / params.vertices;
    var slot = part * ends.x + (((hash >> 16u) * min(part, 0xffffu)) >> 16u) + count;
    if count >= NEAR || part == 0u {
        var x = (ends.x * 0x85ebca6bu) ^ hash ^ (count * 0xc2b2ae35u);
        x = (x ^ (x >> 16u)) * 0x7feb352du;
        slot = x ^ (x >> 15u);
    }
    return slot % params.slots;
}

fn half_edge_in(word: u32) -> u32 {
    return (word & ~(MANY << STATE_BIT)) - 1u;
}

@compute @workgroup_size(WORKGROUP_SIZE)
fn clear(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var h = id.x; h < params.half_edges; h += groups.x * WORKGROUP_SIZE) {
        twins[h] = NONE;
    }
}

// Brings each half-edge into the table. The second half-edge of an edge writes the twins of both.
@compute @workgroup_size(WORKGROUP_SIZE)
fn match_twins(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(local_invocation_index) local: u32,
    @builtin(num_workgroups) groups: vec3u,
) {
    // Edges, then those in each state.
    var found = array<u32, 5>();
    for (var h = id.x; h < params.half_edges; h += groups.x * WORKGROUP_SIZE) {
        atomicStore(&corners[triangles[h]], h + 1u);
        let mine = ends(h);
        let folded = is_folded(h);
        var count = 0u;
        var slot = slot_of(mine, count);
        var word = atomicLoad(&table[slot]);
        loop {
            let state = word >> STATE_BIT;
            let other = half_edge_in(word);
            var next_state = select(SINGLE, MANY, folded);
            var next_word = h + 1u;
            if word != 0u {
                if any(ends(other) != mine) {
                    count++;
                    slot = slot_of(mine, count);
                    word = atomicLoad(&table[slot]);
                    continue;
                }
                if state == MANY {
                    break;
                }
                let pair = select(PAIRED, SAME_DIRECTION, triangles[other] == triangles[h]);
                next_state = select(pair, MANY, folded || state != SINGLE);
                next_word = other + 1u;
            }
            let exchange = atomicCompareExchangeWeak(&table[slot], word, next_word | (next_state << STATE_BIT));
            if exchange.exchanged {
                if word == 0u {
                    found[0]++;
                } else {
                    found[1u + state]--;
                }
                found[1u + next_state]++;
                if next_state == PAIRED {
                    twins[h] = other;
                    twins[other] = h;
                }
                break;
            }
            word = exchange.old_value;
        }
    }
    atomicAdd(&sums[EDGES], found[0]);
    atomicAdd(&sums[BOUNDARY], found[1u + SINGLE]);
    atomicAdd(&sums[NON_MANIFOLD], found[1u + MANY]);
    atomicAdd(&sums[INCONSISTENT], found[1u + SAME_DIRECTION]);
    add_sums(local);
}

// Takes back the twins of edges that got a third half-edge.
@compute @workgroup_size(WORKGROUP_SIZE)
fn part_many(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    if atomicLoad(&counters[NON_MANIFOLD]) > 0u {
        for (var h = id.x; h < params.half_edges; h += groups.x * WORKGROUP_SIZE) {
            if twins[h] != NONE && state_of(ends(h)) == MANY {
                twins[h] = NONE;
            }
        }
    }
}

// The state of an edge that is in the table.
fn state_of(mine: vec2u) -> u32 {
    var count = 0u;
    var word = atomicLoad(&table[slot_of(mine, count)]);
    while any(ends(half_edge_in(word)) != mine) {
        count++;
        word = atomicLoad(&table[slot_of(mine, count)]);
    }
    return word >> STATE_BIT;
}

// Walks one fan of each vertex.
@compute @workgroup_size(WORKGROUP_SIZE)
fn walk_fans(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(local_invocation_index) local: u32,
    @builtin(num_workgroups) groups: vec3u,
) {
    var unwalked = select(0u, params.half_edges, id.x == 0u);
    for (var v = id.x; v < params.vertices; v += groups.x * WORKGROUP_SIZE) {
        let corner = atomicLoad(&corners[v]);
        if corner > 0u {
            unwalked -= fan_length(corner - 1u);
        }
    }
    atomicAdd(&sums[UNWALKED], unwalked);
    add_sums(local);
}

// Corners of the fan that `start` belongs to.
fn fan_length(start: u32) -> u32 {
    var corners = 1u;
    var at = twins[prev(start)];
    while at != NONE && at != start {
        corners++;
        at = twins[prev(at)];
    }
    if at == start {
        return corners;
    }
    at = twins[start];
    while at != NONE {
        corners++;
        at = twins[next(at)];
    }
    return corners;
}

fn add_sums(local: u32) {
    workgroupBarrier();
    if local < COUNTERS {
        let sum = atomicLoad(&sums[local]);
        if sum > 0u {
            atomicAdd(&counters[local], sum);
        }
    }
}
