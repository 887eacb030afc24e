/** The edges of a surface whose vertices at the same position are joined, as the option `weld` joins them. */

/** No half-edge. */
export const NONE = 0xffffffff;

/** The next half-edge of the triangle. `>>> 0` says that it is an integer: numbers of 32 bits divide slowly without. */
export const next = (h: number): number => ((h >>> 0) % 3 < 2 ? h + 1 : h - 2);

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

/** The edges of triangles. */
export class Edges {
  readonly #indices: Uint32Array;
  /** The half-edges that start at vertex `v` are `starts[v]` to `starts[v + 1]` in `halfEdges`. */
  readonly starts: Uint32Array;
  readonly halfEdges: Uint32Array;
  /** For each half-edge, the other one of its edge; {@link NONE} if the edge does not have two triangles. */
  readonly twins: Uint32Array;

  constructor(indices: Uint32Array, vertices: number) {
    const { length } = indices;
    const starts = new Uint32Array(vertices + 1);
    for (let h = 0; h < length; h++) starts[indices[h]! + 1]! += 1;
    for (let v = 0; v < vertices; v++) starts[v + 1]! += starts[v]!;
    const [ends, halfEdges] = [starts.slice(), new Uint32Array(length)];
    for (let h = 0; h < length; h++) halfEdges[ends[indices[h]!]!++] = h;
    this.#indices = indices;
    this.starts = starts;
    this.halfEdges = halfEdges;
    this.twins = this.#pairs(vertices);
  }

  /** The twins: the half-edges of each vertex to and from one with a larger number, if they are two. */
  #pairs(vertices: number): Uint32Array {
    const [indices, starts, halfEdges] = [this.#indices, this.starts, this.halfEdges];
    const twins = new Uint32Array(indices.length).fill(NONE);
    // For each other vertex, the last vertex that has an edge to it, and the first half-edge of that.
    const [lasts, firsts] = [new Uint32Array(vertices).fill(NONE), new Uint32Array(vertices)];
    for (let u = 0; u < vertices; u++) {
      // Each triangle of the vertex has a half-edge that starts there, and one that ends there.
      for (let i = 2 * starts[u]!; i < 2 * starts[u + 1]!; i++) {
        const out = halfEdges[i >>> 1]!;
        const end = next(out);
        const h = i % 2 === 0 ? out : next(end);
        const v = indices[i % 2 === 0 ? end : h]!;
        if (v <= u) continue;
        const first = firsts[v]!;
        if (lasts[v] !== u) {
          lasts[v] = u;
          firsts[v] = h;
        } else if (first !== NONE && twins[first] === NONE) {
          twins[first] = h;
          twins[h] = first;
        } else if (first !== NONE) {
          twins[twins[first]!] = NONE;
          twins[first] = NONE;
          firsts[v] = NONE;
        }
      }
    }
    return twins;
  }

  /** Takes the two triangles of an edge apart. The edge stays. */
  cut(h: number): void {
    this.twins[this.twins[h]!] = NONE;
    this.twins[h] = NONE;
  }

  /** Whether two vertices have an edge. */
  has(u: number, v: number): boolean {
    const [indices, starts] = [this.#indices, this.starts];
    // The vertex with fewer half-edges, and the other one.
    const isFirst = starts[u + 1]! - starts[u]! <= starts[v + 1]! - starts[v]!;
    const from = isFirst ? u : v;
    const to = isFirst ? v : u;
    for (let i = starts[from]!; i < starts[from + 1]!; i++) {
      const end = next(this.halfEdges[i]!);
      if (indices[end] === to || indices[next(end)] === to) return true;
    }
    return false;
  }
}
