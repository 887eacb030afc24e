// Says which triangles an iteration looks at: while many edges flip, all of them, to see which are due; once few do, those
// of the list that the iteration before has built.
#import history_read if reads
#import history_write if writes
#import mesh
#import state

struct Work {
    // 0 where the run has ended: the iteration before flipped nothing.
    count: u32,
    is_listed: bool,
    // Whether nearly all of them are due: then none is asked.
    is_full: bool,
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
    let flips = history_word(entry(index, FLIPS));
    count = select(count, 0u, flips == 0u);
    return Work(count, is_listed, is_listed || flips > params.triangles / 8u, ((params.first + index) & 1u) * params.triangles);
}

fn active_triangle(work: Work, i: u32) -> u32 {
    var t = i;
    if work.is_listed {
        t = atomicLoad(&frontier[work.first + i]);
    }
    return t;
}

// A triangle is due where its choice can be another one than in the iteration before: where it or a neighbour has flipped,
// and where it had one, since keys change and, for duplicates, anything may have.
fn is_due(work: Work, t: u32, iteration: u32) -> bool {
    return work.is_full || best(t) != NONE || atomicLoad(&frontier[stamp_place(t)]) == iteration;
}
