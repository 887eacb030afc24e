// Label: each triangle tests its three edges and keeps the best one that may flip, as src/phases/label.rs.

// The choice of triangle `t`: the twin of its labelled edge with the smallest key, or BLOCKED, or NONE.
fn label(t: u32, iteration: u32) -> u32 {
    var choice = NONE;
    var smallest = 0u;
    for (var h = 3u * t; h < 3u * t + 3u; h++) {
        let g = twin_entry(h);
        var verdict = DELAUNAY;
        // Else there is no twin, or the edge stays.
        if g < LOCKED {
            verdict = verdict_of(h, g);
        }
        if verdict == LABELLED {
            let priority = key(min(h, g), iteration);
            if choice >= BLOCKED || priority < smallest {
                choice = g;
                smallest = priority;
            }
        } else if verdict == BLOCKED_BY + REASON_DUPLICATE && choice == NONE {
            choice = BLOCKED;
        }
    }
    return choice;
}
