/** Reads the points of the entry `edgeflip/points` into the arrays that its module takes: 2 numbers per point. */

import { MOST_THREADS } from './cores.js';
import { EdgeflipError } from './error.js';
import { copyOf, functionOf, isWhole, itselfOf, MOST_NUMBERS, NUMBERS, read, shown, viewOf, wordsOf } from './given.js';
import { namesOf, optionsOf } from './names.js';
import type { Hold } from './settings.js';
import type { IndexArray, VertexArray } from './types.js';

/** Where the points are in an array of numbers. */
export interface Spacing {
  /** The count of numbers from a point to the next: 3 for x, y and a height, which does not count. Default: 2. */
  stride?: number | undefined;
  /** The count of numbers before the first point. Default: 0. */
  offset?: number | undefined;
}

/** How to read the coordinates of the points of a list. */
export interface Accessors<P> {
  /** The x coordinate of a point. Called once for each point, before the call returns. */
  x: (point: P, index: number) => number;
  /** The y coordinate. */
  y: (point: P, index: number) => number;
}

/** On how many threads a call works. */
export interface Threading {
  /**
   * The largest number of threads, 1 to 256. Default: one per core. Fewer than 131,072 points are triangulated on one
   * thread, more on at most one thread per 8,192 points. Several threads need shared memory: Node has it, and so does a
   * cross-origin isolated page. The result is the same for any number.
   */
  threads?: number | undefined;
}

/** Edges that the triangulation has to have. */
export interface Constraints {
  /**
   * Pairs of points, by their indices, one pair after the other: each is joined by edges. A point on the way splits it.
   * Constraints may repeat, overlap and meet at points; one between equal points is no edge. All other edges are
   * Delaunay as far as points count that no constraint hides.
   */
  constraints?: IndexArray | undefined;
  /** Leaves out the constraints that cross an earlier one, and lists them as `leftOut`. Default: they are errors. */
  skipConstraints?: boolean | undefined;
}

/** The options of a call, checked. */
export interface Places extends Spacing, Partial<Accessors<unknown>>, Threading {
  constraints?: Uint32Array | undefined;
  skipConstraints?: boolean | undefined;
}

/** The options of a call that reads points. */
export const PLACED = namesOf<Spacing & Accessors<unknown>>({ stride: true, offset: true, x: true, y: true });
/** The options of a call that triangulates. */
export const TRIANGULATED = [...PLACED, ...namesOf<Constraints>({ constraints: true, skipConstraints: true })];
/** The options of one that can use several threads. */
export const THREADED = [...TRIANGULATED, ...namesOf<Threading>({ threads: true })];

/**
 * The coordinates of points. Every conversion is exact. `hold` copies an array of the caller or returns it.
 *
 * @throws {@link EdgeflipError} `invalid-input`, `invalid-option`, `ragged-array`, `too-large`. Exceptions of accessors
 * pass through.
 */
export function coordinatesOf(
  points: unknown,
  { x, y, stride, offset }: Places,
  hold: Hold,
): Float32Array | Float64Array {
  const view = viewOf(points, NUMBERS, 'points');
  // An array has the length 0 if its buffer has shrunk. This throws for it.
  if (view?.length === 0) read('points', () => Uint8Array.prototype.at.call(points as Uint8Array, 0));
  if (x && y) {
    const items = view ? hold(view, 'points') : read('points', () => itemsOf(points));
    return ofAny(items, x, y);
  }
  return read('points', () => {
    const list = view ? itselfOf(view, 'points') : (points as ArrayLike<unknown>);
    const length = view ? view.length : lengthOf(points);
    if (typeof list[0] !== 'object') return ofNumbers(list, length, stride, offset, hold);
    if (stride !== undefined || offset !== undefined) throw notOfNumbers(stride);
    return ofPairs(list, length);
  });
}

/**
 * Reads and checks the options, once.
 *
 * @param known - The names of the options that are allowed.
 * @throws {@link EdgeflipError} `invalid-input`, `invalid-option`.
 */
export function placesOf(options: unknown, known = PLACED): Places {
  return read('the options', () => {
    const given = optionsOf(options, known) as Spacing & Partial<Accessors<unknown>> & Threading & Constraints;
    const { stride, offset } = given;
    const more = { threads: threadsOf(given.threads), ...constraintsOf(given) };
    const [x, y] = [functionOf(given.x, 'x'), functionOf(given.y, 'y')];
    if (stride !== undefined && !(isWhole(stride) && stride >= 2)) {
      throw new EdgeflipError('invalid-input', `stride: ${shown(stride)} is not a whole number of at least 2`);
    }
    if (offset !== undefined && !isWhole(offset)) {
      throw new EdgeflipError('invalid-input', `offset: ${shown(offset)} is not a whole number of 32 bits`);
    }
    if (!x && !y) return { stride, offset, ...more };
    if (!x || !y) {
      throw new EdgeflipError('invalid-option', `option ${x ? 'y' : 'x'} is missing: x and y go together`);
    }
    if (stride !== undefined || offset !== undefined) throw notOfNumbers(stride);
    return { x, y, ...more };
  });
}

function threadsOf(given: unknown): number | undefined {
  if (given === undefined || (isWhole(given) && given >= 1 && given <= MOST_THREADS)) return given;
  const why = `${shown(given)} is not a number of threads: give 1 to ${MOST_THREADS}`;
  throw new EdgeflipError('invalid-option', `option threads: ${why}`);
}

/** Checks and copies the constraints. */
function constraintsOf({ constraints, skipConstraints }: Constraints): Pick<Places, keyof Constraints> {
  if (skipConstraints !== undefined && typeof skipConstraints !== 'boolean') {
    throw new EdgeflipError('invalid-option', `option skipConstraints: ${shown(skipConstraints)} is not a boolean`);
  }
  if (constraints === undefined) return { skipConstraints };
  const words = copyOf(wordsOf(constraints, 'option constraints', 'invalid-option'), 'constraints');
  if (words.length % 2 === 0) return { constraints: words, skipConstraints };
  throw new EdgeflipError('ragged-array', `constraints has ${words.length} numbers, not a multiple of 2`);
}

function notOfNumbers(stride: number | undefined): EdgeflipError {
  const name = stride === undefined ? 'offset' : 'stride';
  return new EdgeflipError('invalid-option', `option ${name}: it is for an array of numbers, not for a list of points`);
}

/** The length of a list, which is read only once: it may be another one the next time. */
function lengthOf(list: unknown): number {
  if (!Array.isArray(list)) throw wrong(`${shown(list)} is neither a typed array of numbers nor a list`);
  const { length } = list;
  if (length > MOST_NUMBERS) throw wrong(`a list has at most ${MOST_NUMBERS} items; pass a typed array`);
  return length;
}

/** A copy of a list. */
function itemsOf(list: unknown): unknown[] {
  return Array.from({ length: lengthOf(list) }, (_, i) => (list as ArrayLike<unknown>)[i]);
}

/** The coordinates in an array of numbers. */
function ofNumbers(
  list: VertexArray | ArrayLike<unknown>,
  length: number,
  stride = 2,
  offset = 0,
  hold: Hold,
): Float32Array | Float64Array {
  const left = Math.max(0, length - offset);
  if (left % stride === 1) {
    const why = `the last point has 1 of 2 coordinates (stride ${stride}, offset ${offset})`;
    throw new EdgeflipError('ragged-array', `points: ${why}`);
  }
  const hasNoGaps = stride === 2 && offset === 0;
  const isFloat = list instanceof Float32Array || list instanceof Float64Array;
  if (hasNoGaps && isFloat) return hold(list, 'points');
  const floats = floatsFor(Math.ceil(left / stride));
  for (let i = 0, at = offset; 2 * i < floats.length; i++, at += stride) {
    floats[2 * i] = numberOf(list[at], 'x', i);
    floats[2 * i + 1] = numberOf(list[at + 1], 'y', i);
  }
  return floats;
}

/** The coordinates of a list of pairs. */
function ofPairs(list: ArrayLike<unknown>, length: number): Float64Array {
  const advice = '; if the points are not pairs, pass the options x and y';
  const floats = floatsFor(length);
  for (let i = 0; 2 * i < floats.length; i++) {
    const point = list[i];
    if (typeof point !== 'object' || point === null) {
      throw wrong(`point ${i} is ${shown(point)}, not a pair of numbers`);
    }
    floats[2 * i] = numberOf((point as ArrayLike<unknown>)[0], 'x', i, advice);
    floats[2 * i + 1] = numberOf((point as ArrayLike<unknown>)[1], 'y', i, advice);
  }
  return floats;
}

/** The coordinates that accessors read. */
function ofAny(items: ArrayLike<unknown>, x: Accessors<unknown>['x'], y: Accessors<unknown>['y']): Float64Array {
  const floats = floatsFor(items.length);
  for (let i = 0; 2 * i < floats.length; i++) {
    floats[2 * i] = numberOf(x(items[i], i), 'x', i);
    floats[2 * i + 1] = numberOf(y(items[i], i), 'y', i);
  }
  return floats;
}

/** Memory for the coordinates of so many points. */
function floatsFor(count: number): Float64Array {
  return read('points', () => new Float64Array(2 * count));
}

function numberOf(value: unknown, axis: 'x' | 'y', i: number, advice = ''): number {
  if (typeof value === 'number') return value;
  throw wrong(`${axis} of point ${i} is ${shown(value)}, not a number${advice}`);
}

function wrong(why: string): EdgeflipError {
  return new EdgeflipError('invalid-input', `points: ${why}`);
}
