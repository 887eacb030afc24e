// Label: each triangle tests its three edges, and keeps the best of those that may flip, as src/phases/label.rs.
#import guard
#import mesh
#import state

// The choice of triangle `t`, from the verdicts on the geometry of its three edges: the twin of its labelled edge with
// the smallest key, or BLOCKED, or NONE; DOUBTFUL if exact arithmetic has to decide first.
fn label(t: u32, iteration: u32, verdicts: vec3u) -> u32 {
    var choice = NONE;
    var left = verdicts;
    var k = best_of(t, iteration, left);
    if any(verdicts == vec3u(UNDECIDED)) {
        choice = DOUBTFUL;
        k = 3u;
    }
    // The guard takes long: it tests the best edge first, and mostly no other.
    while k < 3u {
        let h = 3u * t + k;
        let g = twin_entry(h);
        choice = select(g, BLOCKED, edge_exists(prev(h), prev(g)));
        left = vec3u(select(left.x, DELAUNAY, k == 0u), select(left.y, DELAUNAY, k == 1u), select(left.z, DELAUNAY, k == 2u));
        k = select(3u, best_of(t, iteration, left), choice == BLOCKED);
    }
    return choice;
}

// Which of the three edges is labelled and has the smallest key; 3 if none is labelled.
fn best_of(t: u32, iteration: u32, verdicts: vec3u) -> u32 {
    var best = 3u;
    var smallest = 0u;
    for (var k = 0u; k < 3u; k++) {
        let verdict = select(select(verdicts.x, verdicts.y, k == 1u), verdicts.z, k == 2u);
        if verdict == LABELLED {
            let h = 3u * t + k;
            let priority = key(min(h, twin_entry(h)), iteration);
            if best == 3u || priority < smallest {
                best = k;
                smallest = priority;
            }
        }
    }
    return best;
}
