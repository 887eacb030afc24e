/** Reads the points of the entry `edgeflip/points` into the arrays that its module takes: 2 numbers per point. */

import { EdgeflipError } from './error.js';
import { functionOf, isWhole, itselfOf, MOST_NUMBERS, NUMBERS, read, shown, viewOf } from './given.js';
import { namesOf, optionsOf } from './names.js';
import type { Hold } from './settings.js';
import type { VertexArray } from './types.js';

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

const OPTIONS = namesOf<Spacing & Accessors<unknown>>({ stride: true, offset: true, x: true, y: true });

/**
 * The coordinates of points. Every conversion is exact. `hold` copies an array of the caller or returns it. Other options
 * may have the names in `more`.
 *
 * @throws {@link EdgeflipError} `invalid-input`, `invalid-option`, `ragged-array`, `too-large`. Exceptions of accessors
 * pass through.
 */
export function coordinatesOf(
  points: unknown,
  options: unknown,
  hold: Hold,
  more: readonly string[] = [],
): Float32Array | Float64Array {
  const { x, y, stride, offset } = placesOf(options, more);
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

/** Checks the options. */
function placesOf(options: unknown, more: readonly string[]): Spacing & Partial<Accessors<unknown>> {
  return read('the options', () => {
    const given = optionsOf(options, [...OPTIONS, ...more]) as Spacing & Partial<Accessors<unknown>>;
    const { stride, offset } = given;
    const [x, y] = [functionOf(given.x, 'x'), functionOf(given.y, 'y')];
    if (stride !== undefined && !(isWhole(stride) && stride >= 2)) {
      throw new EdgeflipError('invalid-input', `stride: ${shown(stride)} is not a whole number of at least 2`);
    }
    if (offset !== undefined && !isWhole(offset)) {
      throw new EdgeflipError('invalid-input', `offset: ${shown(offset)} is not a whole number of 32 bits`);
    }
    if (!x && !y) return { stride, offset };
    if (!x || !y) {
      throw new EdgeflipError('invalid-option', `option ${x ? 'y' : 'x'} is missing: x and y go together`);
    }
    if (stride !== undefined || offset !== undefined) throw notOfNumbers(stride);
    return { x, y };
  });
}

function notOfNumbers(stride: number | undefined): EdgeflipError {
  const name = stride === undefined ? 'offset' : 'stride';
  return new EdgeflipError('invalid-option', `option ${name}: it is for an array of numbers, not for a list of points`);
}

/** The length of a list, which is read only once: it may be another one the next time. */
function lengthOf(list: unknown): number {
  if (!Array.isArray(list)) throw wrong(`${shown(list)} is neither a typed array nor a list`);
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
