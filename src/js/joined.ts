/** The edges of a surface whose vertices at the same position are joined, as the option `weld` joins them. */

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

/** Sorts half-edges by a vertex of each. Those of one vertex keep their order. */
export function listsOf(halfEdges: Uint32Array, vertexOf: (h: number) => number, vertices: number): Lists {
  const starts = new Uint32Array(vertices + 1);
  for (const h of halfEdges) starts[vertexOf(h) + 1]! += 1;
  for (let v = 0; v < vertices; v++) starts[v + 1]! += starts[v]!;
  const [ends, sorted] = [starts.slice(), new Uint32Array(halfEdges.length)];
  for (const h of halfEdges) sorted[ends[vertexOf(h)]!++] = h;
  return { starts, halfEdges: sorted };
}

/** The edges of triangles. */
export class Edges {
  readonly #indices: Uint32Array;
  readonly #lists: Lists;
  /** For each half-edge, the other one of its edge; {@link NONE} if the edge does not have two triangles. */
  readonly twins: Uint32Array;

  constructor(indices: Uint32Array, vertices: number) {
    this.#indices = indices;
    const all = indices.map((_, h) => h);
    // Sorted by the smaller vertex, and then by the larger one.
    this.#lists = listsOf(listsOf(all, (h) => this.#larger(h), vertices).halfEdges, (h) => this.#smaller(h), vertices);
    this.twins = new Uint32Array(indices.length).fill(NONE);
    const { halfEdges } = this.#lists;
    const isSame = (i: number, j: number) => {
      const [g, h] = [halfEdges[i]!, halfEdges[j]!];
      return this.#smaller(g) === this.#smaller(h) && this.#larger(g) === this.#larger(h);
    };
    for (let first = 0, end = 0; first < halfEdges.length; first = end) {
      for (end = first + 1; end < halfEdges.length && isSame(first, end); ) end += 1;
      if (end - first !== 2) continue;
      const [g, h] = [halfEdges[first]!, halfEdges[first + 1]!];
      [this.twins[g], this.twins[h]] = [h, g];
    }
  }

  /** Takes the triangles of some edges apart. The edges stay. */
  cut(isCut: (h: number, twin: number) => boolean): void {
    this.twins.forEach((twin, h) => {
      if (twin === NONE || twin < h || !isCut(h, twin)) return;
      [this.twins[h], this.twins[twin]] = [NONE, NONE];
    });
  }

  /** Whether two vertices have an edge. */
  has(u: number, v: number): boolean {
    const { starts, halfEdges } = this.#lists;
    const [smaller, larger] = [Math.min(u, v), Math.max(u, v)];
    let [low, high] = [starts[smaller]!, starts[smaller + 1]!];
    while (low < high) {
      const middle = (low + high) >>> 1;
      const found = this.#larger(halfEdges[middle]!);
      if (found === larger) return true;
      if (found < larger) low = middle + 1;
      else high = middle;
    }
    return false;
  }

  #smaller(h: number): number {
    return Math.min(this.#indices[h]!, this.#indices[next(h)]!);
  }

  #larger(h: number): number {
    return Math.max(this.#indices[h]!, this.#indices[next(h)]!);
  }
}
