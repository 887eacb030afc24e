// Moves the vertices of a mesh along waves.
struct Motion {
    time: f32,
    // Waves per unit of length, times 2π, and their height.
    number: f32,
    height: f32,
    vertices: u32,
    stride: u32,
}

@group(0) @binding(0) var<uniform> motion: Motion;
@group(0) @binding(1) var<storage, read> rest: array<f32>;
@group(0) @binding(2) var<storage, read_write> positions: array<f32>;

@compute @workgroup_size(256)
fn move_all(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var v = id.x; v < motion.vertices; v += 256u * groups.x) {
        let at = motion.stride * v;
        let x = rest[at];
        let y = rest[at + 1u];
        if motion.stride == 2u {
            // A sheet: each row and each column swings.
            positions[at] = x + motion.height * sin(motion.number * y + motion.time);
            positions[at + 1u] = y + motion.height * sin(motion.number * x - motion.time);
        } else {
            // A surface around the z axis: rings swell and shrink.
            let z = rest[at + 2u];
            let factor = 1.0 + motion.height * sin(motion.number * z + motion.time);
            positions[at] = x * factor;
            positions[at + 1u] = y * factor;
            positions[at + 2u] = z;
        }
    }
}
