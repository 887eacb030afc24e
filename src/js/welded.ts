/** Vertices that are joined for a run, and split again afterwards. */

import { EdgeflipError, fromModule } from './error.js';
import { shown, viewOf } from './given.js';

/** The result of `weld`: a mesh whose vertices at the same position are joined. */
export interface Welded {
  /** Vertex indices, 3 per triangle: the first vertex at each position. */
  indices: Uint32Array;
  /** The seams, two vertices per edge, for the option `lockedEdges`. */
  lockedEdges: Uint32Array;
  /** Triangles whose corners the seams do not protect, for the option `lockedTriangles`. */
  lockedTriangles: Uint32Array;
  /** For each vertex, the first vertex at its position. */
  places: Uint32Array;
  /** How many vertices are joined to an earlier one. */
  joined: number;
  /** The number of reversed triangles. */
  turned: number;
  /**
   * Splits the vertices again. `indices` is the result of a run that started with {@link Welded.indices} and locked the
   * edges and triangles above. Each corner gets a vertex at its position with its attributes. A corner that did not
   * move keeps its vertex.
   *
   * @throws {@link EdgeflipError} `triangle-count`, `index-out-of-range`; `invalid-option` for indices that are not
   * such a result, if that is noticed; `freed`.
   */
  split(indices: Uint32Array): Uint32Array;
  /** Frees the memory at once; the garbage collection frees it later. */
  free(): void;
}

/** The result for what the module has made. */
export function welded(made: Welded): Welded {
  const { indices, lockedEdges, lockedTriangles, places, joined, turned } = made;
  let isFreed = false;
  const split = (given: Uint32Array) => {
    if (isFreed) throw new EdgeflipError('freed', 'the welded mesh has been freed');
    const indices = viewOf(given, ['Uint32Array'], 'indices');
    if (!indices) throw new EdgeflipError('invalid-input', `indices: ${shown(given)} is not a Uint32Array`);
    try {
      return made.split(indices);
    } catch (thrown) {
      throw fromModule(thrown);
    }
  };
  const free = () => {
    if (isFreed) return;
    isFreed = true;
    try {
      made.free();
    } catch {
      // After a crash, the object is still borrowed by the call, and cannot be freed.
    }
  };
  return { indices, lockedEdges, lockedTriangles, places, joined, turned, split, free };
}
