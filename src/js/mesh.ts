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
import { AXES, checkPlan, type Floats, planOf, type Plane } from './plane.js';
import type { IndexArray, Indices, Mesh } from './types.js';

/** The names of the fields of a mesh that hold numbers. */
export const MESH = namesOf<Omit<Mesh, 'plane'>>({
  positions: true,
  indices: true,
  dimension: true,
  stride: true,
  offset: true,
});

/** A mesh with 32-bit indices whose positions are floats without gaps, as the modules take and return it. */
export interface IndexedMesh extends Mesh<Uint32Array> {
  /** 2 or 3 numbers per vertex; 3 with a plane. */
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

/** A mesh that was read. */
export interface ReadMesh extends IndexedMesh {
  /** All three coordinates of the vertices, if the mesh has a plane. `positions` has the two of the plane. */
  space?: Floats | undefined;
}

/** Where the positions of a mesh are in its array. */
interface Places {
  dimension: 2 | 3;
  plane?: Plane | undefined;
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
export function readMesh<I extends IndexArray>(given: Mesh<I>, hold: Hold = copyOf): [ReadMesh, Layout<I>] {
  return read('the mesh', () => {
    const { positions, indices, dimension, plane, stride, offset } = objectOf(given, 'mesh') as unknown as Mesh<I>;
    checkSpelling(given, MESH, 'mesh');
    checkDimension(dimension, plane);
    const places = placesOf(dimension, plane, stride, offset);
    const space = plane && spaceOf(positions, places, hold);
    const points = space ? planOf(space, plane) : floatsOf(positions, places, hold);
    if (space) checkPlan(points, plane);
    const view = viewOf(indices, ['Uint32Array'], 'indices');
    const words = view ? hold(view, 'indices') : wordsOf(indices, 'indices');
    const vertices = Math.floor(points.length / dimension);
    const layout = { ...places, vertices, hasStride: stride !== undefined, give: giverOf(indices) };
    return [{ positions: points, indices: words, dimension, space }, layout];
  });
}

/**
 * The mesh in the arrays that the modules take.
 *
 * @throws {@link EdgeflipError} `invalid-input`, `too-large`.
 */
export function moduleMesh(given: Mesh, hold: Hold): ReadMesh {
  return readMesh(given, hold)[0];
}

/** The same with all coordinates. */
export function inSpace({ positions, indices, dimension, space }: ReadMesh): IndexedMesh {
  return space ? { positions: space, indices, dimension: 3 } : { positions, indices, dimension };
}

/**
 * A copy of the mesh.
 *
 * @throws {@link EdgeflipError} `too-large`.
 */
export function copied({ positions, indices, dimension, space }: ReadMesh): ReadMesh {
  return {
    positions: copyOf(positions, 'positions'),
    indices: copyOf(indices, 'indices'),
    dimension,
    space: space && copyOf(space, 'positions'),
  };
}

/** @throws {@link EdgeflipError} `invalid-input`: a program without types may pass anything. */
export function checkDimension(dimension: number, plane?: unknown): void {
  if (dimension !== 2 && dimension !== 3) {
    throw new EdgeflipError('invalid-input', `dimension: ${shown(dimension)} is not 2 or 3`);
  }
  if (plane === undefined) return;
  if (!Object.hasOwn(AXES, plane as Plane)) {
    throw new EdgeflipError('invalid-input', `plane: ${shown(plane)} is not 'xy', 'xz' or 'yz'`);
  }
  if (dimension === 3) throw new EdgeflipError('invalid-input', 'dimension: a mesh with a plane has dimension 2');
}

/** All coordinates, with those that a plane leaves out, as {@link floatsOf}. */
export function spaceOf(given: Mesh['positions'], places: Places, hold: Hold): Floats {
  return floatsOf(given, { ...places, dimension: widthOf(places) }, hold);
}

/**
 * The coordinates that decide, of all vertices of a mesh that has moved. `isChecked`: whether they have to be finite.
 *
 * @throws {@link EdgeflipError} `position-count`, `non-finite`.
 */
export function movedTo(space: Floats, { plane, vertices }: AllPlaces, isChecked: boolean): Floats {
  if (!plane) return space;
  if (space.length !== 3 * vertices) {
    const message = `positions has ${space.length} numbers, but the vertices of the mesh take ${3 * vertices}`;
    throw new EdgeflipError('position-count', message);
  }
  const plan = planOf(space, plane);
  if (isChecked) checkPlan(plan, plane);
  return plan;
}

/**
 * The positions as floats without gaps. Every conversion is exact. `hold` copies an array of the caller or returns it.
 *
 * @throws {@link EdgeflipError} `invalid-input`, `ragged-array`, `too-large`.
 */
export function floatsOf(given: Mesh['positions'], { dimension, stride, offset }: Places, hold: Hold): Floats {
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

/** The count of numbers of a vertex. */
export const widthOf = ({ dimension, plane }: Pick<Places, 'dimension' | 'plane'>): 2 | 3 => (plane ? 3 : dimension);

function placesOf(dimension: 2 | 3, plane?: Plane, stride: number = widthOf({ dimension, plane }), offset = 0): Places {
  const width = widthOf({ dimension, plane });
  const wrong = (name: string, value: unknown, what: string) =>
    new EdgeflipError('invalid-input', `${name}: ${shown(value)} is not ${what}`);
  if (!isWhole(stride) || stride < width) throw wrong('stride', stride, `a whole number of at least ${width}`);
  if (!isWhole(offset)) throw wrong('offset', offset, 'a whole number of 32 bits');
  return { dimension, plane, stride, offset };
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
