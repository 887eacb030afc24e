// Label: each triangle tests its three edges and keeps the best one that may flip, as src/phases/label.rs.

// The choice of triangle `t`: the twin of its labelled edge with the smallest key, or BLOCKED, or NONE.
fn label(t: u32, iteration: u32) -> u32 {
    var choice = NONE;
    var smallest = 0u;
    for (var h = 3u * t; h < 3u * t + 3u; h++) {
        let g = twin_entry(h);
        if g >= CREASE {
            // No twin, or an edge that stays.
            continue;
        }
        let verdict = verdict_of(h, g);
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

// Tests the interior edge of the half-edges `h` and `g`.
fn verdict_of(h: u32, g: u32) -> u32 {
    let a = position(vertex(h));
    let b = position(vertex(g));
    let c = position(vertex(prev(h)));
    let d = position(vertex(prev(g)));
    var verdict = verdict_on(a, b, c, d, select(1, -1, is_clockwise(h / 3u)));
    if verdict != DELAUNAY && (twin_entry(h) & CREASE) != 0u {
        verdict = BLOCKED_BY + REASON_ANGLE;
    }
    if verdict == LABELLED && edge_exists(prev(h), prev(g)) {
        verdict = BLOCKED_BY + REASON_DUPLICATE;
    }
    return verdict;
}

// Whether an edge joins the vertices that two half-edges start at, or they are the same one. Both stars are
// walked in turns: each of them alone gives the answer, so the cost is that of the smaller one.
fn edge_exists(at_c: u32, at_d: u32) -> bool {
    let c = vertex(at_c);
    let d = vertex(at_d);
    if c == d {
        return true;
    }
    var first = star(at_c);
    var second = star(at_d);
    while first.y != NONE && second.y != NONE {
        if vertex(next(first.y)) == d || vertex(prev(first.y)) == d
            || vertex(next(second.y)) == c || vertex(prev(second.y)) == c {
            return true;
        }
        first = advanced(first);
        second = advanced(second);
    }
    return false;
}
