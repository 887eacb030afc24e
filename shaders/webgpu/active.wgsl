// Tells which triangles an iteration visits. While many edges flip, it visits all triangles and finds those that are
// due. When few flip, it visits the list that the iteration before has built.
#import history_read if reads
#import history_write if writes
#import mesh
#import state

struct Work {
    // 0 if the run has ended: the iteration before flipped nothing.
    count: u32,
    is_listed: bool,
    // Whether all visited triangles are due.
    is_full: bool,
    // The offset of the list.
    first: u32,
}

fn entry(index: u32, word: u32) -> u32 {
    return ENTRIES + ENTRY_WORDS * index + word;
}

fn active_at(index: u32) -> Work {
    let due = history_word(entry(index, DUE));
    let is_listed = due == LISTED;
    var count = params.triangles;
    if is_listed {
        count = history_word(entry(index, LENGTH));
    }
    count = select(count, 0u, history_word(entry(index, FLIPS)) == 0u);
    return Work(count, is_listed, due != STAMPED, ((params.first + index) & 1u) * params.triangles);
}

fn active_triangle(work: Work, i: u32) -> u32 {
    var t = i;
    if work.is_listed {
        t = atomicLoad(&frontier[work.first + i]);
    }
    return t;
}

// A triangle is due if its choice may differ from that of the iteration before. That is so if the triangle or a
// neighbour has flipped. It is also so if the triangle had a choice: keys change, and any flip may remove a duplicate.
fn is_due(work: Work, t: u32, iteration: u32) -> bool {
    return work.is_full || best(t) != NONE || atomicLoad(&frontier[stamp_index(t)]) == iteration;
}
