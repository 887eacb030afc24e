// Surfaces in space: the angle sum, the angle between normals against β, and normals that turn over, as
// src/predicates/space.rs.

// As in space.rs, with ε = 2^-23 and a sqrt that errs by 5ε: the angle sum errs by at most
// (10.6 + 5.01 + 1)·2 + 2.1 = 35.4ε, a product of normals less k|n||m| by 11.1 + 23.2 + 2.1 = 36.4ε of the
// product of the four sizes. 64 leaves room. What is flushed, see plane.wgsl, is below 2^-46 here.
const SPACE_BOUND: f32 = 7.6293945e-6;
const SPACE_FLUSHED: f32 = 5.684342e-14;

struct Quad {
    a: vec3u,
    b: vec3u,
    c: vec3u,
    d: vec3u,
    // a - c, b - c, a - d, b - d, scaled; all zero where no filter can be trusted.
    p: vec3f,
    q: vec3f,
    r: vec3f,
    s: vec3f,
}

// A difference of points, exactly.
struct Exact3 {
    x: vec4u,
    y: vec4u,
    z: vec4u,
}

struct ExactQuad {
    p: Exact3,
    q: Exact3,
    r: Exact3,
    s: Exact3,
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
    if scale == 0.0 {
        return Quad(a, b, c, d, vec3f(), vec3f(), vec3f(), vec3f());
    }
    return Quad(a, b, c, d, p * scale, q * scale, r * scale, s * scale);
}

fn size(v: vec3f) -> f32 {
    return abs(v.x) + abs(v.y) + abs(v.z);
}

fn space_bound(quad: Quad) -> f32 {
    return SPACE_BOUND * (size(quad.p) * size(quad.q)) * (size(quad.s) * size(quad.r)) + SPACE_FLUSHED;
}

// Whether the opposite angles sum to more than π.
fn is_non_delaunay(quad: Quad) -> bool {
    let n1 = cross(quad.p, quad.q);
    let n2 = cross(quad.s, quad.r);
    let value = sqrt(dot(n1, n1)) * dot(quad.s, quad.r) + sqrt(dot(n2, n2)) * dot(quad.p, quad.q);
    if abs(value) > space_bound(quad) {
        return value < 0.0;
    }
    return is_non_delaunay_exact(exact_quad(quad));
}

// The cosine of the angle between two normals less cos β, times their lengths: -1 below, 1 above, 0 unknown.
fn compare_angle(n: vec3f, m: vec3f, bound: f32) -> i32 {
    let value = dot(n, m) - params.cos * (sqrt(dot(n, n)) * sqrt(dot(m, m)));
    return select(select(0, -1, value < -bound), 1, value > bound);
}

// Whether the angle between the normals is larger than β, before the flip or after it.
fn exceeds_angle(quad: Quad) -> bool {
    // Only -1 has a square of 1 and this sign; by Cauchy and Schwarz no angle exceeds 180°.
    if params.cos_sign < 0 && params.cos_shift == 0u {
        return false;
    }
    let bound = space_bound(quad);
    let before = compare_angle(cross(quad.p, quad.q), cross(quad.s, quad.r), bound);
    if before < 0 {
        return true;
    }
    let after = compare_angle(cross(quad.r, quad.p), cross(quad.q, quad.s), bound);
    if after < 0 {
        return true;
    }
    return (before == 0 || after == 0) && exceeds_angle_exact(exact_quad(quad));
}

// Whether a new normal has a strictly negative dot product with an old one.
fn turns_over(quad: Quad) -> bool {
    let n1 = cross(quad.p, quad.q);
    let n2 = cross(quad.s, quad.r);
    let m1 = cross(quad.r, quad.p);
    let m2 = cross(quad.q, quad.s);
    let largest = max(max(size(quad.p), size(quad.q)), max(size(quad.r), size(quad.s)));
    let bound = SPACE_BOUND * (largest * largest) * (largest * largest) + SPACE_FLUSHED;
    let dots = vec4f(dot(n1, m1), dot(n1, m2), dot(n2, m1), dot(n2, m2));
    if any(dots < vec4f(-bound)) {
        return true;
    }
    return !all(dots > vec4f(bound)) && turns_over_exact(exact_quad(quad));
}

fn unit3(v: vec3u) -> i32 {
    return min(min(unit_exponent(v.x), unit_exponent(v.y)), unit_exponent(v.z));
}

fn minus(u: vec3u, v: vec3u, unit: i32) -> Exact3 {
    return Exact3(
        difference(on_grid(u.x, unit), on_grid(v.x, unit)),
        difference(on_grid(u.y, unit), on_grid(v.y, unit)),
        difference(on_grid(u.z, unit), on_grid(v.z, unit)),
    );
}

fn exact_quad(quad: Quad) -> ExactQuad {
    let unit = min(min(unit3(quad.a), unit3(quad.b)), min(unit3(quad.c), unit3(quad.d)));
    return ExactQuad(
        minus(quad.a, quad.c, unit),
        minus(quad.b, quad.c, unit),
        minus(quad.a, quad.d, unit),
        minus(quad.b, quad.d, unit),
    );
}

fn exact_dot(u: Exact3, v: Exact3) -> Int {
    var x = product(u.x, v.x);
    var y = product(u.y, v.y);
    var z = product(u.z, v.z);
    var xy = add(&x, &y, false);
    return add(&xy, &z, false);
}

// (u × v)·(w × x) = (u·w)(v·x) - (u·x)(v·w), the identity of Binet and Cauchy.
fn exact_normal_dot(u: Exact3, v: Exact3, w: Exact3, x: Exact3) -> Int {
    var first = exact_dot(u, w);
    var second = exact_dot(v, x);
    var left = multiply(&first, &second);
    first = exact_dot(u, x);
    second = exact_dot(v, w);
    var right = multiply(&first, &second);
    return add(&left, &right, true);
}

// The sign of √(n1²)·dot2 + √(n2²)·dot1: of equal signs of the two terms that sign, else by their squares.
fn is_non_delaunay_exact(quad: ExactQuad) -> bool {
    var square1 = exact_normal_dot(quad.p, quad.q, quad.p, quad.q);
    var square2 = exact_normal_dot(quad.s, quad.r, quad.s, quad.r);
    var dot1 = exact_dot(quad.p, quad.q);
    var dot2 = exact_dot(quad.s, quad.r);
    var dot1_square = multiply(&dot1, &dot1);
    var dot2_square = multiply(&dot2, &dot2);
    // The squares with the signs of what was squared.
    dot1_square.negative = dot1.negative;
    dot2_square.negative = dot2.negative;
    return sum_of_products_sign(&square1, &dot2_square, &square2, &dot1_square) < 0;
}

// Whether n·m < k|n||m|, of the dot product and the squares of the lengths.
fn exceeds_exact(cosine: ptr<function, Int>, square1: ptr<function, Int>, square2: ptr<function, Int>) -> bool {
    let left_sign = int_sign(cosine);
    let right_sign = params.cos_sign * int_sign(square1) * int_sign(square2);
    if left_sign != right_sign {
        return left_sign < right_sign;
    }
    if left_sign == 0 {
        return false;
    }
    var left = multiply(cosine, cosine);
    var power: Int;
    power.len = params.cos_shift / 32u + 1u;
    power.limbs[params.cos_shift / 32u] = 1u << (params.cos_shift % 32u);
    left = multiply(&left, &power);
    var k_square: Int;
    for (var i = 0u; i < 4u; i++) {
        k_square.limbs[i] = params.cos_square[i];
        if params.cos_square[i] != 0u {
            k_square.len = i + 1u;
        }
    }
    var right = multiply(square1, square2);
    right = multiply(&right, &k_square);
    return compare_magnitude(&left, &right) * left_sign < 0;
}

fn exceeds_angle_exact(quad: ExactQuad) -> bool {
    var cosine = exact_normal_dot(quad.p, quad.q, quad.s, quad.r);
    var square1 = exact_normal_dot(quad.p, quad.q, quad.p, quad.q);
    var square2 = exact_normal_dot(quad.s, quad.r, quad.s, quad.r);
    if exceeds_exact(&cosine, &square1, &square2) {
        return true;
    }
    cosine = exact_normal_dot(quad.r, quad.p, quad.q, quad.s);
    square1 = exact_normal_dot(quad.r, quad.p, quad.r, quad.p);
    square2 = exact_normal_dot(quad.q, quad.s, quad.q, quad.s);
    return exceeds_exact(&cosine, &square1, &square2);
}

fn turns_over_exact(quad: ExactQuad) -> bool {
    var cosine = exact_normal_dot(quad.p, quad.q, quad.r, quad.p);
    if int_sign(&cosine) < 0 {
        return true;
    }
    cosine = exact_normal_dot(quad.p, quad.q, quad.q, quad.s);
    if int_sign(&cosine) < 0 {
        return true;
    }
    cosine = exact_normal_dot(quad.s, quad.r, quad.r, quad.p);
    if int_sign(&cosine) < 0 {
        return true;
    }
    cosine = exact_normal_dot(quad.s, quad.r, quad.q, quad.s);
    return int_sign(&cosine) < 0;
}
