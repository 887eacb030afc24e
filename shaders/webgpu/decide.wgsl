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

var<workgroup> limit: u32;
var<workgroup> together: u32;
// Waiting triangles, in no order.
var<workgroup> waiting: array<u32, CHUNKS * WORKGROUP_SIZE>;
// The half-edges of the edges that are still undecided in as many triangles as there are invocations, in no order.
var<workgroup> undecided: array<u32, 3u * DECIDERS>;
// How many entries either list has.
var<workgroup> counter: atomic<u32>;
var<workgroup> counted: u32;

// Each invocation tries a triangle of its own: many ties, as those of a lattice, need no long integers. All decide
// together what is left, edge by edge.
@compute @workgroup_size(DECIDERS)
fn decide_all(
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) local: u32,
    @builtin(num_workgroups) groups: vec3u,
) {
    lane = local;
    let index = index_of_task();
    let work = work_of_task(index);
    if local == 0u {
        limit = select(0u, work.count, has_doubts());
        // In a list, most chunks may be doubtful, so a workgroup takes one at a time, and all workgroups share them.
        together = select(CHUNKS, 1u, work.is_listed || decides_few());
    }
    let end = workgroupUniformLoad(&limit);
    let step = workgroupUniformLoad(&together);
    for (var first = step * group.x; first * WORKGROUP_SIZE < end; first += step * groups.x) {
        let bits = doubtful_chunks(first, step);
        for (var chunk = 0u; chunk < step; chunk++) {
            if ((bits >> chunk) & 1u) == 1u {
                collect((first + chunk) * WORKGROUP_SIZE, work);
            }
        }
        let count = min(counted_entries(), params.most_decided);
        for (var i = 0u; i < count; i += DECIDERS) {
            decide(i + lane, count, params.first + index);
        }
        if decides_few() && count > 0u {
            break;
        }
    }
}

// Whether a workgroup decides few triangles per dispatch, in several dispatches: for drivers that end loops too early,
// see rounds.wgsl.
fn decides_few() -> bool {
    return params.most_decided != NONE;
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
fn collect(first: u32, work: Work) {
    for (var i = first + lane; i < min(first + WORKGROUP_SIZE, work.count); i += DECIDERS) {
        let t = active_triangle(work, i);
        if choices[waiting_index(t)] == DOUBTFUL {
            waiting[atomicAdd(&counter, 1u)] = t;
        }
    }
}

// The length of a list that all invocations have appended to. The next list is empty.
fn counted_entries() -> u32 {
    workgroupBarrier();
    if lane == 0u {
        counted = atomicExchange(&counter, 0u);
    }
    return workgroupUniformLoad(&counted);
}

// Decides a waiting triangle for each invocation, if there are so many.
fn decide(i: u32, count: u32, iteration: u32) {
    var t = NONE;
    var verdicts = vec3u();
    if i < count {
        t = waiting[i];
        verdicts = verdicts_alone(t);
        for (var k = 0u; k < 3u; k++) {
            if verdict_at(verdicts, k) == UNDECIDED {
                undecided[atomicAdd(&counter, 1u)] = 3u * t + k;
            }
        }
    }
    let edges = counted_entries();
    for (var edge = 0u; edge < edges; edge++) {
        let h = undecided[edge];
        let g = twin(h);
        let winding = select(1, -1, is_clockwise(h / 3u));
        let a = position(vertex(h));
        let b = position(vertex(next(h)));
        let c = position(vertex(prev(h)));
        let d = position(vertex(prev(g)));
        let verdict = exact_verdict_on(a, b, c, d, winding);
        if h / 3u == t {
            verdicts = with_verdict(verdicts, h % 3u, verdict);
        }
    }
    if i < count && step_.task == PREPARE {
        prepare(t, verdicts);
    } else if i < count && step_.task == CENSUS {
        choices[waiting_index(t)] = packed(verdicts);
    } else if i < count {
        choices[t] = label(t, iteration, verdicts);
    }
}
