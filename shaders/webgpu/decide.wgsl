// Decides the edges that the filters leave undecided, by exact arithmetic: in an iteration, the census or the
// preparation.
#import active
#import doubts
#import history_read
#import label
#import mesh
#import numbers
#import plane_numbers if plane
#import points
#import space_numbers if space
#import state
#import verdicts

// Invocations of a workgroup, each with its own lane.
const DECIDERS: u32 = 64u;

var<workgroup> limit: u32;
var<workgroup> together: u32;
// Waiting triangles, in no order.
var<workgroup> waiting: array<u32, CHUNKS * WORKGROUP_SIZE>;
var<workgroup> waiting_count: atomic<u32>;
var<workgroup> found: u32;

@compute @workgroup_size(DECIDERS)
fn decide_all(
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) local: u32,
    @builtin(num_workgroups) groups: vec3u,
) {
    lane = group.x * DECIDERS + local;
    let index = index_of_task();
    let work = work_of_task(index);
    if local == 0u {
        limit = select(0u, work.count, has_doubts());
        // In a list, most chunks may be doubtful, so a workgroup takes one at a time, and all workgroups share them.
        together = select(CHUNKS, 1u, work.is_listed || decides_one());
    }
    let end = workgroupUniformLoad(&limit);
    let step = workgroupUniformLoad(&together);
    for (var first = step * group.x; first * WORKGROUP_SIZE < end; first += step * groups.x) {
        let bits = doubtful_chunks(first, step);
        for (var chunk = 0u; chunk < step; chunk++) {
            if ((bits >> chunk) & 1u) == 1u {
                collect((first + chunk) * WORKGROUP_SIZE, work, local);
            }
        }
        workgroupBarrier();
        if local == 0u {
            found = atomicExchange(&waiting_count, 0u);
        }
        let count = workgroupUniformLoad(&found);
        let end_of_answers = select(count, min(count, DECIDERS), decides_one());
        for (var i = local; i < end_of_answers; i += DECIDERS) {
            answer(waiting[i], params.first + index);
        }
        if decides_one() && count > 0u {
            break;
        }
        workgroupBarrier();
    }
}

// Whether each invocation decides one triangle per dispatch, in several dispatches: for drivers that end loops too
// early, see rounds.wgsl.
fn decides_one() -> bool {
    return params.decides_one == 1u;
}

// The iteration; without meaning for other tasks.
fn index_of_task() -> u32 {
    return select(step_.index, history_word(PAUSED) - 1u, step_.task == RESUME);
}

fn work_of_task(index: u32) -> Work {
    var work = Work(params.triangles, false, true, 0u);
    if index == NONE {
        work.count = 0u;
    } else if step_.task == ITERATE || step_.task == RESUME {
        work = active_at(index);
    }
    return work;
}

// Collects the waiting triangles of a chunk.
fn collect(first: u32, work: Work, local: u32) {
    for (var i = first + local; i < min(first + WORKGROUP_SIZE, work.count); i += DECIDERS) {
        let t = active_triangle(work, i);
        if choices[waiting_index(t)] == DOUBTFUL {
            waiting[atomicAdd(&waiting_count, 1u)] = t;
        }
    }
}

fn answer(t: u32, iteration: u32) {
    let answers = exact_answers(t, filtered_answers(t, step_.task), step_.task);
    if step_.task == PREPARE {
        prepare(t, answers);
    } else if step_.task == CENSUS {
        choices[waiting_index(t)] = packed(answers);
    } else {
        choices[t] = label(t, iteration, answers);
    }
}

// Uses exact arithmetic for the edges that the filter does not decide: mostly one edge of a triangle. The loop begins
// with an undecided edge, so that all invocations compute at the same time.
fn exact_answers(t: u32, filtered: vec3u, task: u32) -> vec3u {
    let winding = select(1, -1, is_clockwise(t));
    var answers = filtered;
    var k = first_undecided(answers);
    while k < 3u {
        let h = 3u * t + k;
        let a = position(vertex(h));
        let b = position(vertex(next(h)));
        let c = position(vertex(prev(h)));
        // In the plane, the preparation needs only the triangle, and this edge may have no twin.
        let g = twin(h);
        let d = position(vertex(select(prev(g), h, g == NONE)));
        answers = with_verdict(answers, k, exact_verdict_on(a, b, c, d, winding, task));
        k = first_undecided(answers);
    }
    return answers;
}

// The first undecided edge; 3 if all are decided.
fn first_undecided(verdicts: vec3u) -> u32 {
    let is_undecided = verdicts == vec3u(UNDECIDED);
    return select(select(select(3u, 2u, is_undecided.z), 1u, is_undecided.y), 0u, is_undecided.x);
}
