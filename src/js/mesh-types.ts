/** What a mesh is given as, and its parts. */

import type { Original } from './original.js';
import type { Plane } from './plane.js';

export type { Files, Original } from './original.js';
export type { Plane } from './plane.js';

/** A `GPUDevice`, where the types of WebGPU are known. */
export type GpuDevice = typeof globalThis extends { GPUDevice: { prototype: infer T } } ? T : unknown;

/** A `GPUBuffer`, where the types of WebGPU are known. */
export type GpuBuffer = typeof globalThis extends { GPUBuffer: { prototype: infer T } } ? T : unknown;

/** Bytes in a buffer of their own. */
export type Bytes = ReturnType<Uint8Array['slice']>;

/** Vertex indices, in an array of whole numbers. */
export type IndexArray =
  | Int8Array
  | Uint8Array
  | Uint8ClampedArray
  | Int16Array
  | Uint16Array
  | Int32Array
  | Uint32Array
  | readonly number[];

/** Indices of a result, in an array of the type of `I`. */
export type Indices<I extends IndexArray> = I extends Uint32Array
  ? Uint32Array
  : I extends Uint16Array
    ? Uint16Array
    : I extends Uint8Array
      ? Uint8Array
      : I extends Uint8ClampedArray
        ? Uint8ClampedArray
        : I extends Int32Array
          ? Int32Array
          : I extends Int16Array
            ? Int16Array
            : I extends Int8Array
              ? Int8Array
              : number[];

/** A triangle mesh. A call copies its arrays before it returns. */
export interface Mesh<I extends IndexArray = IndexArray> {
  /**
   * 2 or 3 coordinates per vertex, with a `plane` 3. Integers, as in quantized meshes, count as these numbers. Decisions
   * are exact for the numbers in the array. A plain array counts as 32-bit floats if all its numbers are such. The CPU
   * accepts all finite numbers, WebGPU and WebGL2 multiples of a power of two: 84 bits and a sign relative to the centre.
   */
  positions: VertexArray | readonly number[];
  /** Vertex indices, 3 per triangle. Results have indices of the same type. */
  indices: I;
  /** 2 for a mesh in the plane, 3 for a surface in space. */
  dimension: 2 | 3;
  /** For a terrain, which has the dimension 2 and 3 coordinates per vertex: those that decide. */
  plane?: Plane | undefined;
  /** The count of numbers in `positions` from a vertex to the next. Default: `dimension`, or 3 with a `plane`. */
  stride?: number | undefined;
  /** The count of numbers in `positions` before the first vertex. Default: 0. */
  offset?: number | undefined;
}

/** A triangle mesh in buffers of a device. Their usage includes COPY_SRC. */
export interface DeviceMesh {
  /** f32: 2 or 3 coordinates per vertex. */
  positions: GpuBuffer;
  /** u32: vertex indices, 3 per triangle. */
  indices: GpuBuffer;
  /** 2 for a mesh in the plane, 3 for a surface in space. */
  dimension: 2 | 3;
  /** As {@link Mesh.plane}. */
  plane?: Plane | undefined;
  /** As {@link Mesh.stride}. */
  stride?: number | undefined;
  /** As {@link Mesh.offset}. */
  offset?: number | undefined;
  /** The number of vertices, if `positions` has more. Default: all that it has. */
  vertices?: number | undefined;
  /** The number of triangles, if `indices` has more. Default: all that it has. */
  triangles?: number | undefined;
}

/** An attribute of the vertices: the same count of numbers for each vertex, such as 2 texture coordinates. */
export type VertexArray =
  | Int8Array
  | Uint8Array
  | Uint8ClampedArray
  | Int16Array
  | Uint16Array
  | Int32Array
  | Uint32Array
  | Float32Array
  | Float64Array;

/**
 * The attributes that vertices at the same position are compared by: two vertices are equal if all arrays have the same
 * bits for them. Instead of arrays, it can be the file that the mesh was read from. In glTF, the vertices of each
 * primitive are joined separately, and they are equal if all accessors have the same bytes for them. In other formats,
 * all vertices at the same position are equal; write the result without `original` then.
 */
export type Attributes = readonly VertexArray[] | Original;
