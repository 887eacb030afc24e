/** The buffers of a session on a GPU. */

import type { GpuBuffer, GpuDevice } from './types.js';

/** The device of a session, and its buffers there. */
export interface SessionBuffers {
  device: GpuDevice;
  /** 2 or 3 f32 per vertex; 3 if the mesh has a plane. */
  positions: GpuBuffer;
  /** 3 u32 per triangle. */
  indices: GpuBuffer;
  /** A u32 per triangle from byte `offset` on, a multiple of 256. Absent without the option `trackChanges`. */
  changes?: { buffer: GpuBuffer; offset: number };
  /**
   * A u32 per half-edge: the half-edge on the other side of its edge, in the opposite direction. Half-edge 3t + k goes
   * from corner k of triangle t to the next corner. 0xffffffff on the boundary, at an edge of three or more triangles,
   * and between triangles of opposite orientations. Absent without the option `adjacency`.
   */
  twins?: GpuBuffer;
  /**
   * A u32 per vertex: a half-edge that starts at the vertex; the smallest without a twin, or else the smallest. From
   * there, `twins[prev(h)]`, with `prev(h)` the half-edge before h in its triangle, goes to the next triangle, and
   * reaches all triangles of the vertex before it is the first half-edge again, or 0xffffffff. Where the triangles of a
   * vertex are several fans, it reaches those of one fan. 0xffffffff for a vertex without triangles. Absent without the
   * option `adjacency`.
   */
  vertexHalfEdges?: GpuBuffer;
}
