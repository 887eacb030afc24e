// Which triangles an iteration looks at: all of them while many edges flip; once few do, those of the list that the
// iteration before has built.

struct Work {
    // 0 where the run has ended: the iteration before flipped nothing.
    count: u32,
    is_listed: bool,
    // Where the list begins.
    first: u32,
}

fn entry(index: u32, word: u32) -> u32 {
    return ENTRIES + ENTRY_WORDS * index + word;
}

fn active_at(index: u32) -> Work {
    let is_listed = history_word(entry(index, BUILT)) == 1u;
    var count = params.triangles;
    if is_listed {
        count = history_word(entry(index, LENGTH));
    }
    count = select(count, 0u, history_word(entry(index, FLIPS)) == 0u);
    return Work(count, is_listed, ((params.first + index) & 1u) * params.triangles);
}

fn active_triangle(work: Work, i: u32) -> u32 {
    var t = i;
    if work.is_listed {
        t = frontier_word(work.first + i);
    }
    return t;
}
