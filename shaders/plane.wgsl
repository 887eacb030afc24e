// The plane: orientation and the in-circle test, as src/predicates/plane.rs.

// A filter of degree 4 in f32. WGSL leaves the direction of rounding open: each operation errs by at most
// ε = 2^-23, fused or not. As in plane.rs the value errs by at most 10.1ε of `magnitude`; 16 leaves room.
const PLANE_BOUND: f32 = 1.9073486e-6;
// Subnormals may be flushed. The differences are scaled so that the largest lies in [1, 2) and none was
// computed from a quad smaller than 2^-67; what is flushed then changes the value by less than 2^-48.
const FLUSHED: f32 = 1.4210855e-14;
const SMALLEST_FIELD: u32 = 60u;
const LARGEST_FIELD: u32 = 250u;


fn position2(v: u32) -> vec2u {
    return vec2u(positions[2u * v], positions[2u * v + 1u]);
}

// The power of two that scales `largest` into [1, 2); 0 where a filter cannot be trusted.
fn scale_for(largest: f32) -> f32 {
    let field = (bitcast<u32>(largest) >> 23u) & 0xffu;
    return select(0.0, bitcast<f32>((254u - field) << 23u), field >= SMALLEST_FIELD && field <= LARGEST_FIELD);
}

// Whether an edge may flip by its geometry: DELAUNAY, BLOCKED_BY + REASON_FOLD or LABELLED. `winding` is -1 in
// a clockwise component, else 1.
fn verdict_in_plane(a: vec2u, b: vec2u, c: vec2u, d: vec2u, winding: i32) -> u32 {
    var p = bitcast<vec2f>(a) - bitcast<vec2f>(c);
    var q = bitcast<vec2f>(b) - bitcast<vec2f>(c);
    var r = bitcast<vec2f>(a) - bitcast<vec2f>(d);
    var s = bitcast<vec2f>(b) - bitcast<vec2f>(d);
    let largest = max(max(abs(p), abs(q)), max(abs(r), abs(s)));
    let scale = scale_for(max(largest.x, largest.y));
    p *= scale;
    q *= scale;
    r *= scale;
    s *= scale;
    let in_circle = winding * in_circle_sign(p, q, r, s);
    if in_circle > 0 {
        return DELAUNAY;
    }
    let area1 = winding * area_sign(r, p);
    let area2 = winding * area_sign(q, s);
    if in_circle < 0 && (area1 < 0 || area2 < 0) {
        return BLOCKED_BY + REASON_FOLD;
    }
    if in_circle < 0 && area1 > 0 && area2 > 0 {
        return LABELLED;
    }
    return verdict_in_plane_exact(a, b, c, d, winding);
}

// The sign of cross(λ)·dot(γ) + dot(λ)·cross(γ): -1 when λ + γ > π, for counter-clockwise triangles; 0 where
// the filter cannot decide.
fn in_circle_sign(p: vec2f, q: vec2f, r: vec2f, s: vec2f) -> i32 {
    let cross1 = vec2f(p.x * q.y, p.y * q.x);
    let dot1 = p * q;
    let cross2 = vec2f(s.x * r.y, s.y * r.x);
    let dot2 = s * r;
    let value = (cross1.x - cross1.y) * (dot2.x + dot2.y) + (dot1.x + dot1.y) * (cross2.x - cross2.y);
    let magnitude = (abs(cross1.x) + abs(cross1.y)) * (abs(dot2.x) + abs(dot2.y))
        + (abs(dot1.x) + abs(dot1.y)) * (abs(cross2.x) + abs(cross2.y));
    return filtered_sign(value, PLANE_BOUND * magnitude + FLUSHED);
}

// The sign of u × v, twice the area of a triangle; 0 where the filter cannot decide.
fn area_sign(u: vec2f, v: vec2f) -> i32 {
    return filtered_sign(u.x * v.y - u.y * v.x, PLANE_BOUND * (abs(u.x * v.y) + abs(u.y * v.x)) + FLUSHED);
}

fn filtered_sign(value: f32, bound: f32) -> i32 {
    return select(0, select(1, -1, value < 0.0), abs(value) > bound);
}

fn unit2(v: vec2u) -> i32 {
    return min(unit_exponent(v.x), unit_exponent(v.y));
}

// Differences p, q, r, s: x and y of each.
const PX: u32 = 0u;
const PY: u32 = 1u;
const QX: u32 = 2u;
const QY: u32 = 3u;
const RX: u32 = 4u;
const RY: u32 = 5u;
const SX: u32 = 6u;
const SY: u32 = 7u;

// What is computed from them, each as a product of two less (or plus) a product of two: cross1, dot1, cross2,
// dot2, and the new areas r × p and q × s.
const FACTORS = array<vec4u, 6>(
    vec4u(PX, QY, PY, QX),
    vec4u(PX, QX, PY, QY),
    vec4u(SX, RY, SY, RX),
    vec4u(SX, RX, SY, RY),
    vec4u(RX, PY, RY, PX),
    vec4u(QX, SY, QY, SX),
);
const CROSS1: u32 = 0u;
const DOT1: u32 = 1u;
const CROSS2: u32 = 2u;
const DOT2: u32 = 3u;
const AREA1: u32 = 4u;
const AREA2: u32 = 5u;

fn verdict_in_plane_exact(a: vec2u, b: vec2u, c: vec2u, d: vec2u, winding: i32) -> u32 {
    let unit = min(min(unit2(a), unit2(b)), min(unit2(c), unit2(d)));
    var points = array<vec2u, 4>(a, b, c, d);
    var v = array<vec4u, 8>();
    var widest = vec4u();
    for (var i = 0u; i < 8u; i++) {
        // p = a - c, q = b - c, r = a - d, s = b - d.
        let from_point = points[(i / 2u) & 1u];
        let to_point = points[2u + i / 4u];
        v[i] = difference(on_grid(from_point[i & 1u], unit), on_grid(to_point[i & 1u], unit));
        widest |= v[i];
    }
    var factors = FACTORS;
    // Below 2^30 everything fits 128 bits, in registers; a lattice takes this path for every edge.
    if widest.x < 0x40000000u && widest.y == 0u && widest.z == 0u {
        var sums = array<vec3u, 6>();
        for (var i = 0u; i < 6u; i++) {
            let f = factors[i];
            sums[i] = narrow_sum(v[f.x], v[f.y], v[f.z], v[f.w], i != DOT1 && i != DOT2);
        }
        if winding * narrow_sign(sums[CROSS1], sums[DOT2], sums[DOT1], sums[CROSS2]) >= 0 {
            return DELAUNAY;
        }
        let flat = all(sums[AREA1].xy == vec2u()) || all(sums[AREA2].xy == vec2u());
        let turned = select(0u, 1u, winding > 0);
        let fold = flat || sums[AREA1].z == turned || sums[AREA2].z == turned;
        return select(LABELLED, BLOCKED_BY + REASON_FOLD, fold);
    }
    var wide = array<Int, 4>();
    var fold = false;
    for (var i = 0u; i < 6u; i++) {
        let f = factors[i];
        var left = product(v[f.x], v[f.y]);
        var right = product(v[f.z], v[f.w]);
        var sum = add(&left, &right, i != DOT1 && i != DOT2);
        if i < AREA1 {
            wide[i] = sum;
        } else {
            fold = fold || winding * int_sign(&sum) <= 0;
        }
    }
    var cross1 = wide[CROSS1];
    var dot1 = wide[DOT1];
    var cross2 = wide[CROSS2];
    var dot2 = wide[DOT2];
    if winding * sum_of_products_sign(&cross1, &dot2, &dot1, &cross2) >= 0 {
        return DELAUNAY;
    }
    return select(LABELLED, BLOCKED_BY + REASON_FOLD, fold);
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
    if left_sign == right_sign || right_sign == 0 {
        return left_sign;
    }
    if left_sign == 0 {
        return right_sign;
    }
    for (var i = 3; i >= 0; i--) {
        if left[i] != right[i] {
            return select(right_sign, left_sign, left[i] > right[i]);
        }
    }
    return 0;
}

// 64 by 64 bits.
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
