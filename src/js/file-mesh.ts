/** A mesh from a file: what it holds, and the options to read and write it. */

import type { IndexedMesh } from './mesh.js';
import type { FindFile } from './settings.js';
import type { Files, Original, Plane } from './types.js';

/**
 * A mesh that was read: all vertices of the file, in its order, and its faces as triangles. The positions are a
 * Float64Array if the file has numbers that 32-bit floats do not show, see {@link ReadOptions.coordinates}. An STL file
 * has only corners of triangles: corners at the same position become one vertex, in the order of the file. In a glTF
 * file every primitive has its own vertices.
 */
export interface FileMesh extends IndexedMesh {
  /**
   * Faces with more than three corners. Each was cut into triangles: two less than it has corners, and the fan around
   * its first corner if that does not leave the polygon.
   */
  polygons: number;
  /**
   * Polygons whose outline crosses or touches itself, seen along their normal: their numbers among the faces of the
   * file, from 0. Each was cut into the fan around its first corner. `undefined` if there are none.
   */
  crossing: Uint32Array | undefined;
  /** The contents of the file that a mesh cannot hold, such as `normals`. */
  dropped: string[];
  /** Whether `writeMesh` with `original` keeps them in a file of the same format. Not for PLY with strips. */
  keeps: boolean;
  /** Other notes about the file, a sentence each. */
  notes: string[];
  /**
   * The positions in the scene of a glTF file, to draw the mesh: 3 numbers per vertex. `positions` has the coordinates
   * that the flips use: those of the file, each part in its own system, but scaled where a node scales it unevenly.
   * `undefined` for other formats.
   */
  placed: Float32Array | undefined;
  /**
   * The attributes of faces and corners that lock edges, and how many edges each locks: the largest number first.
   * Several attributes may lock the same edge. An edge may flip if {@link ReadOptions.ignoreAttributes} names all that
   * lock it.
   */
  attributeEdges: { name: string; edges: number }[];
  /**
   * Pass these three as options of the same names to a run, so that `writeMesh` can keep the attributes of faces
   * and corners. `groups` has a number for each triangle, such as the index of its material. `lockedEdges` has the
   * seams, where corners of a vertex differ in texture coordinates or normals. `lockedTriangles` has triangles whose
   * corners the seams do not protect. Each is `undefined` if it is empty, as for glTF, whose attributes belong to
   * vertices.
   */
  groups: Uint32Array | undefined;
  lockedEdges: Uint32Array | undefined;
  lockedTriangles: Uint32Array | undefined;
}

/** The options of `readMesh`. */
export interface ReadOptions {
  /** Default: 2 if the file has two coordinates per vertex or every z is 0, else 3. For glTF always 3. */
  dimension?: 2 | 3 | undefined;
  /**
   * The plane of a terrain. The mesh then has this plane, the dimension 2, and 3 numbers per vertex. Polygons are cut as
   * seen from above.
   */
  plane?: Plane | undefined;
  /**
   * The bits of the floats that coordinates are read as. Default: those of a binary file; in text 32, if each float,
   * rounded to as many digits as its number in the file has, is that number, else 64. Then the coordinates are those
   * that the file shows. The positions are a Float32Array wherever it holds them exactly.
   */
  coordinates?: 32 | 64 | undefined;
  /** The most bytes that the file may have, compressed and unpacked. Default: 2^30. */
  maxBytes?: number | undefined;
  /**
   * The other files that hold the buffers of a `.gltf` file, or a function that is called with the name of each
   * when the file is read. If the function throws, `readMesh` throws the same error. Nothing is fetched.
   */
  files?: Files | FindFile | undefined;
  /**
   * The names of attributes of faces and corners that lock no edges: in PLY the names of the properties of faces, in OBJ
   * the keywords `vt`, `vn`, `usemtl`, `g`, `o`, `s`, `mg` and `usemap`, in OFF `colour`, in binary STL `attribute`. A
   * name that the file does not have is an error. Give `original` the same names: then each new triangle keeps what the
   * triangle that it replaces has.
   */
  ignoreAttributes?: readonly string[] | undefined;
}

/** The options of `writeMesh`. */
export interface WriteOptions {
  /**
   * The file that the mesh was read from; the positions must be those of the file. In the same format, the result is
   * this file with other triangles. A glTF file gets other indices, as `.gltf` or `.glb`. In OFF, OBJ, PLY and binary
   * STL, only faces that contain a changed triangle are rewritten, as triangles with the attributes of their face. The
   * run needs {@link FileMesh.groups}, {@link FileMesh.lockedEdges} and {@link FileMesh.lockedTriangles} as options, and
   * `original` the `ignoreAttributes` and the `coordinates` that the file was read with: with other `coordinates`, the
   * positions differ from those of the mesh.
   */
  original?: Original | undefined;
}
