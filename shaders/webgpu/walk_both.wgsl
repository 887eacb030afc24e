// Lets the tail alternate between two stars from the first step. It tests few edges at a time, and waits for the
// slowest test.

const ALONE: u32 = 0u;
