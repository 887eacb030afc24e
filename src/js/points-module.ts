/** The WebAssembly modules of the entry `edgeflip/points`. */

import initModule from './wasm/edgeflip_points.js';
import type { PointSession as ModuleSession } from './wasm/edgeflip_point_session.js';
import { EdgeflipError } from './error.js';
import { compile, initOf, loader } from './module.js';

let isStarted = false;

/** Whether the module of one thread is loaded. */
export const isLoaded = (): boolean => isStarted;

/** Loads the module of one thread. */
export const load = loader(
  async (source) => {
    await initModule(source);
    isStarted = true;
  },
  'edgeflip_points_bg.wasm',
  () => new URL('./wasm/edgeflip_points_bg.wasm', import.meta.url),
);

let compiled: WebAssembly.Module;

const compileThreads = loader(
  async ({ module_or_path }) => {
    compiled = await compile(module_or_path);
  },
  'edgeflip_points_threads_bg.wasm',
  () => new URL('./wasm/edgeflip_points_threads_bg.wasm', import.meta.url),
);

/** Loads the module of several threads, which workers start. */
export async function loadThreads(): Promise<WebAssembly.Module> {
  await compileThreads();
  return compiled;
}

let session: typeof ModuleSession | undefined;

/** The class of the module of points that move, if it is loaded. */
export const sessionClass = (): typeof ModuleSession | undefined => session;

const startSession = loader(
  async (source) => {
    const { default: init, PointSession } = await import('./wasm/edgeflip_point_session.js');
    await init(source);
    session = PointSession;
  },
  'edgeflip_point_session_bg.wasm',
  () => new URL('./wasm/edgeflip_point_session_bg.wasm', import.meta.url),
);

/** Loads the module of points that move. */
export async function loadSession(): Promise<typeof ModuleSession> {
  await startSession();
  return session!;
}

/**
 * Loads the WebAssembly modules that `sources` names, or that of one thread if it names none. The calls that return a
 * promise load what they need by themselves; the others need this call before. Pass a source if a module is not in
 * `wasm/` next to this file.
 *
 * A module is loaded once; later sources are ignored. After a failure, the next call tries again.
 *
 * @throws {@link EdgeflipError} `load-failed`; `invalid-input` and `invalid-option` about `sources`.
 */
export const init = initOf('points', { points: load, threads: compileThreads, session: startSession });

/** @throws {@link EdgeflipError} `load-failed` if the module of one thread is not loaded. */
export function checkLoaded(caller: string): void {
  if (isStarted) return;
  const why = `the module of the points is not loaded; call \`await init()\` before ${caller}`;
  throw new EdgeflipError('load-failed', why);
}
