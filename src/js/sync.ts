/** Flips without waiting, in the module of the engines that `init` has loaded. */

import { EdgeflipError, fromModule } from './error.js';
import { itselfOf } from './given.js';
import { isLoaded } from './load.js';
import { readMesh } from './mesh.js';
import { resultOf } from './result.js';
import { type Settings, settingsOf, SYNC_OPTIONS } from './settings.js';
import type { IndexArray, Mesh, Result, SyncOptions } from './types.js';
import { Session } from './wasm/edgeflip.js';

/**
 * As {@link makeDelaunay}, without a promise: on the CPU engine, on one thread, in this call. It is for many small
 * meshes, such as those of an editor or of a test; a large mesh blocks the page. Call {@link init} before.
 *
 * ```ts
 * await init();
 * const { indices } = makeDelaunaySync({ positions, indices: old, dimension: 2 });
 * ```
 *
 * @throws {@link EdgeflipError} about the mesh or the options; `load-failed` without `init`; `internal` if memory runs
 * out during the run.
 */
export function makeDelaunaySync<I extends IndexArray>(mesh: Mesh<I>, options: SyncOptions = {}): Result<I> {
  if (!isLoaded())
    throw new EdgeflipError('load-failed', 'the engines are not loaded; call `await init()` before makeDelaunaySync');
  const [{ positions, indices, dimension }, layout] = readMesh(mesh, itselfOf);
  const settings: Settings = { ...settingsOf(options, SYNC_OPTIONS), backend: 'cpu' };
  try {
    const session = now(Session.create(positions, indices, dimension, settings, false));
    try {
      while (now(session.advance()));
      return resultOf(now(session.outcome()), layout, {});
    } finally {
      session.free();
    }
  } catch (thrown) {
    throw fromModule(thrown);
  }
}

/** The result of a promise of the module that is settled: `src/system/promise.rs` makes it a field. */
function now<T>(promise: Promise<T> & { value?: T; error?: unknown }): T {
  if ('value' in promise) return promise.value;
  // Nobody else handles the rejection.
  promise.catch(() => undefined);
  throw promise.error ?? new EdgeflipError('internal', 'the engine crashed or ran out of memory');
}
