// Finds the verdicts on the three edges of a triangle, by filters.
#import mesh
#import moving
#import plane if plane
#import points
#import space if space
#import state

// The verdicts by the fast or the slower filter; UNDECIDED if exact arithmetic has to decide. A census tests every edge
// from its lower half-edge; an iteration tests the edges that may flip. The other edges get DELAUNAY.
fn verdicts_on(t: u32, is_census: bool, is_close: bool) -> vec3u {
    let winding = select(1, -1, is_clockwise(t));
    let leaves = leaves_some();
    var a = position(vertex(3u * t));
    var b = position(vertex(3u * t + 1u));
    var c = position(vertex(3u * t + 2u));
    var verdicts = vec3u();
    for (var h = 3u * t; h < 3u * t + 3u; h++) {
        let entry = twin_entry(h);
        var verdict = DELAUNAY;
        if counts(h, entry, is_census) {
            let d = position(vertex(prev(unflagged(entry))));
            if leaves {
                verdict = left_alone(a, b, c, d);
            }
            if verdict == DELAUNAY && is_close {
                verdict = close_verdict_on(a, b, c, d, winding);
            } else if verdict == DELAUNAY {
                verdict = filtered_verdict_on(a, b, c, d, winding);
            }
        }
        verdicts = vec3u(verdicts.yz, verdict);
        let first = a;
        a = b;
        b = c;
        c = first;
    }
    return verdicts;
}

fn counts(h: u32, entry: u32, is_census: bool) -> bool {
    return select(entry < LOCKED, entry != NONE && h < unflagged(entry), is_census);
}

fn verdict_at(verdicts: vec3u, k: u32) -> u32 {
    return select(select(verdicts.x, verdicts.y, k == 1u), verdicts.z, k == 2u);
}

fn with_verdict(verdicts: vec3u, k: u32, verdict: u32) -> vec3u {
    return select(verdicts, vec3u(verdict), vec3u(0u, 1u, 2u) == vec3u(k));
}
