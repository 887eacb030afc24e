/**
 * Triangulates points in the plane, in a WebAssembly module that is loaded on first use.
 *
 * ```ts
 * import { triangulate } from 'edgeflip/points';
 * const { triangles, twins, hull } = await triangulate(points);
 * ```
 *
 * @packageDocumentation
 */

import initModule, * as wasm from './wasm/edgeflip_points.js';
import { type Accessors, coordinatesOf, placesOf, type Spacing, THREADED, type Threading } from './coordinates.js';
import { threadCount, whyOneThread } from './cores.js';
import { EdgeflipError, fromModule } from './error.js';
import { copyOf, itselfOf, messageOf } from './given.js';
import { compile, initOf, loader } from './module.js';
import type { Triangulator } from './points-threads.js';
import type { Hold } from './settings.js';
import type { VertexArray } from './types.js';

export type { Accessors, Spacing, Threading } from './coordinates.js';
export { EdgeflipError, type ErrorCode } from './error.js';
export type { ModuleSource, PointsSources } from './module.js';
export type { VertexArray } from './types.js';

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
  /** The threads that worked. */
  threads: number;
  /**
   * Why there is no triangle, or why many points had only one thread: sentences for a developer. `undefined` if there
   * are triangles and all is well.
   */
  hint: string | undefined;
}

let isLoaded = false;

const load = loader(
  async (source) => {
    await initModule(source);
    isLoaded = true;
  },
  'edgeflip_points_bg.wasm',
  () => new URL('./wasm/edgeflip_points_bg.wasm', import.meta.url),
);

let threadsModule: WebAssembly.Module;

const loadThreads = loader(
  async ({ module_or_path }) => {
    threadsModule = await compile(module_or_path);
  },
  'edgeflip_points_threads_bg.wasm',
  () => new URL('./wasm/edgeflip_points_threads_bg.wasm', import.meta.url),
);

/**
 * Loads the WebAssembly modules that `sources` names, or that of one thread if it names none. {@link triangulate} loads
 * what it needs by itself; {@link triangulateSync} needs this call before. Pass a source if a module is not in `wasm/`
 * next to this file.
 *
 * A module is loaded once; later sources are ignored. After a failure, the next call tries again.
 *
 * @throws {@link EdgeflipError} `load-failed`; `invalid-input` and `invalid-option` about `sources`.
 */
export const init = initOf('points', { points: load, threads: loadThreads });

/**
 * The Delaunay triangulation of points in the plane.
 *
 * No point is inside the circumcircle of a triangle. If four points are on one circle, the least of them, by x and then
 * by y, is joined to the other three: so the points alone determine the triangles, whatever their order. Every decision
 * is exact, for 32-bit and 64-bit floats. Points without a triangle are no error: {@link Triangulation.hint} says why.
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
  options?: Spacing & Threading,
): Promise<Triangulation>;
/**
 * The same, of a list of points that begin with x and y.
 *
 * @param points - Pairs of numbers, or arrays with more numbers, which do not count.
 */
export async function triangulate(points: readonly ArrayLike<number>[], options?: Threading): Promise<Triangulation>;
/**
 * The same, of any list, with functions that read the coordinates. Their exceptions pass through.
 *
 * @param points - Anything that the functions take.
 */
export async function triangulate<P>(
  points: readonly P[] | (VertexArray & ArrayLike<P>),
  options: Accessors<P> & Threading,
): Promise<Triangulation>;
export async function triangulate(points: unknown, options: unknown = {}): Promise<Triangulation> {
  const places = placesOf(options, THREADED);
  const isHere = ({ length }: VertexArray) => isLoaded && threadCount(workOf(length), places) === 1;
  const hold: Hold = (view, what) => (isHere(view) ? itselfOf : copyOf)(view, what);
  const coordinates = coordinatesOf(points, places, hold);
  const work = workOf(coordinates.length);
  const count = threadCount(work, places);
  return count > 1 ? onThreads(coordinates, count) : onOneThread(coordinates, whyOneThread(work, places));
}

/**
 * As how many triangles of a mesh so many coordinates count. Fewer points than 131,072 take less time than it takes to
 * start a worker. Each number of threads has workers of its own: a power of two keeps it the same for similar sets.
 */
function workOf(coordinates: number): number {
  return 2 ** Math.floor(Math.log2(coordinates / 4));
}

/** Transfers the coordinates. If the threads cannot be started, one thread gives the same result. */
async function onThreads(coordinates: Float32Array | Float64Array, threads: number): Promise<Triangulation> {
  let triangulator: Triangulator;
  try {
    const [{ triangulatorOn }] = await Promise.all([import('./points-threads.js'), loadThreads()]);
    triangulator = await triangulatorOn(threadsModule, threads);
  } catch (thrown) {
    return onOneThread(coordinates, `the workers could not be started (${messageOf(thrown)})`);
  }
  return triangulationOf(await triangulator(coordinates), threads);
}

/** @param alone - Why there are not several threads, if there could be. */
async function onOneThread(
  coordinates: Float32Array | Float64Array,
  alone: string | undefined,
): Promise<Triangulation> {
  if (!isLoaded) await load();
  return triangulated(coordinates, alone);
}

/**
 * As {@link triangulate}, without a promise, on the thread of the caller. Call {@link init} before.
 *
 * ```ts
 * await init();
 * const { triangles } = triangulateSync(points);
 * ```
 *
 * @throws {@link EdgeflipError} `load-failed` without {@link init}; otherwise as {@link triangulate}.
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
  if (!isLoaded) {
    const why = 'the module of the points is not loaded; call `await init()` before triangulateSync';
    throw new EdgeflipError('load-failed', why);
  }
  return triangulated(coordinatesOf(points, placesOf(options), itselfOf));
}

function triangulated(coordinates: Float32Array | Float64Array, alone?: string): Triangulation {
  try {
    return triangulationOf(wasm.triangulate(coordinates), 1, alone);
  } catch (thrown) {
    throw fromModule(thrown);
  }
}

/** The result of a module, and what to say about it. */
function triangulationOf(
  { triangles, twins, hull, duplicates }: ReturnType<typeof wasm.triangulate>,
  threads: number,
  alone?: string,
): Triangulation {
  const hints: string[] = [];
  if (triangles.length === 0) {
    const why = hull.length < 3 ? 'There are fewer than three distinct points' : 'All points are on one line';
    hints.push(`${why}, so there is no triangle.`);
  }
  if (alone !== undefined) hints.push(`The points were triangulated on one thread: ${alone}.`);
  return { triangles, twins, hull, duplicates, threads, hint: hints.length > 0 ? hints.join(' ') : undefined };
}
