/** What the options have done to a mesh before the run, by the module of `edgeflip/files`. */

import { reorient, weld, type Welded } from './files.js';
import type { IndexedMesh } from './mesh.js';
import type { Settings } from './settings.js';

/** What a session begins with. */
export interface Prepared {
  indices: Uint32Array;
  turned?: number;
  welded?: Welded;
  settings: Settings;
}

/** Turns triangles and joins vertices, where the options say so. The settings that are left are for the run. */
export async function prepare(
  mesh: IndexedMesh,
  { weld: attributes, reorient: turns, ...settings }: Settings,
): Promise<Prepared> {
  if (!attributes) return { ...(await reorient(mesh)), settings };
  const welded = await weld(mesh, attributes, turns);
  const { indices, turned } = welded;
  return { indices, turned, welded, settings: { ...settings, ...locks(welded, settings) } };
}

/** What the options name, and what keeps attributes. */
function locks({ places, ...keep }: Welded, { lockedEdges, lockedTriangles }: Settings): Settings {
  const edges = (lockedEdges ?? new Uint32Array()).map((vertex) => places[vertex] ?? vertex);
  return {
    lockedEdges: joined(edges, keep.lockedEdges),
    lockedTriangles: joined(lockedTriangles ?? new Uint32Array(), keep.lockedTriangles),
  };
}

function joined(first: Uint32Array, second: Uint32Array): Uint32Array {
  const all = new Uint32Array(first.length + second.length);
  all.set(first);
  all.set(second, first.length);
  return all;
}
