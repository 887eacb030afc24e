// Surfaces in space: the angle sum, the angle between normals against β, and normals that turn over, as
// src/predicates/space.rs.

const DIMENSION: u32 = 3u;

// As in space.rs, with ε = 2^-23, differences that err by up to 3ε and a sqrt that errs by 5ε: each of the two terms of
// the angle sum errs by at most 14.7 + 9.1 + 1 + 1.05 = 25.9ε of the product of its sizes, their sum by 51.7ε of the
// larger product; a product of normals less k|n||m| by 19.1 + 31.4 + 0.5 + 2.1 = 53.1ε, cos β being rounded to f32 too,
// of the product of the four sizes. The sizes of a normal are those of the two vectors that it is made from. 64 leaves
// room.
const SPACE_BOUND: f32 = 7.6293945e-6;
// What is flushed, see points.wgsl, is below 2^-46.
const SPACE_FLUSHED: f32 = 5.684342e-14;

// The vectors p = a - c, q = b - c, r = a - d, s = b - d.
alias Sides = mat4x3f;

// They, a - b and c - d, scaled; all zero where no filter can decide.
alias Quad = array<vec3f, 6>;

fn quad_of(a: Point, b: Point, c: Point, d: Point) -> Quad {
    let sides = unscaled(a, b, c, d);
    let scale = scale_for(largest_of(sides));
    return Quad(
        scale * sides[0],
        scale * sides[1],
        scale * sides[2],
        scale * sides[3],
        scale * rounded_difference(a, b),
        scale * rounded_difference(c, d),
    );
}

fn unscaled(a: Point, b: Point, c: Point, d: Point) -> Sides {
    return Sides(rounded_difference(a, c), rounded_difference(b, c), rounded_difference(a, d), rounded_difference(b, d));
}

fn largest_of(sides: Sides) -> f32 {
    let largest = max(max(abs(sides[0]), abs(sides[1])), max(abs(sides[2]), abs(sides[3])));
    return max(max(largest.x, largest.y), largest.z);
}

fn size(v: vec3f) -> f32 {
    return abs(v.x) + abs(v.y) + abs(v.z);
}

// A normal, and the product of the sizes of the two vectors that it is made from.
alias Normal = vec4f;

// u × v, given w = u - v. A precise one is made from the two shortest of them, as w × v or w × u may be: of a needle
// that is off by far less.
fn normal_of(u: vec3f, v: vec3f, w: vec3f, is_precise: bool) -> Normal {
    let takes_w = is_precise && size(w) < max(size(u), size(v));
    let first = select(u, w, takes_w);
    let second = select(v, u, takes_w && size(u) < size(v));
    return Normal(cross(first, second), size(first) * size(second));
}

alias Normals = mat2x4f;

// The normals of the triangles (a, b, c) and (b, a, d).
fn old_normals(quad: Quad, is_precise: bool) -> Normals {
    return Normals(
        normal_of(quad[0], quad[1], quad[4], is_precise),
        normal_of(quad[3], quad[2], -quad[4], is_precise),
    );
}

// Those of (c, d, a) and (d, c, b).
fn new_normals(quad: Quad, is_precise: bool) -> Normals {
    return Normals(
        normal_of(quad[2], quad[0], quad[5], is_precise),
        normal_of(quad[1], quad[3], -quad[5], is_precise),
    );
}

// Of a value that is off by as much as `sizes` allow; 0 where the filter cannot decide.
fn sign_of(value: f32, sizes: f32) -> i32 {
    return filtered_sign(value, SPACE_BOUND * sizes + SPACE_FLUSHED);
}

// What the geometry of an edge says: -1 where the opposite angles sum to more than π; where the angle between the normals
// is larger than β before the flip; after it; where a new normal has a negative dot product with an old one. 1 where not,
// 0 where that is open.
alias Signs = vec4i;

// DELAUNAY, BLOCKED_BY + REASON_ANGLE or REASON_FOLD, or LABELLED; UNDECIDED while a sign that matters is open.
fn verdict_of(signs: Signs) -> u32 {
    let angle = min(signs.y, signs.z);
    var verdict = select(select(LABELLED, BLOCKED_BY + REASON_FOLD, signs.w < 0), BLOCKED_BY + REASON_ANGLE, angle < 0);
    verdict = select(verdict, UNDECIDED, signs.x == 0 || angle == 0 || (angle > 0 && signs.w == 0));
    return select(verdict, DELAUNAY, signs.x > 0);
}

// Whether an edge may flip by its geometry: DELAUNAY, BLOCKED_BY + REASON_ANGLE, REASON_FOLD or REASON_DEVIATION, or
// LABELLED; UNDECIDED where `exact_verdict_on` has to decide. The winding has no meaning in space.
fn filtered_verdict_on(a: Point, b: Point, c: Point, d: Point, winding: i32) -> u32 {
    var verdict = verdict_of(filtered_signs(a, b, c, d, false));
    if verdict == LABELLED {
        verdict = filtered_deviation(a, b, c, d);
    }
    return verdict;
}

// The same of any edge: by a filter that takes longer and leaves less, then by integers.
fn exact_verdict_on(a: Point, b: Point, c: Point, d: Point, winding: i32) -> u32 {
    var signs = filtered_signs(a, b, c, d, true);
    if verdict_of(signs) == UNDECIDED {
        signs = exact_signs(a, b, c, d, signs);
    }
    var verdict = verdict_of(signs);
    if verdict == LABELLED {
        verdict = filtered_deviation(a, b, c, d);
    }
    if verdict == UNDECIDED {
        verdict = exact_deviation(a, b, c, d);
    }
    return verdict;
}

// All but the first are 1 where that is.
fn filtered_signs(a: Point, b: Point, c: Point, d: Point, is_precise: bool) -> Signs {
    let quad = quad_of(a, b, c, d);
    let old = old_normals(quad, is_precise);
    var signs = Signs(angle_sum_sign(quad, old), 1, 1, 1);
    if signs.x <= 0 {
        let updated = new_normals(quad, is_precise);
        signs = Signs(signs.x, angle_sign(old), angle_sign(updated), turn_sign(old, updated));
    }
    return signs;
}

fn angle_sum_sign(quad: Quad, old: Normals) -> i32 {
    let n1 = old[0].xyz;
    let n2 = old[1].xyz;
    let value = sqrt(dot(n1, n1)) * dot(quad[3], quad[2]) + sqrt(dot(n2, n2)) * dot(quad[0], quad[1]);
    return sign_of(value, max(old[0].w * (size(quad[3]) * size(quad[2])), old[1].w * (size(quad[0]) * size(quad[1]))));
}

fn angle_sign(normals: Normals) -> i32 {
    let n = normals[0].xyz;
    let m = normals[1].xyz;
    let value = dot(n, m) - cos_rounded() * (sqrt(dot(n, n)) * sqrt(dot(m, m)));
    return select(sign_of(value, normals[0].w * normals[1].w), 1, has_any_angle());
}

fn turn_sign(old: Normals, updated: Normals) -> i32 {
    return min(
        min(dot_sign(old[0], updated[0]), dot_sign(old[0], updated[1])),
        min(dot_sign(old[1], updated[0]), dot_sign(old[1], updated[1])),
    );
}

fn dot_sign(n: Normal, m: Normal) -> i32 {
    return sign_of(dot(n.xyz, m.xyz), n.w * m.w);
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

// The signs, those that are open and matter by integers.
fn exact_signs(a: Point, b: Point, c: Point, d: Point, filtered: Signs) -> Signs {
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
    var signs = filtered;
    if signs.x == 0 {
        signs.x = narrow_angle_sum_sign(p, q, r, s, count);
    }
    if verdict_of(signs) == UNDECIDED {
        signs = wide_signs(p, q, r, s, count, signs);
    }
    return signs;
}

fn wide_signs(p: Vector, q: Vector, r: Vector, s: Vector, count: u32, narrow: Signs) -> Signs {
    let pp = dot_of(p, p, count);
    let pq = dot_of(p, q, count);
    let qq = dot_of(q, q, count);
    let rr = dot_of(r, r, count);
    let rs = dot_of(r, s, count);
    let ss = dot_of(s, s, count);
    // Of the old normals n1 = p × q and n2 = s × r.
    let n1_square = determinant(pp, qq, pq, pq, count);
    let n2_square = determinant(ss, rr, rs, rs, count);
    var signs = narrow;
    if signs.x == 0 {
        signs.x = select(1, -1, is_angle_sum_negative(n1_square, rs, n2_square, pq, count));
    }
    if verdict_of(signs) == UNDECIDED {
        let pr = dot_of(p, r, count);
        let ps = dot_of(p, s, count);
        let qr = dot_of(q, r, count);
        let qs = dot_of(q, s, count);
        // The old normals, then the new ones, m1 = r × p and m2 = q × s.
        var n_square = n1_square;
        var m_square = n2_square;
        var cosine = determinant(ps, qr, pr, qs, count);
        for (var round = 0u; round < 2u; round++) {
            if select(signs.y, signs.z, round == 1u) == 0 {
                if round == 1u {
                    n_square = determinant(rr, pp, pr, pr, count);
                    m_square = determinant(qq, ss, qs, qs, count);
                    cosine = determinant(qr, ps, rs, pq, count);
                }
                let angle = select(1, -1, exceeds_angle(n_square, m_square, cosine));
                signs = select(Signs(signs.x, angle, signs.zw), Signs(signs.xy, angle, signs.w), round == 1u);
            }
        }
        if signs.w == 0 {
            let turned = min(
                min(large_sign(determinant(pr, pq, pp, qr, count)), large_sign(determinant(pq, qs, ps, qq, count))),
                min(large_sign(determinant(rs, pr, ps, rr, count)), large_sign(determinant(qs, rs, ss, qr, count))),
            );
            signs.w = select(1, -1, turned < 0);
        }
    }
    return signs;
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
