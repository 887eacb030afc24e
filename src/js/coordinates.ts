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
 * The coordinates of points. Every conversion is exact. `hold` copies an array of the caller or returns it.
 *
 * @throws {@link EdgeflipError} `invalid-input`, `invalid-option`, `ragged-array`, `too-large`. Exceptions of accessors
 * pass through.
 */
export function coordinatesOf(points: unknown, options: unknown, hold: Hold): Float32Array | Float64Array {
  const { x, y, stride, offset } = placesOf(options);
  const view = viewOf(points, NUMBERS, 'points');
  // An array has the length 0 if its buffer has shrunk. This throws for it.
  if (view?.length === 0) read('points', () => Uint8Array.prototype.at.call(points as Uint8Array, 0));
  if (x && y) {
    const list = view ? hold(view, 'points') : read('points', () => Array.from(listOf(points)));
    return filled(
      list.length,
      (i) => x(list[i], i),
      (i) => y(list[i], i),
    );
  }
  return read('points', () => {
    const list = view ? itselfOf(view, 'points') : listOf(points);
    if (typeof list[0] !== 'object') return ofNumbers(list, stride, offset, hold);
    if (stride !== undefined || offset !== undefined) throw notOfNumbers(stride);
    const advice = '; if the points are not pairs, pass the options x and y';
    const pair = (i: number): ArrayLike<unknown> => {
      const point = list[i];
      if (typeof point === 'object' && point !== null) return point as ArrayLike<unknown>;
      throw wrong(`point ${i} is ${shown(point)}, not a pair of numbers`);
    };
    return filled(
      list.length,
      (i) => pair(i)[0],
      (i) => pair(i)[1],
      advice,
    );
  });
}

/** Checks the options. */
function placesOf(options: unknown): Spacing & Partial<Accessors<unknown>> {
  return read('the options', () => {
    const given = optionsOf(options, OPTIONS) as Spacing & Partial<Accessors<unknown>>;
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

/** A list whose length can be trusted. */
function listOf(given: unknown): ArrayLike<unknown> {
  if (!Array.isArray(given)) throw wrong(`${shown(given)} is neither a typed array nor a list`);
  const { length } = given;
  if (length > MOST_NUMBERS) throw wrong(`a list has at most ${MOST_NUMBERS} items; pass a typed array`);
  return given;
}

/** The coordinates in an array of numbers. */
function ofNumbers(
  list: VertexArray | ArrayLike<unknown>,
  stride = 2,
  offset = 0,
  hold: Hold,
): Float32Array | Float64Array {
  const left = Math.max(0, list.length - offset);
  if (left % stride === 1) {
    const why = `the last point has 1 of 2 coordinates (stride ${stride}, offset ${offset})`;
    throw new EdgeflipError('ragged-array', `points: ${why}`);
  }
  const hasNoGaps = stride === 2 && offset === 0;
  const isFloat = list instanceof Float32Array || list instanceof Float64Array;
  if (hasNoGaps && isFloat) return hold(list, 'points');
  return filled(
    Math.ceil(left / stride),
    (i) => list[offset + i * stride],
    (i) => list[offset + i * stride + 1],
  );
}

/** Two numbers for each point, read from these functions. */
function filled(count: number, x: (i: number) => unknown, y: (i: number) => unknown, advice = ''): Float64Array {
  const floats = read('points', () => new Float64Array(2 * count));
  const numberOf = (value: unknown, axis: string, i: number): number => {
    if (typeof value === 'number') return value;
    throw wrong(`${axis} of point ${i} is ${shown(value)}, not a number${advice}`);
  };
  for (let i = 0; i < count; i++) {
    floats[2 * i] = numberOf(x(i), 'x', i);
    floats[2 * i + 1] = numberOf(y(i), 'y', i);
  }
  return floats;
}

function wrong(why: string): EdgeflipError {
  return new EdgeflipError('invalid-input', `points: ${why}`);
}
