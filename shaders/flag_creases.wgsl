// The entry point of the creases, before the first iteration on a surface.

// Whether exact arithmetic decides what the filter leaves, or a later dispatch does.
override EXACT: bool = true;

fn decides_exactly() -> bool {
    return EXACT;
}

// Flags the edges of the input over β, and no others, from each of their half-edges. With EXACT, only those of the
// triangles that wait for it.
@compute @workgroup_size(WORKGROUP_SIZE)
fn flag_creases(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    for (var t = id.x; t < params.triangles; t += groups.x * WORKGROUP_SIZE) {
        if !EXACT || best(t) == DOUBTFUL {
            choices[t] = select(NONE, DOUBTFUL, flag_edges(t));
        }
    }
}

// Whether an edge of the triangle is left, as exact arithmetic has to decide.
fn flag_edges(t: u32) -> bool {
    var is_left = false;
    for (var h = 3u * t; h < 3u * t + 3u; h++) {
        let entry = twin_entry(h);
        if entry != NONE {
            let verdict = crease_verdict(h, unflagged(entry));
            set_twin_entry(h, select(entry & ~CREASE, entry | CREASE, verdict != DELAUNAY));
            is_left = is_left || verdict == UNDECIDED;
        }
    }
    return is_left;
}
