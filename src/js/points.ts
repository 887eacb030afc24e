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
import {
  type Accessors,
  type Constraints,
  coordinatesOf,
  type Places,
  placesOf,
  type Spacing,
  THREADED,
  type Threading,
  TRIANGULATED,
} from './coordinates.js';
import { threadCount, whyOneThread } from './cores.js';
import { fromModule } from './error.js';
import { copyOf, itselfOf, messageOf } from './given.js';
import { checkLoaded, isLoaded, load, loadThreads } from './points-module.js';
import type { Triangulator } from './points-threads.js';
import type { Hold } from './settings.js';
import { type Triangulation, triangulationOf } from './triangulation.js';
import type { VertexArray } from './types.js';

export type { Accessors, Constraints, Spacing, Threading } from './coordinates.js';
export { EdgeflipError, type ErrorCode } from './error.js';
export type { ModuleSource, PointsSources } from './module.js';
export { PointSession } from './point-session.js';
export { init } from './points-module.js';
export type { Triangulation } from './triangulation.js';
export type { IndexArray, LeftOut, VertexArray } from './types.js';
export { type Bounds, type TriangulationArrays, type Voronoi, voronoi, voronoiSync } from './voronoi.js';

/**
 * The Delaunay triangulation of points in the plane.
 *
 * No point is inside the circumcircle of a triangle. If four points are on one circle, the least of them, by x and then
 * by y, is joined to the other three: so the points alone determine the triangles, whatever their order. Every decision
 * is exact, for 32-bit and 64-bit floats. Points without a triangle are no error: {@link Triangulation.hint} says why.
 * With {@link Constraints}, it is the constrained Delaunay triangulation.
 *
 * Reads the points before it returns its promise, and never changes them. Many points are triangulated in workers, one
 * per core, where these can share memory; see {@link Threading}. On one thread, and once the module is loaded, it
 * triangulates in the call.
 *
 * @param points - 2 numbers per point, in any typed array or in an array of numbers. Integers count as these numbers.
 * @throws {@link EdgeflipError} `non-finite` for the first coordinate that is NaN or infinite; `ragged-array`,
 * `invalid-input`, `invalid-option`, `too-large`, `load-failed`.
 */
export async function triangulate(
  points: VertexArray | readonly number[],
  options?: Spacing & Constraints & Threading,
): Promise<Triangulation>;
/**
 * The same, of a list of points that begin with x and y.
 *
 * @param points - Pairs of numbers, or arrays with more numbers, which do not count.
 */
export async function triangulate(
  points: readonly ArrayLike<number>[],
  options?: Constraints & Threading,
): Promise<Triangulation>;
/**
 * The same, of any list, with functions that read the coordinates. Their exceptions pass through.
 *
 * @param points - Anything that the functions take.
 */
export async function triangulate<P>(
  points: readonly P[] | (VertexArray & ArrayLike<P>),
  options: Accessors<P> & Constraints & Threading,
): Promise<Triangulation>;
export async function triangulate(points: unknown, options: unknown = {}): Promise<Triangulation> {
  const places = placesOf(options, THREADED);
  const isHere = ({ length }: VertexArray) => isLoaded() && threadCount(workOf(length), places) === 1;
  const hold: Hold = (view, what) => (isHere(view) ? itselfOf : copyOf)(view, what);
  const coordinates = coordinatesOf(points, places, hold);
  const work = workOf(coordinates.length);
  const count = threadCount(work, places);
  return count > 1
    ? onThreads(coordinates, places, count)
    : onOneThread(coordinates, places, whyOneThread(work, places));
}

/**
 * As how many triangles of a mesh so many coordinates count. Fewer points than 131,072 take less time than it takes to
 * start a worker. Each number of threads has workers of its own: a power of two keeps it the same for similar sets.
 */
function workOf(coordinates: number): number {
  return 2 ** Math.floor(Math.log2(coordinates / 4));
}

/** Transfers the coordinates. If the threads cannot be started, one thread gives the same result. */
async function onThreads(
  coordinates: Float32Array | Float64Array,
  places: Places,
  threads: number,
): Promise<Triangulation> {
  let triangulator: Triangulator;
  try {
    const [{ triangulatorOn }, module] = await Promise.all([import('./points-threads.js'), loadThreads()]);
    triangulator = await triangulatorOn(module, threads);
  } catch (thrown) {
    return onOneThread(coordinates, places, `the workers could not be started (${messageOf(thrown)})`);
  }
  return triangulationOf(await triangulator(coordinates, places), threads);
}

/** @param alone - Why there are not several threads, if there could be. */
async function onOneThread(
  coordinates: Float32Array | Float64Array,
  places: Places,
  alone: string | undefined,
): Promise<Triangulation> {
  if (!isLoaded()) await load();
  return triangulated(coordinates, places, alone);
}

/**
 * As {@link triangulate}, without a promise, on the thread of the caller. Call `init` before.
 *
 * ```ts
 * await init();
 * const { triangles } = triangulateSync(points);
 * ```
 *
 * @throws {@link EdgeflipError} `load-failed` without `init`; otherwise as {@link triangulate}.
 */
export function triangulateSync(
  points: VertexArray | readonly number[],
  options?: Spacing & Constraints,
): Triangulation;
/** The same, of a list of points that begin with x and y. */
export function triangulateSync(points: readonly ArrayLike<number>[], options?: Constraints): Triangulation;
/** The same, of any list, with functions that read the coordinates. Their exceptions pass through. */
export function triangulateSync<P>(
  points: readonly P[] | (VertexArray & ArrayLike<P>),
  options: Accessors<P> & Constraints,
): Triangulation;
export function triangulateSync(points: unknown, options: unknown = {}): Triangulation {
  checkLoaded('triangulateSync');
  const places = placesOf(options, TRIANGULATED);
  return triangulated(coordinatesOf(points, places, itselfOf), places);
}

function triangulated(
  coordinates: Float32Array | Float64Array,
  { constraints, skipConstraints = false }: Places,
  alone?: string,
): Triangulation {
  try {
    return triangulationOf(wasm.triangulate(coordinates, constraints, skipConstraints), 1, alone);
  } catch (thrown) {
    throw fromModule(thrown);
  }
}
