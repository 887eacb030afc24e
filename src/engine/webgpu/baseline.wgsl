// The kernel of the baseline: takes the selection of the CPU, see baseline.rs.
#import mesh
#import state

// The CPU has written one half-edge of each selected edge into both triangles of the edge, where Select would write its
// choice; and NONE into all other triangles.
@compute @workgroup_size(WORKGROUP_SIZE)
fn take_selection(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var t = id.x; t < params.triangles; t += groups.x * WORKGROUP_SIZE) {
        let g = choices[params.triangles + t];
        if g != NONE {
            let h = select(twin(g), g, g / 3u == t);
            set_flip(h, twin(h));
        }
    }
}
