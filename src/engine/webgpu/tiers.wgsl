// Counts the interior edges that the filter decides, and those that it does not: for the tests.
#import history_write
#import mesh
#import plane if plane
#import points
#import space if space
#import state

@compute @workgroup_size(WORKGROUP_SIZE)
fn tiers(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var h = id.x; h < 3u * params.triangles; h += groups.x * WORKGROUP_SIZE) {
        let g = twin(h);
        if g != NONE && h < g {
            let a = position(vertex(h));
            let b = position(vertex(g));
            let c = position(vertex(prev(h)));
            let d = position(vertex(prev(g)));
            let verdict = filtered_verdict_on(a, b, c, d, select(1, -1, is_clockwise(h / 3u)));
            atomicAdd(&history[COUNTED + select(0u, 1u, verdict == UNDECIDED)], 1u);
        }
    }
}
