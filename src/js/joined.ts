/** The edges of a surface whose vertices at the same position are joined, as the option `weld` joins them. */

import { sequence } from './surface.js';

/** No half-edge. */
export const NONE = 0xffffffff;

/** The next half-edge of the triangle. */
export const next = (h: number): number => (h % 3 < 2 ? h + 1 : h - 2);

/**
 * For each vertex, the first vertex at its position. -0 equals 0.
 *
 * @param points - 3 numbers per vertex.
 */
export function placesOf(points: Float32Array | Float64Array): Uint32Array {
  const vertices = points.length / 3;
  const size = 2 ** Math.ceil(Math.log2(2 * vertices + 1));
  // A hash table. An entry is a vertex and 1; 0 is free.
  const [table, places] = [new Uint32Array(size), new Uint32Array(vertices)];
  const point = new Float64Array(3);
  const words = new Uint32Array(point.buffer);
  for (let v = 0; v < vertices; v++) {
    for (let axis = 0; axis < 3; axis++) point[axis] = points[3 * v + axis]! + 0;
    places[v] = v;
    // The run refuses these, and they equal nothing.
    if (Number.isNaN(point[0]! + point[1]! + point[2]!)) continue;
    let hash = 0;
    for (const word of words) hash = Math.imul(hash ^ (hash >>> 15) ^ word, 0x9e3779b1);
    let slot = (hash ^ (hash >>> 16)) & (size - 1);
    for (; table[slot]! > 0; slot = (slot + 1) & (size - 1)) {
      const other = 3 * (table[slot]! - 1);
      if (points[other] === point[0] && points[other + 1] === point[1] && points[other + 2] === point[2]) break;
    }
    if (table[slot] === 0) table[slot] = v + 1;
    places[v] = table[slot]! - 1;
  }
  return places;
}

/** Lists of half-edges, one for each vertex: those of vertex `v` are `starts[v]` to `starts[v + 1]` in `halfEdges`. */
export interface Lists {
  starts: Uint32Array;
  halfEdges: Uint32Array;
}

/** Sorts half-edges by the vertex of each. Those of one vertex keep their order. */
export function listsOf(halfEdges: Uint32Array, vertexOf: Uint32Array, vertices: number): Lists {
  const starts = new Uint32Array(vertices + 1);
  for (let h = 0; h < vertexOf.length; h++) starts[vertexOf[h]! + 1]! += 1;
  for (let v = 0; v < vertices; v++) starts[v + 1]! += starts[v]!;
  const [ends, sorted] = [starts.slice(), new Uint32Array(halfEdges.length)];
  for (let i = 0; i < halfEdges.length; i++) {
    const h = halfEdges[i]!;
    sorted[ends[vertexOf[h]!]!++] = h;
  }
  return { starts, halfEdges: sorted };
}

/** The edges of triangles. */
export class Edges {
  /** Where the edges of each vertex to vertices with larger numbers start. */
  readonly #starts: Uint32Array;
  /** These larger vertices, sorted for each vertex. */
  readonly #larger: Uint32Array;
  /** For each half-edge, the other one of its edge; {@link NONE} if the edge does not have two triangles. */
  readonly twins: Uint32Array;

  constructor(indices: Uint32Array, vertices: number) {
    const { length } = indices;
    const [smaller, larger] = [new Uint32Array(length), new Uint32Array(length)];
    for (let h = 0; h < length; h++) {
      const u = indices[h]!;
      const v = indices[next(h)]!;
      smaller[h] = Math.min(u, v);
      larger[h] = Math.max(u, v);
    }
    const byLarger = listsOf(sequence(0, length), larger, vertices).halfEdges;
    const { starts, halfEdges } = listsOf(byLarger, smaller, vertices);
    const [sorted, twins] = [new Uint32Array(length), new Uint32Array(length).fill(NONE)];
    for (let i = 0; i < length; i++) sorted[i] = larger[halfEdges[i]!]!;
    for (let v = 0; v < vertices; v++) {
      const last = starts[v + 1]!;
      for (let first = starts[v]!, end = first; first < last; first = end) {
        while (end < last && sorted[end] === sorted[first]) end += 1;
        if (end - first !== 2) continue;
        const g = halfEdges[first]!;
        const h = halfEdges[first + 1]!;
        twins[g] = h;
        twins[h] = g;
      }
    }
    this.#starts = starts;
    this.#larger = sorted;
    this.twins = twins;
  }

  /** Takes the two triangles of an edge apart. The edge stays. */
  cut(h: number): void {
    this.twins[this.twins[h]!] = NONE;
    this.twins[h] = NONE;
  }

  /** Whether two vertices have an edge. */
  has(u: number, v: number): boolean {
    const [smaller, larger] = [Math.min(u, v), Math.max(u, v)];
    let [low, high] = [this.#starts[smaller]!, this.#starts[smaller + 1]!];
    while (low < high) {
      const middle = (low + high) >>> 1;
      const found = this.#larger[middle]!;
      if (found === larger) return true;
      if (found < larger) low = middle + 1;
      else high = middle;
    }
    return false;
  }
}
