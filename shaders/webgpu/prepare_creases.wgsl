// The kernel that flags creases, before the first iteration in space.
#import begin
#import doubts
#import flag_creases
#import mesh
#import points
#import spans
#import state

@compute @workgroup_size(WORKGROUP_SIZE)
fn prepare_all(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(local_invocation_index) local: u32,
    @builtin(num_workgroups) groups: vec3u,
) {
    if id.x == 0u {
        begin_history(false);
    }
    var all = deviation_span();
    for (var t = id.x; t < params.triangles; t += groups.x * WORKGROUP_SIZE) {
        let verdicts = filtered_creases(t);
        flag_creases(t, verdicts);
        choices[t] = wait_for(t, any(verdicts == vec3u(UNDECIDED)));
        for (var h = 3u * t; h < 3u * t + 3u; h++) {
            all = max(all, span_of(position(vertex(h))));
        }
    }
    add_span(all, local);
}
