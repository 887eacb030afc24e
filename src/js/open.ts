/** Opens a session in the module of its engine. */

import { threadCount, whyOneThread } from './cores.js';
import { messageOf } from './given.js';
import { isLoaded, loadCore, moduleOfThreads } from './load.js';
import { copied, type IndexedMesh } from './mesh.js';
import type { GpuSettings, Settings } from './settings.js';
import type { ModuleSession } from './threads.js';
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
  const given = isLoaded() ? mesh : await whileLoading(mesh);
  const { positions, indices, dimension } = given;
  const why = whyCpu(indices.length / 3, dimension, positions instanceof Float64Array, count, settings);
  if (why !== undefined) {
    return openOnThreads(given === mesh ? copied(mesh) : given, settings, count, why);
  }
  try {
    return { session: await openAlone(given, { ...settings, leavesCpu: true }, settles) };
  } catch (thrown) {
    const { mesh: left, message } = Object(thrown) as { mesh?: Arrays; message: string };
    if (!left) throw thrown;
    const [positions, indices, dimension] = left;
    return openOnThreads({ positions, indices, dimension }, settings, count, message);
  }
}

/** The arguments of `Session.create` that make the mesh. */
type Arrays = [IndexedMesh['positions'], Uint32Array, IndexedMesh['dimension']];

/**
 * Opens a session in the module of the engines. With `leavesCpu`, the settings are those of a mesh for which `'auto'`
 * takes a GPU. If there is none, the exception has the mesh for another module, which has the CPU engine on threads.
 */
async function openAlone(mesh: IndexedMesh, settings: GpuSettings, settles = false): Promise<ModuleSession> {
  const given = isLoaded() ? mesh : await whileLoading(mesh);
  const { positions, indices, dimension } = given;
  const spare = !settles && indices.length >= FEWEST_SPARE ? spareOf(given, settings) : undefined;
  return Session.create(positions, indices, dimension, { ...settings, spare } as GpuSettings, settles);
}

/** The arrays are not read after a wait. */
async function spareOf({ positions, indices: { length }, dimension }: IndexedMesh, settings: GpuSettings) {
  const shape = { dimension, isDouble: positions instanceof Float64Array };
  const { spareFor } = await import('./spare.js');
  return spareFor(length, shape, settings);
}

/** The fewest indices of a mesh for whose result a worker makes the memory. */
const FEWEST_SPARE = 2 ** 19;

/** A copy of the mesh, once the module is loaded: the caller's arrays must not be read after a wait. */
async function whileLoading(mesh: IndexedMesh): Promise<IndexedMesh> {
  const copy = copied(mesh);
  await loadCore();
  return copy;
}

/** Transfers the arrays of the mesh. If the threads cannot be started, one thread gives the same result. */
async function openOnThreads(mesh: IndexedMesh, settings: Settings, count: number, fallback?: string): Promise<Opened> {
  let start: () => Promise<ModuleSession>;
  try {
    // Most runs do not need the script.
    const [{ ThreadsSession, threadsOf }, module] = await Promise.all([import('./threads.js'), moduleOfThreads()]);
    const threads = await threadsOf(module, count);
    start = () => ThreadsSession.create(threads, count, mesh, settings, fallback);
  } catch (thrown) {
    const alone = `the workers could not be started (${messageOf(thrown)})`;
    return { session: await openAlone(mesh, settings), alone };
  }
  return { session: await start() };
}
