// The entry point of rounds.wgsl.

@group(0) @binding(0) var<storage, read_write> result: array<u32>;

@compute @workgroup_size(1)
fn probe() {
    result[0] = rounds();
}
