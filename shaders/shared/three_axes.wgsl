// Surfaces in space: a vertex has three coordinates.

const DIMENSION: u32 = 3u;
