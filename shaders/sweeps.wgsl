// The entry points of Label and Select: a dispatch for the triangles that the filters decide, one for the others, since
// exact arithmetic takes so many registers that a kernel with it has few invocations at a time, and one to select.

@compute @workgroup_size(WORKGROUP_SIZE)
fn label_all(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let work = active_at(step_.index);
    let iteration = params.first + step_.index;
    for (var i = id.x; i < work.count; i += groups.x * WORKGROUP_SIZE) {
        let t = active_triangle(work, i);
        if is_due(work, t, iteration) {
            let choice = label(t, iteration, filtered_verdicts(t));
            choices[t] = choice;
            if flip_of(t).x != NONE {
                clear_flip(t);
            }
            if choice == DOUBTFUL {
                doubt(i / WORKGROUP_SIZE);
            }
        }
    }
}

@compute @workgroup_size(WORKGROUP_SIZE)
fn decide_all(
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) local: u32,
    @builtin(num_workgroups) groups: vec3u,
) {
    let work = active_at(step_.index);
    let iteration = params.first + step_.index;
    // In a list most chunks may be doubtful: those are done side by side.
    let together = select(CHUNKS, 1u, work.is_listed);
    for (var first = together * group.x; first * WORKGROUP_SIZE < work.count; first += together * groups.x) {
        var bits = doubtful_chunks(first, together);
        while bits != 0u {
            let i = (first + firstTrailingBit(bits)) * WORKGROUP_SIZE + local;
            bits &= bits - 1u;
            if i < work.count {
                let t = active_triangle(work, i);
                if best(t) == DOUBTFUL {
                    choices[t] = label(t, iteration, exact_verdicts(t, filtered_verdicts(t)));
                }
            }
        }
    }
}

@compute @workgroup_size(WORKGROUP_SIZE)
fn select_all(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let work = active_at(step_.index);
    let iteration = params.first + step_.index;
    for (var i = id.x; i < work.count; i += groups.x * WORKGROUP_SIZE) {
        let g = selection(active_triangle(work, i), iteration);
        if g != NONE {
            set_flip(best(g / 3u), g);
        }
    }
}
