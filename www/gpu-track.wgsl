// The history of a run on the GPU, without a read-back: each iteration as the places that it changed and what was
// there xor what is there now, which does it again or takes it back.

@group(0) @binding(0) var<storage, read> newest: array<u32>;
@group(0) @binding(1) var<storage, read_write> shown: array<u32>;
@group(0) @binding(2) var<storage, read_write> changes: array<vec2u>;
@group(0) @binding(3) var<storage, read_write> count: atomic<u32>;

const SIZE = 256u;

// What turns `shown` into `newest`. The order of the entries has no meaning: each is at a place of its own.
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

// Entries that were not needed are zeros, and change nothing.
@compute @workgroup_size(SIZE)
fn apply(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var k = id.x; k < arrayLength(&changes); k += groups.x * SIZE) {
        let change = changes[k];
        if change.y != 0u {
            shown[change.x] ^= change.y;
        }
    }
}

// The lines around the triangles of `shown`, as indices; they go into the binding of the changes.
@compute @workgroup_size(SIZE)
fn lines(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var h = id.x; h < arrayLength(&shown); h += groups.x * SIZE) {
        changes[h] = vec2u(shown[h], shown[select(h + 1u, h - 2u, h % 3u == 2u)]);
    }
}
