/** Opens a session in the module that has its engine. */

import { collecting } from './collect.js';
import { fromModule } from './error.js';
import { init, loadThreads } from './load.js';
import type { IndexedMesh } from './mesh.js';
import type { Settings } from './settings.js';
import { type ModuleSession, threadCount, ThreadsSession, threadsOf } from './threads.js';
import { Session, whyCpu } from './wasm/edgeflip.js';

/**
 * A session on the engine that the settings take; the CPU engine has threads where they are worth while and can be had.
 * The arrays of the mesh are given away.
 */
export async function open(mesh: IndexedMesh, settings: Settings): Promise<ModuleSession> {
  const count = threadCount(mesh.indices.length / 3, settings);
  const { backend = 'auto', order } = settings;
  if (count === 1 || (backend !== 'auto' && backend !== 'cpu')) return openAlone(mesh, settings);
  if (backend === 'cpu' || order === 'any') return openOnThreads(mesh, settings, count);
  await init();
  const { positions, indices, dimension } = mesh;
  const why = whyCpu(indices.length / 3, dimension, positions instanceof Float64Array, count, settings);
  if (why !== undefined) return openOnThreads(mesh, settings, count, inWordsOfPackage(why));
  try {
    return await openAlone(mesh, { ...settings, leavesCpu: true });
  } catch (thrown) {
    const { code, message } = fromModule(thrown);
    if (code !== 'backend-unavailable') throw thrown;
    return openOnThreads(mesh, settings, count, inWordsOfPackage(message));
  }
}

function inWordsOfPackage(why: string): string {
  return why.replace('backend gpu ', 'backend webgpu ');
}

/** In the module of the engines; `leavesCpu`: but for the CPU engine, where `'auto'` would take that. */
async function openAlone(
  { positions, indices, dimension }: IndexedMesh,
  settings: Settings & { leavesCpu?: boolean },
): Promise<ModuleSession> {
  await init();
  return collecting(() => Session.create(positions, indices, dimension, settings));
}

/** Where they cannot be started, one gives the same result. */
async function openOnThreads(mesh: IndexedMesh, settings: Settings, count: number, fallback?: string): Promise<ModuleSession> {
  const module = await loadThreads().catch(() => undefined);
  const threads = await (module && threadsOf(module, count).catch(() => undefined));
  if (!threads) return openAlone(mesh, settings);
  return ThreadsSession.create(threads, mesh, settings, fallback);
}
