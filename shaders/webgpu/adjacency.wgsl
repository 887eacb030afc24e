// Finds the twins from the triangles, as src/mesh/adjacency.rs, by buckets: counts the half-edges of each bucket,
// allocates, scatters, matches. Then finds out whether vertices have several fans. The order within a bucket depends on
// the device; no result depends on it.
#import mesh

const WORKGROUP_SIZE: u32 = 256u;
// Buckets that one invocation of `allocate` sums.
const BUCKETS_EACH: u32 = 8u;

// Words of `counters`.
const ALLOCATED: u32 = 0u;
const EDGES: u32 = 1u;
const BOUNDARY: u32 = 2u;
const NON_MANIFOLD: u32 = 3u;
const INCONSISTENT: u32 = 4u;
const SEVERAL_FANS: u32 = 5u;
const MOST_CORNERS: u32 = 6u;

struct Params {
    half_edges: u32,
    vertices: u32,
    // A multiple of 256, at least the number of vertices.
    buckets: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> triangles: array<u32>;
@group(0) @binding(2) var<storage, read_write> twins: array<u32>;
// Half-edges by bucket.
@group(0) @binding(3) var<storage, read_write> sorted: array<u32>;
// The number of half-edges of each bucket, then the index for its next half-edge. For the fans: the number of corners
// of each vertex, then one of them.
@group(0) @binding(4) var<storage, read_write> buckets: array<atomic<u32>>;
@group(0) @binding(5) var<storage, read_write> counters: array<atomic<u32>>;

var<workgroup> sums: array<u32, WORKGROUP_SIZE>;
var<workgroup> base: u32;
var<workgroup> kinds: array<atomic<u32>, 6>;
var<workgroup> most_corners: atomic<u32>;

fn ends(h: u32) -> vec2u {
    let u = triangles[h];
    let v = triangles[next(h)];
    return vec2u(min(u, v), max(u, v));
}

// By the smaller vertex. Its half-edges are spread over 256 buckets, so that a vertex with many triangles does not fill
// a single one.
fn bucket_of(ends: vec2u) -> u32 {
    let hash = (ends.y * 0x9e3779b9u) >> 24u;
    return (ends.x & ~255u) | ((ends.x + hash) & 255u);
}

@compute @workgroup_size(WORKGROUP_SIZE)
fn count(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var h = id.x; h < params.half_edges; h += groups.x * WORKGROUP_SIZE) {
        atomicAdd(&buckets[bucket_of(ends(h))], 1u);
    }
}

// Gives each bucket its range in `sorted`. A workgroup allocates the ranges of all its buckets with one atomic
// addition.
@compute @workgroup_size(WORKGROUP_SIZE)
fn allocate(
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) local: u32,
    @builtin(num_workgroups) groups: vec3u,
) {
    let each = WORKGROUP_SIZE * BUCKETS_EACH;
    for (var start = group.x * each; start < params.buckets; start += groups.x * each) {
        let first = start + local * BUCKETS_EACH;
        var sum = 0u;
        for (var b = first; b < min(first + BUCKETS_EACH, params.buckets); b++) {
            sum += atomicLoad(&buckets[b]);
        }
        sums[local] = sum;
        workgroupBarrier();
        for (var reach = 1u; reach < WORKGROUP_SIZE; reach *= 2u) {
            let before = select(0u, sums[max(local, reach) - reach], local >= reach);
            workgroupBarrier();
            sums[local] += before;
            workgroupBarrier();
        }
        if local == WORKGROUP_SIZE - 1u {
            base = atomicAdd(&counters[ALLOCATED], sums[local]);
        }
        workgroupBarrier();
        var at = base + sums[local] - sum;
        for (var b = first; b < min(first + BUCKETS_EACH, params.buckets); b++) {
            atomicStore(&buckets[params.buckets + b], at);
            at += atomicLoad(&buckets[b]);
        }
        workgroupBarrier();
    }
}

@compute @workgroup_size(WORKGROUP_SIZE)
fn scatter(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var h = id.x; h < params.half_edges; h += groups.x * WORKGROUP_SIZE) {
        sorted[atomicAdd(&buckets[params.buckets + bucket_of(ends(h))], 1u)] = h;
    }
}

@compute @workgroup_size(WORKGROUP_SIZE)
fn match_twins(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(local_invocation_index) local: u32,
    @builtin(num_workgroups) groups: vec3u,
) {
    // In the order of the buckets, so that the half-edges of a bucket are read together.
    for (var index = id.x; index < params.half_edges; index += groups.x * WORKGROUP_SIZE) {
        let h = sorted[index];
        let mine = ends(h);
        let bucket = bucket_of(mine);
        // The scatter has moved this index to the end of the bucket.
        let end = atomicLoad(&buckets[params.buckets + bucket]);
        var others = 0u;
        var other = NONE;
        var is_first = true;
        for (var i = end - atomicLoad(&buckets[bucket]); i < end; i++) {
            let x = sorted[i];
            if x != h && all(ends(x) == mine) {
                others++;
                other = x;
                is_first = is_first && h < x;
            }
        }
        var kind = BOUNDARY;
        var twin = NONE;
        if others == 1u && other / 3u != h / 3u {
            if triangles[other] == triangles[h] {
                kind = INCONSISTENT;
            } else {
                kind = EDGES;
                twin = other;
            }
        } else if others > 0u {
            kind = NON_MANIFOLD;
        }
        twins[h] = twin;
        if is_first {
            atomicAdd(&kinds[EDGES], 1u);
            if kind != EDGES {
                atomicAdd(&kinds[kind], 1u);
            }
        }
    }
    add_kinds(local);
}

// Counts the corners of each vertex, and stores one of them, the last that the device writes. `buckets` must be zero.
@compute @workgroup_size(WORKGROUP_SIZE)
fn count_corners(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var h = id.x; h < params.half_edges; h += groups.x * WORKGROUP_SIZE) {
        let v = triangles[h];
        atomicAdd(&buckets[v], 1u);
        atomicStore(&buckets[params.buckets + v], h);
    }
}

// Counts the vertices that have several fans, and finds the most corners at one vertex.
@compute @workgroup_size(WORKGROUP_SIZE)
fn count_fans(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(local_invocation_index) local: u32,
    @builtin(num_workgroups) groups: vec3u,
) {
    for (var v = id.x; v < params.vertices; v += groups.x * WORKGROUP_SIZE) {
        let corners = atomicLoad(&buckets[v]);
        atomicMax(&most_corners, corners);
        if corners > 1u && fan_length(atomicLoad(&buckets[params.buckets + v])) < corners {
            atomicAdd(&kinds[SEVERAL_FANS], 1u);
        }
    }
    add_kinds(local);
    if local == 0u {
        atomicMax(&counters[MOST_CORNERS], atomicLoad(&most_corners));
    }
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

fn add_kinds(local: u32) {
    workgroupBarrier();
    if local < 6u {
        let count = atomicLoad(&kinds[local]);
        if count > 0u {
            atomicAdd(&counters[local], count);
        }
    }
}
