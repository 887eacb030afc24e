// Surfaces in space: the angle sum, the angle between normals against β, and normals that turn over, as
// src/predicates/space.rs.

const DIMENSION: u32 = 3u;

// As in space.rs, with ε = 2^-23, differences that err by up to 3ε and a sqrt that errs by 5ε: the angle sum errs by at
// most (14.7 + 9.1 + 1)·2 + 2.1 = 51.7ε, a product of normals less k|n||m| by 19.1 + 31.4 + 0.5 + 2.1 = 53.1ε, cos β
// being rounded to f32 too, of the product of the four sizes. 64 leaves room.
const SPACE_BOUND: f32 = 7.6293945e-6;
// What is flushed, see points.wgsl, is below 2^-46.
const SPACE_FLUSHED: f32 = 5.684342e-14;

// The vectors p = a - c, q = b - c, r = a - d, s = b - d, scaled; all zero where no filter can decide.
alias Quad = mat4x3f;

fn quad_of(a: Point, b: Point, c: Point, d: Point) -> Quad {
    let quad = unscaled(a, b, c, d);
    return scale_for(largest_of(quad)) * quad;
}

fn unscaled(a: Point, b: Point, c: Point, d: Point) -> Quad {
    return Quad(rounded_difference(a, c), rounded_difference(b, c), rounded_difference(a, d), rounded_difference(b, d));
}

fn largest_of(quad: Quad) -> f32 {
    let largest = max(max(abs(quad[0]), abs(quad[1])), max(abs(quad[2]), abs(quad[3])));
    return max(max(largest.x, largest.y), largest.z);
}

fn size(v: vec3f) -> f32 {
    return abs(v.x) + abs(v.y) + abs(v.z);
}

fn bound_of(quad: Quad) -> f32 {
    return SPACE_BOUND * (size(quad[0]) * size(quad[1])) * (size(quad[3]) * size(quad[2])) + SPACE_FLUSHED;
}

// Whether an edge may flip by its geometry: DELAUNAY, BLOCKED_BY + REASON_ANGLE, REASON_FOLD or REASON_DEVIATION, or
// LABELLED. The winding has no meaning in space.
fn verdict_on(a: Point, b: Point, c: Point, d: Point, winding: i32) -> u32 {
    var verdict = filtered_verdict_on(a, b, c, d, winding);
    if verdict == UNDECIDED {
        verdict = exact_verdict_on(a, b, c, d, winding);
    }
    return verdict;
}

// UNDECIDED where exact arithmetic has to decide.
fn filtered_verdict_on(a: Point, b: Point, c: Point, d: Point, winding: i32) -> u32 {
    let quad = quad_of(a, b, c, d);
    let bound = bound_of(quad);
    let sum = angle_sum_sign(quad, bound);
    var verdict = DELAUNAY;
    if sum <= 0 {
        let angle = compare_angles(quad, bound);
        let turned = compare_turns(quad);
        verdict = select(select(LABELLED, BLOCKED_BY + REASON_FOLD, turned < 0), BLOCKED_BY + REASON_ANGLE, angle < 0);
        verdict = select(verdict, UNDECIDED, sum == 0 || angle == 0 || (angle > 0 && turned == 0));
    }
    if verdict == LABELLED {
        verdict = filtered_deviation(a, b, c, d);
    }
    return verdict;
}

// -1 when the opposite angles sum to more than π; 0 where the filter cannot decide.
fn angle_sum_sign(quad: Quad, bound: f32) -> i32 {
    let n1 = cross(quad[0], quad[1]);
    let n2 = cross(quad[3], quad[2]);
    let value = sqrt(dot(n1, n1)) * dot(quad[3], quad[2]) + sqrt(dot(n2, n2)) * dot(quad[0], quad[1]);
    return filtered_sign(value, bound);
}

// -1 when the angle between the normals is larger than β before the flip or after it, 1 when it is not, 0
// where the filter cannot decide.
fn compare_angles(quad: Quad, bound: f32) -> i32 {
    let before = compare_angle(cross(quad[0], quad[1]), cross(quad[3], quad[2]), bound);
    let after = compare_angle(cross(quad[2], quad[0]), cross(quad[1], quad[3]), bound);
    // Not decided where one is 0 and none is -1.
    return select(min(before, after), 1, has_any_angle());
}

fn compare_angle(n: vec3f, m: vec3f, bound: f32) -> i32 {
    return filtered_sign(dot(n, m) - cos_rounded() * (sqrt(dot(n, n)) * sqrt(dot(m, m))), bound);
}

// -1 when a new normal has a negative dot product with an old one, 1 when none has, 0 where the filter cannot
// decide.
fn compare_turns(quad: Quad) -> i32 {
    let n1 = cross(quad[0], quad[1]);
    let n2 = cross(quad[3], quad[2]);
    let m1 = cross(quad[2], quad[0]);
    let m2 = cross(quad[1], quad[3]);
    // Of n1, n2, m1 and m2.
    let p = size(quad[0]);
    let q = size(quad[1]);
    let r = size(quad[2]);
    let s = size(quad[3]);
    let bound = SPACE_BOUND * vec4f((p * q) * (r * p), (p * q) * (q * s), (s * r) * (r * p), (s * r) * (q * s)) + SPACE_FLUSHED;
    let dots = vec4f(dot(n1, m1), dot(n1, m2), dot(n2, m1), dot(n2, m2));
    return select(select(0, 1, all(dots > bound)), -1, any(dots < -bound));
}

// x, y and z, of the digits of a Small each.
alias Vector = array<vec4i, 6>;

fn vector_of(differences: Differences) -> Vector {
    let x = digits_of(differences[0]);
    let y = digits_of(differences[1]);
    let z = digits_of(differences[2]);
    return Vector(x[0], x[1], y[0], y[1], z[0], z[1]);
}

fn dot_of(u: Vector, v: Vector, count: u32) -> Medium {
    return sum_of_products(
        Small(u[0], u[1]),
        Small(v[0], v[1]),
        Small(u[2], u[3]),
        Small(v[2], v[3]),
        Small(u[4], u[5]),
        Small(v[4], v[5]),
        count,
    );
}

// u·v - x·y: dot products of normals by the identity of Binet and Cauchy,
// (u × v)·(x × y) = (u·x)(v·y) - (u·y)(v·x).
fn determinant(u: Medium, v: Medium, x: Medium, y: Medium, count: u32) -> Large {
    return sum_of_medium_products(u, v, x, negated_medium(y), count);
}

fn exact_verdict_on(a: Point, b: Point, c: Point, d: Point, winding: i32) -> u32 {
    var verdict = exactly_on(a, b, c, d, false);
    if verdict == LABELLED {
        verdict = exact_deviation(a, b, c, d);
    }
    return verdict;
}

// With `angle_only`, only the angle before the flip is looked at: DELAUNAY or BLOCKED_BY + REASON_ANGLE.
fn exactly_on(a: Point, b: Point, c: Point, d: Point, angle_only: bool) -> u32 {
    let grid = grid_of(a, b, c, d);
    let from_ac = exact_differences(a, c, grid);
    let from_bc = exact_differences(b, c, grid);
    let from_ad = exact_differences(a, d, grid);
    let from_bd = exact_differences(b, d, grid);
    let widest = from_ac[0] | from_ac[1] | from_ac[2] | from_bc[0] | from_bc[1] | from_bc[2]
        | from_ad[0] | from_ad[1] | from_ad[2] | from_bd[0] | from_bd[1] | from_bd[2];
    let count = digits_in_use(widest);
    let p = vector_of(from_ac);
    let q = vector_of(from_bc);
    let r = vector_of(from_ad);
    let s = vector_of(from_bd);
    var verdict = DELAUNAY;
    if angle_only || !is_known_delaunay(p, q, r, s, count) {
        verdict = wide_verdict_on(p, q, r, s, count, angle_only);
    }
    return verdict;
}

fn wide_verdict_on(p: Vector, q: Vector, r: Vector, s: Vector, count: u32, angle_only: bool) -> u32 {
    let pp = dot_of(p, p, count);
    let pq = dot_of(p, q, count);
    let qq = dot_of(q, q, count);
    let rr = dot_of(r, r, count);
    let rs = dot_of(r, s, count);
    let ss = dot_of(s, s, count);
    // Of the old normals n1 = p × q and n2 = s × r.
    let n1_square = determinant(pp, qq, pq, pq, count);
    let n2_square = determinant(ss, rr, rs, rs, count);
    var verdict = DELAUNAY;
    if angle_only || is_angle_sum_negative(n1_square, rs, n2_square, pq, count) {
        let pr = dot_of(p, r, count);
        let ps = dot_of(p, s, count);
        let qr = dot_of(q, r, count);
        let qs = dot_of(q, s, count);
        var is_over = false;
        if !has_any_angle() {
            // The old normals, then the new ones, m1 = r × p and m2 = q × s.
            var n_square = n1_square;
            var m_square = n2_square;
            var cosine = determinant(ps, qr, pr, qs, count);
            let most = select(2u, 1u, angle_only);
            for (var round = 0u; round < most; round++) {
                if round == 1u {
                    n_square = determinant(rr, pp, pr, pr, count);
                    m_square = determinant(qq, ss, qs, qs, count);
                    cosine = determinant(qr, ps, rs, pq, count);
                }
                is_over = is_over || exceeds_angle(n_square, m_square, cosine);
            }
        }
        let turned = min(
            min(large_sign(determinant(pr, pq, pp, qr, count)), large_sign(determinant(pq, qs, ps, qq, count))),
            min(large_sign(determinant(rs, pr, ps, rr, count)), large_sign(determinant(qs, rs, ss, qr, count))),
        );
        verdict = select(LABELLED, BLOCKED_BY + REASON_FOLD, turned < 0);
        verdict = select(verdict, DELAUNAY, angle_only);
        verdict = select(verdict, BLOCKED_BY + REASON_ANGLE, is_over);
    }
    return verdict;
}

// Whether √(n1²)·dot2 + √(n2²)·dot1 < 0: by the squares, with the signs of what was squared.
fn is_angle_sum_negative(n1_square: Large, dot2: Medium, n2_square: Large, dot1: Medium, count: u32) -> bool {
    let first = large_sign(n1_square) * medium_sign(dot2);
    let second = large_sign(n2_square) * medium_sign(dot1);
    var sum = first + second;
    if first * second < 0 {
        let zero = Medium();
        let square2 = sum_of_medium_products(dot2, dot2, zero, zero, count);
        let square1 = negated_large(sum_of_medium_products(dot1, dot1, zero, zero, count));
        sum = first * sum_of_large_products_sign(n1_square, square2, n2_square, square1, 8u * count + 3u);
    }
    return sum < 0;
}

// Whether n·m < k|n||m|, given n², m² and n·m.
fn exceeds_angle(n_square: Large, m_square: Large, cosine: Large) -> bool {
    let left_sign = large_sign(cosine);
    let right_sign = cos_sign() * large_sign(n_square) * large_sign(m_square);
    var difference_sign = left_sign - right_sign;
    if left_sign * right_sign > 0 {
        // With |k| = mantissa / 2^shift: (n·m·2^shift)² against (n²·mantissa)·(m²·mantissa).
        let left = scaled(cosine, cos_power());
        let right_n = scaled(n_square, cos_mantissa());
        let right_m = negated_large(scaled(m_square, cos_mantissa()));
        difference_sign = left_sign * sum_of_large_products_sign(left, left, right_n, right_m, 73u);
    }
    return difference_sign < 0;
}
