// Moves the vertices of a mesh, and finds the edges that have flipped. DIMENSION, VERTICES, CORNERS, HALF, LENGTH,
// LONGEST and SHARPNESS come before this text, and so does `pose`.

struct Frame {
    // The line of sight through the pointer, and how far along it vertices are dragged.
    origin: vec3f,
    depth: f32,
    way: vec3f,
    // The share of a displacement that stays.
    kept: f32,
    // How far the pointer has moved.
    by: vec3f,
    // Seconds since the start.
    time: f32,
    // The middle of the bubble, how strongly it pushes, and how sharply that falls off.
    bubble: vec4f,
}

@group(0) @binding(0) var<uniform> frame: Frame;
// For each vertex: three numbers of where it began; or 1 if it stays, as the first of three.
@group(0) @binding(1) var<storage, read> start: array<f32>;
@group(0) @binding(2) var<storage, read_write> positions: array<f32>;
@group(0) @binding(3) var<storage, read> indices: array<u32>;
// For each vertex, three numbers: how far it was dragged, as bits; or the sum of its ways to the circumcentres of its
// triangles, each times the area, and the sum of the areas. The sums are integers, so their order does not matter.
@group(0) @binding(4) var<storage, read_write> sums: array<atomic<i32>>;
// The triangles of the last frame, and for each side of a triangle, from its corner to the next, when it flipped.
@group(0) @binding(5) var<storage, read_write> before: array<u32>;
@group(0) @binding(6) var<storage, read_write> flashed: array<f32>;

const SIZE = 256u;
const UNIT = 4194304.0;

fn dragged(point: vec3f) -> vec3f {
    let arm = point - frame.origin;
    let along = dot(arm, frame.way);
    let aside = arm - along * frame.way;
    return select(vec3f(0), frame.by * exp(-SHARPNESS * dot(aside, aside)), along <= frame.depth);
}

fn at(i: u32) -> vec2f {
    return vec2f(positions[2 * i], positions[2 * i + 1]);
}

@compute @workgroup_size(SIZE)
fn move_all(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var i = id.x; i < VERTICES; i += groups.x * SIZE) {
        let home = pose(vec3f(start[3 * i], start[3 * i + 1], start[3 * i + 2]), frame.time);
        var away = vec3f(0);
        for (var k = 0u; k < 3; k++) {
            away[k] = frame.kept * bitcast<f32>(atomicLoad(&sums[3 * i + k]));
        }
        away += dragged(home + away);
        for (var k = 0u; k < 3; k++) {
            atomicStore(&sums[3 * i + k], bitcast<i32>(away[k]));
            if k < DIMENSION { positions[DIMENSION * i + k] = home[k] + away[k]; }
        }
    }
}

fn whole(x: f32) -> i32 {
    return i32(clamp(x * UNIT, -67108864.0, 67108864.0));
}

@compute @workgroup_size(SIZE)
fn add(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var h = 3 * id.x; h < CORNERS; h += 3 * groups.x * SIZE) {
        let a = at(indices[h]);
        let b = (at(indices[h + 1]) - a) / LENGTH;
        let c = (at(indices[h + 2]) - a) / LENGTH;
        let area = b.x * c.y - b.y * c.x;
        if area <= 0 { continue; }
        // The way from a to the circumcentre, times the area.
        let way = 0.5 * vec2f(c.y * dot(b, b) - b.y * dot(c, c), b.x * dot(c, c) - c.x * dot(b, b));
        let corners = array(vec2f(0), b, c);
        for (var k = 0u; k < 3; k++) {
            let own = way - area * corners[k];
            atomicAdd(&sums[3 * indices[h + k]], whole(own.x));
            atomicAdd(&sums[3 * indices[h + k] + 1], whole(own.y));
            atomicAdd(&sums[3 * indices[h + k] + 2], whole(area));
        }
    }
}

@compute @workgroup_size(SIZE)
fn relax(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var i = id.x; i < VERTICES; i += groups.x * SIZE) {
        let way = vec2f(f32(atomicExchange(&sums[3 * i], 0)), f32(atomicExchange(&sums[3 * i + 1], 0)));
        let area = f32(atomicExchange(&sums[3 * i + 2], 0));
        if start[3 * i] != 0 || area <= 0 { continue; }
        let here = at(i);
        let step = 0.5 * LENGTH * way / area;
        let arm = here - frame.bubble.xy;
        let push = frame.bubble.z * arm * exp(-frame.bubble.w * dot(arm, arm));
        let shortened = step * min(1, LONGEST * LENGTH / max(length(step), 1e-9));
        let next = here + shortened + push + dragged(vec3f(here, 0)).xy;
        positions[2 * i] = clamp(next.x, -0.999 * HALF, 0.999 * HALF);
        positions[2 * i + 1] = clamp(next.y, -0.999 * HALF, 0.999 * HALF);
    }
}

@compute @workgroup_size(SIZE)
fn flash(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    // A flip gives each of its two triangles one new corner, at which the new edge begins.
    for (var i = id.x; i < CORNERS; i += groups.x * SIZE) {
        if indices[i] != before[i] {
            before[i] = indices[i];
            flashed[i] = frame.time;
        }
    }
}
