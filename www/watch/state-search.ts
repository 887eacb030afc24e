/**
 * Finds the states of the edges of a large mesh. A worker repeats the run on the CPU, because every engine has the same
 * triangles, so that the page never waits for it.
 */

import { optionsFor } from './options.ts';
import type { SideStates } from './mesh-worker.ts';
import type { Shown } from './shown.ts';

/** The most triangles of a mesh whose states are looked for: the run on the CPU would take many seconds. */
export const SEARCHED = 4_000_000;

export class StateSearch {
  #of: Pick<Shown, 'opened' | 'settings'> | undefined;
  #last: Promise<unknown> = Promise.resolve();

  /** The states at the shown iteration; `undefined` if they are outdated before their turn, or the mesh is too large. */
  find(shown: Shown, isOutdated: () => boolean): Promise<SideStates | undefined> {
    const call = this.#last.then(() => (isOutdated() ? undefined : this.#find(shown)));
    this.#last = call.catch(() => undefined);
    return call;
  }

  async #find({ opened, settings, run: { at } }: Shown): Promise<SideStates | undefined> {
    const { client, mesh } = opened;
    if (mesh.indices.length > 3 * SEARCHED) return undefined;
    if (this.#of?.opened !== opened || this.#of.settings !== settings) {
      const options = await optionsFor(opened, settings);
      await client.call((worker) => worker.beginStates(mesh, options));
      this.#of = { opened, settings };
    }
    return client.call((worker) => worker.statesAt(at));
  }
}
