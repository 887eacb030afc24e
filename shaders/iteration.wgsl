// The entry points: one dispatch a phase while there is much to do, one workgroup for a run of iterations
// when there is little; and the census.

fn verdict_of(h: u32, g: u32) -> u32 {
    return guarded(geometric_verdict(h, g), h, g);
}

var<workgroup> flips: atomic<u32>;
var<workgroup> census_counts: array<atomic<u32>, ENTRIES>;
var<workgroup> tail_count: u32;

@compute @workgroup_size(WORKGROUP_SIZE)
fn label_all(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let index = step_.index;
    if !is_running(index) {
        return;
    }
    let iteration = params.first + index;
    let count = active_count(index);
    for (var i = id.x; i < count; i += groups.x * WORKGROUP_SIZE) {
        let t = active_triangle(index, i, iteration);
        choices[t] = label(t, iteration);
    }
}

@compute @workgroup_size(WORKGROUP_SIZE)
fn select_all(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let index = step_.index;
    if !is_running(index) {
        return;
    }
    let iteration = params.first + index;
    let count = active_count(index);
    for (var i = id.x; i < count; i += groups.x * WORKGROUP_SIZE) {
        let t = active_triangle(index, i, iteration);
        choices[params.triangles + t] = selection(t, iteration);
    }
}

@compute @workgroup_size(WORKGROUP_SIZE)
fn flip_all(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(local_invocation_index) local: u32,
    @builtin(num_workgroups) groups: vec3u,
) {
    let index = step_.index;
    if is_running(index) {
        let iteration = params.first + index;
        let count = active_count(index);
        let builds = builds_list(index);
        var flipped = 0u;
        for (var i = id.x; i < count; i += groups.x * WORKGROUP_SIZE) {
            flipped += flip_triangle(active_triangle(index, i, iteration), index, iteration, builds);
        }
        for (var i = params.vertices + id.x; i < params.fans_length; i += groups.x * WORKGROUP_SIZE) {
            move_anchor(i);
        }
        if flipped > 0u {
            atomicAdd(&flips, flipped);
        }
        if id.x == 0u {
            atomicStore(&history[entry(index + 1u, BUILT)], select(0u, 1u, builds));
            atomicStore(&history[entry(index + 1u, RAN)], 1u);
        }
    }
    workgroupBarrier();
    if local == 0u {
        let total = atomicLoad(&flips);
        if total > 0u {
            atomicAdd(&history[entry(index + 1u, FLIPS)], total);
        }
    }
}

// Iterations in one workgroup, as long as their lists are short.
@compute @workgroup_size(WORKGROUP_SIZE)
fn tail(@builtin(local_invocation_index) local: u32) {
    for (var index = params.tail; index < params.tail + params.tail_iterations; index++) {
        if local == 0u {
            let is_short = atomicLoad(&history[entry(index, BUILT)]) == 1u && active_count(index) <= params.tail_length;
            tail_count = select(0u, active_count(index), is_short && is_running(index));
        }
        let count = workgroupUniformLoad(&tail_count);
        if count == 0u {
            break;
        }
        let iteration = params.first + index;
        for (var i = local; i < count; i += WORKGROUP_SIZE) {
            let t = active_triangle(index, i, iteration);
        choices[t] = label(t, iteration);
        }
        storageBarrier();
        for (var i = local; i < count; i += WORKGROUP_SIZE) {
            let t = active_triangle(index, i, iteration);
            choices[params.triangles + t] = selection(t, iteration);
        }
        storageBarrier();
        var flipped = 0u;
        for (var i = local; i < count; i += WORKGROUP_SIZE) {
            flipped += flip_triangle(active_triangle(index, i, iteration), index, iteration, true);
        }
        for (var i = params.vertices + local; i < params.fans_length; i += WORKGROUP_SIZE) {
            move_anchor(i);
        }
        if flipped > 0u {
            atomicAdd(&history[entry(index + 1u, FLIPS)], flipped);
        }
        if local == 0u {
            atomicStore(&history[entry(index + 1u, BUILT)], 1u);
            atomicStore(&history[entry(index + 1u, RAN)], 1u);
        }
        storageBarrier();
    }
}

// Counts the verdicts of all interior edges: labelled, then blocked by reason.
@compute @workgroup_size(WORKGROUP_SIZE)
fn census(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(local_invocation_index) local: u32,
    @builtin(num_workgroups) groups: vec3u,
) {
    for (var h = id.x; h < 3u * params.triangles; h += groups.x * WORKGROUP_SIZE) {
        let g = twin(h);
        if g != NONE && h < g {
            let verdict = verdict_of(h, g);
            if verdict != DELAUNAY {
                atomicAdd(&census_counts[verdict - LABELLED], 1u);
            }
        }
    }
    workgroupBarrier();
    if local < ENTRIES {
        let count = atomicLoad(&census_counts[local]);
        if count > 0u {
            atomicAdd(&history[CENSUS + local], count);
        }
    }
}
