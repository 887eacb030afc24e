// Counts the verdicts on all edges, in two dispatches, with one of exact arithmetic between them.
#import doubts
#import guard
#import history_write
#import mesh
#import state
#import verdicts

var<workgroup> census_counts: array<atomic<u32>, COUNTS>;

// Counts the verdicts on all interior edges: labelled, then blocked by reason. The verdicts of a triangle that waits
// for exact arithmetic are counted in the second dispatch.
@compute @workgroup_size(WORKGROUP_SIZE)
fn census(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(local_invocation_index) local: u32,
    @builtin(num_workgroups) groups: vec3u,
) {
    let is_resumed = step_.task == RESUME;
    for (var t = id.x; t < params.triangles; t += groups.x * WORKGROUP_SIZE) {
        let at = params.triangles + t;
        if !is_resumed {
            let verdicts = close_verdicts_on(t, true);
            let is_left = any(verdicts == vec3u(UNDECIDED));
            choices[at] = wait_for(t, is_left);
            if !is_left {
                count_edges(t, verdicts);
            }
        } else if is_packed(choices[at]) {
            count_edges(t, unpacked(choices[at]));
            choices[at] = NONE;
        }
    }
    if is_resumed {
        clear_doubts(id.x, groups.x * WORKGROUP_SIZE);
    }
    workgroupBarrier();
    if local < COUNTS {
        let count = atomicLoad(&census_counts[local]);
        if count > 0u {
            atomicAdd(&history[COUNTED + local], count);
        }
    }
}

fn count_edges(t: u32, verdicts: vec3u) {
    for (var k = 0u; k < 3u; k++) {
        let h = 3u * t + k;
        let entry = twin_entry(h);
        var verdict = verdict_at(verdicts, k);
        if entry != NONE && h < unflagged(entry) && verdict != DELAUNAY {
            if (entry & FLAGS) != 0u && verdict < LEFT_AS_INFINITE {
                verdict = BLOCKED_BY + select(REASON_ANGLE, REASON_LOCKED, (entry & LOCKED) != 0u);
            }
            verdict = guarded(verdict, h, unflagged(entry));
            atomicAdd(&census_counts[verdict - LABELLED], 1u);
        }
    }
}
