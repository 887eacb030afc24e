/** The types of the answers of `verify` and `problems`. */

import type { Reason, Reasons, Result } from './types.js';

/** The result of an independent check of the triangles against the input. */
export interface Audit {
  /**
   * Whether there is no violation, and no triangle is turned over. Edges that are not Delaunay and flat triangles do not
   * count. A triangle that is turned over is no violation: it was so before, or no flip could turn it back.
   */
  clean: boolean;
  /** The violations: at most 100 sentences. */
  violations: string[];
  /** How many more violations there are. */
  unlisted: number;
  /** The number of edges that are not Delaunay, by the reason why they cannot flip; `stopped` if they can. */
  remaining: Reasons;
  /**
   * These edges, by reason, as pairs of vertices, one pair after the other. An array therefore serves as the index
   * buffer of line segments. Each pair has the smaller vertex first, and the pairs are in ascending order. A reason
   * without edges is absent.
   */
  remainingEdges: Partial<Record<Reason, Uint32Array>>;
  /** The triangles that are turned over, as {@link Result.inverted} counts them, in ascending order. */
  invertedTriangles: Uint32Array;
  /** The triangles of no area, in ascending order. */
  flatTriangles: Uint32Array;
}

/**
 * What keeps positions in the plane from having a triangulation with the boundary of a mesh. Each component counts alone:
 * components may overlap. If all three are empty, each component has a triangulation; if components overlap, two of them
 * may still need the same edge, which can have only two triangles.
 */
export interface Problems {
  /**
   * Vertices that are not inside the boundary of their component, in ascending order. If a whole ring of the boundary is
   * where it cannot be, such as a hole outside, all its vertices; if the component has a handle, so that no positions have
   * a triangulation, all of its vertices.
   */
  outside: Uint32Array;
  /**
   * Pairs of vertices at one point, one pair after the other. A vertex is paired with itself if triangles go all round it,
   * and others of its component touch it there.
   */
  coincident: Uint32Array;
  /**
   * Pairs of boundary edges that cross or touch, other than in a common vertex, or that are edges of two corners at a
   * common vertex that overlap: four vertices for each pair, two for each edge.
   */
  crossing: Uint32Array;
}
