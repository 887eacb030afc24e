/** Loads the modules of the entry `edgeflip`: the module of the engines, and modules that only some sessions need. */

import initModule, { setWebGl2 } from './wasm/edgeflip.js';
import { compile, initOf, loader } from './module.js';

let isStarted = false;

/** Whether the module of the engines is loaded. */
export function isLoaded(): boolean {
  return isStarted;
}

const start: typeof initModule = async (source) => {
  const module = await initModule(source);
  isStarted = true;
  setWebGl2({
    async create(...mesh) {
      await loadWebGl2();
      const { WebGl2 } = await import('./wasm/edgeflip_webgl2.js');
      return WebGl2.create(...mesh);
    },
  });
  return module;
};

let inlined: (() => Promise<ArrayBuffer>) | undefined;

/** Makes the bytes in the script of `edgeflip/inline` the source of the module of the engines. */
export function inlineCore(unpack: () => Promise<ArrayBuffer>): void {
  inlined = unpack;
}

/** Loads the module of the engines. */
export const loadCore = loader(
  start,
  'edgeflip_bg.wasm',
  () => new URL('./wasm/edgeflip_bg.wasm', import.meta.url),
  () => inlined?.(),
);

const loadWebGl2 = loader(
  async (source) => {
    const { default: initModule, setShaderLoader } = await import('./wasm/edgeflip_webgl2.js');
    await initModule(source);
    setShaderLoader(() => import('./glsl.js'));
  },
  'edgeflip_webgl2_bg.wasm',
  () => new URL('./wasm/edgeflip_webgl2_bg.wasm', import.meta.url),
);

let threadsModule: WebAssembly.Module;

const loadThreads = loader(
  async ({ module_or_path }) => {
    threadsModule = await compile(module_or_path);
  },
  'edgeflip_threads_bg.wasm',
  () => new URL('./wasm/edgeflip_threads_bg.wasm', import.meta.url),
);

/** The module of the threads. */
export async function moduleOfThreads(): Promise<WebAssembly.Module> {
  await loadThreads();
  return threadsModule;
}

let untangleModule: WebAssembly.Module;

const loadUntangle = loader(
  async ({ module_or_path }) => {
    untangleModule = await compile(module_or_path);
  },
  'edgeflip_untangle_bg.wasm',
  () => new URL('./wasm/edgeflip_untangle_bg.wasm', import.meta.url),
);

/** The module of the repair. */
export async function moduleOfUntangler(): Promise<WebAssembly.Module> {
  await loadUntangle();
  return untangleModule;
}

/** Loads the module that `FlipSession.verify` calls. */
export const loadAudit = loader(
  async (source) => (await import('./wasm/edgeflip_audit.js')).default(source),
  'edgeflip_audit_bg.wasm',
  () => new URL('./wasm/edgeflip_audit_bg.wasm', import.meta.url),
);

/**
 * Loads the WebAssembly modules that `sources` names, or the module of the engines if it names none. The package loads
 * each module by itself on first use. Call this to load early, or if the modules are not in `wasm/` next to this file:
 *
 * ```ts
 * await init({ base: '/static/edgeflip' });
 * ```
 *
 * A module is loaded once; later sources are ignored. After a failure, the next call tries again.
 *
 * @throws {@link EdgeflipError} `load-failed`; `invalid-input` and `invalid-option` about `sources`.
 */
export const init = initOf('core', {
  core: loadCore,
  webgl2: loadWebGl2,
  threads: loadThreads,
  untangle: loadUntangle,
  audit: loadAudit,
  files: async (source) => (await import('./load-files.js')).loadFiles(source),
});
