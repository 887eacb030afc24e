// Surfaces in space: the filters of the angle sum, of the angle between normals against β, and of normals that turn over,
// as src/predicates/space.rs.

const DIMENSION: u32 = 3u;

// Whether Label takes the close look at once: few edges need it.
const LABELS_CLOSELY: bool = false;

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
    return verdict_by(a, b, c, d, false);
}

// The same by a filter that takes longer and leaves less.
fn close_verdict_on(a: Point, b: Point, c: Point, d: Point, winding: i32) -> u32 {
    return verdict_by(a, b, c, d, true);
}

fn verdict_by(a: Point, b: Point, c: Point, d: Point, is_precise: bool) -> u32 {
    var verdict = verdict_of(filtered_signs(a, b, c, d, is_precise));
    if verdict == LABELLED {
        verdict = filtered_deviation(a, b, c, d);
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
