// The kernels of Label and Select. Exact arithmetic has a dispatch between them, for edges that the filter does not
// decide.
#import active
#import doubts
#import label
#import mesh
#import select
#import state
#import verdicts

@compute @workgroup_size(WORKGROUP_SIZE)
fn label_all(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let work = active_at(step_.index);
    let iteration = params.first + step_.index;
    for (var i = id.x; i < work.count; i += groups.x * WORKGROUP_SIZE) {
        let t = active_triangle(work, i);
        if is_due(work, t, iteration) {
            let choice = label(t, iteration, verdicts_on(t));
            choices[t] = choice;
            if has_selection() && flip_of(t).x != NONE {
                clear_flip(t);
            }
            if choice == DOUBTFUL {
                doubt(i / WORKGROUP_SIZE);
            }
        }
    }
}

@compute @workgroup_size(WORKGROUP_SIZE)
fn select_all(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let iteration = params.first + step_.index;
    var work = active_at(step_.index);
    if !has_selection() {
        work.count = 0u;
    }
    for (var i = id.x; i < work.count; i += groups.x * WORKGROUP_SIZE) {
        let g = selection(active_triangle(work, i), iteration);
        if g != NONE {
            set_flip(best(g / 3u), g);
        }
    }
}
