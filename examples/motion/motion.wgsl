// Moves the vertices of a mesh along waves, or by random steps.
struct Motion {
    time: f32,
    // Waves per unit of length, times 2π, and their height.
    number: f32,
    height: f32,
    // The longest step, or 0 for waves.
    step: f32,
    frame: u32,
    vertices: u32,
    stride: u32,
}

@group(0) @binding(0) var<uniform> motion: Motion;
@group(0) @binding(1) var<storage, read> rest: array<f32>;
@group(0) @binding(2) var<storage, read_write> positions: array<f32>;

// From -1 to 1.
fn random(seed: u32) -> f32 {
    let state = seed * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return f32((word >> 22u) ^ word) / 2147483648.0 - 1.0;
}

// A step inside of a sheet. The last vertex is its last corner.
fn walk(v: u32) {
    let seed = 2u * (motion.frame * motion.vertices + v);
    let now = vec2f(positions[2u * v], positions[2u * v + 1u]);
    let to = now + motion.step * vec2f(random(seed), random(seed + 1u));
    let end = vec2f(rest[2u * motion.vertices - 2u], rest[2u * motion.vertices - 1u]);
    if all(now > vec2f()) && all(now < end) && all(to > vec2f()) && all(to < end) {
        positions[2u * v] = to.x;
        positions[2u * v + 1u] = to.y;
    }
}

@compute @workgroup_size(256)
fn move_all(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var v = id.x; v < motion.vertices; v += 256u * groups.x) {
        let at = motion.stride * v;
        let x = rest[at];
        let y = rest[at + 1u];
        if motion.step > 0.0 {
            walk(v);
        } else if motion.stride == 2u {
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
