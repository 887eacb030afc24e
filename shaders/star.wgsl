// Walking around a vertex, as src/star.rs.

// Where the walk of a fan began, where it is, whether it goes clockwise (0 or 1), and where the next anchor stands in
// the table of the fans, if the vertex has several fans.
alias Star = vec4u;

// All corners at the vertex that `corner` starts at.
fn star(corner: u32) -> Star {
    if has_fans() {
        let list = fan_entry(vertex(corner));
        if list != NONE {
            let anchor = fan_entry(list);
            return Star(anchor, anchor, 0u, list + 1u);
        }
    }
    return Star(corner, corner, 0u, NONE);
}

fn at_next_fan(walk: Star) -> Star {
    if walk.w == NONE {
        return Star(NONE, NONE, 0u, NONE);
    }
    let start = fan_entry(walk.w);
    return Star(start, start, 0u, walk.w + 1u);
}

// At the next corner; at NONE (in y) behind the last one.
fn advanced(walk: Star) -> Star {
    var from_corner = walk.y;
    if walk.z == 0u {
        let at = twin(prev(walk.y));
        if at == walk.x {
            return at_next_fan(walk);
        }
        if at != NONE {
            return Star(walk.x, at, 0u, walk.w);
        }
        // The fan is open: back to where it began and round the other way.
        from_corner = walk.x;
    }
    let other = twin(from_corner);
    if other == NONE {
        return at_next_fan(walk);
    }
    return Star(walk.x, next(other), 1u, walk.w);
}
