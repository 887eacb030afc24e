/** Checks the types of a mesh before it goes into the module, which checks its values. */

import { EdgeflipError } from './error.js';
import type { Mesh } from './types.js';

/** A mesh in the arrays that the modules take and give. */
export interface Mesh32 extends Mesh {
  /** 2 or 3 numbers a vertex. */
  positions: Float32Array;
  /** Vertex indices, 3 a triangle. */
  indices: Uint32Array;
}

/**
 * The mesh in 32 bits.
 *
 * @throws {@link EdgeflipError} `invalid-input` or `not-float32`.
 */
export function moduleMesh({ positions, indices, dimension }: Mesh): Mesh32 {
  checkDimension(dimension);
  return { positions: float32(positions, dimension), indices: uint32(indices), dimension };
}

/** @throws {@link EdgeflipError} `invalid-input`, for a program without types. */
export function checkDimension(dimension: number): void {
  if (dimension === 2 || dimension === 3) return;
  throw new EdgeflipError('invalid-input', `dimension is ${String(dimension)}, not 2 or 3`);
}

/**
 * Positions in 32 bits.
 *
 * @throws {@link EdgeflipError} `invalid-input` or `not-float32`.
 */
export function float32(positions: Float32Array | Float64Array, dimension: 2 | 3): Float32Array {
  if (positions instanceof Float32Array) return positions;
  if (!(positions instanceof Float64Array)) {
    throw new EdgeflipError('invalid-input', 'positions are neither a Float32Array nor a Float64Array');
  }
  const rounded = Float32Array.from(positions);
  const place = positions.findIndex((x, i) => !Object.is(x, rounded[i]));
  if (place < 0) return rounded;
  const vertex = Math.floor(place / dimension);
  const axis = 'xyz'.charAt(place % dimension);
  throw new EdgeflipError(
    'not-float32',
    `vertex ${vertex}: coordinate ${axis} is ${positions[place]}, not a 32-bit float; round it first`,
  );
}

function uint32(indices: Uint32Array | Uint16Array): Uint32Array {
  if (indices instanceof Uint32Array) return indices;
  if (indices instanceof Uint16Array) return Uint32Array.from(indices);
  throw new EdgeflipError('invalid-input', 'indices are neither a Uint32Array nor a Uint16Array');
}
