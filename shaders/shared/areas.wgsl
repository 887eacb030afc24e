// Finds the triangles whose area is not positive, exactly, as src/mesh/areas.rs.
#import left_alone if floats
#import mesh
#import points
#import products
#import state
#import still if fixed
#import three_axes if space
#import two_axes if plane

// In the plane, the area has the opposite sign of the winding.
const INVERTED: u32 = 0u;
const FLAT: u32 = 1u;
// The triangle is left alone while the mesh moves.
const UNDECIDED_AREA: u32 = 2u;
// The triangle has an area; in the plane, with the sign of the winding.
const POSITIVE_AREA: u32 = 3u;

// Each operation errs by at most ε = 2^-23, fused or not, and differences by up to 3ε. So a component of a cross product
// errs by at most 8.1ε of the sum of the magnitudes of its products; the bound is 16ε.
const AREA_BOUND: f32 = 1.9073486e-6;
// Flushed values, see points.wgsl, are below 2^-48.
const AREA_FLUSHED: f32 = 1.4210855e-14;

// One of the constants above. `leaves`: whether some triangles may have to be left alone.
fn area_of(t: u32, leaves: bool) -> u32 {
    return area_at(t, vec3u(vertex(3u * t), vertex(3u * t + 1u), vertex(3u * t + 2u)), leaves);
}

// The same for three vertices, with the winding of triangle `t`.
fn area_at(t: u32, corners: vec3u, leaves: bool) -> u32 {
    let a = position(corners.x);
    let b = position(corners.y);
    let c = position(corners.z);
    var area = POSITIVE_AREA;
    if leaves && is_too_wide(max(span_of(a), max(span_of(b), span_of(c)))) {
        area = UNDECIDED_AREA;
    } else {
        var signs = filtered_normal(a, b, c);
        if all(signs == vec3i()) {
            signs = exact_normal(a, b, c);
        }
        // In the plane, only z is not 0.
        let winding = select(1, -1, DIMENSION == 2u && is_clockwise(t));
        if all(signs == vec3i()) {
            area = FLAT;
        } else if DIMENSION == 2u && winding * signs.z < 0 {
            area = INVERTED;
        }
    }
    return area;
}

// The signs of the components of the normal; 0 where the filter cannot decide.
fn filtered_normal(a: Point, b: Point, c: Point) -> vec3i {
    let p = rounded_difference(b, a);
    let q = rounded_difference(c, a);
    let largest = max(abs(p), abs(q));
    let scale = scale_for(max(max(largest.x, largest.y), largest.z));
    let u = scale * p;
    let v = scale * q;
    let left = u.yzx * v.zxy;
    let right = u.zxy * v.yzx;
    let value = left - right;
    let bound = AREA_BOUND * (abs(left) + abs(right)) + vec3f(AREA_FLUSHED);
    return vec3i(value > bound) - vec3i(value < -bound);
}

// The signs of the components of the normal.
fn exact_normal(a: Point, b: Point, c: Point) -> vec3i {
    let grid = grid_of(a, b, c, c);
    let u = exact_differences(b, a, grid);
    let v = exact_differences(c, a, grid);
    var signs = vec3i(0, 0, sign_of_difference(u[0], v[1], u[1], v[0]));
    if DIMENSION == 3u {
        signs.x = sign_of_difference(u[1], v[2], u[2], v[1]);
        signs.y = sign_of_difference(u[2], v[0], u[0], v[2]);
    }
    return signs;
}
