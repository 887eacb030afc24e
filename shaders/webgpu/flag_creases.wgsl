// Flags the creases, and no other edges, from each of their half-edges.
#import creases
#import mesh
#import moving
#import points
#import state
#import verdicts

// Whether each edge of a triangle is a crease, by a filter.
fn filtered_creases(t: u32) -> vec3u {
    var verdicts = vec3u();
    for (var h = 3u * t; h < 3u * t + 3u; h++) {
        let g = twin(h);
        var verdict = DELAUNAY;
        if g != NONE {
            let a = position(vertex(h));
            let b = position(vertex(g));
            let c = position(vertex(prev(h)));
            let d = position(vertex(prev(g)));
            if params.update > 0u {
                verdict = left_alone(a, b, c, d);
            }
            if verdict == DELAUNAY {
                verdict = filtered_crease(a, b, c, d);
            }
        }
        verdicts = vec3u(verdicts.yz, verdict);
    }
    return verdicts;
}

fn flag_creases(t: u32, verdicts: vec3u) {
    for (var k = 0u; k < 3u; k++) {
        let entry = twin_entry(3u * t + k);
        if entry != NONE {
            let is_crease = verdict_at(verdicts, k) == BLOCKED_BY + REASON_ANGLE;
            set_twin_entry(3u * t + k, select(entry & ~CREASE, entry | CREASE, is_crease));
        }
    }
}
