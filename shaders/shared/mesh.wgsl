// Half-edges, their flags, and verdicts: names and functions that all phases of both GPU engines share.

const NONE: u32 = 0xffffffffu;
const BLOCKED: u32 = 0xfffffffeu;
// The choice of a triangle that waits for exact arithmetic.
const DOUBTFUL: u32 = 0xfffffffdu;
// Flag in both twin entries of a crease: an edge whose normals differed by more than β in the input. It never flips,
// whatever the angle becomes.
const CREASE: u32 = 0x80000000u;
// The same for an edge that the user has locked.
const LOCKED: u32 = 0x40000000u;
// All flags. Half-edges are smaller than the lowest flag.
const FLAGS: u32 = 0xc0000000u;

// The verdict on an interior edge; a blocked one is BLOCKED_BY plus the index of its reason.
const DELAUNAY: u32 = 0u;
const LABELLED: u32 = 1u;
const BLOCKED_BY: u32 = 2u;
// The filter cannot decide: exact arithmetic has to.
const UNDECIDED: u32 = 0xffffffffu;
const REASON_ANGLE: u32 = 0u;
const REASON_FOLD: u32 = 1u;
const REASON_DUPLICATE: u32 = 2u;
const REASON_LOCKED: u32 = 3u;
const REASON_DEVIATION: u32 = 4u;
// Verdicts on edges that are left alone while the mesh moves, see moving.wgsl. The host does not count them by reason.
const LEFT_AS_INFINITE: u32 = BLOCKED_BY + 5u;
const LEFT_AS_WIDE: u32 = BLOCKED_BY + 6u;

fn next(h: u32) -> u32 {
    return select(h + 1u, h - 2u, h % 3u == 2u);
}

fn prev(h: u32) -> u32 {
    return select(h - 1u, h + 2u, h % 3u == 0u);
}

// The half-edge in an entry of the twins, without the flags.
fn unflagged(entry: u32) -> u32 {
    return select(entry & ~FLAGS, NONE, entry == NONE);
}

// The key of an edge in an iteration, as in src/phases/state.rs; the smallest key wins.
fn key(edge: u32, iteration: u32) -> u32 {
    var x = edge ^ (iteration * 0x9e3779b9u);
    x = (x ^ (x >> 16u)) * 0x7feb352du;
    x = (x ^ (x >> 15u)) * 0x846ca68bu;
    return x ^ (x >> 16u);
}
