/**
 * Triangulates points in the plane and makes their Voronoi diagram, in a WebAssembly module that is loaded on first use.
 *
 * ```ts
 * import { triangulate } from 'edgeflip/points';
 * const { triangles, twins, hull } = await triangulate(points);
 * ```
 *
 * @packageDocumentation
 */

import * as wasm from './wasm/edgeflip_points.js';
import { type Accessors, coordinatesOf, type Spacing } from './coordinates.js';
import { fromModule } from './error.js';
import { copyOf, itselfOf } from './given.js';
import { checkLoaded, isLoaded, load } from './points-module.js';
import type { VertexArray } from './types.js';

export type { Accessors, Spacing } from './coordinates.js';
export { EdgeflipError, type ErrorCode } from './error.js';
export type { ModuleSource, PointsSources } from './module.js';
export { init } from './points-module.js';
export type { IndexArray, VertexArray } from './types.js';
export { type Bounds, type TriangulationArrays, type Voronoi, voronoi, voronoiSync } from './voronoi.js';

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
  /** Why there is no triangle: a sentence for a developer. `undefined` if there are triangles. */
  hint: string | undefined;
}

/**
 * The Delaunay triangulation of points in the plane.
 *
 * No point is inside the circumcircle of a triangle. If four points are on one circle, the least of them, by x and then
 * by y, is joined to the other three: so the points alone determine the triangles, whatever their order. Every decision
 * is exact, for 32-bit and 64-bit floats. Points without a triangle are no error: {@link Triangulation.hint} says why.
 *
 * Reads the points before it returns its promise, and never changes them. Once the module is loaded, it triangulates in
 * the call.
 *
 * @param points - 2 numbers per point, in any typed array or in an array of numbers. Integers count as these numbers.
 * @throws {@link EdgeflipError} `non-finite` for the first coordinate that is NaN or infinite; `ragged-array`,
 * `invalid-input`, `invalid-option`, `too-large`, `load-failed`.
 */
export async function triangulate(points: VertexArray | readonly number[], options?: Spacing): Promise<Triangulation>;
/**
 * The same, of a list of points that begin with x and y.
 *
 * @param points - Pairs of numbers, or arrays with more numbers, which do not count.
 */
export async function triangulate(points: readonly ArrayLike<number>[]): Promise<Triangulation>;
/**
 * The same, of any list, with functions that read the coordinates. Their exceptions pass through.
 *
 * @param points - Anything that the functions take.
 */
export async function triangulate<P>(
  points: readonly P[] | (VertexArray & ArrayLike<P>),
  options: Accessors<P>,
): Promise<Triangulation>;
export async function triangulate(points: unknown, options: unknown = {}): Promise<Triangulation> {
  const coordinates = coordinatesOf(points, options, isLoaded() ? itselfOf : copyOf);
  if (!isLoaded()) await load();
  return triangulated(coordinates);
}

/**
 * As {@link triangulate}, without a promise. Call `init` before.
 *
 * ```ts
 * await init();
 * const { triangles } = triangulateSync(points);
 * ```
 *
 * @throws {@link EdgeflipError} `load-failed` without `init`; otherwise as {@link triangulate}.
 */
export function triangulateSync(points: VertexArray | readonly number[], options?: Spacing): Triangulation;
/** The same, of a list of points that begin with x and y. */
export function triangulateSync(points: readonly ArrayLike<number>[]): Triangulation;
/** The same, of any list, with functions that read the coordinates. Their exceptions pass through. */
export function triangulateSync<P>(
  points: readonly P[] | (VertexArray & ArrayLike<P>),
  options: Accessors<P>,
): Triangulation;
export function triangulateSync(points: unknown, options: unknown = {}): Triangulation {
  checkLoaded('triangulateSync');
  return triangulated(coordinatesOf(points, options, itselfOf));
}

function triangulated(coordinates: Float32Array | Float64Array): Triangulation {
  try {
    const { triangles, twins, hull, duplicates } = wasm.triangulate(coordinates);
    return { triangles, twins, hull, duplicates, hint: triangles.length > 0 ? undefined : hintOf(hull.length) };
  } catch (thrown) {
    throw fromModule(thrown);
  }
}

/** Why so many distinct points have no triangle. */
function hintOf(distinct: number): string {
  const why = distinct < 3 ? 'There are fewer than three distinct points' : 'All points are on one line';
  return `${why}, so there is no triangle.`;
}
