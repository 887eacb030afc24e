/** Opens a session in the module that has its engine. */

import { fromModule } from './error.js';
import { init, loadThreads } from './load.js';
import type { IndexedMesh } from './mesh.js';
import { type ModuleSession, threadCount, ThreadsSession, threadsOf } from './threads.js';
import type { Options } from './types.js';
import { Session } from './wasm/edgeflip.js';

/** A session on the engine that the options take; the CPU engine has threads where they are worth while and can be had. */
export async function open(mesh: IndexedMesh, options: Options): Promise<ModuleSession> {
  const count = threadCount(mesh.indices.length / 3, options);
  const { backend = 'auto', order, device } = options;
  // What is refused is so there.
  const isDevice = device === undefined || (typeof GPUDevice !== 'undefined' && device instanceof GPUDevice);
  if (count === 1 || (backend !== 'auto' && backend !== 'cpu') || !isDevice) return openAlone(mesh, options);
  if (backend === 'cpu' || order === 'any') return openOnThreads(mesh, options, count);
  try {
    return await openAlone(mesh, { ...options, leavesCpu: true });
  } catch (thrown) {
    const { code, message } = fromModule(thrown);
    if (code !== 'backend-unavailable') throw thrown;
    return openOnThreads(mesh, options, count, message.replace('backend gpu ', 'backend webgpu '));
  }
}

/** In the module of the engines; `leavesCpu`: but for the CPU engine, where `'auto'` would take that. */
async function openAlone(
  { positions, indices, dimension }: IndexedMesh,
  options: Options & { leavesCpu?: boolean },
): Promise<ModuleSession> {
  await init();
  return Session.create(positions, indices, dimension, options);
}

/** Where they cannot be started, one gives the same result. */
async function openOnThreads(mesh: IndexedMesh, options: Options, count: number, fallback?: string): Promise<ModuleSession> {
  const module = await loadThreads().catch(() => undefined);
  const threads = await (module && threadsOf(module, count).catch(() => undefined));
  if (!threads) return openAlone(mesh, options);
  try {
    return await ThreadsSession.create(threads, mesh, options, fallback);
  } catch (thrown) {
    // An option that cannot be sent, which is refused there.
    if (thrown instanceof DOMException && thrown.name === 'DataCloneError') return openAlone(mesh, options);
    throw thrown;
  }
}
