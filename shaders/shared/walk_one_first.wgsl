// Lets sweeps walk one of two stars alone for 16 steps: of the many edges of a sweep, few are at a vertex with a larger
// star.

const ALONE: u32 = 16u;
