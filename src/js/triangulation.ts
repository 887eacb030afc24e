/** What the calls of the entry `edgeflip/points` return. */

import type { triangulate } from './wasm/edgeflip_points.js';
import type { LeftOut } from './types.js';

/** A Delaunay triangulation of points in the plane. */
export interface Triangulation {
  /**
   * Three indices of points per triangle, counter-clockwise. The first is the smallest, and the triangles are sorted by
   * their indices: first by the first, then by the second.
   */
  triangles: Uint32Array;
  /** For each half-edge, the half-edge on the other side; 0xffffffff on the hull. */
  twins: Uint32Array;
  /**
   * The indices of the points on the hull, counter-clockwise, from the smallest. Points on a side of the hull count as
   * points of the hull. If there is no triangle, these are all distinct points, by x and then by y.
   */
  hull: Uint32Array;
  /**
   * For each point that equals another with a smaller index: its index, and the smallest of the indices, one pair after
   * the other, in ascending order. Only the smallest is in triangles.
   */
  duplicates: Uint32Array;
  /**
   * The edges of the constraints, two points per edge, in the order of the constraints and in their direction. A
   * constraint through points is several edges.
   */
  constraintEdges: Uint32Array;
  /** The constraints that were left out. */
  leftOut: LeftOut[];
  /** The threads that worked. */
  threads: number;
  /**
   * Why there is no triangle, or why many points had only one thread: sentences for a developer. `undefined` if there
   * are triangles and all is well.
   */
  hint: string | undefined;
}

/** The result of a module, and what to say about it. */
export function triangulationOf(
  arrays: ReturnType<typeof triangulate>,
  threads: number,
  alone?: string,
): Triangulation {
  const { triangles, hull } = arrays;
  const hints: string[] = [];
  if (triangles.length === 0) {
    const why = hull.length < 3 ? 'There are fewer than three distinct points' : 'All points are on one line';
    hints.push(`${why}, so there is no triangle.`);
  }
  if (alone !== undefined) hints.push(`The points were triangulated on one thread: ${alone}.`);
  return { ...arrays, threads, hint: hints.length > 0 ? hints.join(' ') : undefined };
}
