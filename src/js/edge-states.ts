/** The states of an edge between two iterations. */

/**
 * The states of an edge; `FlipSession.edgeStates` returns indices into this list.
 *
 * | state | meaning |
 * |---|---|
 * | `delaunay` | interior and Delaunay |
 * | `flips` | not Delaunay, and selected: the next iteration, if there is one, flips it |
 * | `waits` | not Delaunay, and may flip, but the next iteration does not select it (`order: 'any'` selects none) |
 * | `angle`, `fold`, `duplicate`, `locked`, `deviation` | not Delaunay, and cannot flip for this reason |
 * | `non-manifold`, `inconsistent` | frozen for this reason, whatever its angles |
 * | `boundary` | on the boundary: it has one triangle |
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

/** The state of an edge between two iterations. */
export type EdgeState = (typeof EDGE_STATES)[number];
