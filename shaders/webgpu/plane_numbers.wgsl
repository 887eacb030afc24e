// Tests edges in the plane by exact integers in memory.
#import doubts
#import mesh
#import numbers
#import points
#import state
#import verdicts

const IN_CIRCLE: u32 = 0u;
const AREAS: u32 = 1u;

// Offsets of the results of these programs: the value of the in-circle test, or the areas of both new triangles.
const FIRST: u32 = 359u;
const SECOND: u32 = 396u;

// The verdict on any edge. In the preparation, 1 plus the sign of the triangle a, b, c.
fn exact_verdict_on(a: Point, b: Point, c: Point, d: Point, winding: i32, task: u32) -> u32 {
    var far = d;
    if task == PREPARE {
        far = b;
    }
    put_differences(a, b, c, far, grid_of(a, b, c, far));
    var verdict = UNDECIDED;
    for (var program = select(IN_CIRCLE, AREAS, task == PREPARE); verdict == UNDECIDED; program++) {
        run(program);
        let first = sign_at(FIRST);
        let second = sign_at(SECOND);
        if task == PREPARE {
            verdict = u32(1 + first);
        } else if program == AREAS {
            verdict = select(LABELLED, BLOCKED_BY + REASON_FOLD, min(winding * first, winding * second) <= 0);
        } else if winding * first >= 0 {
            verdict = DELAUNAY;
        }
    }
    return verdict;
}

// In the preparation, UNDECIDED for the sign of the triangle; else the verdict of the filter on each edge.
fn filtered_answers(t: u32, task: u32) -> vec3u {
    var answers = vec3u(UNDECIDED, 0u, 0u);
    if task != PREPARE {
        answers = verdicts_on(t, task == CENSUS, false);
    }
    return answers;
}

fn prepare(t: u32, answers: vec3u) {
    choices[t] = answers.x;
}
