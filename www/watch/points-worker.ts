/** The worker that triangulates the points of a file. Not every visit needs it, so it is apart from the one that reads. */

import { expose, transfer } from 'comlink';
import { triangulate } from 'edgeflip/points';

/** What the page needs of a triangulation. */
export interface Triangulated {
  triangles: Uint32Array;
  /** How many points have the x and y of an earlier one. */
  equal: number;
  /** Why there is no triangle. */
  hint: string | undefined;
}

const work = {
  /** Triangulates points by their first two of `stride` numbers. */
  async triangulate(positions: Float32Array | Float64Array, stride: number): Promise<Triangulated> {
    const { triangles, duplicates, hint } = await triangulate(positions, { stride });
    return transfer({ triangles, equal: duplicates.length / 2, hint }, [triangles.buffer]);
  },
};

export type PointsWorker = typeof work;
expose(work);
