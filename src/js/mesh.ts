/** Checks the types of a mesh before it goes into the module, which checks its values. */

import { EdgeflipError } from './error.js';
import type { Mesh } from './types.js';

/** A mesh in the arrays that the modules give. */
export interface IndexedMesh extends Mesh {
  /** Vertex indices, 3 a triangle. */
  indices: Uint32Array;
}

/** One in 32-bit floats. */
export interface Mesh32 extends IndexedMesh {
  /** 2 or 3 numbers a vertex. */
  positions: Float32Array;
}

/**
 * The mesh in the arrays that the modules take.
 *
 * @throws {@link EdgeflipError} `invalid-input`.
 */
export function moduleMesh({ positions, indices, dimension }: Mesh): IndexedMesh {
  checkDimension(dimension);
  checkPositions(positions);
  return { positions, indices: uint32(indices), dimension };
}

/** @throws {@link EdgeflipError} `invalid-input`, for a program without types. */
export function checkDimension(dimension: number): void {
  if (dimension === 2 || dimension === 3) return;
  throw new EdgeflipError('invalid-input', `dimension is ${String(dimension)}, not 2 or 3`);
}

/** @throws {@link EdgeflipError} `invalid-input`, for a program without types. */
export function checkPositions(positions: Float32Array | Float64Array): void {
  if (positions instanceof Float32Array || positions instanceof Float64Array) return;
  throw new EdgeflipError('invalid-input', 'positions are neither a Float32Array nor a Float64Array');
}

function uint32(indices: Uint32Array | Uint16Array): Uint32Array {
  if (indices instanceof Uint32Array) return indices;
  if (indices instanceof Uint16Array) return Uint32Array.from(indices);
  throw new EdgeflipError('invalid-input', 'indices are neither a Uint32Array nor a Uint16Array');
}
