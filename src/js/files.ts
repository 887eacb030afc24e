/**
 * Mesh files, generated meshes and measures, in a WebAssembly module that is loaded on first use.
 *
 * ```ts
 * import { readMesh, writeMesh } from 'edgeflip/files';
 * const mesh = await readMesh(new Uint8Array(await file.arrayBuffer()), file.name);
 * const bytes = await writeMesh(mesh, 'copy.off');
 * ```
 *
 * All functions run on the calling thread, so read a file of many million triangles in a worker.
 *
 * @packageDocumentation
 */

import * as wasm from './wasm/edgeflip_files.js';
import { checkWidths, type SplitCrossings, type SplitOptions, splitOf } from './crossings.js';
import { EdgeflipError, fromModule } from './error.js';
import type { FileMesh, ReadOptions, WriteOptions } from './file-mesh.js';
import { copyOf, read, shown, wordsOf } from './given.js';
import { areFilesLoaded, loadFiles } from './load-files.js';
import { checkDimension, inSpace, type Mesh32, moduleMesh } from './mesh.js';
import { initOf } from './module.js';
import { namesOf, optionsOf } from './names.js';
import {
  attributeNamesOf,
  attributesOf,
  bytesOf,
  coordinatesOf,
  filesOf,
  foundBy,
  maxBytesOf,
  originalOf,
  textOf,
} from './settings.js';
import type { Attributes, Bytes, IndexArray, LeftOut, Mesh, Original, VertexArray } from './types.js';
import { type Welded, welded } from './welded.js';

export type { SplitCrossings, SplitOptions } from './crossings.js';
export { EdgeflipError, type ErrorCode } from './error.js';
export type { FileMesh, ReadOptions, WriteOptions } from './file-mesh.js';
export type { IndexedMesh, Mesh32 } from './mesh.js';
export type { ModuleSource, Sources } from './module.js';
export type { FindFile } from './settings.js';
export type { Attributes, Bytes, Files, IndexArray, LeftOut, Mesh, Original, VertexArray } from './types.js';
export type { Welded } from './welded.js';

/**
 * The extensions of the formats that are read and written, in upper or lower case. If `.gz` follows, as in
 * `bunny.ply.gz`, the written file is compressed with gzip.
 */
export const FORMATS = ['.off', '.obj', '.ply', '.stl', '.gltf', '.glb'] as const;

/**
 * The extensions of the formats that have points and no triangles. They are only read, also compressed: the mesh has no
 * triangles, and `triangulate` of `edgeflip/points` takes its positions.
 */
export const POINT_FORMATS = ['.csv', '.xyz'] as const;

/** Statistics of the angles of a mesh. A degenerate triangle counts as one with an angle of 0°. */
export interface Angles {
  /** The smallest angle of the mesh in degrees; 60 without triangles. */
  min: number;
  /** The mean of the smallest angles of the triangles, in degrees; 60 without triangles. */
  meanMin: number;
  /** A histogram of all angles, three per triangle, in equal bins from 0° to 180°; a bin includes its lower end. */
  counts: Uint32Array;
}

/** The result of {@link reorient}. */
export interface Reoriented {
  /** Vertex indices, 3 per triangle. */
  indices: Uint32Array;
  /** The number of reversed triangles. */
  turned: number;
}

/** Edges that must not flip, as the options of the same names. */
export interface Locks {
  lockedEdges?: IndexArray | undefined;
  lockedTriangles?: IndexArray | undefined;
  groups?: IndexArray | undefined;
}

/** The result of {@link constrain}. */
export interface Constrained {
  /** Vertex indices, 3 per triangle. */
  indices: Uint32Array;
  /**
   * The edges that must not flip, two vertices per edge, for the option `lockedEdges`: all locks, then the constraints.
   */
  lockedEdges: Uint32Array;
  /**
   * The end of `lockedEdges`, without the locks, for {@link regions}. The edges are in the order of the constraints; a
   * constraint through vertices is several edges.
   */
  constraintEdges: Uint32Array;
  /** How many edges they crossed: each made way for another one. */
  crossedEdges: number;
  /** The largest distance of a vertex from the constraint that goes through it; 0 without a tolerance. */
  deviation: number;
  /** The constraints that were left out. */
  leftOut: LeftOut[];
}

/** The result of {@link regions}. */
export interface Regions {
  /** How many regions there are. */
  count: number;
  /** The region of each triangle. Regions are numbered in the order of their first triangles, from 0. */
  ofTriangles: Uint32Array;
  /** 1 for each triangle that is inside, else 0. */
  inside: Uint8Array;
  /** Whether the edges are closed polygons: an even number of them ends at every vertex. If not, `inside` is a guess. */
  isClosed: boolean;
}

/** Measures of a mesh. */
export interface Measures {
  /** Smallest angle in degrees; 60 without triangles. */
  minAngle: number;
  /** Mean of the smallest angles of the triangles, in degrees; 60 without triangles. */
  meanMinAngle: number;
  /**
   * Mean aspect ratio of the triangles that are not flat: the longest edge divided by the diameter of the incircle,
   * scaled to 1 for an equilateral triangle.
   */
  meanAspect: number;
  /** The number of triangles without area. */
  flat: number;
  /** The sum of the unsigned areas of the triangles. */
  area: number;
  /** The volume inside a closed surface, negative if its triangles are clockwise from outside; 0 in the plane. */
  volume: number;
}

/** The changes that a run made. */
export interface Change {
  /** The indices of the triangles that changed, in ascending order. */
  moved: Uint32Array;
  /** The largest distance between the surfaces before and after, measured at the edges that only one of them has. */
  distance: number;
}

/**
 * Loads the WebAssembly module of this entry. Every other function loads it by itself. Call this to load early, or if
 * the module is not in `wasm/` next to this file. `init` of `edgeflip` does the same, and takes sources for all
 * modules.
 *
 * A module is loaded once; later sources are ignored. After a failure, the next call tries again.
 *
 * @throws {@link EdgeflipError} `load-failed`; `invalid-input` and `invalid-option` about `sources`.
 */
export const init = initOf('files', { files: loadFiles });

const READ_OPTIONS = namesOf<ReadOptions>({
  dimension: true,
  plane: true,
  coordinates: true,
  maxBytes: true,
  files: true,
  ignoreAttributes: true,
});
const LOCKS = namesOf<Locks>({ lockedEdges: true, lockedTriangles: true, groups: true });
const SPLIT_OPTIONS = namesOf<SplitOptions>({
  lockedEdges: true,
  lockedTriangles: true,
  groups: true,
  skipConstraints: true,
  attributes: true,
});
const NONE = new Uint32Array();
const WRITE_OPTIONS = namesOf<WriteOptions>({ original: true });

/** The array itself if the module is loaded; else a copy, because the caller may change the array during the wait. */
function held<A extends VertexArray>(view: A, what: string): A {
  return areFilesLoaded() ? view : copyOf(view, what);
}

/**
 * Reads a mesh from the bytes of a file, which may be compressed with gzip.
 *
 * @param name - The file's name, such as `bunny.obj`: the extension names the format.
 * @throws {@link EdgeflipError} `parse`, with the line or the byte, or with a vertex whose z is not 0 if `dimension` is
 * 2; `unknown-format`, `file-too-large`, `too-large`, `invalid-input`, `invalid-option`.
 */
export async function readMesh(bytes: Uint8Array, name: string, options: ReadOptions = {}): Promise<FileMesh> {
  const [view, file] = [bytesOf(bytes, 'bytes'), textOf(name, 'name')];
  const failures: unknown[] = [];
  const { dimension, files, ...more } = read('the options', () => {
    const given = optionsOf(options, READ_OPTIONS) as ReadOptions;
    const { plane, dimension = plane && 2, coordinates, maxBytes, files, ignoreAttributes } = given;
    if (dimension !== undefined) checkDimension(dimension, plane);
    const found = typeof files === 'function' ? foundBy(files, failures) : filesOf(files, held);
    return {
      dimension,
      plane,
      files: found,
      maxBytes: maxBytesOf(maxBytes),
      coordinates: coordinatesOf(coordinates),
      ignoreAttributes: attributeNamesOf(ignoreAttributes),
    };
  });
  // The module counts bytes with 32 bits.
  if (view.length >= 2 ** 32) throw new EdgeflipError('file-too-large', 'the file has more than 4294967295 bytes');
  const content = held(view, 'bytes');
  try {
    const mesh = await call(() => wasm.readMesh({ bytes: content, name: file, files, ...more }, dimension));
    return more.plane ? { ...mesh, dimension: 2, plane: more.plane } : mesh;
  } catch (error) {
    throw failures.length > 0 ? failures[0] : error;
  }
}

/**
 * The bytes of a file that holds the mesh. If the mesh is in the plane, every z is 0, unless it has a `plane` and so
 * heights. In OFF and OBJ each number has
 * the fewest digits from which its 32 or 64 bits follow; {@link readMesh} needs `coordinates: 64` to read the same 64
 * bits, if 32-bit floats show all digits. PLY is binary and keeps all bits. STL is binary, and its positions are
 * rounded to 32-bit floats, as in glTF.
 *
 * @param name - The file's name, such as `bunny.obj` or `bunny.ply.gz`: the extension names the format.
 * @throws {@link EdgeflipError} about the mesh; `unknown-format`; `io` for coordinates that STL and glTF cannot hold;
 * for the original the errors of {@link readMesh}, `triangle-count` if it has another number of triangles, and
 * `invalid-option` if its positions differ from those of the mesh or if flips crossed its seams.
 */
export async function writeMesh(mesh: Mesh, name: string, options: WriteOptions = {}): Promise<Bytes> {
  const { positions, indices, dimension } = inSpace(moduleMesh(mesh, held));
  const file = textOf(name, 'name');
  const original = read('the options', () => {
    const { original } = optionsOf(options, WRITE_OPTIONS) as WriteOptions;
    return original === undefined ? undefined : originalOf(original, held);
  });
  if (original) {
    const { plane } = mesh;
    return call(() => wasm.rewriteMesh({ ...original, plane }, positions, indices, dimension, file));
  }
  return call(() => wasm.writeMesh(positions, indices, dimension, file));
}

/**
 * Generates a mesh, with the same bits on every machine.
 *
 * @param spec - A family, its size, and optionally a parameter and a seed: `uvsphere 600`, `shear 300 30`,
 * `random 100 seed=7`. The message of the error lists all families.
 * @throws {@link EdgeflipError} `invalid-option`, `too-large`.
 */
export async function generate(spec: string): Promise<Mesh32> {
  const family = textOf(spec, 'spec');
  return call(() => wasm.generate(family));
}

/**
 * The angles of a mesh, for statistics: computed in 64-bit floats, not exactly.
 *
 * @param bins - How many bins the histogram has: 1 to 65536.
 * @throws {@link EdgeflipError} about the mesh; `invalid-option`.
 */
export async function angles(mesh: Mesh, bins = 180): Promise<Angles> {
  const { positions, indices, dimension } = moduleMesh(mesh, held);
  if (typeof bins !== 'number') throw new EdgeflipError('invalid-input', `bins: ${shown(bins)} is not a number`);
  return call(() => wasm.angles(positions, indices, dimension, bins));
}

/**
 * Reverses the minority of inconsistently oriented triangles in each orientable component. The option `reorient` does
 * so before a run.
 *
 * @throws {@link EdgeflipError} about the mesh.
 */
export async function reorient(mesh: Mesh): Promise<Reoriented> {
  const { positions, indices, dimension } = moduleMesh(mesh, held);
  return call(() => wasm.reorient(positions, indices, dimension));
}

/**
 * Joins the vertices at exactly the same position; -0 equals 0. The option `weld` does so for a run.
 *
 * @param attributes - The attributes that vertices at the same position are compared by. By default all such vertices
 * are equal.
 * @param turns - Whether to reorient the joined mesh, as {@link reorient} does.
 * @throws {@link EdgeflipError} about the mesh; `invalid-input`; those of {@link readMesh} about the original.
 */
export async function weld(mesh: Mesh, attributes: Attributes = [], turns = false): Promise<Welded> {
  const { positions, indices, dimension } = inSpace(moduleMesh(mesh, held));
  const given = attributesOf(attributes, held);
  if (!isList(given)) return call(() => welded(wasm.Weld.ofFile(given, indices, dimension, Boolean(turns))));
  const vertices = positions.length / dimension;
  checkWidths(given, vertices);
  const arrays = given.map((array) => new Uint8Array(array.buffer, array.byteOffset, array.byteLength));
  return call(() => welded(wasm.Weld.of(positions, indices, dimension, arrays, Boolean(turns))));
}

/**
 * Brings edges into a mesh in the plane: the edges that they cross make way for others, by exact tests. No vertex moves,
 * and none is added. The option `constraints` does so before a run.
 *
 * @param constraints - Pairs of vertices, as the option `constraints`.
 * @param locks - Edges that must not flip.
 * @param skips - Whether constraints that cannot be brought in are left out. Otherwise they are errors.
 * @param tolerance - As the option `constraintTolerance`.
 * @throws {@link EdgeflipError} about the mesh; `invalid-option` for a mesh in space, for a constraint that cannot be
 * brought in, and for locks that the mesh does not have; `invalid-input`.
 */
export async function constrain(
  mesh: Mesh,
  constraints: IndexArray,
  locks: Locks = {},
  skips = false,
  tolerance = 0,
): Promise<Constrained> {
  flagOf(skips, 'skips');
  if (typeof tolerance !== 'number')
    throw new EdgeflipError('invalid-input', `tolerance: ${shown(tolerance)} is not a number`);
  const { positions, indices, dimension } = moduleMesh(mesh, held);
  const pairs = held(wordsOf(constraints, 'constraints'), 'constraints');
  const given = read('the locks', () => locksOf(optionsOf(locks, LOCKS, 'locks') as Locks));
  return call(() => wasm.constrain(positions, indices, dimension, pairs, given, skips, tolerance));
}

/**
 * Brings edges that may cross each other into a mesh in the plane: as {@link constrain}, but with a new vertex where two
 * of them cross. It is at the exact crossing, rounded to the floats of the positions, and both lines go on through it.
 * Where rounding would put another vertex on the wrong side of a line, the line goes through that vertex. It is the one
 * call that adds vertices to a mesh. The result depends on the order of the constraints.
 *
 * ```ts
 * const { positions, indices, dimension, constraintEdges } = await splitCrossings(mesh, [0, 2, 1, 3]);
 * const result = await makeDelaunay({ positions, indices, dimension }, { lockedEdges: constraintEdges });
 * ```
 *
 * @param constraints - Pairs of vertices, as the option `constraints`.
 * @throws {@link EdgeflipError} about the mesh; `invalid-option` for a mesh in space, for a constraint that cannot be
 * brought in, and for locks that the mesh does not have; `invalid-input`; `too-large`.
 */
export async function splitCrossings(
  mesh: Mesh,
  constraints: IndexArray,
  options: SplitOptions = {},
): Promise<SplitCrossings> {
  const given = moduleMesh(mesh, held);
  const { plane } = mesh;
  const pairs = held(wordsOf(constraints, 'constraints'), 'constraints');
  const { skips, locks, arrays } = read('the options', () => {
    const { skipConstraints = false, attributes = [], ...locks } = optionsOf(options, SPLIT_OPTIONS) as SplitOptions;
    flagOf(skipConstraints, 'skipConstraints');
    const arrays = attributesOf(attributes, held);
    if (!isList(arrays)) throw new EdgeflipError('invalid-input', 'attributes: it is not a list of typed arrays');
    return { skips: skipConstraints, locks: locksOf(locks), arrays };
  });
  const { positions, indices, dimension, space } = given;
  if (dimension === 2) checkWidths(arrays, positions.length / 2);
  const isDouble = (space ?? positions) instanceof Float64Array;
  return call(() => {
    const split = wasm.splitCrossings(positions, indices, dimension, isDouble, pairs, locks, skips);
    return splitOf(given, plane, arrays, split);
  });
}

/** All locks, as the module takes them. */
function locksOf(locks: Locks): Required<Locks> {
  const names = Object.entries(locks).map(([name, value]) => [name, held(wordsOf(value ?? [], name), name)]);
  return { lockedEdges: NONE, lockedTriangles: NONE, groups: NONE, ...Object.fromEntries(names) };
}

/** @throws {@link EdgeflipError} `invalid-input`. */
function flagOf(value: unknown, what: string): void {
  if (typeof value === 'boolean') return;
  throw new EdgeflipError('invalid-input', `${what}: ${shown(value)} is not true or false`);
}

/**
 * Cuts a mesh into regions along edges, such as {@link Constrained.constraintEdges}, and tells which triangles are
 * inside. Two triangles are in one region if a path from one to the other crosses none of these edges.
 *
 * A triangle is inside if a path to it from outside crosses the edges an odd number of times. An edge that is given twice
 * counts twice, so two polygons with a common side are both inside. In the plane, outside is what surrounds a component,
 * not a hole in it. In space, it is all that lies beyond the boundary; in a component without boundary, the region of the
 * first triangle is not inside. If the edges are not closed polygons, the path with the fewest crossings counts.
 *
 * @param edges - Pairs of vertices, one pair after the other.
 * @throws {@link EdgeflipError} about the mesh; `invalid-option` for a pair that is no edge of the mesh;
 * `invalid-input`.
 */
export async function regions(mesh: Mesh, edges: IndexArray): Promise<Regions> {
  const { positions, indices, dimension } = moduleMesh(mesh, held);
  const pairs = held(wordsOf(edges, 'edges'), 'edges');
  return call(() => wasm.regions(positions, indices, dimension, pairs));
}

/**
 * Measures a mesh, for reports: in 64-bit floats, not exactly.
 *
 * @throws {@link EdgeflipError} about the mesh.
 */
export async function measures(mesh: Mesh): Promise<Measures> {
  const { positions, indices, dimension } = moduleMesh(mesh, held);
  return call(() => wasm.measures(positions, indices, dimension));
}

/**
 * Compares a mesh with the result of a run.
 *
 * @param after - The indices of the result.
 * @throws {@link EdgeflipError} about the mesh; `triangle-count`.
 */
export async function change(mesh: Mesh, after: IndexArray): Promise<Change> {
  const { positions, indices, dimension } = inSpace(moduleMesh(mesh, held));
  const changed = held(wordsOf(after, 'indices'), 'indices');
  return call(() => wasm.change(positions, indices, dimension, changed));
}

/** `Array.isArray` does not narrow the type of a readonly array. */
function isList(attributes: readonly VertexArray[] | Required<Original>): attributes is readonly VertexArray[] {
  return Array.isArray(attributes);
}

/** Calls the module. If it is loaded, the call runs at once, before the caller can change the arrays. */
async function call<T>(work: () => T): Promise<T> {
  if (!areFilesLoaded()) await loadFiles();
  try {
    return work();
  } catch (thrown) {
    throw fromModule(thrown);
  }
}
