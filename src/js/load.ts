/** Loads the module of the engines. */

import initModule, { setShaderLoader } from './wasm/edgeflip.js';
import { loader } from './module.js';

const start: typeof initModule = async (source) => {
  const module = await initModule(source);
  setShaderLoader(() => import('./glsl.js'));
  return module;
};

/**
 * Loads the WebAssembly module. Everything else calls it by itself: call it to load early, or with a source where the
 * module does not lie beside this file. The first call counts; after a failure the next one tries again.
 *
 * @throws {@link EdgeflipError} `load-failed`.
 */
export const init = loader(start, () => new URL('./wasm/edgeflip_bg.wasm', import.meta.url));
