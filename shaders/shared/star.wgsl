// Walks around a vertex, from triangle to triangle, as src/mesh/star.rs.
#import mesh
#import state

// Where the walk of a fan began, where it is, whether it goes clockwise (0 or 1), and where the next anchor stands in
// the table of the fans, if the vertex has several fans.
alias Star = vec4u;

// All corners at the vertex that `corner` starts at.
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

// The fan whose anchor is a word of the table; behind the last one, or without a table, none.
fn fan_at(word: u32) -> Star {
    var anchor = NONE;
    if word != NONE {
        anchor = fan_entry(word);
    }
    return Star(anchor, anchor, 0u, select(word + 1u, NONE, word == NONE));
}

// At the next corner; at NONE (in y) behind the last one.
fn advanced(walk: Star) -> Star {
    var corner = NONE;
    var is_clockwise = walk.z;
    if is_clockwise == 0u {
        corner = twin(prev(walk.y));
    }
    if corner == NONE {
        // The fan is open: back to where it began and round the other way.
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
