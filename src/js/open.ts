/** Opens a session in the module of its engine. */

import { collecting } from './collect.js';
import { fromModule } from './error.js';
import { messageOf } from './given.js';
import { isLoaded, loadCore, moduleOfThreads } from './load.js';
import { copied, type IndexedMesh } from './mesh.js';
import type { Settings } from './settings.js';
import { type ModuleSession, threadCount, ThreadsSession, threadsOf, whyOneThread } from './threads.js';
import { Session, whyCpu } from './wasm/edgeflip.js';

/** A session, and why it has one thread of the CPU if it could use more. */
export interface Opened {
  session: ModuleSession;
  alone?: string | undefined;
}

/**
 * Opens a session on the engine that the settings choose. The CPU engine uses threads if the mesh is large enough and
 * they can be started. The arrays of the mesh are read before this returns its promise, and not afterwards. `settles`:
 * whether updates may follow at once.
 */
export async function open(mesh: IndexedMesh, settings: Settings, settles: boolean): Promise<Opened> {
  const count = threadCount(mesh.indices.length / 3, settings);
  const { backend = 'auto', order } = settings;
  if (count === 1 || (backend !== 'auto' && backend !== 'cpu')) {
    const alone = whyOneThread(mesh.indices.length / 3, settings);
    return { session: await openAlone(mesh, settings, settles), alone };
  }
  if (backend === 'cpu' || order === 'any') return openOnThreads(copied(mesh), settings, count);
  let given = mesh;
  if (!isLoaded()) {
    given = copied(mesh);
    await loadCore();
  }
  const { positions, indices, dimension } = given;
  const why = whyCpu(indices.length / 3, dimension, positions instanceof Float64Array, count, settings);
  if (why !== undefined) {
    return openOnThreads(given === mesh ? copied(mesh) : given, settings, count, why);
  }
  try {
    return { session: await openAlone(given, { ...settings, leavesCpu: count }, settles) };
  } catch (thrown) {
    const { code, message } = fromModule(thrown);
    if (code !== 'backend-unavailable') throw thrown;
    return openOnThreads(refused(thrown) ?? given, settings, count, message);
  }
}

/**
 * Opens a session in the module of the engines. With `leavesCpu`, `'auto'` fails if it chooses the CPU engine, which
 * then runs in another module on `leavesCpu` threads.
 */
async function openAlone(
  mesh: IndexedMesh,
  settings: Settings & { leavesCpu?: number },
  settles = false,
): Promise<ModuleSession> {
  const ours = isLoaded() ? undefined : copied(mesh);
  if (ours) await loadCore();
  let [given, error]: [IndexedMesh | undefined, unknown] = [ours ?? mesh, undefined];
  return collecting(async () => {
    if (!given) throw error;
    let opening: Promise<ModuleSession> | undefined;
    try {
      opening = Session.create(given.positions, given.indices, given.dimension, settings, settles);
      return await opening;
    } catch (thrown) {
      // Another try needs the arrays. The caller's arrays must not be read after a wait, so they are copied.
      const last = given;
      [given, error] = [undefined, thrown];
      given = opening ? (refused(thrown) ?? ours) : copied(last);
      throw thrown;
    }
  });
}

/** The mesh in an exception of the module, which has it if another engine or another try may succeed. */
function refused(thrown: unknown): IndexedMesh | undefined {
  const { mesh } = thrown as { mesh?: [IndexedMesh['positions'], Uint32Array, IndexedMesh['dimension']] };
  return mesh && { positions: mesh[0], indices: mesh[1], dimension: mesh[2] };
}

/** Transfers the arrays of the mesh. If the threads cannot be started, one thread gives the same result. */
async function openOnThreads(mesh: IndexedMesh, settings: Settings, count: number, fallback?: string): Promise<Opened> {
  let threads: Awaited<ReturnType<typeof threadsOf>>;
  try {
    threads = await threadsOf(await moduleOfThreads(), count);
  } catch (thrown) {
    const alone = `the workers could not be started (${messageOf(thrown)})`;
    return { session: await openAlone(mesh, settings), alone };
  }
  return { session: await ThreadsSession.create(threads, count, mesh, settings, fallback) };
}
