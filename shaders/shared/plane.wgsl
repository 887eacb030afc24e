// Tests edges in the plane: float filters for orientation and in-circle, as src/predicates/plane.rs, and both tests on
// integers of few bits.
#import integers
#import mesh
#import points
#import products
#import state

// A filter of degree 4 in f32. WGSL and GLSL ES leave the direction of rounding open: each operation errs by at most
// ε = 2^-23, fused or not. As in plane.rs, but with differences that err by up to 3ε, the value errs by at most 18.2ε
// of `magnitude`; the bound is 24ε.
const PLANE_BOUND: f32 = 2.861023e-6;
// Flushed values, see points.wgsl, are below 2^-48.
const PLANE_FLUSHED: f32 = 1.4210855e-14;

// The verdict on the geometry of an edge: DELAUNAY, BLOCKED_BY + REASON_FOLD or LABELLED; UNDECIDED if exact arithmetic
// has to decide. `winding` is -1 in a clockwise component, else 1.
fn filtered_verdict_on(a: Point, b: Point, c: Point, d: Point, winding: i32) -> u32 {
    var verdict = DELAUNAY;
    if !has_right_angles(a, b, c, d) {
        verdict = rounded_verdict_on(a, b, c, d, winding);
    }
    return verdict;
}

fn rounded_verdict_on(a: Point, b: Point, c: Point, d: Point, winding: i32) -> u32 {
    var p = rounded_difference(a, c).xy;
    var q = rounded_difference(b, c).xy;
    var r = rounded_difference(a, d).xy;
    var s = rounded_difference(b, d).xy;
    let largest = max(max(abs(p), abs(q)), max(abs(r), abs(s)));
    let scale = scale_for(max(largest.x, largest.y));
    p *= scale;
    q *= scale;
    r *= scale;
    s *= scale;
    let in_circle = winding * in_circle_sign(angle_of(p, q), angle_of(s, r));
    var verdict = select(select(DELAUNAY, LABELLED, in_circle < 0), UNDECIDED, in_circle == 0);
    if verdict == LABELLED && !is_strict() {
        let area = min(winding * area_sign(r, p), winding * area_sign(q, s));
        verdict = select(select(LABELLED, BLOCKED_BY + REASON_FOLD, area < 0), UNDECIDED, area == 0);
    }
    return verdict;
}

// The cross product of two vectors, the dot product, and the sums of the sizes of the terms of each.
alias Angle = vec4f;

fn angle_of(u: vec2f, v: vec2f) -> Angle {
    let cross = vec2f(u.x * v.y, u.y * v.x);
    let dot = u * v;
    return Angle(cross.x - cross.y, dot.x + dot.y, abs(cross.x) + abs(cross.y), abs(dot.x) + abs(dot.y));
}

// The sign of cross(λ)·dot(γ) + dot(λ)·cross(γ), with the angles λ at c and γ at d: -1 if λ + γ > π, for
// counter-clockwise triangles; 0 if the filter cannot decide.
fn in_circle_sign(at_c: Angle, at_d: Angle) -> i32 {
    let value = at_c.x * at_d.y + at_c.y * at_d.x;
    return filtered_sign(value, PLANE_BOUND * (at_c.z * at_d.w + at_c.w * at_d.z) + PLANE_FLUSHED);
}

// The sign of u × v, twice the area of a triangle; 0 where the filter cannot decide.
fn area_sign(u: vec2f, v: vec2f) -> i32 {
    return filtered_sign(u.x * v.y - u.y * v.x, PLANE_BOUND * (abs(u.x * v.y) + abs(u.y * v.x)) + PLANE_FLUSHED);
}

// The sign of the area of a triangle; 0 where the filter cannot decide.
fn filtered_sign_of(a: Point, b: Point, c: Point) -> i32 {
    let u = rounded_difference(b, a).xy;
    let v = rounded_difference(c, a).xy;
    let largest = max(abs(u), abs(v));
    let scale = scale_for(max(largest.x, largest.y));
    return area_sign(u * scale, v * scale);
}

// The verdict where `filtered_verdict_on` gives UNDECIDED: 128-bit integers decide if all differences are below 2^30. They
// decide the ties of most lattices.
fn close_verdict_on(a: Point, b: Point, c: Point, d: Point, winding: i32) -> u32 {
    let grid = grid_of(a, b, c, d);
    let p = exact_differences(a, c, grid);
    let q = exact_differences(b, c, grid);
    let r = exact_differences(a, d, grid);
    let s = exact_differences(b, d, grid);
    let widest = p[0] | p[1] | q[0] | q[1] | r[0] | r[1] | s[0] | s[1];
    var verdict = UNDECIDED;
    if widest.x < 0x40000000u && (widest.y | widest.z) == 0u {
        verdict = verdict_in_narrow_plane(p, q, r, s, winding);
    }
    return verdict;
}

fn verdict_in_narrow_plane(p: Differences, q: Differences, r: Differences, s: Differences, winding: i32) -> u32 {
    let cross1 = narrow_sum(p[0], q[1], p[1], q[0], true);
    let dot1 = narrow_sum(p[0], q[0], p[1], q[1], false);
    let cross2 = narrow_sum(s[0], r[1], s[1], r[0], true);
    let dot2 = narrow_sum(s[0], r[0], s[1], r[1], false);
    var verdict = select(DELAUNAY, LABELLED, winding * narrow_sign(cross1, dot2, dot1, cross2) < 0);
    if verdict == LABELLED && !is_strict() {
        let area1 = narrow_sum(r[0], p[1], r[1], p[0], true);
        let area2 = narrow_sum(q[0], s[1], q[1], s[0], true);
        let is_flat = all(area1.xy == vec2u()) || all(area2.xy == vec2u());
        let turned = select(0u, 1u, winding > 0);
        let is_fold = is_flat || area1.z == turned || area2.z == turned;
        verdict = select(LABELLED, BLOCKED_BY + REASON_FOLD, is_fold);
    }
    return verdict;
}

// x·u + y·v or x·u - y·v of differences below 2^30: magnitude below 2^61 in xy, sign in z.
fn narrow_sum(x: vec4u, u: vec4u, y: vec4u, v: vec4u, subtract: bool) -> vec3u {
    let left = multiply_words(x.x, u.x);
    let right = multiply_words(y.x, v.x);
    let left_sign = x.w ^ u.w;
    let right_sign = y.w ^ v.w ^ select(0u, 1u, subtract);
    let first = vec4u(left, 0u, left_sign);
    let second = vec4u(right, 0u, 1u - right_sign);
    let sum = difference(first, second);
    return vec3u(sum.xy, sum.w);
}

// The sign of x·u + y·v.
fn narrow_sign(x: vec3u, u: vec3u, y: vec3u, v: vec3u) -> i32 {
    let left = narrow_product(x.xy, u.xy);
    let right = narrow_product(y.xy, v.xy);
    let left_sign = select(select(1, -1, x.z != u.z), 0, all(left == vec4u()));
    let right_sign = select(select(1, -1, y.z != v.z), 0, all(right == vec4u()));
    let larger = highest_sign(vec4i(left > right) - vec4i(left < right), 0);
    // If the signs differ, the sign of the larger magnitude.
    return select(sign(left_sign + right_sign), left_sign * larger, left_sign * right_sign < 0);
}

// The 128-bit product of two 64-bit integers.
fn narrow_product(x: vec2u, y: vec2u) -> vec4u {
    let low = multiply_words(x.x, y.x);
    let cross1 = multiply_words(x.x, y.y);
    let cross2 = multiply_words(x.y, y.x);
    let high = multiply_words(x.y, y.y);
    let first = low.y + cross1.x;
    let second = first + cross2.x;
    let carry = select(0u, 1u, first < low.y) + select(0u, 1u, second < first);
    let third = cross1.y + cross2.y;
    let fourth = third + high.x;
    let fifth = fourth + carry;
    let carries = select(0u, 1u, third < cross1.y) + select(0u, 1u, fourth < third) + select(0u, 1u, fifth < fourth);
    return vec4u(low.x, second, fifth, high.y + carries);
}
