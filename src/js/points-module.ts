/** The WebAssembly module of the entry `edgeflip/points`. */

import initModule from './wasm/edgeflip_points.js';
import { EdgeflipError } from './error.js';
import { initOf, loader } from './module.js';

let isStarted = false;

/** Whether the module is loaded. */
export const isLoaded = (): boolean => isStarted;

/** Loads the module. */
export const load = loader(
  async (source) => {
    await initModule(source);
    isStarted = true;
  },
  'edgeflip_points_bg.wasm',
  () => new URL('./wasm/edgeflip_points_bg.wasm', import.meta.url),
);

/**
 * Loads the WebAssembly module of this entry. `triangulate` and `voronoi` load it by themselves; `triangulateSync` and
 * `voronoiSync` need this call before. Pass a source if the module is not in `wasm/` next to this file.
 *
 * The module is loaded once; later sources are ignored. After a failure, the next call tries again.
 *
 * @throws {@link EdgeflipError} `load-failed`; `invalid-input` and `invalid-option` about `sources`.
 */
export const init = initOf('points', { points: load });

/** @throws {@link EdgeflipError} `load-failed` if the module is not loaded. */
export function checkLoaded(caller: string): void {
  if (isStarted) return;
  throw new EdgeflipError(
    'load-failed',
    `the module of the points is not loaded; call \`await init()\` before ${caller}`,
  );
}
