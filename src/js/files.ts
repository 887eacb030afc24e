/**
 * Mesh files, generated meshes and angles, in a WebAssembly module of their own that is loaded when one is used.
 *
 * ```ts
 * import { readMesh, writeMesh } from 'edgeflip/files';
 * const mesh = await readMesh(new Uint8Array(await file.arrayBuffer()), file.name);
 * const bytes = await writeMesh(mesh, 'copy.off');
 * ```
 *
 * All of it runs on the thread that calls: a file of many million triangles is for a worker.
 *
 * @packageDocumentation
 */

import * as wasm from './wasm/edgeflip_files.js';
import { EdgeflipError, fromModule } from './error.js';
import { copyOf, read, shown, viewOf } from './given.js';
import { areFilesLoaded, loadFiles } from './load-files.js';
import { checkDimension, indicesOf, type IndexedMesh, type Mesh32, moduleMesh } from './mesh.js';
import { initOf } from './module.js';
import { namesOf, optionsOf } from './names.js';
import { attributesOf, bytesOf, filesOf, maxBytesOf, originalOf, textOf } from './settings.js';
import type { Attributes, Files, Mesh, Original, VertexArray } from './types.js';

export { EdgeflipError, type ErrorCode } from './error.js';
export type { IndexedMesh, Mesh32 } from './mesh.js';
export type { ModuleSource, Sources } from './module.js';
export type { Attributes, Files, Mesh, Original, VertexArray } from './types.js';

/**
 * The extensions of the formats that are read and written, in either case. With `.gz` after it, as in `bunny.ply.gz`,
 * the file is gzip'd.
 */
export const FORMATS = ['.off', '.obj', '.ply', '.stl', '.gltf', '.glb'] as const;

/**
 * A mesh as it was read: the file's vertices, all of them, in its order, and its faces as triangles. Its positions are a
 * Float64Array where a PLY file has doubles that are no 32-bit floats. An STL file has no vertices, only corners of
 * triangles: those at the same position become one, in the order in which they appear. In a glTF file every primitive
 * has vertices of its own.
 */
export interface FileMesh extends IndexedMesh {
  /** Faces with more than three corners; each was cut into a fan of triangles around its first corner. */
  polygons: number;
  /** What the file holds that a mesh has no place for, such as `normals`. Normals of an STL file are its triangles'. */
  dropped: string[];
  /** Whether {@link writeMesh} keeps it, given the original, in a file of the same format: not of PLY with strips. */
  keeps: boolean;
  /** What else there is to say about the file, a sentence each. */
  notes: string[];
  /**
   * Positions to draw the mesh at, 3 numbers a vertex: a glTF file has each part with coordinates of its own, by which
   * it is decided what is Delaunay, and places it in a scene.
   */
  placed: Float32Array | undefined;
  /**
   * What a run has to be told, as its options of the same names, so that {@link writeMesh} can keep attributes of faces and
   * corners: a number for each triangle, such as that of its material or colour; the seams, where corners of a vertex
   * differ in their texture coordinates or normals; and triangles that nothing else would tell. `undefined` where there
   * are none. What glTF has is at vertices.
   */
  groups: Uint32Array | undefined;
  lockedEdges: Uint32Array | undefined;
  lockedTriangles: Uint32Array | undefined;
}

/** What can be chosen for {@link readMesh}. */
export interface ReadOptions {
  /** Default: 2 if the file has two coordinates a vertex or every z is 0, else 3. */
  dimension?: 2 | 3 | undefined;
  /** How many bytes the file may have, and a gzip'd one also once it is unpacked. Default: 2^30. */
  maxBytes?: number | undefined;
  /** The files that a `.gltf` file has its buffers in. Nothing is fetched. */
  files?: Files | undefined;
}

/** What can be chosen for {@link writeMesh}. */
export interface WriteOptions {
  /**
   * The file that the mesh was read from, and whose triangles have become others; its vertices are where they were. In the same format it is written again,
   * with all else as it was: glTF, in either form, with other indices; OFF, OBJ, PLY and binary STL with other faces. Those of
   * which no triangle is another stay, polygons too; the others give way to triangles with their attributes. It takes the
   * triangles of a run with {@link FileMesh.groups}, {@link FileMesh.lockedEdges} and {@link FileMesh.lockedTriangles}.
   */
  original?: Original | undefined;
}

/** What the angles of a mesh say about its triangles. A degenerate triangle counts as one with an angle of 0°. */
export interface Angles {
  /** The smallest angle of the mesh in degrees; 60 without triangles. */
  min: number;
  /** The mean over the triangles of their smallest angle, in degrees; 60 without triangles. */
  meanMin: number;
  /** How many angles, three a triangle, fall into each of equal bins over 0° to 180°; a bin has its lower end. */
  counts: Uint32Array;
}

/** What {@link reorient} gives. */
export interface Reoriented {
  /** Vertex indices, 3 a triangle. */
  indices: Uint32Array;
  /** How many triangles were turned. */
  turned: number;
}

/** What {@link weld} gives: a mesh whose vertices at one place are one. */
export interface Welded {
  /** Vertex indices, 3 a triangle: the first vertex of each place. */
  indices: Uint32Array;
  /** Two vertices an edge: seams, for the option `lockedEdges`. */
  lockedEdges: Uint32Array;
  /** Triangles that have to stay too, for the option `lockedTriangles`. */
  lockedTriangles: Uint32Array;
  /** For each vertex the first one at its place. */
  places: Uint32Array;
  /** How many vertices are joined to another one. */
  joined: number;
  /** How many triangles were turned. */
  turned: number;
  /**
   * The indices of a result, which a run makes of `indices` while those edges and triangles are locked: each corner with
   * a vertex of its place that has its attributes, the one that it had if its triangle has that still.
   *
   * @throws {@link EdgeflipError} `triangle-count`, `index-out-of-range`; `invalid-option` for what is no such result, as
   * far as that is noticed; `freed`.
   */
  split(indices: Uint32Array): Uint32Array;
  /** Gives memory back; the collection of garbage does so too, but later. */
  free(): void;
}

/** What can be measured on a mesh. */
export interface Measures {
  /** Smallest angle in degrees; 60 without triangles. */
  minAngle: number;
  /** Mean over the triangles of their smallest angle, in degrees; 60 without triangles. */
  meanMinAngle: number;
  /** Mean aspect ratio of the triangles that are not flat: longest edge by the diameter of the incircle, 1 for an equilateral triangle. */
  meanAspect: number;
  /** Triangles without area. */
  flat: number;
  /** Area, all triangles counted positive. */
  area: number;
  /** What a closed surface encloses, negative where triangles are clockwise from outside; 0 in the plane. */
  volume: number;
}

/** What a run has changed. */
export interface Change {
  /** The numbers of the triangles that are others now, in ascending order. */
  moved: Uint32Array;
  /** The largest distance between the surfaces before and after, at points of the edges that they do not share. */
  distance: number;
}

/**
 * Loads the WebAssembly module of this entry. Every other function loads it by itself. Call this to load early, or if the
 * module does not lie in `wasm/` beside this file. `init` of `edgeflip` does the same, and takes sources for all modules.
 *
 * A module is loaded once: later sources of it are ignored. After a failure the next call tries again.
 *
 * @throws {@link EdgeflipError} `load-failed`; `invalid-input` and `invalid-option` about `sources`.
 */
export const init = initOf('files', { files: loadFiles });

const READ_OPTIONS = namesOf<ReadOptions>({ dimension: true, maxBytes: true, files: true });
const WRITE_OPTIONS = namesOf<WriteOptions>({ original: true });

/** The array until the module has it: a copy where that waits for the module. */
function held<A extends VertexArray>(view: A, what: string): A {
  return areFilesLoaded() ? view : copyOf(view, what);
}

/**
 * Reads the bytes of a file, gzip'd or not.
 *
 * @param name - Its name, such as `bunny.obj`: the extension gives the format.
 * @throws {@link EdgeflipError} `parse`, which names the line or the byte, or the vertex that has a height where 2
 * dimensions were asked for; `unknown-format`, `file-too-large`, `too-large`, `invalid-input`, `invalid-option`.
 */
export async function readMesh(bytes: Uint8Array, name: string, options: ReadOptions = {}): Promise<FileMesh> {
  const [view, file] = [bytesOf(bytes, 'bytes'), textOf(name, 'name')];
  const { dimension, maxBytes, files } = read('the options', () => {
    const { dimension, maxBytes, files } = optionsOf(options, READ_OPTIONS) as ReadOptions;
    if (dimension !== undefined) checkDimension(dimension);
    return { dimension, maxBytes: maxBytesOf(maxBytes), files: filesOf(files, held) };
  });
  // The module counts bytes with 32 bits.
  if (view.length >= 2 ** 32) throw new EdgeflipError('file-too-large', 'the file has more than 4294967295 bytes');
  const content = held(view, 'bytes');
  return call(() => wasm.readMesh({ bytes: content, name: file, files, maxBytes }, dimension));
}

/**
 * The bytes of a file that holds the mesh; of one in the plane every z is 0. In OFF and OBJ each number has the fewest
 * digits that read back to the same 32 or 64 bits, of which {@link readMesh} reads 32. PLY is written in binary and
 * keeps all bits; STL in binary and glTF have positions rounded to 32-bit floats.
 *
 * @param name - Its name, such as `bunny.obj` or `bunny.ply.gz`: the extension gives the format.
 * @throws {@link EdgeflipError} about the mesh; `unknown-format`; `io` for coordinates that STL and glTF cannot hold; those of
 * {@link readMesh} about the original, `triangle-count` if it has another number of triangles, and `invalid-option` for
 * positions that are not those of the original, and for triangles that flips across its seams have made.
 */
export async function writeMesh(
  mesh: Mesh,
  name: string,
  options: WriteOptions = {},
): Promise<Uint8Array<ArrayBuffer>> {
  const { positions, indices, dimension } = moduleMesh(mesh, held);
  const file = textOf(name, 'name');
  const original = read('the options', () => {
    const { original } = optionsOf(options, WRITE_OPTIONS) as WriteOptions;
    return original === undefined ? undefined : originalOf(original, held);
  });
  if (original) return call(() => wasm.rewriteMesh(original, positions, indices, dimension, file));
  return call(() => wasm.writeMesh(positions, indices, dimension, file));
}

/**
 * A generated mesh, the same bits everywhere.
 *
 * @param spec - A family, its size, perhaps a parameter and a seed: `uvsphere 600`, `shear 300 30`,
 * `random 100 seed=7`. The message about a wrong one lists them all.
 * @throws {@link EdgeflipError} `invalid-option`, `too-large`.
 */
export async function generate(spec: string): Promise<Mesh32> {
  const family = textOf(spec, 'spec');
  return call(() => wasm.generate(family));
}

/**
 * The angles of a mesh, for statistics: in 64-bit floats, not exact.
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
 * The mesh with triangles turned so that neighbours agree about the side that is outside, in each component where that
 * is possible: the fewer are turned. The option `reorient` does it for a run.
 *
 * @throws {@link EdgeflipError} about the mesh.
 */
export async function reorient(mesh: Mesh): Promise<Reoriented> {
  const { positions, indices, dimension } = moduleMesh(mesh, held);
  return call(() => wasm.reorient(positions, indices, dimension));
}

/**
 * Joins the vertices at exactly the same position; -0 is 0. The option `weld` does it for a run.
 *
 * @param attributes - What vertices of one place have to have in common to be the same; nothing, if it is not given.
 * @param turns - Whether triangles are turned then, as by {@link reorient}.
 * @throws {@link EdgeflipError} about the mesh; `invalid-input`; those of {@link readMesh} about the original.
 */
export async function weld(mesh: Mesh, attributes: Attributes = [], turns = false): Promise<Welded> {
  const { positions, indices, dimension } = moduleMesh(mesh, held);
  const given = attributesOf(attributes, held);
  if (!isList(given)) return call(() => welded(wasm.Weld.ofFile(given, indices, dimension, Boolean(turns))));
  const vertices = positions.length / dimension;
  const arrays = given.map((array, i) => {
    if (array.length % vertices === 0 || array.length === vertices) {
      return new Uint8Array(array.buffer, array.byteOffset, array.byteLength);
    }
    throw new EdgeflipError(
      'invalid-input',
      `attribute ${i} has ${array.length} numbers, not a multiple of ${vertices}`,
    );
  });
  return call(() => welded(wasm.Weld.of(positions, indices, dimension, arrays, Boolean(turns))));
}

/**
 * Measures a mesh, for reports: in 64-bit floats, not exact.
 *
 * @throws {@link EdgeflipError} about the mesh.
 */
export async function measures(mesh: Mesh): Promise<Measures> {
  const { positions, indices, dimension } = moduleMesh(mesh, held);
  return call(() => wasm.measures(positions, indices, dimension));
}

/**
 * What a run has changed of a mesh.
 *
 * @param after - The indices of the result.
 * @throws {@link EdgeflipError} about the mesh; `triangle-count`.
 */
export async function change(mesh: Mesh, after: Uint32Array | Uint16Array): Promise<Change> {
  const { positions, indices, dimension } = moduleMesh(mesh, held);
  const view = indicesOf(after);
  const changed = view instanceof Uint32Array ? held(view, 'indices') : Uint32Array.from(view);
  return call(() => wasm.change(positions, indices, dimension, changed));
}

/** The compiler does not see it where a list is only read. */
function isList(attributes: readonly VertexArray[] | Required<Original>): attributes is readonly VertexArray[] {
  return Array.isArray(attributes);
}

function welded(made: wasm.Weld): Welded {
  const { indices, lockedEdges, lockedTriangles, places, joined, turned } = made;
  let isFreed = false;
  const split = (given: Uint32Array) => {
    if (isFreed) throw new EdgeflipError('freed', 'what was joined has been freed');
    const indices = viewOf(given, ['Uint32Array'], 'indices');
    if (!indices) throw new EdgeflipError('invalid-input', `indices: ${shown(given)} is not a Uint32Array`);
    try {
      return made.split(indices);
    } catch (thrown) {
      throw fromModule(thrown);
    }
  };
  const free = () => {
    if (isFreed) return;
    isFreed = true;
    try {
      made.free();
    } catch {
      // A call that has crashed has it still.
    }
  };
  return { indices, lockedEdges, lockedTriangles, places, joined, turned, split, free };
}

/** Runs at once where the module is loaded: nobody can change what was passed. */
async function call<T>(work: () => T): Promise<T> {
  if (!areFilesLoaded()) await loadFiles();
  try {
    return work();
  } catch (thrown) {
    throw fromModule(thrown);
  }
}
