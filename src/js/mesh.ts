/** Checks the types of a mesh. The modules check its values. */

import { EdgeflipError } from './error.js';
import { copyOf, objectOf, read, shown, viewOf } from './given.js';
import type { Hold } from './settings.js';
import type { Mesh } from './types.js';

/** A mesh with 32-bit indices, as the modules take and return it. */
export interface IndexedMesh extends Mesh {
  /** Vertex indices, 3 per triangle. */
  indices: Uint32Array;
}

/** A mesh whose positions are 32-bit floats. */
export interface Mesh32 extends IndexedMesh {
  /** 2 or 3 numbers per vertex. */
  positions: Float32Array;
}

/**
 * The mesh in the arrays that the modules take. `hold` copies each array or returns it.
 *
 * @throws {@link EdgeflipError} `invalid-input`, `too-large`.
 */
export function moduleMesh(mesh: Mesh, hold: Hold = copyOf): IndexedMesh {
  return read('the mesh', () => {
    const { positions, indices, dimension } = objectOf(mesh, 'mesh') as unknown as Mesh;
    checkDimension(dimension);
    const [points, corners] = [positionsOf(positions), indicesOf(indices)];
    const words = corners instanceof Uint32Array ? hold(corners, 'indices') : new Uint32Array(corners);
    return { positions: hold(points, 'positions'), indices: words, dimension };
  });
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

/** @throws {@link EdgeflipError} `invalid-input`: a program without types may pass anything. */
export function positionsOf(positions: Float32Array | Float64Array): Float32Array | Float64Array {
  const view = viewOf(positions, ['Float32Array', 'Float64Array'], 'positions');
  if (view) return view;
  throw new EdgeflipError('invalid-input', 'positions are neither a Float32Array nor a Float64Array');
}

/** @throws {@link EdgeflipError} `invalid-input`: a program without types may pass anything. */
export function indicesOf(indices: Uint32Array | Uint16Array): Uint32Array | Uint16Array {
  const view = viewOf(indices, ['Uint32Array', 'Uint16Array'], 'indices');
  if (view) return view;
  throw new EdgeflipError('invalid-input', 'indices are neither a Uint32Array nor a Uint16Array');
}
