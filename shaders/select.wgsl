// Select: an edge flips if it is the best of both its triangles and no better one makes the same new edge,
// as src/phases/select.rs.

fn select_edge(t: u32, iteration: u32) {
    let h = mutual(t);
    var choice = NONE;
    if h != NONE && !yields(h, best(t), iteration) {
        choice = best(t);
    }
    choices[params.triangles + t] = choice;
}

// The half-edge of triangle `t` that is the best of both its triangles, or NONE.
fn mutual(t: u32) -> u32 {
    let g = best(t);
    if g >= BLOCKED {
        return NONE;
    }
    let h = best(g / 3u);
    return select(NONE, h, h < BLOCKED && h / 3u == t);
}

// Whether another selected edge with a smaller key would join the same two vertices.
fn yields(h: u32, g: u32, iteration: u32) -> bool {
    let c = triangles[prev(h)];
    let d = triangles[prev(g)];
    let mine = key(min(h, g), iteration);
    var first = star(prev(h));
    var second = star(prev(g));
    while first.at != NONE && second.at != NONE {
        if wins(first.at, d, mine, iteration) || wins(second.at, c, mine, iteration) {
            return true;
        }
        advance(&first);
        advance(&second);
    }
    return false;
}

// Whether the edge opposite to `corner` is selected, lies opposite to the vertex `far` too and is better.
fn wins(corner: u32, far: u32, mine: u32, iteration: u32) -> bool {
    let h = mutual(corner / 3u);
    if h == NONE || h != next(corner) {
        return false;
    }
    let g = best(corner / 3u);
    return triangles[prev(g)] == far && key(min(h, g), iteration) < mine;
}
