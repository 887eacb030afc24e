// Label: each triangle tests its three edges and keeps the best one that may flip, as src/phases/label.rs.

fn label(t: u32, iteration: u32) {
    var choice = NONE;
    var smallest = 0u;
    for (var h = 3u * t; h < 3u * t + 3u; h++) {
        let g = twins[h];
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
    choices[t] = choice;
}

// Whether the angle between the normals at an interior edge is larger than β.
fn is_sharp(h: u32, g: u32) -> bool {
    let a = position3(triangles[h]);
    let b = position3(triangles[g]);
    let c = position3(triangles[prev(h)]);
    let d = position3(triangles[prev(g)]);
    return is_over_angle(a, b, c, d);
}

// Tests the interior edge of the half-edges `h` and `g`.
fn verdict_of(h: u32, g: u32) -> u32 {
    let a = triangles[h];
    let b = triangles[g];
    let c = triangles[prev(h)];
    let d = triangles[prev(g)];
    var verdict = DELAUNAY;
    if params.dimension == 2u {
        let winding = select(1, -1, is_clockwise(h / 3u));
        verdict = verdict_in_plane(position2(a), position2(b), position2(c), position2(d), winding);
    } else {
        verdict = verdict_in_space(position3(a), position3(b), position3(c), position3(d));
    }
    if verdict != DELAUNAY && is_crease(h) {
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
    let c = triangles[at_c];
    let d = triangles[at_d];
    var first = star(at_c);
    var second = star(at_d);
    while first.at != NONE && second.at != NONE {
        if c == d || triangles[next(first.at)] == d || triangles[prev(first.at)] == d
            || triangles[next(second.at)] == c || triangles[prev(second.at)] == c {
            return true;
        }
        advance(&first);
        advance(&second);
    }
    return false;
}
