// The frontier, the list of the triangles that the next iteration looks at: those that have flipped and their neighbours,
// and those with an edge that was labelled and has not flipped, or was blocked as a duplicate. An edge's verdict can change
// only where one of its triangles has changed, or, for duplicates, anywhere.

// Whether an iteration builds the list for the next one.
fn builds_list(index: u32) -> bool {
    return history_word(entry(index, FLIPS)) < params.list_below;
}

// Appends a triangle to the list of the next iteration, once.
fn append(t: u32, index: u32, iteration: u32) {
    if atomicExchange(&frontier[2u * params.triangles + t], iteration + 1u) != iteration + 1u {
        let at = atomicAdd(&history[entry(index + 1u, LENGTH)], 1u);
        atomicStore(&frontier[((iteration + 1u) & 1u) * params.triangles + at], t);
    }
}

fn append_neighbour(outer: u32, index: u32, iteration: u32) {
    if outer != NONE {
        append(outer / 3u, index, iteration);
    }
}

// Flips triangle `t`'s selected edge, from its lower half-edge, and appends what the flip touches. Returns
// the number of flips.
fn flip_triangle(t: u32, index: u32, iteration: u32, builds: bool) -> u32 {
    let g = selected(t);
    if g == NONE {
        if builds && best(t) != NONE {
            append(t, index, iteration);
        }
        return 0u;
    }
    let h = selected(g / 3u);
    if h > g {
        return 0u;
    }
    if builds {
        append(t, index, iteration);
        append(g / 3u, index, iteration);
        append_neighbour(twin(next(h)), index, iteration);
        append_neighbour(twin(prev(h)), index, iteration);
        append_neighbour(twin(next(g)), index, iteration);
        append_neighbour(twin(prev(g)), index, iteration);
    }
    flip_edge(h, g);
    return 1u;
}
