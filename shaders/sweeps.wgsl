// The entry points of Label and Select: one dispatch each, while there is much to do.

// With EXACT, only the triangles that wait for it.
@compute @workgroup_size(WORKGROUP_SIZE)
fn label_all(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let work = active_at(step_.index);
    let iteration = params.first + step_.index;
    for (var i = id.x; i < work.count; i += groups.x * WORKGROUP_SIZE) {
        let t = active_triangle(work, i);
        if !EXACT || choices[t] == DOUBTFUL {
            choices[t] = label(t, iteration, verdicts_on(t));
        }
    }
}

@compute @workgroup_size(WORKGROUP_SIZE)
fn select_all(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let work = active_at(step_.index);
    let iteration = params.first + step_.index;
    for (var i = id.x; i < work.count; i += groups.x * WORKGROUP_SIZE) {
        let t = active_triangle(work, i);
        choices[params.triangles + t] = selection(t, iteration);
    }
}
