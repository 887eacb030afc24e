// Lets the first iteration begin.
#import active
#import history_write
#import state

// Writes the entry that the first iteration starts from: as if one before it had flipped something and built no list. Where
// the host has to help first, with windings or the table of the fans, nothing has flipped, and no iteration runs.
fn begin_history(needs_windings: bool) {
    let needs_fans = history_word(SEVERAL_FANS) > 0u && !has_fans();
    atomicStore(&history[entry(0u, FLIPS)], select(params.triangles, 0u, needs_windings || needs_fans));
    atomicStore(&history[entry(0u, RAN)], 1u);
}
