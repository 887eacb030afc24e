// Tests the three edges of a triangle in the plane together: they share its sides and its area, and one scale.
#import mesh
#import plane
#import points
#import state

// The verdicts on ab, bc and ca; UNDECIDED if the filter of `filtered_verdict_on` cannot decide with the shared scale and
// area, or if an edge might fold.
fn verdicts_together(
    a: Point,
    b: Point,
    c: Point,
    beyond_ab: Point,
    beyond_bc: Point,
    beyond_ca: Point,
    winding: i32,
) -> vec3u {
    let raw_ab = rounded_difference(b, a).xy;
    let raw_bc = rounded_difference(c, b).xy;
    let raw_ca = rounded_difference(a, c).xy;
    let raw_r = mat3x2f(
        rounded_difference(a, beyond_ab).xy,
        rounded_difference(b, beyond_bc).xy,
        rounded_difference(c, beyond_ca).xy,
    );
    let raw_s = mat3x2f(
        rounded_difference(b, beyond_ab).xy,
        rounded_difference(c, beyond_bc).xy,
        rounded_difference(a, beyond_ca).xy,
    );
    let largest = max(max(max(abs(raw_ab), abs(raw_bc)), abs(raw_ca)), max(largest_of(raw_r), largest_of(raw_s)));
    let scale = scale_for(max(largest.x, largest.y));
    let ab = scale * raw_ab;
    let bc = scale * raw_bc;
    let ca = scale * raw_ca;
    let r = scale * raw_r;
    let s = scale * raw_s;
    let at_c = angle_of(ca, -bc);
    return vec3u(
        verdict_of(winding * in_circle_sign(at_c, angle_of(s[0], r[0]))),
        verdict_of(winding * in_circle_sign(with_area_of(at_c, ab, ca), angle_of(s[1], r[1]))),
        verdict_of(winding * in_circle_sign(with_area_of(at_c, bc, ab), angle_of(s[2], r[2]))),
    );
}

fn largest_of(vectors: mat3x2f) -> vec2f {
    return max(max(abs(vectors[0]), abs(vectors[1])), abs(vectors[2]));
}

// The angle of -u and v in the triangle. All three cross products are twice its area.
fn with_area_of(other: Angle, u: vec2f, v: vec2f) -> Angle {
    let dot = u * v;
    return Angle(other.x, -dot.x - dot.y, other.z, abs(dot.x) + abs(dot.y));
}

fn verdict_of(in_circle: i32) -> u32 {
    return select(select(UNDECIDED, DELAUNAY, in_circle > 0), LABELLED, in_circle < 0 && is_strict());
}
