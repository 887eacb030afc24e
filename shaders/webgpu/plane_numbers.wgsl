// Tests edges in the plane by exact integers.
#import doubts
#import mesh
#import numbers
#import points
#import products
#import state
#import verdicts

const IN_CIRCLE: u32 = 0u;

// Offsets of the results of this program: the value of the in-circle test, and the areas of both new triangles.
const VALUE: u32 = 272u;
const FIRST: u32 = 308u;
const SECOND: u32 = 344u;

// The verdict on any edge. All invocations of a workgroup call it for the same one.
fn exact_verdict_on(a: Point, b: Point, c: Point, d: Point, winding: i32) -> u32 {
    put_given(digit_of_differences(a, b, c, d));
    run(IN_CIRCLE);
    var verdict = DELAUNAY;
    if winding * sign_at(VALUE) < 0 {
        let least = min(winding * sign_at(FIRST), winding * sign_at(SECOND));
        verdict = select(LABELLED, BLOCKED_BY + REASON_FOLD, least <= 0);
    }
    return verdict;
}

// The sign of the area of a triangle.
fn exact_sign_of(a: Point, b: Point, c: Point) -> i32 {
    let grid = grid_of(a, b, c, c);
    let u = exact_differences(b, a, grid);
    let v = exact_differences(c, a, grid);
    return sign_of_difference(u[0], v[1], u[1], v[0]);
}

// The verdict on each edge, UNDECIDED if the invocations have to decide it together. In the preparation, 1 plus the sign
// of the triangle.
fn verdicts_alone(t: u32) -> vec3u {
    var verdicts = vec3u();
    if step_.task == PREPARE {
        let sign = exact_sign_of(position(vertex(3u * t)), position(vertex(3u * t + 1u)), position(vertex(3u * t + 2u)));
        verdicts.x = u32(1 + sign);
    } else {
        verdicts = close_verdicts_on(t, step_.task == CENSUS);
    }
    return verdicts;
}

fn prepare(t: u32, verdicts: vec3u) {
    choices[t] = verdicts.x;
}
