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

// Triangles of a slice: one workgroup decides them. Neighbours in a chunk are often in doubt together, so slices of one
// chunk go to different workgroups.
const SLICE: u32 = 8u;

var<workgroup> limit: u32;
// Where doubtful slices begin, in no order.
var<workgroup> slices: array<u32, DECIDERS>;
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
    }
    let end = workgroupUniformLoad(&limit);
    let stride = SLICE * groups.x * groups.y;
    for (var first = SLICE * (group.y * groups.x + group.x); first < end; first += stride * DECIDERS) {
        let slice = first + stride * lane;
        if slice < end && is_doubtful(slice / WORKGROUP_SIZE) {
            slices[atomicAdd(&counter, 1u)] = slice;
        }
        let count = SLICE * counted_entries();
        for (var i = 0u; i < count; i += DECIDERS) {
            decide(i + lane, count, work, params.first + index);
        }
    }
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

// The length of a list that all invocations have appended to. The next list is empty.
fn counted_entries() -> u32 {
    workgroupBarrier();
    if lane == 0u {
        counted = atomicExchange(&counter, 0u);
    }
    return workgroupUniformLoad(&counted);
}

// Decides the triangles of as many entries of slices as there are invocations.
fn decide(i: u32, count: u32, work: Work, iteration: u32) {
    let at = slices[min(i, count - 1u) / SLICE] + i % SLICE;
    let t = active_triangle(work, min(at, work.count - 1u));
    let waits = i < count && at < work.count && choices[waiting_index(t)] == DOUBTFUL;
    var verdicts = vec3u();
    if waits {
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
        // In the preparation, this edge may have no twin.
        let d = position(vertex(select(prev(g), h, g == NONE)));
        let verdict = exact_verdict_on(a, b, c, d, winding);
        if waits && h / 3u == t {
            verdicts = with_verdict(verdicts, h % 3u, verdict);
        }
    }
    if waits && step_.task == PREPARE {
        prepare(t, verdicts);
    } else if waits && step_.task == CENSUS {
        choices[waiting_index(t)] = packed(verdicts);
    } else if waits {
        choices[t] = label(t, iteration, verdicts);
    }
}
