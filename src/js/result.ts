/** Completes the outcome of a module to the result that callers get. */

import { hintOf } from './hint.js';
import type { Layout } from './mesh.js';
import type { Preparation } from './prepare.js';
import type { IndexArray, Plane, Result } from './types.js';
import type { Session } from './wasm/edgeflip.js';

/** How the package prepared the mesh and ran the CPU engine. */
export interface Context extends Preparation {
  /** The number of threads, if they are several. */
  threads?: number | undefined;
  /** Why the CPU engine has one thread, if it could use more. */
  alone?: string | undefined;
  /** Whether triangles that had turned over have become positive, where that was possible. */
  untangles?: boolean | undefined;
  /** The plane in which no triangle is turned over, if it is another one than the mesh has. */
  rightPlane?: Plane | undefined;
}

/** The result of a session: the same object with more fields, because a copy takes longer than a small mesh. */
export function resultOf<I extends IndexArray>(
  outcome: Awaited<ReturnType<Session['outcome']>>,
  layout: Layout<I>,
  { threads = 1, alone, untangles, rightPlane, turned = 0, welded, constrained }: Context,
): Result<I> {
  const seamEdges = (welded?.lockedEdges.length ?? 0) / 2;
  const { timings } = outcome;
  const constraints = constrained?.ms ?? 0;
  const isOnCpu = outcome.backend === 'cpu';
  const indices = welded?.split(outcome.indices) ?? outcome.indices;
  return Object.assign(outcome, {
    indices: layout.give(indices),
    threads: isOnCpu ? threads : 0,
    hint: hintOf(outcome, indices, layout, {
      seams: welded && seamEdges,
      untangles,
      rightPlane,
      alone: isOnCpu ? alone : undefined,
    }),
    turnedTriangles: turned,
    joinedVertices: welded?.joined ?? 0,
    seamEdges,
    crossedEdges: constrained?.crossedEdges ?? 0,
    constraintEdges: constrained?.edgesIn(indices, outcome.indices) ?? new Uint32Array(),
    constraintDeviation: constrained?.deviation ?? 0,
    leftOut: constrained?.leftOut ?? [],
    timings: { ...timings, constraints, total: constraints + timings.total },
  });
}
