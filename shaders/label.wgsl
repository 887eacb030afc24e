// Label: each triangle tests its three edges and keeps the best one that may flip, as src/phases/label.rs.

fn label(t: u32, iteration: u32) {
    var choice = NONE;
    var smallest = 0u;
    for (var h = 3u * t; h < 3u * t + 3u; h++) {
        let g = twins[h];
        if g == NONE {
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
    choices[t] = choice;
}

// Tests the interior edge of the half-edges `h` and `g`.
fn verdict_of(h: u32, g: u32) -> u32 {
    let a = triangles[h];
    let b = triangles[g];
    let c = triangles[prev(h)];
    let d = triangles[prev(g)];
    if params.dimension == 2u {
        let winding = select(1, -1, is_clockwise(h / 3u));
        let pa = position2(a);
        let pb = position2(b);
        let pc = position2(c);
        let pd = position2(d);
        if winding * in_circle_sign(pa, pb, pc, pd) >= 0 {
            return DELAUNAY;
        }
        if winding * area_sign(pa, pd, pc) <= 0 || winding * area_sign(pb, pc, pd) <= 0 {
            return BLOCKED_BY + REASON_FOLD;
        }
    } else {
        let quad = quad_of(position3(a), position3(b), position3(c), position3(d));
        if !is_non_delaunay(quad) {
            return DELAUNAY;
        }
        if exceeds_angle(quad) {
            return BLOCKED_BY + REASON_ANGLE;
        }
        if turns_over(quad) {
            return BLOCKED_BY + REASON_FOLD;
        }
    }
    if edge_exists(prev(h), prev(g)) {
        return BLOCKED_BY + REASON_DUPLICATE;
    }
    return LABELLED;
}

// Whether an edge joins the vertices that two half-edges start at, or they are the same one. Both stars are
// walked in turns: each of them alone gives the answer, so the cost is that of the smaller one.
fn edge_exists(at_c: u32, at_d: u32) -> bool {
    let c = triangles[at_c];
    let d = triangles[at_d];
    var first = star(at_c);
    var second = star(at_d);
    loop {
        if c == d || triangles[next(first.at)] == d || triangles[prev(first.at)] == d
            || triangles[next(second.at)] == c || triangles[prev(second.at)] == c {
            return true;
        }
        advance(&first);
        advance(&second);
        if first.at == NONE || second.at == NONE {
            return false;
        }
    }
}
