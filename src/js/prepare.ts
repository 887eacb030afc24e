/** Welds and reorients a mesh before the run, in the module of `edgeflip/files`. */

import { reorient, weld, type Welded } from './files.js';
import type { IndexedMesh } from './mesh.js';
import type { Settings } from './settings.js';

/** The mesh and the settings that a session starts with. */
export interface Prepared {
  indices: Uint32Array;
  turned?: number;
  welded?: Welded;
  settings: Settings;
}

/** Applies the options `weld` and `reorient`. The result has the other settings. */
export async function prepare(
  mesh: IndexedMesh,
  { weld: attributes, reorient: turns, ...settings }: Settings,
): Promise<Prepared> {
  if (!attributes) return { ...(await reorient(mesh)), settings };
  const welded = await weld(mesh, attributes, turns);
  const { indices, turned } = welded;
  return { indices, turned, welded, settings: { ...settings, ...locks(welded, settings) } };
}

/** The locks of the options, and the locks that keep the attributes. */
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
