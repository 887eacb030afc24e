// Finds the edges that Select considers.
#import mesh
#import state

// The half-edge of triangle `t` whose edge is the best of both its triangles, or NONE.
fn mutual(t: u32) -> u32 {
    let g = best(t);
    var h = NONE;
    if g < DOUBTFUL {
        h = best(g / 3u);
    }
    return select(NONE, h, h < DOUBTFUL && h / 3u == t);
}
