/** Loads the module of the engines, those of the WebGL2 engine and of the CPU engine's threads, and that of the audit. */

import initModule, { setWebGl2 } from './wasm/edgeflip.js';
import { compile, loader } from './module.js';

let isStarted = false;

/** Whether the module of the engines can be called at once. */
export function isLoaded(): boolean {
  return isStarted;
}

const start: typeof initModule = async (source) => {
  const module = await initModule(source);
  isStarted = true;
  setWebGl2({
    async create(...mesh) {
      await initWebGl2();
      const { WebGl2 } = await import('./wasm/edgeflip_webgl2.js');
      return WebGl2.create(...mesh);
    },
  });
  return module;
};

/**
 * Loads the WebAssembly module. Everything else calls it by itself: call it to load early, or with a source where the
 * module does not lie beside this file. The first call counts; after a failure the next one tries again.
 *
 * @throws {@link EdgeflipError} `load-failed`.
 */
export const init = loader(start, () => new URL('./wasm/edgeflip_bg.wasm', import.meta.url));

/**
 * Loads the module of the WebGL2 engine; a session does so by itself where it takes that engine. Call it to load early,
 * or with a source where `edgeflip_webgl2_bg.wasm` does not lie beside this file. The first call counts; after a failure
 * the next one tries again.
 *
 * @throws {@link EdgeflipError} `load-failed`.
 */
export const initWebGl2 = loader(
  async (source) => {
    const { default: initModule, setShaderLoader } = await import('./wasm/edgeflip_webgl2.js');
    await initModule(source);
    setShaderLoader(() => import('./glsl.js'));
  },
  () => new URL('./wasm/edgeflip_webgl2_bg.wasm', import.meta.url),
);

let threadsModule: WebAssembly.Module;

/** The module of the threads. */
export async function loadThreads(): Promise<WebAssembly.Module> {
  await initThreads();
  return threadsModule;
}

/**
 * Loads the module of the CPU engine's threads; a session does so by itself where it takes that engine for a large mesh,
 * and the page is cross-origin isolated. Call it to load early, or with a source where `edgeflip_threads_bg.wasm` does not
 * lie beside this file. The first call counts; after a failure the next one tries again.
 *
 * @throws {@link EdgeflipError} `load-failed`.
 */
export const initThreads = loader(
  async ({ module_or_path }) => {
    threadsModule = await compile(module_or_path);
  },
  () => new URL('./wasm/edgeflip_threads_bg.wasm', import.meta.url),
);

/**
 * Loads the module that `FlipSession.verify` calls; `verify` does so by itself. Call it to load early, or with a source
 * where `edgeflip_audit_bg.wasm` does not lie beside this file. The first call counts; after a failure the next one tries
 * again.
 *
 * @throws {@link EdgeflipError} `load-failed`.
 */
export const initAudit = loader(
  async (source) => (await import('./wasm/edgeflip_audit.js')).default(source),
  () => new URL('./wasm/edgeflip_audit_bg.wasm', import.meta.url),
);
