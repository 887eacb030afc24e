// Meshes in the plane: a vertex has two coordinates.

const DIMENSION: u32 = 2u;
