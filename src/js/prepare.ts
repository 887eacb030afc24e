/** Changes a mesh as the options ask before the run, in the modules of `edgeflip/files` and of the repair. */

import { type Constrained, constrain, reorient, weld, type Welded } from './files.js';
import { moduleOfUntangler } from './load.js';
import { type IndexedMesh, inSpace, type ReadMesh } from './mesh.js';
import type { Settings } from './settings.js';
import { Turns } from './turn.js';
import { started } from './untangler.js';

/** What was done before the run. */
export interface Preparation {
  /** The number of triangles that `reorient` reversed. */
  turned?: number;
  /** What `weld` joined. */
  welded?: Welded;
  /** What `constraints` brought in. */
  constrained?: Pick<Constrained, 'crossedEdges' | 'deviation' | 'leftOut'> & {
    ms: number;
    /** The edges of the constraints by the vertices of a result. `joined` are its triangles before the split. */
    edgesIn: (indices: Uint32Array, joined: Uint32Array) => Uint32Array;
  };
  /** What the audit compares with, until vertices move. */
  before?: Before | undefined;
}

/** The mesh before `constraints` came in, and what they became. The settings share none of these arrays. */
export interface Before {
  indices: Uint32Array;
  lockedEdges: Uint32Array;
  constraints: Uint32Array;
  constraintEdges: Uint32Array;
  /** The option `constraintTolerance`. */
  tolerance: number;
  /** The indices of the constraints that were left out. */
  leftOut: Uint32Array;
}

/** The indices and the settings that a session starts with. */
export interface Prepared extends Preparation {
  indices: Uint32Array;
  settings: Settings;
}

/**
 * Applies the options `weld`, `reorient`, `untangle` and `constraints`, in this order. The result has the other settings.
 * The page handles events before and after the constraints come in.
 */
export async function prepare(
  mesh: ReadMesh,
  { weld: attributes, reorient: turns, constraints, constraintTolerance, skipConstraints, ...settings }: Settings,
): Promise<Prepared> {
  const page = new Turns();
  const prepared = await untangled(mesh, await joined(mesh, settings, attributes, turns));
  await page.give();
  if (!constraints) return prepared;
  const { lockedEdges, lockedTriangles, groups, ...others } = prepared.settings;
  const { indices, welded } = prepared;
  const ends = welded ? placed(constraints, welded) : constraints;
  const locks = { lockedEdges, lockedTriangles, groups };
  const start = performance.now();
  const { constraintEdges, crossedEdges, deviation, leftOut, ...made } = await constrain(
    { positions: mesh.positions, indices, dimension: mesh.dimension },
    ends,
    locks,
    skipConstraints,
    constraintTolerance,
  );
  const ms = performance.now() - start;
  await page.give();
  const ofLocks = made.lockedEdges.length - constraintEdges.length;
  return {
    ...prepared,
    constrained: {
      crossedEdges,
      deviation,
      leftOut,
      ms,
      edgesIn: (indices, joined) => edgesIn(constraintEdges, indices, joined),
    },
    before: {
      indices,
      // A copy, because a session may transfer its settings.
      lockedEdges: made.lockedEdges.slice(0, ofLocks),
      constraints: ends,
      constraintEdges,
      tolerance: constraintTolerance ?? 0,
      leftOut: Uint32Array.from(leftOut, ({ index }) => index),
    },
    indices: made.indices,
    settings: { ...others, lockedEdges: made.lockedEdges },
  };
}

async function joined(
  mesh: ReadMesh,
  settings: Settings,
  attributes: Settings['weld'],
  turns = false,
): Promise<Prepared> {
  if (attributes) {
    const welded = await weld(inSpace(mesh), attributes, turns);
    const { indices, turned } = welded;
    return { indices, turned, welded, settings: { ...settings, ...locks(welded, settings) } };
  }
  return turns ? { ...(await reorient(inSpace(mesh))), settings } : { indices: mesh.indices, settings };
}

/** Untangles a mesh in the plane. The modules of the engines refuse a surface in space. */
async function untangled({ positions, dimension }: IndexedMesh, prepared: Prepared): Promise<Prepared> {
  const { indices, settings } = prepared;
  if (!settings.untangle || dimension === 3) return prepared;
  const { untangleFirst } = await started(await moduleOfUntangler());
  const begun = untangleFirst(positions, indices, settings);
  if (!begun) return prepared;
  const { lockedTriangles, groups, ...others } = settings;
  const { lockedEdges, lostEdges } = begun;
  return { ...prepared, indices: begun.indices, settings: { ...others, lockedEdges, lostEdges } };
}

/**
 * The ends of edges by the vertices of a result. `joined` has the same corners with the vertices of the edges.
 */
function edgesIn(edges: Uint32Array, indices: Uint32Array, joined: Uint32Array): Uint32Array {
  if (joined === indices) return edges.slice();
  const ends = new Set(edges);
  const keyOf = (from: number, to: number) => Math.min(from, to) * 2 ** 32 + Math.max(from, to);
  const corners = new Map<number, number>();
  for (let h = 0; h < joined.length; h++) {
    if (!ends.has(joined[h]!)) continue;
    const to = joined[h % 3 === 2 ? h - 2 : h + 1]!;
    if (ends.has(to)) corners.set(keyOf(joined[h]!, to), h);
  }
  return edges.map((vertex, i) => {
    const h = corners.get(keyOf(vertex, edges[i ^ 1]!));
    if (h === undefined) return vertex;
    return indices[joined[h] === vertex ? h : h % 3 === 2 ? h - 2 : h + 1]!;
  });
}

/** The locks of the options, and the locks that keep the attributes. */
function locks(welded: Welded, { lockedEdges, lockedTriangles }: Settings): Settings {
  const edges = placed(lockedEdges ?? new Uint32Array(), welded);
  return {
    lockedEdges: both(edges, welded.lockedEdges),
    lockedTriangles: both(lockedTriangles ?? new Uint32Array(), welded.lockedTriangles),
  };
}

/** Vertices of the mesh as those of the welded mesh. */
function placed(vertices: Uint32Array, { places }: Welded): Uint32Array {
  return vertices.map((vertex) => places[vertex] ?? vertex);
}

function both(first: Uint32Array, second: Uint32Array): Uint32Array {
  const all = new Uint32Array(first.length + second.length);
  all.set(first);
  all.set(second, first.length);
  return all;
}
