// The history of a run on the GPU, without a read-back. Each iteration is stored as offsets into the indices, and the
// old value xor the new value at each offset. Applying it redoes or undoes the iteration.

@group(0) @binding(0) var<storage, read> newest: array<u32>;
@group(0) @binding(1) var<storage, read_write> shown: array<u32>;
@group(0) @binding(2) var<storage, read_write> changes: array<vec2u>;
@group(0) @binding(3) var<storage, read_write> count: atomic<u32>;

const SIZE = 256u;
// The number of the state in `EDGE_STATES`.
const FLIPS = 1u;

// Stores the change from `shown` to `newest`. The order of the entries does not matter, because their offsets differ.
@compute @workgroup_size(SIZE)
fn record(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var i = id.x; i < arrayLength(&newest); i += groups.x * SIZE) {
        let difference = newest[i] ^ shown[i];
        if difference != 0u {
            changes[atomicAdd(&count, 1u)] = vec2u(i, difference);
            shown[i] ^= difference;
        }
    }
}

// Applies a change. Unused entries are zeros and change nothing.
@compute @workgroup_size(SIZE)
fn apply(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var k = id.x; k < arrayLength(&changes); k += groups.x * SIZE) {
        let change = changes[k];
        if change.y != 0u {
            shown[change.x] ^= change.y;
        }
    }
}

// Writes the sides that a change flips to the binding of `shown`: an entry for each triangle, with the state of side k
// from bit 4k. `count` is the corner at which the side begins, counted from the corner that changes.
@compute @workgroup_size(SIZE)
fn mark(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let start = atomicLoad(&count);
    for (var k = id.x; k < arrayLength(&changes); k += groups.x * SIZE) {
        let change = changes[k];
        if change.y != 0u {
            shown[change.x / 3u] = FLIPS << (4u * ((change.x + start) % 3u));
        }
    }
}
