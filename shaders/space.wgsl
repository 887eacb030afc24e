// Surfaces in space: the angle sum, the angle between normals against β, and normals that turn over, as
// src/predicates/space.rs.

// As in space.rs, with ε = 2^-23 and a sqrt that errs by 5ε: the angle sum errs by at most
// (10.6 + 5.01 + 1)·2 + 2.1 = 35.4ε, a product of normals less k|n||m| by 11.1 + 23.2 + 0.5 + 2.1 = 36.9ε, cos β being rounded to f32 too, of the
// product of the four sizes. 64 leaves room. What is flushed, see plane.wgsl, is below 2^-46 here.
const SPACE_BOUND: f32 = 7.6293945e-6;
const SPACE_FLUSHED: f32 = 5.684342e-14;

// The vectors a - c, b - c, a - d, b - d, scaled; all zero where no filter can decide.
struct Quad {
    p: vec3f,
    q: vec3f,
    r: vec3f,
    s: vec3f,
}

fn position3(v: u32) -> vec3u {
    return vec3u(positions[3u * v], positions[3u * v + 1u], positions[3u * v + 2u]);
}

fn quad_of(a: vec3u, b: vec3u, c: vec3u, d: vec3u) -> Quad {
    let p = bitcast<vec3f>(a) - bitcast<vec3f>(c);
    let q = bitcast<vec3f>(b) - bitcast<vec3f>(c);
    let r = bitcast<vec3f>(a) - bitcast<vec3f>(d);
    let s = bitcast<vec3f>(b) - bitcast<vec3f>(d);
    let largest = max(max(abs(p), abs(q)), max(abs(r), abs(s)));
    let scale = scale_for(max(max(largest.x, largest.y), largest.z));
    return Quad(p * scale, q * scale, r * scale, s * scale);
}

fn bound_of(quad: Quad) -> f32 {
    return SPACE_BOUND * (size(quad.p) * size(quad.q)) * (size(quad.s) * size(quad.r)) + SPACE_FLUSHED;
}

// Whether an edge may flip by its geometry: DELAUNAY, BLOCKED_BY + REASON_ANGLE or REASON_FOLD, or LABELLED.
fn verdict_in_space(a: vec3u, b: vec3u, c: vec3u, d: vec3u) -> u32 {
    let quad = quad_of(a, b, c, d);
    let bound = bound_of(quad);
    let sum = angle_sum_sign(quad, bound);
    if sum > 0 {
        return DELAUNAY;
    }
    let angle = compare_angles(quad, bound);
    if sum < 0 && angle < 0 {
        return BLOCKED_BY + REASON_ANGLE;
    }
    let turned = compare_turns(quad);
    if sum < 0 && angle > 0 && turned != 0 {
        return select(LABELLED, BLOCKED_BY + REASON_FOLD, turned < 0);
    }
    return verdict_in_space_exact(a, b, c, d, false);
}

// Whether the angle between the normals, before any flip, is larger than β.
fn is_over_angle(a: vec3u, b: vec3u, c: vec3u, d: vec3u) -> bool {
    if has_any_angle() {
        return false;
    }
    let quad = quad_of(a, b, c, d);
    let before = compare_angle(cross(quad.p, quad.q), cross(quad.s, quad.r), bound_of(quad));
    if before != 0 {
        return before < 0;
    }
    return verdict_in_space_exact(a, b, c, d, true) != DELAUNAY;
}

fn size(v: vec3f) -> f32 {
    return abs(v.x) + abs(v.y) + abs(v.z);
}

// -1 when the opposite angles sum to more than π; 0 where the filter cannot decide.
fn angle_sum_sign(quad: Quad, bound: f32) -> i32 {
    let n1 = cross(quad.p, quad.q);
    let n2 = cross(quad.s, quad.r);
    let value = sqrt(dot(n1, n1)) * dot(quad.s, quad.r) + sqrt(dot(n2, n2)) * dot(quad.p, quad.q);
    return filtered_sign(value, bound);
}

// -1 when the angle between the normals is larger than β before the flip or after it, 1 when it is not, 0
// where the filter cannot decide.
fn compare_angles(quad: Quad, bound: f32) -> i32 {
    if has_any_angle() {
        return 1;
    }
    let before = compare_angle(cross(quad.p, quad.q), cross(quad.s, quad.r), bound);
    let after = compare_angle(cross(quad.r, quad.p), cross(quad.q, quad.s), bound);
    return min(min(before, after), select(0, 1, before != 0 && after != 0));
}

// Whether β is 180°: only a cosine of -1 has this sign and a square of 1.
fn has_any_angle() -> bool {
    return params.cos_sign < 0 && params.cos_shift == 0u;
}

fn compare_angle(n: vec3f, m: vec3f, bound: f32) -> i32 {
    return filtered_sign(dot(n, m) - params.cos * (sqrt(dot(n, n)) * sqrt(dot(m, m))), bound);
}

// -1 when a new normal has a negative dot product with an old one, 1 when none has, 0 where the filter cannot
// decide.
fn compare_turns(quad: Quad) -> i32 {
    let n1 = cross(quad.p, quad.q);
    let n2 = cross(quad.s, quad.r);
    let m1 = cross(quad.r, quad.p);
    let m2 = cross(quad.q, quad.s);
    let largest = max(max(size(quad.p), size(quad.q)), max(size(quad.r), size(quad.s)));
    let bound = vec4f(SPACE_BOUND * (largest * largest) * (largest * largest) + SPACE_FLUSHED);
    let dots = vec4f(dot(n1, m1), dot(n1, m2), dot(n2, m1), dot(n2, m2));
    return select(select(0, 1, all(dots > bound)), -1, any(dots < -bound));
}

// A dot product of differences: 6 limbs hold 3·2^170.
struct Dot {
    negative: bool,
    limbs: array<u32, 6>,
}

fn packed(x: ptr<function, Int>) -> Dot {
    var result = Dot();
    result.negative = (*x).negative;
    for (var i = 0u; i < 6u; i++) {
        result.limbs[i] = (*x).limbs[i];
    }
    return result;
}

fn unpacked(packed_dot: Dot) -> Int {
    var result = Int();
    result.negative = packed_dot.negative;
    for (var i = 0u; i < 6u; i++) {
        result.limbs[i] = packed_dot.limbs[i];
        if packed_dot.limbs[i] != 0u {
            result.len = i + 1u;
        }
    }
    return result;
}

// The dot products of p, q, r, s, by place: the pairs (i, j) with i <= j in order.
const PP: u32 = 0u;
const PQ: u32 = 1u;
const PR: u32 = 2u;
const PS: u32 = 3u;
const QQ: u32 = 4u;
const QR: u32 = 5u;
const QS: u32 = 6u;
const RR: u32 = 7u;
const RS: u32 = 8u;
const SS: u32 = 9u;

// Dot products of normals by the identity of Binet and Cauchy, (u × v)·(w × x) = (u·w)(v·x) - (u·x)(v·w):
// of the old normals n1 = p × q and n2 = s × r with themselves and with each other, of the new ones m1 = r × p
// and m2 = q × s likewise, and of each old one with each new one.
const NORMAL_DOTS = array<vec4u, 10>(
    vec4u(PP, QQ, PQ, PQ),
    vec4u(SS, RR, RS, RS),
    vec4u(PS, QR, PR, QS),
    vec4u(RR, PP, PR, PR),
    vec4u(QQ, SS, QS, QS),
    vec4u(QR, PS, RS, PQ),
    vec4u(PR, PQ, PP, QR),
    vec4u(PQ, QS, PS, QQ),
    vec4u(RS, PR, PS, RR),
    vec4u(QS, RS, SS, QR),
);

fn unit3(v: vec3u) -> i32 {
    return min(min(unit_exponent(v.x), unit_exponent(v.y)), unit_exponent(v.z));
}

// With `angle_only`, only the angle before the flip is looked at: DELAUNAY or BLOCKED_BY + REASON_ANGLE.
fn verdict_in_space_exact(a: vec3u, b: vec3u, c: vec3u, d: vec3u, angle_only: bool) -> u32 {
    let unit = min(min(unit3(a), unit3(b)), min(unit3(c), unit3(d)));
    var points = array<vec3u, 4>(a, b, c, d);
    // p, q, r, s: three words each.
    var v = array<vec4u, 12>();
    for (var i = 0u; i < 12u; i++) {
        let axis = i % 3u;
        let from_point = points[(i / 3u) & 1u];
        let to_point = points[2u + i / 6u];
        v[i] = difference(on_grid(from_point[axis], unit), on_grid(to_point[axis], unit));
    }
    var dots = array<Dot, 10>();
    var at = 0u;
    for (var i = 0u; i < 4u; i++) {
        for (var j = i; j < 4u; j++) {
            var sum = Int();
            for (var axis = 0u; axis < 3u; axis++) {
                var term = product(v[3u * i + axis], v[3u * j + axis]);
                sum = add(&sum, &term, false);
            }
            dots[at] = packed(&sum);
            at++;
        }
    }
    var normal_dots = NORMAL_DOTS;
    var squares = array<Int, 3>();
    for (var i = 0u; i < 10u; i++) {
        let f = normal_dots[i];
        // The first product, then the difference to the second.
        var value = Int();
        for (var k = 0u; k < 2u; k++) {
            var x = unpacked(dots[f[2u * k]]);
            var y = unpacked(dots[f[2u * k + 1u]]);
            var term = multiply(&x, &y);
            value = add(&value, &term, k == 1u);
        }
        if i >= 6u {
            if int_sign(&value) < 0 {
                return BLOCKED_BY + REASON_FOLD;
            }
            continue;
        }
        squares[i % 3u] = value;
        if i == 1u && !angle_only && !is_angle_sum_negative(&squares, &dots) {
            return DELAUNAY;
        }
        if i % 3u == 2u && !has_any_angle() && exceeds_angle(&squares) {
            return BLOCKED_BY + REASON_ANGLE;
        }
        if i == 2u && angle_only {
            return DELAUNAY;
        }
    }
    return LABELLED;
}

// Whether √(n1²)·dot2 + √(n2²)·dot1 < 0: by the squares, with the signs of what was squared.
fn is_angle_sum_negative(squares: ptr<function, array<Int, 3>>, dots: ptr<function, array<Dot, 10>>) -> bool {
    var terms = array<Int, 2>();
    for (var i = 0u; i < 2u; i++) {
        // n1² with dot2 = r·s, n2² with dot1 = p·q.
        var dot_product = unpacked((*dots)[select(PQ, RS, i == 0u)]);
        var square = multiply(&dot_product, &dot_product);
        square.negative = dot_product.negative;
        var normal = (*squares)[i];
        terms[i] = multiply(&normal, &square);
    }
    var left = terms[0];
    var right = terms[1];
    let first = int_sign(&left);
    let second = int_sign(&right);
    return first + second < 0 || (first * second < 0 && first * compare_magnitude(&left, &right) < 0);
}

// Whether n·m < k|n||m|, given n², m² and n·m.
fn exceeds_angle(squares: ptr<function, array<Int, 3>>) -> bool {
    var n_square = (*squares)[0];
    var m_square = (*squares)[1];
    var cosine = (*squares)[2];
    let left_sign = int_sign(&cosine);
    let right_sign = params.cos_sign * int_sign(&n_square) * int_sign(&m_square);
    if left_sign != right_sign || left_sign == 0 {
        return left_sign < right_sign;
    }
    // (n·m)²·2^shift against n²·m²·mantissa².
    var sides = array<Int, 2>();
    for (var i = 0u; i < 2u; i++) {
        var factor = Int();
        if i == 0u {
            factor.len = params.cos_shift / 32u + 1u;
            factor.limbs[factor.len - 1u] = 1u << (params.cos_shift % 32u);
        } else {
            for (var k = 0u; k < 4u; k++) {
                factor.limbs[k] = params.cos_square[k];
                factor.len = select(factor.len, k + 1u, params.cos_square[k] != 0u);
            }
        }
        for (var k = 0u; k < 2u; k++) {
            var other = (*squares)[select(k, 2u, i == 0u)];
            factor = multiply(&factor, &other);
        }
        sides[i] = factor;
    }
    var left = sides[0];
    var right = sides[1];
    return compare_magnitude(&left, &right) * left_sign < 0;
}
