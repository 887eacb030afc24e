/**
 * Makes an existing triangle mesh Delaunay by flipping edges: exactly, with the same result on every engine. Vertices
 * stay unchanged.
 *
 * ```ts
 * import { makeDelaunay } from 'edgeflip';
 * const { indices, remaining } = await makeDelaunay({ positions, indices: old, dimension: 3 });
 * ```
 *
 * @packageDocumentation
 */

import { createWatched, runWatched } from './session.js';
import { watchOf } from './settings.js';
import type { IndexArray, MakeDelaunayOptions, Mesh, Result } from './types.js';

export type { Audit, Problems } from './audit.js';
export { EDGE_STATES, type EdgeState } from './edge-states.js';
export { EdgeflipError, type ErrorCode } from './error.js';
export { init } from './load.js';
export type { ModuleSource, Sources } from './module.js';
export { FlipSession } from './session.js';
export type { SessionBuffers } from './session-buffers.js';
export { makeDelaunaySync } from './sync.js';
export type * from './types.js';

/**
 * Flips edges until every edge is Delaunay or cannot flip. Copies the arrays of the mesh before it returns its promise,
 * and never changes them.
 *
 * @throws {@link EdgeflipError} about the mesh, the options or the backend.
 */
export async function makeDelaunay<I extends IndexArray>(
  mesh: Mesh<I>,
  options: MakeDelaunayOptions = {},
): Promise<Result<I>> {
  const watch = watchOf(options);
  const session = await createWatched(mesh, options);
  try {
    return await runWatched(session, watch);
  } finally {
    session.free();
  }
}
