/** The number of locked edges of what is shown, which a worker counts. */

import type { Locks } from './locks.ts';
import { optionsFor } from './options.ts';
import type { Shown } from './shown.ts';

/** The most triangles of a mesh whose locks are counted. */
const COUNTED = 200_000;

/** Counts the locks of the shown run, once for each run. */
export class LockCount {
  #of: Pick<Shown, 'opened' | 'settings'> | undefined;
  #count: number | undefined;

  /** The number of locked edges; `undefined` before they are counted, and for a large mesh. */
  of({ opened, settings }: Shown): number | undefined {
    return this.#of?.opened === opened && this.#of.settings === settings ? this.#count : undefined;
  }

  async count({ opened, settings }: Shown): Promise<void> {
    const { client, plan: mesh } = opened;
    if (this.#of?.opened === opened && this.#of.settings === settings) return;
    this.#of = { opened, settings };
    this.#count = undefined;
    if (mesh.indices.length > 3 * COUNTED) return;
    const { groups, lockedEdges, lockedTriangles }: Locks = { ...opened.mesh, ...(await optionsFor(opened, settings)) };
    const locks = { groups, lockedEdges, lockedTriangles };
    const isFree = Object.values(locks).every((list) => list === undefined || list.length === 0);
    const count = isFree ? 0 : await client.call((worker) => worker.countLocks(mesh, locks));
    if (this.#of?.opened === opened && this.#of.settings === settings) this.#count = count;
  }
}
