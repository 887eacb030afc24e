// Lets sweeps walk around one of two vertices alone for 16 steps. A sweep tests many edges, and few of them are at a
// vertex with a larger star.

const ALONE: u32 = 16u;
