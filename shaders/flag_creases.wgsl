// The entry point of the creases, before the first iteration on a surface.

// Flags the edges of the input over β, and no others, from each of their half-edges.
@compute @workgroup_size(WORKGROUP_SIZE)
fn flag_creases(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var h = id.x; h < 3u * params.triangles; h += groups.x * WORKGROUP_SIZE) {
        let entry = twin_entry(h);
        if entry != NONE {
            twins[h] = creased(h, entry);
        }
    }
}
