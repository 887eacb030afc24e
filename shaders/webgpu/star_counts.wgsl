// Words of each vertex in the memory of the lists, which count the turns of its star.
#import doubts
#import state

// What a triangle that is not positive adds to its vertices: more than 1, and no sum overflows.
const NOT_EMBEDDED: u32 = 2u;

// Words of a vertex in the memory of the lists: its crossings; the boundary half-edges that start at it; and the vertices
// in the first and in the last direction of its open fan, counter-clockwise, if it has one.
const CROSSINGS: u32 = 0u;
const STARTS: u32 = 1u;
const FIRST: u32 = 2u;
const LAST: u32 = 3u;
const VERTEX_WORDS: u32 = 4u;

// There may be more vertices than memory before the bits of the chunks: with many unreferenced ones, or in a mesh that is
// mostly boundary. Then Select runs.
fn counted_vertices() -> u32 {
    return min(params.vertices, doubts() / VERTEX_WORDS);
}

fn word_of(v: u32, word: u32) -> u32 {
    return VERTEX_WORDS * v + word;
}
