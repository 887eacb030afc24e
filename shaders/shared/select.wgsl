// Select: an edge flips if it is the best of both its triangles and no better edge would make the same new edge,
// as src/phases/select.rs.
#import mesh
#import mutual
#import star
#import state
#import walk_both if tail
#import walk_one_first if sweep

// The half-edge on the other side of triangle `t`'s selected edge, or NONE.
fn selection(t: u32, iteration: u32) -> u32 {
    let h = mutual(t);
    var choice = NONE;
    if h != NONE {
        choice = select(best(t), NONE, yields(h, best(t), iteration));
    }
    return choice;
}

// Whether an edge yields: another edge that is the best of both its triangles, and has a smaller key, would make the
// same new edge. As in guard.wgsl, the star of each vertex alone gives the answer.
fn yields(h: u32, g: u32, iteration: u32) -> bool {
    let c = vertex(prev(h));
    let d = vertex(prev(g));
    let mine = key(min(h, g), iteration);
    let is_alone = is_embedded(c) || is_embedded(d);
    var first = star(prev(h));
    var second = star(prev(g));
    var is_beaten = false;
    var steps = 0u;
    while !is_alone && !is_beaten && first.y != NONE && second.y != NONE {
        is_beaten = wins(first.y, d, mine, iteration) || (steps >= ALONE && wins(second.y, c, mine, iteration));
        first = advanced(first);
        if steps >= ALONE {
            second = advanced(second);
        }
        steps++;
    }
    return is_beaten;
}

// Whether the edge opposite to `corner` is the best of both its triangles, is also opposite to the vertex `far`, and
// has a smaller key than `mine`.
fn wins(corner: u32, far: u32, mine: u32, iteration: u32) -> bool {
    let h = mutual(corner / 3u);
    var is_better = false;
    if h == next(corner) {
        let g = best(corner / 3u);
        is_better = vertex(prev(g)) == far && key(min(h, g), iteration) < mine;
    }
    return is_better;
}
