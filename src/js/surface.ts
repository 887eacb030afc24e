/** Runs on surfaces in the arrays of other libraries, for `three.ts` and `gltf-transform.ts`. */

import type { MakeDelaunayOptions, Mesh, Plane, VertexArray } from './types.js';

/** Numbers of vertices: those of vertex `i` are `array[i * stride + offset]` and the following, `width` in all. */
export interface Columns {
  array: VertexArray | Float16;
  width: number;
  stride: number;
  offset: number;
  /** Whether integers stand for fractions of the largest integer of their type. */
  isNormalized: boolean;
}

/** A Float16Array, which not every environment has. */
interface Float16 extends Omit<Uint16Array, typeof Symbol.toStringTag> {
  readonly [Symbol.toStringTag]: string;
}

/** A surface in space, or a terrain. */
export interface Surface {
  /** The number of vertices. */
  vertices: number;
  /** 3 numbers per vertex. */
  positions: Columns;
  /** All other attributes of the vertices, to tell vertices at the same position apart. */
  attributes: readonly Columns[];
  /** 3 per triangle. */
  indices: VertexArray;
}

/**
 * The mesh and the options for `makeDelaunay`. `plane` is that of a terrain. `weld` compares all attributes by default,
 * and `maxDeviation` is in the units that normalized positions stand for.
 */
export function meshOf(
  surface: Surface,
  plane: Plane | undefined,
  options: MakeDelaunayOptions,
): [Mesh<Uint32Array>, MakeDelaunayOptions] {
  const { vertices, positions, attributes } = surface;
  const { weld = attributes.map((columns) => comparable(columns, vertices)), maxDeviation } = options;
  const units = typeof maxDeviation === 'number' ? { maxDeviation: maxDeviation * unitOf(positions) } : {};
  const points = pointsOf(positions, vertices);
  const dimension = plane === undefined ? 3 : 2;
  const mesh: Mesh<Uint32Array> = { positions: points, indices: cornersOf(surface), dimension, plane, stride: 3 };
  return [mesh, { ...options, ...units, weld }];
}

/** The whole numbers from `first` up to `end`, which is excluded: the indices of vertices that make triangles in order. */
export function sequence(first: number, end: number): Uint32Array {
  const numbers = new Uint32Array(end - first);
  for (let i = 0; i < numbers.length; i++) numbers[i] = first + i;
  return numbers;
}

/** The positions as floats without gaps. Each conversion is exact. */
export function pointsOf(positions: Columns, vertices: number): Float32Array | Float64Array {
  const numbers = packed(positions, vertices);
  if (numbers instanceof Float32Array || numbers instanceof Float64Array) return numbers;
  const isShort = numbers.BYTES_PER_ELEMENT < 4;
  const points = isShort ? new Float32Array(numbers.length) : new Float64Array(numbers.length);
  // The smallest integer of a type and its successor both stand for -1.
  const least = positions.isNormalized ? -unitOf(positions) : -Infinity;
  for (let i = 0; i < points.length; i++) points[i] = Math.max(numbers[i]!, least);
  return points;
}

function cornersOf({ indices }: Surface): Uint32Array {
  return indices instanceof Uint32Array ? indices : Uint32Array.from(indices);
}

/** The integer that stands for 1. */
export function unitOf({ array, isNormalized }: Columns): number {
  if (!isNormalized || isFloat(array)) return 1;
  const isSigned = kindOf(array).startsWith('Int');
  return 2 ** (8 * array.BYTES_PER_ELEMENT - Number(isSigned)) - 1;
}

/** The numbers without gaps, to compare their bits: -0 becomes 0, because normals of flat faces have either. */
function comparable(columns: Columns, vertices: number): VertexArray {
  const { array } = columns;
  if (kindOf(array) === 'Float16Array') {
    const halves = new Uint16Array(array.buffer, array.byteOffset, array.length);
    return packed({ ...columns, array: halves.map((bits) => (bits === 0x8000 ? 0 : bits)) }, vertices);
  }
  const numbers = packed(columns, vertices);
  return isFloat(array) ? numbers.map((x) => x + 0) : numbers;
}

/** The numbers without gaps. */
function packed({ array: given, width, stride, offset }: Columns, vertices: number): VertexArray {
  const array = given as VertexArray;
  const length = vertices * width;
  if (stride === width) return array.subarray(offset, offset + length);
  const numbers = array.slice(0, length);
  for (let i = 0, to = 0; i < vertices; i++) {
    for (let k = 0; k < width; k++) numbers[to++] = array[i * stride + offset + k]!;
  }
  return numbers;
}

function isFloat(array: Columns['array']): boolean {
  return kindOf(array).startsWith('Float');
}

function kindOf(array: Columns['array']): string {
  return array[Symbol.toStringTag];
}
