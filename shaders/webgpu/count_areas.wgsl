// Counts the triangles whose area is not positive.
#import areas
#import history_write
#import moving
#import state

// Words of the history from here on: inverted, flat, undecided.
const AREAS: u32 = 8u;
const AREA_COUNTS: u32 = 3u;

var<workgroup> area_counts: array<atomic<u32>, AREA_COUNTS>;

@compute @workgroup_size(WORKGROUP_SIZE)
fn count_areas(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(local_invocation_index) local: u32,
    @builtin(num_workgroups) groups: vec3u,
) {
    let leaves = leaves_some();
    for (var t = id.x; t < params.triangles; t += groups.x * WORKGROUP_SIZE) {
        let area = area_of(t, leaves);
        if area != POSITIVE_AREA {
            atomicAdd(&area_counts[area], 1u);
        }
    }
    workgroupBarrier();
    if local < AREA_COUNTS {
        let count = atomicLoad(&area_counts[local]);
        if count > 0u {
            atomicAdd(&history[AREAS + local], count);
        }
    }
}
