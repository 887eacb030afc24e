// Reads points with fixed-point coordinates: relative to the lowest corner of the bounding box, in units of the mesh's
// grid. No predicate depends on the origin or on the unit.
#import integers
#import state

// The low words of the coordinates, the middle ones, the high ones.
alias Point = array<vec3u, 3>;

fn position(v: u32) -> Point {
    return Point(coordinates(3u * v), coordinates(3u * v + 1u), coordinates(3u * v + 2u));
}

// For each axis, 1 if u is greater than v, -1 if v is greater.
fn order(u: Point, v: Point) -> vec3i {
    let high = vec3i(u[2] > v[2]) - vec3i(u[2] < v[2]);
    let middle = vec3i(u[1] > v[1]) - vec3i(u[1] < v[1]);
    let low = vec3i(u[0] > v[0]) - vec3i(u[0] < v[0]);
    return select(high, select(middle, low, middle == vec3i()), high == vec3i());
}

// For each axis, 0 if u and v are the same.
fn apart(u: Point, v: Point) -> vec3u {
    return (u[0] ^ v[0]) | (u[1] ^ v[1]) | (u[2] ^ v[2]);
}

// All points are on the grid of the mesh.
fn grid_of(a: Point, b: Point, c: Point, d: Point) -> i32 {
    return 0;
}

fn exact_difference(u: Point, v: Point, axis: u32, grid: i32) -> vec4u {
    return difference(fixed_at(u, axis), fixed_at(v, axis));
}

fn fixed_at(u: Point, axis: u32) -> vec4u {
    return vec4u(component_of(u[0], axis), component_of(u[1], axis), component_of(u[2], axis), 0u);
}

fn deviation_grid() -> i32 {
    return 0;
}

fn deviation_on(grid: i32) -> vec4u {
    return vec4u(deviation().xyz, 0u);
}

// u - v. Converting a word to f32 errs by ε. No term is negative, so each of the two sums errs by ε as well: 3ε in all.
fn rounded_difference(u: Point, v: Point) -> vec3f {
    return vec3f(
        rounded(exact_difference(u, v, 0u, 0)),
        rounded(exact_difference(u, v, 1u, 0)),
        rounded(exact_difference(u, v, 2u, 0)),
    );
}

fn rounded(x: vec4u) -> f32 {
    let magnitude = f32(x.z) * 1.8446744e19 + (f32(x.y) * 4294967296.0 + f32(x.x));
    return select(magnitude, -magnitude, x.w == 1u);
}
