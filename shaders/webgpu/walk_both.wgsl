// Lets the tail walk two stars in turns from the first step: it has few edges at a time, and waits for the slowest.

const ALONE: u32 = 0u;
