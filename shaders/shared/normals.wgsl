// Computes in floats the normals of the triangles of a quad, and the signs of values that are made of normals. A sign
// is 0 if rounding makes it uncertain.
#import points
#import state

// The bounds are found as in space.rs, with ε = 2^-23, differences that err by up to 3ε and a sqrt that errs by 5ε.
// Each of the two terms of the angle sum errs by at most 14.7 + 9.1 + 1 + 1.05 = 25.9ε of the product of its sizes.
// Their sum errs by at most 51.7ε of the larger product. With k = cos β, also rounded to f32, n·m - k|n||m| errs by at
// most 19.1 + 31.4 + 0.5 + 2.1 = 53.1ε of the product of the four sizes. The sizes of a normal are those of its two
// vectors. The bound is 64ε.
const SPACE_BOUND: f32 = 7.6293945e-6;
// Flushed values, see points.wgsl, are below 2^-46.
const SPACE_FLUSHED: f32 = 5.684342e-14;

// The vectors p = a - c, q = b - c, r = a - d, s = b - d.
alias Sides = mat4x3f;

// The vectors p, q, r, s, a - b and c - d, scaled; all are zero if no filter can decide.
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

// A normal, and the product of the sizes of its two vectors.
alias Normal = vec4f;

// u × v, given w = u - v. If precise, it uses the two shortest of u, v and w: for a needle, w × v or w × u has a far
// smaller error.
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

// The normals of the triangles (c, d, a) and (d, c, b).
fn new_normals(quad: Quad, is_precise: bool) -> Normals {
    return Normals(
        normal_of(quad[2], quad[0], quad[5], is_precise),
        normal_of(quad[1], quad[3], -quad[5], is_precise),
    );
}

// The sign of a value whose error is relative to `sizes`; 0 if the filter cannot decide.
fn sign_of(value: f32, sizes: f32) -> i32 {
    return filtered_sign(value, SPACE_BOUND * sizes + SPACE_FLUSHED);
}

// Whether the angle between two normals is at most β: 1 if it is, -1 if not, 0 if the filter cannot decide.
fn angle_sign(normals: Normals) -> i32 {
    let n = normals[0].xyz;
    let m = normals[1].xyz;
    let value = dot(n, m) - cos_rounded() * (sqrt(dot(n, n)) * sqrt(dot(m, m)));
    return select(sign_of(value, normals[0].w * normals[1].w), 1, has_any_angle());
}
