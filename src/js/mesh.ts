/** Reads a mesh: checks the types of its arrays, and converts them to those of the modules, which check the values. */

import { EdgeflipError } from './error.js';
import {
  copyOf,
  floatsOfList,
  INTEGERS,
  isWhole,
  itselfOf,
  NUMBERS,
  objectOf,
  read,
  shown,
  viewOf,
  wordsOf,
} from './given.js';
import { checkSpelling, namesOf } from './names.js';
import type { Hold } from './settings.js';
import type { IndexArray, Indices, Mesh } from './types.js';

/** The names of the fields of a mesh. */
export const MESH = namesOf<Mesh>({ positions: true, indices: true, dimension: true, stride: true, offset: true });

/** A mesh with 32-bit indices whose positions are floats without gaps, as the modules take and return it. */
export interface IndexedMesh extends Mesh<Uint32Array> {
  /** 2 or 3 numbers per vertex. */
  positions: Float32Array | Float64Array;
  /** Positions have no gaps. */
  stride?: undefined;
  /** Positions start at the first number. */
  offset?: undefined;
}

/** A mesh whose positions are 32-bit floats. */
export interface Mesh32 extends IndexedMesh {
  /** 2 or 3 numbers per vertex. */
  positions: Float32Array;
}

/** Where the positions of a mesh are in its array. */
interface Places {
  dimension: 2 | 3;
  stride: number;
  offset: number;
}

/** Where all positions of a mesh are. */
export interface AllPlaces extends Places {
  vertices: number;
}

/** What a session keeps of a mesh, without its arrays. */
export interface Layout<I extends IndexArray> extends AllPlaces {
  /** Whether the mesh says what its stride is. */
  hasStride: boolean;
  /** Converts indices to the type of the given indices. */
  give: (indices: Uint32Array) => Indices<I>;
}

/**
 * Reads a mesh. `hold` copies an array of the caller or returns it.
 *
 * @throws {@link EdgeflipError} `invalid-input`, `ragged-array`, `too-large`.
 */
export function readMesh<I extends IndexArray>(given: Mesh<I>, hold: Hold = copyOf): [IndexedMesh, Layout<I>] {
  return read('the mesh', () => {
    const { positions, indices, dimension, stride, offset } = objectOf(given, 'mesh') as unknown as Mesh<I>;
    checkSpelling(given, MESH, 'mesh');
    checkDimension(dimension);
    const places = placesOf(dimension, stride, offset);
    const points = floatsOf(positions, places, hold);
    const view = viewOf(indices, ['Uint32Array'], 'indices');
    const words = view ? hold(view, 'indices') : wordsOf(indices, 'indices');
    const vertices = Math.floor(points.length / dimension);
    const layout = { ...places, vertices, hasStride: stride !== undefined, give: giverOf(indices) };
    return [{ positions: points, indices: words, dimension }, layout];
  });
}

/**
 * The mesh in the arrays that the modules take.
 *
 * @throws {@link EdgeflipError} `invalid-input`, `too-large`.
 */
export function moduleMesh(given: Mesh, hold: Hold): IndexedMesh {
  return readMesh(given, hold)[0];
}

/**
 * A copy of the mesh.
 *
 * @throws {@link EdgeflipError} `too-large`.
 */
export function copied({ positions, indices, dimension }: IndexedMesh): IndexedMesh {
  return { positions: copyOf(positions, 'positions'), indices: copyOf(indices, 'indices'), dimension };
}

/** @throws {@link EdgeflipError} `invalid-input`: a program without types may pass anything. */
export function checkDimension(dimension: number): void {
  if (dimension === 2 || dimension === 3) return;
  throw new EdgeflipError('invalid-input', `dimension: ${shown(dimension)} is not 2 or 3`);
}

/**
 * The positions as floats without gaps. Every conversion is exact. `hold` copies an array of the caller or returns it.
 *
 * @throws {@link EdgeflipError} `invalid-input`, `ragged-array`, `too-large`.
 */
export function floatsOf(
  given: Mesh['positions'],
  { dimension, stride, offset }: Places,
  hold: Hold,
): Float32Array | Float64Array {
  const view = viewOf(given, NUMBERS, 'positions') ?? floatsOfList(given, 'positions');
  const isFloat = view instanceof Float32Array || view instanceof Float64Array;
  if (isFloat && stride === dimension && offset === 0) return hold(view, 'positions');
  itselfOf(view, 'positions');
  const left = Math.max(0, view.length - offset);
  const rest = left % stride;
  if (rest > 0 && rest < dimension) {
    const why = `the last vertex has ${rest} of ${dimension} coordinates (stride ${stride}, offset ${offset})`;
    throw new EdgeflipError('ragged-array', `positions: ${why}`);
  }
  const length = Math.ceil(left / stride) * dimension;
  // A 32-bit float holds all numbers of 16 bits.
  const isShort = view instanceof Float32Array || view.BYTES_PER_ELEMENT < 4;
  const floats = isShort ? new Float32Array(length) : new Float64Array(length);
  for (let to = 0, from = offset; to < length; from += stride) {
    for (let axis = 0; axis < dimension; axis++) floats[to++] = view[from + axis]!;
  }
  return floats;
}

function placesOf(dimension: 2 | 3, stride: number = dimension, offset = 0): Places {
  const wrong = (name: string, value: unknown, what: string) =>
    new EdgeflipError('invalid-input', `${name}: ${shown(value)} is not ${what}`);
  if (!isWhole(stride) || stride < dimension) throw wrong('stride', stride, `a whole number of at least ${dimension}`);
  if (!isWhole(offset)) throw wrong('offset', offset, 'a whole number of 32 bits');
  return { dimension, stride, offset };
}

/** Converts indices to the type of an array: every index of a result is one of the input. */
function giverOf<I extends IndexArray>(given: I): (indices: Uint32Array) => Indices<I> {
  const kind = viewOf(given, INTEGERS, 'indices')?.constructor as Uint16ArrayConstructor | undefined;
  const give = (indices: Uint32Array): unknown => {
    if (!kind) return Array.from(indices);
    return (kind as unknown) === Uint32Array ? indices : new kind(indices);
  };
  return give as (indices: Uint32Array) => Indices<I>;
}
