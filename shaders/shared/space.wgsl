// Tests edges in space by float filters: the angle sum, the angle between normals, and normals that turn over, as
// src/predicates/space.rs.
#import any_deviation if any_deviation
#import deviation if deviation
#import mesh
#import normals
#import points

// Four signs of an edge, each -1 if a condition holds, 1 if not, 0 if undecided. The conditions: the opposite angles
// sum to more than π; before the flip, the angle between the normals is larger than β; after the flip, it is larger
// than β; a new normal has a negative dot product with an old one.
alias Signs = vec4i;

// DELAUNAY, BLOCKED_BY + REASON_ANGLE or REASON_FOLD, or LABELLED; UNDECIDED if a sign that matters is undecided.
fn verdict_of(signs: Signs) -> u32 {
    let angle = min(signs.y, signs.z);
    var verdict = select(select(LABELLED, BLOCKED_BY + REASON_FOLD, signs.w < 0), BLOCKED_BY + REASON_ANGLE, angle < 0);
    verdict = select(verdict, UNDECIDED, signs.x == 0 || angle == 0 || (angle > 0 && signs.w == 0));
    return select(verdict, DELAUNAY, signs.x > 0);
}

// The verdict on the geometry of an edge: DELAUNAY, BLOCKED_BY + REASON_ANGLE, REASON_FOLD or REASON_DEVIATION, or
// LABELLED; UNDECIDED if `exact_verdict_on` has to decide. The winding has no meaning in space.
fn filtered_verdict_on(a: Point, b: Point, c: Point, d: Point, winding: i32) -> u32 {
    return verdict_by(a, b, c, d, false);
}

// The verdict where that gives UNDECIDED, by a filter that is slower and decides more.
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

// If the first sign is 1, the others are 1 too.
fn filtered_signs(a: Point, b: Point, c: Point, d: Point, is_precise: bool) -> Signs {
    var signs = Signs(1, 1, 1, 1);
    if !has_right_angles(a, b, c, d) {
        signs = rounded_signs(a, b, c, d, is_precise);
    }
    return signs;
}

fn rounded_signs(a: Point, b: Point, c: Point, d: Point, is_precise: bool) -> Signs {
    let quad = quad_of(a, b, c, d);
    let old = old_normals(quad, is_precise);
    var signs = Signs(angle_sum_sign(old[0], old[1], sized_dot(quad[0], quad[1]), sized_dot(quad[3], quad[2])), 1, 1, 1);
    if signs.x <= 0 {
        let updated = new_normals(quad, is_precise);
        signs = Signs(signs.x, angle_sign(old), angle_sign(updated), turn_sign(old, updated));
    }
    return signs;
}

// The sign of |n|·(r·s) + |m|·(p·q), for the normals n of (a, b, c) and m of (b, a, d), and for both dot products with the
// products of the sizes of their vectors.
fn angle_sum_sign(n: Normal, m: Normal, at_c: vec2f, at_d: vec2f) -> i32 {
    let value = sqrt(dot(n.xyz, n.xyz)) * at_d.x + sqrt(dot(m.xyz, m.xyz)) * at_c.x;
    return sign_of(value, max(n.w * at_d.y, m.w * at_c.y));
}

// The dot product of two vectors, and the product of their sizes.
fn sized_dot(u: vec3f, v: vec3f) -> vec2f {
    return vec2f(dot(u, v), size(u) * size(v));
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
