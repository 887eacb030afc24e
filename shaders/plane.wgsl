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
    let field = bitcast<u32>(largest) >> 23u & 0xffu;
    return select(0.0, bitcast<f32>((254u - field) << 23u), field >= SMALLEST_FIELD && field <= LARGEST_FIELD);
}

// The sign of cross(λ)·dot(γ) + dot(λ)·cross(γ): -1 when λ + γ > π, for counter-clockwise triangles.
fn in_circle_sign(a: vec2u, b: vec2u, c: vec2u, d: vec2u) -> i32 {
    var p = bitcast<vec2f>(a) - bitcast<vec2f>(c);
    var q = bitcast<vec2f>(b) - bitcast<vec2f>(c);
    var r = bitcast<vec2f>(a) - bitcast<vec2f>(d);
    var s = bitcast<vec2f>(b) - bitcast<vec2f>(d);
    let largest = max(max(abs(p), abs(q)), max(abs(r), abs(s)));
    let scale = scale_for(max(largest.x, largest.y));
    if scale > 0.0 {
        p *= scale;
        q *= scale;
        r *= scale;
        s *= scale;
        let cross1 = vec2f(p.x * q.y, p.y * q.x);
        let dot1 = p * q;
        let cross2 = vec2f(s.x * r.y, s.y * r.x);
        let dot2 = s * r;
        let value = (cross1.x - cross1.y) * (dot2.x + dot2.y) + (dot1.x + dot1.y) * (cross2.x - cross2.y);
        let magnitude = (abs(cross1.x) + abs(cross1.y)) * (abs(dot2.x) + abs(dot2.y))
            + (abs(dot1.x) + abs(dot1.y)) * (abs(cross2.x) + abs(cross2.y));
        if abs(value) > PLANE_BOUND * magnitude + FLUSHED {
            return select(1, -1, value < 0.0);
        }
    }
    return in_circle_exact(a, b, c, d);
}

// The sign of the area of (a, b, c).
fn area_sign(a: vec2u, b: vec2u, c: vec2u) -> i32 {
    var p = bitcast<vec2f>(a) - bitcast<vec2f>(c);
    var q = bitcast<vec2f>(b) - bitcast<vec2f>(c);
    let largest = max(abs(p), abs(q));
    let scale = scale_for(max(largest.x, largest.y));
    if scale > 0.0 {
        p *= scale;
        q *= scale;
        let value = p.x * q.y - p.y * q.x;
        let magnitude = abs(p.x * q.y) + abs(p.y * q.x);
        if abs(value) > PLANE_BOUND * magnitude + FLUSHED {
            return select(1, -1, value < 0.0);
        }
    }
    let unit = min(min(unit2(a), unit2(b)), unit2(c));
    let cx = on_grid(c.x, unit);
    let cy = on_grid(c.y, unit);
    var left = product(difference(on_grid(a.x, unit), cx), difference(on_grid(b.y, unit), cy));
    var right = product(difference(on_grid(a.y, unit), cy), difference(on_grid(b.x, unit), cx));
    var area = add(&left, &right, true);
    return int_sign(&area);
}

fn unit2(v: vec2u) -> i32 {
    return min(unit_exponent(v.x), unit_exponent(v.y));
}

fn in_circle_exact(a: vec2u, b: vec2u, c: vec2u, d: vec2u) -> i32 {
    let unit = min(min(unit2(a), unit2(b)), min(unit2(c), unit2(d)));
    let ax = on_grid(a.x, unit);
    let ay = on_grid(a.y, unit);
    let bx = on_grid(b.x, unit);
    let by = on_grid(b.y, unit);
    let cx = on_grid(c.x, unit);
    let cy = on_grid(c.y, unit);
    let dx = on_grid(d.x, unit);
    let dy = on_grid(d.y, unit);
    let px = difference(ax, cx);
    let py = difference(ay, cy);
    let qx = difference(bx, cx);
    let qy = difference(by, cy);
    let rx = difference(ax, dx);
    let ry = difference(ay, dy);
    let sx = difference(bx, dx);
    let sy = difference(by, dy);
    // Below 2^30 everything fits 128 bits, in registers; a lattice takes this path for every edge.
    let widest = px | py | qx | qy | rx | ry | sx | sy;
    if widest.x < 0x40000000u && widest.y == 0u && widest.z == 0u {
        let cross1 = narrow_sum(px, qy, py, qx, true);
        let dot1 = narrow_sum(px, qx, py, qy, false);
        let cross2 = narrow_sum(sx, ry, sy, rx, true);
        let dot2 = narrow_sum(sx, rx, sy, ry, false);
        return narrow_sign(cross1, dot2, dot1, cross2);
    }
    var first = product(px, qy);
    var second = product(py, qx);
    var cross1 = add(&first, &second, true);
    first = product(px, qx);
    second = product(py, qy);
    var dot1 = add(&first, &second, false);
    first = product(sx, ry);
    second = product(sy, rx);
    var cross2 = add(&first, &second, true);
    first = product(sx, rx);
    second = product(sy, ry);
    var dot2 = add(&first, &second, false);
    return sum_of_products_sign(&cross1, &dot2, &dot1, &cross2);
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
