/** What an edge can be between two iterations. */

/**
 * The states of an edge; `FlipSession.edgeStates` gives their places in this list.
 *
 * | state | meaning |
 * |---|---|
 * | `delaunay` | between two triangles, and Delaunay |
 * | `flips` | not Delaunay, and selected: the next iteration, if there is one, flips it |
 * | `waits` | not Delaunay, and may flip, but not in the next iteration (in the order `'any'`: at some time) |
 * | `angle`, `fold`, `duplicate`, `locked`, `deviation` | not Delaunay, and may not flip, for this reason |
 * | `non-manifold`, `inconsistent` | frozen for this reason, Delaunay or not |
 * | `boundary` | of one triangle only |
 */
export const EDGE_STATES = [
  'delaunay',
  'flips',
  'waits',
  'angle',
  'fold',
  'duplicate',
  'locked',
  'deviation',
  'non-manifold',
  'inconsistent',
  'boundary',
] as const;

/** What an edge can be between two iterations. */
export type EdgeState = (typeof EDGE_STATES)[number];
