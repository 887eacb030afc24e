/** The Voronoi diagram of points, from their triangulation; part of the entry `edgeflip/points`. */

import * as wasm from './wasm/edgeflip_points.js';
import { type Accessors, coordinatesOf, PLACED, placesOf, type Spacing } from './coordinates.js';
import { EdgeflipError, fromModule } from './error.js';
import { copyOf, floatsOfList, itselfOf, NUMBERS, objectOf, read, viewOf, wordsOf } from './given.js';
import { namesOf } from './names.js';
import { checkLoaded, isLoaded, load } from './points-module.js';
import type { Hold } from './settings.js';
import type { IndexArray, VertexArray } from './types.js';

/** The Voronoi diagram of points in a box. */
export interface Voronoi {
  /** x and y of the circumcentre of each triangle. It may be far away, and infinite if it is beyond 64-bit floats. */
  circumcentres: Float64Array;
  /** The cell of point i has the corners from `starts[i]` to before `starts[i + 1]`. One more than there are points. */
  starts: Uint32Array;
  /**
   * x and y of the corners of the cells. Those of a cell are counter-clockwise, all different, and the last is not the
   * first again. There are none if the point equals another with a smaller index, if the cell does not reach into the
   * box, or if what it has there has no area in 64-bit floats.
   */
  corners: Float64Array;
}

/** The arrays of a triangulation: what `triangulate` returns, or what is left of it in a file or a message. */
export interface TriangulationArrays {
  /** Three indices of points per triangle. */
  triangles: IndexArray;
  /** For each half-edge, the half-edge on the other side; 0xffffffff or -1 on the hull. */
  twins: IndexArray;
  /** If there is no triangle, all distinct points, by x and then by y. Otherwise it does not matter. */
  hull: IndexArray;
  /** Pairs: the index of a point, and that of one in a triangle that equals it. */
  duplicates: IndexArray;
}

/** The box that the cells share. */
export interface Bounds {
  /** `[xmin, ymin, xmax, ymax]`. Default: the smallest box that has all points. */
  bounds?: ArrayLike<number> | undefined;
}

const BOXED = [...PLACED, ...namesOf<Bounds>({ bounds: true })];

/**
 * The Voronoi diagram of points: for each point, the part of a box that is nearer to it than to the others.
 *
 * The cells fill the box. Each corner of a cell is a circumcentre, a corner of the box, or where two cells meet on its
 * side: the exact coordinates, rounded once. So the cells that have a corner in common have it with the same bits. Which
 * corners a cell has is decided without rounding.
 *
 * Reads its arguments before it returns its promise, and never changes them. Once the module is loaded, it works in the
 * call.
 *
 * @param points - As for `triangulate`, with the same options.
 * @param triangulation - The triangulation of these points, unchanged.
 * @throws {@link EdgeflipError} `invalid-option` for wrong bounds, and if there are none and the points have no box with
 * an area; `invalid-input` if this is not the Delaunay triangulation of the points; `index-out-of-range`,
 * `ragged-array`, `non-finite`, `too-large`, `load-failed`.
 */
export async function voronoi(
  points: VertexArray | readonly number[],
  triangulation: TriangulationArrays,
  options?: Spacing & Bounds,
): Promise<Voronoi>;
/** The same, of a list of points that begin with x and y. */
export async function voronoi(
  points: readonly ArrayLike<number>[],
  triangulation: TriangulationArrays,
  options?: Bounds,
): Promise<Voronoi>;
/** The same, of any list, with functions that read the coordinates. Their exceptions pass through. */
export async function voronoi<P>(
  points: readonly P[] | (VertexArray & ArrayLike<P>),
  triangulation: TriangulationArrays,
  options: Accessors<P> & Bounds,
): Promise<Voronoi>;
export async function voronoi(points: unknown, triangulation: unknown, options: unknown = {}): Promise<Voronoi> {
  const given = argumentsOf(points, triangulation, options, isLoaded() ? itselfOf : copyOf);
  if (!isLoaded()) await load();
  return diagramOf(given);
}

/**
 * As {@link voronoi}, without a promise. Call `init` before.
 *
 * @throws {@link EdgeflipError} `load-failed` without `init`; otherwise as {@link voronoi}.
 */
export function voronoiSync(
  points: VertexArray | readonly number[],
  triangulation: TriangulationArrays,
  options?: Spacing & Bounds,
): Voronoi;
/** The same, of a list of points that begin with x and y. */
export function voronoiSync(
  points: readonly ArrayLike<number>[],
  triangulation: TriangulationArrays,
  options?: Bounds,
): Voronoi;
/** The same, of any list, with functions that read the coordinates. */
export function voronoiSync<P>(
  points: readonly P[] | (VertexArray & ArrayLike<P>),
  triangulation: TriangulationArrays,
  options: Accessors<P> & Bounds,
): Voronoi;
export function voronoiSync(points: unknown, triangulation: unknown, options: unknown = {}): Voronoi {
  checkLoaded('voronoiSync');
  return diagramOf(argumentsOf(points, triangulation, options, itselfOf));
}

type Arguments = Parameters<typeof wasm.voronoi>;

/** What the module takes. */
function argumentsOf(points: unknown, triangulation: unknown, options: unknown, hold: Hold): Arguments {
  const places = placesOf(options, BOXED);
  // All that may call functions of the caller comes before the views of its arrays.
  const lists = read('the triangulation', () => {
    const given = objectOf(triangulation, 'triangulation') as unknown as TriangulationArrays;
    const { triangles, twins, hull, duplicates } = given;
    return { triangles, twins, hull, duplicates };
  });
  const bounds = read('the options', () => boundsOf((options as Bounds).bounds));
  const words = (name: keyof TriangulationArrays, size: number) => {
    const what = `triangulation.${name}`;
    const array = wordsOf(lists[name], what);
    if (array.length % size === 0) return (places.x ? copyOf : hold)(array, what);
    throw new EdgeflipError('ragged-array', `${what} has ${array.length} numbers, not a multiple of ${size}`);
  };
  const [triangles, twins] = [words('triangles', 3), words('twins', 3)];
  const [hull, duplicates] = [words('hull', 1), words('duplicates', 2)];
  return [coordinatesOf(points, places, hold), triangles, twins, hull, duplicates, bounds];
}

/** The four numbers of a box, which the module checks. */
function boundsOf(given: unknown): Float64Array | undefined {
  if (given === undefined) return undefined;
  const numbers = viewOf(given, NUMBERS, 'bounds') ?? floatsOfList(given, 'bounds');
  if (numbers.length === 4) return new Float64Array(numbers);
  const why = `it has ${numbers.length} numbers, not the 4 of [xmin, ymin, xmax, ymax]`;
  throw new EdgeflipError('invalid-option', `option bounds: ${why}`);
}

function diagramOf(given: Arguments): Voronoi {
  try {
    return wasm.voronoi(...given);
  } catch (thrown) {
    throw fromModule(thrown);
  }
}
