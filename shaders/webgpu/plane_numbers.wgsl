// Tests edges in the plane by exact integers.
#import doubts
#import mesh
#import numbers
#import points
#import state
#import verdicts

const IN_CIRCLE: u32 = 0u;

// Offsets of the results of this program: the value of the in-circle test, and the areas of both new triangles.
const VALUE: u32 = 272u;
const FIRST: u32 = 308u;
const SECOND: u32 = 344u;

// The verdict on any edge. In the preparation, 1 plus the sign of the triangle a, b, c. All invocations of a workgroup call
// it for the same edge.
fn exact_verdict_on(a: Point, b: Point, c: Point, d: Point, winding: i32) -> u32 {
    var far = d;
    if step_.task == PREPARE {
        far = b;
    }
    put_given(digit_of_differences(a, b, c, far));
    run(IN_CIRCLE);
    let first = sign_at(FIRST);
    var verdict = u32(1 + first);
    if step_.task != PREPARE {
        let is_fold = min(winding * first, winding * sign_at(SECOND)) <= 0;
        verdict = select(DELAUNAY, select(LABELLED, BLOCKED_BY + REASON_FOLD, is_fold), winding * sign_at(VALUE) < 0);
    }
    return verdict;
}

// The verdict on each edge, UNDECIDED if the invocations have to decide it together; in the preparation, UNDECIDED for the
// sign of the triangle.
fn verdicts_alone(t: u32) -> vec3u {
    var verdicts = vec3u(UNDECIDED, 0u, 0u);
    if step_.task != PREPARE {
        verdicts = close_verdicts_on(t, step_.task == CENSUS);
    }
    return verdicts;
}

fn prepare(t: u32, verdicts: vec3u) {
    choices[t] = verdicts.x;
}
