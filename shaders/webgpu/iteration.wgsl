// The kernel of Flip, and the tail: a kernel that runs whole iterations in one workgroup while few triangles are due.
#import active
#import doubts
#import flip
#import frontier
#import history_write
#import label
#import mesh
#import select
#import state
#import verdicts

var<workgroup> flips: atomic<u32>;
// The work of Flip: how many triangles, the offset of their list or NONE, and how the next iteration
// finds its own.
var<workgroup> known: vec3u;
var<workgroup> tail_first: u32;
var<workgroup> tail_count: u32;
var<workgroup> doubtful: atomic<u32>;
var<workgroup> is_paused: u32;

@compute @workgroup_size(WORKGROUP_SIZE)
fn flip_all(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(local_invocation_index) local: u32,
    @builtin(num_workgroups) groups: vec3u,
) {
    let index = step_.index;
    // Atomic reads of the same words by all invocations are slow.
    if local == 0u {
        let now = active_at(index);
        known = vec3u(now.count, select(NONE, now.first, now.is_listed), due_after(index));
    }
    let got = workgroupUniformLoad(&known);
    let work = Work(got.x, got.y != NONE, false, got.y);
    let next_due = got.z;
    if work.count > 0u {
        var flipped = 0u;
        for (var i = id.x; i < work.count; i += groups.x * WORKGROUP_SIZE) {
            let t = active_triangle(work, i);
            flipped += flip_triangle(t, index, params.first + index, next_due);
        }
        clear_doubts(id.x, groups.x * WORKGROUP_SIZE);
        for (var i = params.vertices + id.x; i < params.fans_length; i += groups.x * WORKGROUP_SIZE) {
            move_anchor(i);
        }
        if flipped > 0u {
            atomicAdd(&flips, flipped);
        }
        if id.x == 0u {
            atomicStore(&history[entry(index + 1u, DUE)], next_due);
            atomicStore(&history[entry(index + 1u, RAN)], 1u);
        }
    }
    workgroupBarrier();
    if local == 0u {
        let total = atomicLoad(&flips);
        if total > 0u {
            atomicAdd(&history[entry(index + 1u, FLIPS)], total);
            add_flips(total);
        }
    }
}

// Adds to the flips of all updates.
fn add_flips(count: u32) {
    if params.update > 0u {
        let before = atomicAdd(&history[FLIPPED], count);
        if before + count < before {
            atomicAdd(&history[FLIPPED + 1u], 1u);
        }
    }
}

// Invocations of the tail. The host sets their number for the device.
override TAIL_SIZE: u32 = WORKGROUP_SIZE;

// Runs iterations in one workgroup while their lists are short. Pauses in an iteration that needs exact arithmetic:
// another dispatch decides, then the tail resumes.
@compute @workgroup_size(TAIL_SIZE)
fn tail(@builtin(local_invocation_index) local: u32) {
    if local == 0u {
        tail_first = params.tail;
        if step_.task == RESUME {
            // If the tail has not paused, this is NONE, and no iteration follows.
            tail_first = atomicExchange(&history[PAUSED], 0u) - 1u;
            atomicStore(&frontier[doubts()], 0u);
            atomicStore(&frontier[end_of_doubts()], 0u);
        }
    }
    let first = workgroupUniformLoad(&tail_first);
    for (var index = first; index < params.tail + params.tail_iterations; index++) {
        if local == 0u {
            let work = active_at(index);
            tail_count = select(0u, work.count, work.is_listed && work.count <= params.tail_length);
        }
        let count = workgroupUniformLoad(&tail_count);
        if count == 0u {
            break;
        }
        let iteration = params.first + index;
        let work = Work(count, true, true, (iteration & 1u) * params.triangles);
        if step_.task != RESUME || index > first {
            for (var i = local; i < count; i += TAIL_SIZE) {
                let t = active_triangle(work, i);
                let choice = label(t, iteration, close_verdicts_on(t, false));
                choices[t] = choice;
                clear_flip(t);
                if choice == DOUBTFUL {
                    doubt(i / WORKGROUP_SIZE);
                    atomicStore(&doubtful, 1u);
                }
            }
        }
        storageBarrier();
        workgroupBarrier();
        if local == 0u {
            is_paused = atomicLoad(&doubtful);
            if is_paused == 1u {
                atomicStore(&history[PAUSED], index + 1u);
            }
        }
        if workgroupUniformLoad(&is_paused) == 1u {
            break;
        }
        for (var i = select(count, local, has_selection()); i < count; i += TAIL_SIZE) {
            let g = selection(active_triangle(work, i), iteration);
            if g != NONE {
                set_flip(best(g / 3u), g);
            }
        }
        storageBarrier();
        var flipped = 0u;
        for (var i = local; i < count; i += TAIL_SIZE) {
            flipped += flip_triangle(active_triangle(work, i), index, iteration, LISTED);
        }
        for (var i = params.vertices + local; i < params.fans_length; i += TAIL_SIZE) {
            move_anchor(i);
        }
        if flipped > 0u {
            atomicAdd(&history[entry(index + 1u, FLIPS)], flipped);
            add_flips(flipped);
        }
        if local == 0u {
            atomicStore(&history[entry(index + 1u, DUE)], LISTED);
            atomicStore(&history[entry(index + 1u, RAN)], 1u);
        }
        storageBarrier();
    }
}
