// Begins the history, so that the first iteration can run.
#import active
#import history_write
#import state

// Writes the entry that the first iteration reads. The entry says that an iteration before it flipped edges, and that all
// triangles are due. If the host first has to add windings or the table of the fans, the entry says that nothing
// flipped, so no iteration runs.
fn begin_history(needs_windings: bool) {
    let needs_fans = history_word(SEVERAL_FANS) > 0u && !has_fans();
    atomicStore(&history[entry(0u, FLIPS)], select(params.triangles, 0u, needs_windings || needs_fans));
    atomicStore(&history[entry(0u, DUE)], ALL);
    atomicStore(&history[entry(0u, RAN)], 1u);
}
