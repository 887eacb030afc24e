// Lets sweeps walk one of two stars alone for 16 steps: few of many edges are at a pole.

const ALONE: u32 = 16u;
