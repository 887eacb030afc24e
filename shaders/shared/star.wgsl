// Walks around a vertex, from triangle to triangle, as src/mesh/star.rs.
#import mesh
#import state

// A walk around a fan: its first corner; its present corner; whether it goes clockwise (0 or 1); and the index of the
// next anchor in the table of the fans, or NONE if the vertex has one fan.
alias Star = vec4u;

// A walk over all corners at the vertex at which `corner` starts.
fn star(corner: u32) -> Star {
    var list = NONE;
    if has_fans() {
        list = fan_entry(vertex(corner));
    }
    var walk = Star(corner, corner, 0u, NONE);
    if list != NONE {
        walk = fan_at(list);
    }
    return walk;
}

// A walk around the fan whose anchor is at index `word` of the table. The walk is empty after the last anchor, or if
// `word` is NONE.
fn fan_at(word: u32) -> Star {
    var anchor = NONE;
    if word != NONE {
        anchor = fan_entry(word);
    }
    return Star(anchor, anchor, 0u, select(word + 1u, NONE, word == NONE));
}

// Moves the walk to the next corner; NONE (in y) after the last one.
fn advanced(walk: Star) -> Star {
    var corner = NONE;
    var is_clockwise = walk.z;
    if is_clockwise == 0u {
        corner = twin(prev(walk.y));
    }
    if corner == NONE {
        // The fan is open: return to its start and turn clockwise.
        let other = twin(select(walk.x, walk.y, is_clockwise == 1u));
        corner = select(next(other), NONE, other == NONE);
        is_clockwise = 1u;
    } else if corner == walk.x {
        corner = NONE;
    }
    var result = Star(walk.x, corner, is_clockwise, walk.w);
    if corner == NONE {
        result = fan_at(walk.w);
    }
    return result;
}
