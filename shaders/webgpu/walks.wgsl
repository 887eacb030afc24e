// Writes the adjacency for kernels of the caller: the twins without flags, and for each vertex the half-edge at which a
// walk around it begins: of those that start there, the smallest without a twin, else the smallest.
#import mesh

const WORKGROUP_SIZE: u32 = 256u;

@group(0) @binding(0) var<storage, read> triangles: array<u32>;
@group(0) @binding(1) var<storage, read> entries: array<u32>;
@group(0) @binding(2) var<storage, read_write> twins: array<u32>;
// First zeros, then the complement of the smallest half-edge, where LOCKED marks those with a twin.
@group(0) @binding(3) var<storage, read_write> starts: array<atomic<u32>>;

@compute @workgroup_size(WORKGROUP_SIZE)
fn find_starts(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var h = id.x; h < arrayLength(&twins); h += groups.x * WORKGROUP_SIZE) {
        let other = unflagged(entries[h]);
        twins[h] = other;
        atomicMax(&starts[triangles[h]], ~select(h | LOCKED, h, other == NONE));
    }
}

@compute @workgroup_size(WORKGROUP_SIZE)
fn name_starts(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var v = id.x; v < arrayLength(&starts); v += groups.x * WORKGROUP_SIZE) {
        atomicStore(&starts[v], unflagged(~atomicLoad(&starts[v])));
    }
}
