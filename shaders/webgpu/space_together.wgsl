// Tests the three edges of a triangle in space together: they share its sides and its normal, and one scale.
#import mesh
#import normals
#import points
#import space

// DELAUNAY for each of ab, bc and ca that is Delaunay by the filter of the angle sum; else UNDECIDED. The winding has no
// meaning in space.
fn verdicts_together(
    a: Point,
    b: Point,
    c: Point,
    beyond_ab: Point,
    beyond_bc: Point,
    beyond_ca: Point,
    winding: i32,
) -> vec3u {
    let raw = mat3x3f(rounded_difference(b, a), rounded_difference(c, b), rounded_difference(a, c));
    let raw_r = mat3x3f(
        rounded_difference(a, beyond_ab),
        rounded_difference(b, beyond_bc),
        rounded_difference(c, beyond_ca),
    );
    let raw_s = mat3x3f(
        rounded_difference(b, beyond_ab),
        rounded_difference(c, beyond_bc),
        rounded_difference(a, beyond_ca),
    );
    let largest = max(greatest(raw), max(greatest(raw_r), greatest(raw_s)));
    let scale = scale_for(max(max(largest.x, largest.y), largest.z));
    let sides = scale * raw;
    let r = scale * raw_r;
    let s = scale * raw_s;
    let normal = normal_of(sides[1], sides[2], vec3f(), false);
    return vec3u(
        verdict_beyond(normal, sized_dot(sides[2], -sides[1]), r[0], s[0]),
        verdict_beyond(normal, sized_dot(sides[0], -sides[2]), r[1], s[1]),
        verdict_beyond(normal, sized_dot(sides[1], -sides[0]), r[2], s[2]),
    );
}

fn greatest(vectors: mat3x3f) -> vec3f {
    return max(max(abs(vectors[0]), abs(vectors[1])), abs(vectors[2]));
}

// The verdict on an edge, from p·q in the triangle with this normal, and r and s of the other one.
fn verdict_beyond(normal: Normal, at_c: vec2f, r: vec3f, s: vec3f) -> u32 {
    let sum = angle_sum_sign(normal, normal_of(s, r, vec3f(), false), at_c, sized_dot(s, r));
    return select(UNDECIDED, DELAUNAY, sum > 0);
}
