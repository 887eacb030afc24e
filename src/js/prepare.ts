/** What the options have done to a mesh before the run, by the module of `edgeflip/files`. */

import { reorient, weld, type Welded } from './files.js';
import type { Mesh, Options } from './types.js';

/** What a session begins with. */
export interface Prepared {
  indices: Uint32Array;
  turned: number;
  welded?: Welded;
  options: Options;
}

/** Turns triangles and joins vertices, where the options say so. */
export async function prepare(mesh: Mesh, options: Options): Promise<Prepared> {
  if (!options.weld) return { ...(await reorient(mesh)), options };
  const welded = await weld(mesh, options.weld === true ? [] : options.weld, options.reorient);
  const { indices, turned } = welded;
  return { indices, turned, welded, options: { ...options, ...locks(welded, options) } };
}

/** What the options name, and what keeps attributes. What is no array is left to the engine, which refuses it. */
function locks({ places, ...keep }: Welded, { lockedEdges = [], lockedTriangles = [] }: Options): Options {
  return {
    lockedEdges: isList(lockedEdges)
      ? [...Array.from(lockedEdges, (vertex) => places[vertex] ?? vertex), ...keep.lockedEdges]
      : lockedEdges,
    lockedTriangles: isList(lockedTriangles) ? [...lockedTriangles, ...keep.lockedTriangles] : lockedTriangles,
  };
}

function isList(given: unknown): boolean {
  return Array.isArray(given) || given instanceof Uint32Array;
}
