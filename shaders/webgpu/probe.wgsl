// The kernel that finds drivers whose loops end too early, by rounds.wgsl.
#import rounds

@group(0) @binding(0) var<storage, read_write> result: array<u32>;

@compute @workgroup_size(1)
fn probe() {
    result[0] = rounds();
}
