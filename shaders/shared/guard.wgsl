// The guard: blocks a flip whose new edge exists already, as `makes_duplicate` in src/phases/label.rs.
#import mesh
#import star
#import state
#import walk_both if tail
#import walk_one_first if sweep

// The verdict on the edge of `h` and `g`, from the verdict on its geometry.
fn guarded(verdict: u32, h: u32, g: u32) -> u32 {
    var result = verdict;
    if verdict == LABELLED {
        result = select(verdict, BLOCKED_BY + REASON_DUPLICATE, edge_exists(prev(h), prev(g)));
    }
    return result;
}

// Whether an edge joins the vertices at which two half-edges start, or both vertices are the same.
fn edge_exists(at_c: u32, at_d: u32) -> bool {
    let is_alone = is_embedded(vertex(at_c)) || is_embedded(vertex(at_d));
    return are_joined(at_c, at_d, select(NONE, 0u, is_alone));
}

// The same, if no edge does where `most` is 0. The star of either vertex gives the answer. The walk takes ALONE steps
// around the first vertex, which are mostly enough. Then it alternates between both. Its cost is these steps plus twice
// the smaller star. After `most` steps, it is as if an edge did.
fn are_joined(at_c: u32, at_d: u32, most: u32) -> bool {
    let c = vertex(at_c);
    let d = vertex(at_d);
    var exists = c == d;
    var first = star(at_c);
    var second = star(at_d);
    var steps = 0u;
    while steps < most && !exists && first.y != NONE && second.y != NONE {
        exists = joins(first, d) || (steps >= ALONE && joins(second, c));
        first = advanced(first);
        if steps >= ALONE {
            second = advanced(second);
        }
        steps++;
    }
    return exists || (most > 0u && steps == most && first.y != NONE && second.y != NONE);
}

// Whether the present triangle of a walk has an edge from its vertex to `far`.
fn joins(walk: Star, far: u32) -> bool {
    return vertex(next(walk.y)) == far || vertex(prev(walk.y)) == far;
}
