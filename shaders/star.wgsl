// Walking around a vertex, as src/star.rs.

struct Star {
    start: u32,
    at: u32,
    is_clockwise: bool,
    // Where the next anchor stands in `topology`, if the vertex has several fans.
    further: u32,
}

// All corners at the vertex that `corner` starts at.
fn star(corner: u32) -> Star {
    if params.fans_length > 0u {
        let list = topology[params.fans + triangles[corner]];
        if list != NONE {
            let anchor = topology[params.fans + list];
            return Star(anchor, anchor, false, params.fans + list + 1u);
        }
    }
    return Star(corner, corner, false, NONE);
}

fn begin_next_fan(walk: ptr<function, Star>) {
    (*walk).start = NONE;
    if (*walk).further != NONE {
        (*walk).start = topology[(*walk).further];
        (*walk).further++;
    }
    (*walk).at = (*walk).start;
    (*walk).is_clockwise = false;
}

// Moves to the next corner; `at` is NONE behind the last one.
fn advance(walk: ptr<function, Star>) {
    if !(*walk).is_clockwise {
        (*walk).at = twin(prev((*walk).at));
        if (*walk).at == (*walk).start {
            begin_next_fan(walk);
            return;
        }
        if (*walk).at != NONE {
            return;
        }
        (*walk).is_clockwise = true;
        (*walk).at = (*walk).start;
    }
    let other = twin((*walk).at);
    if other == NONE {
        begin_next_fan(walk);
    } else {
        (*walk).at = next(other);
    }
}
