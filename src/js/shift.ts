/** Measures how far flips shift the attributes of a surface, such as texture coordinates. */

import type { IndexedMesh } from './mesh.js';
import { Edges, type Lists, listsOf, next, NONE, placesOf } from './joined.js';

/** An attribute whose shift is limited. */
export interface Limit {
  name: string;
  /** `width` numbers per vertex. */
  values: Float64Array;
  width: number;
  /** The largest shift that is allowed. */
  most: number;
}

/** How vertices at the same position are joined: not at all, those with equal attributes, or all. */
export type Joining = 'none' | 'equal' | 'all';

/** The tangent of the angle from the normal to the camera: 27 degrees. */
const BESIDE = 1 / 2;

/** What flips have shifted. */
export interface Comparison {
  /** The largest shift of each limited attribute. */
  largest: number[];
  /** For each edge of the result that shifts an attribute too far, the edge of the input that it crosses there. */
  crossed: Edge[];
}

/**
 * The attributes of a surface before a run. An attribute is linear on each triangle. A flip changes it inside the two
 * triangles, most of all where the two diagonals cross. Where the triangles are bent, one diagonal is above the other
 * there. The shift is then that of the picture from a camera beside the normal: the difference of the attribute,
 * and the distance times {@link BESIDE} times the slope of the attribute. Not measured are more oblique cameras, and how
 * a flip changes the silhouette and the light.
 */
export class Attributes {
  readonly #points: IndexedMesh['positions'];
  readonly #indices: Uint32Array;
  readonly #limits: readonly Limit[];
  readonly #places: Uint32Array;
  /** The triangles with places instead of vertices. */
  readonly #corners: Uint32Array;
  readonly #edges: Edges;
  /** The half-edges that start at each place. */
  readonly #stars: Lists;
  /** For each limited attribute, its slope on each triangle. */
  readonly #slopes: Float64Array[];

  /** The arrays must not change afterwards. */
  constructor({ positions, indices }: IndexedMesh, limits: readonly Limit[], joining: Joining) {
    const vertices = positions.length / 3;
    const all = indices.map((_, h) => h);
    this.#points = positions;
    this.#indices = indices;
    this.#limits = limits;
    this.#places = joining === 'none' ? Uint32Array.from({ length: vertices }, (_, v) => v) : placesOf(positions);
    this.#corners = indices.map((v) => this.#places[v]!);
    this.#edges = new Edges(this.#corners, vertices);
    this.#stars = listsOf(all, (h) => this.#corners[h]!, vertices);
    this.#slopes = limits.map((limit) => new Float64Array(indices.length / 3).map((_, t) => this.#slope(limit, t)));
    // Seams stay, and the attributes beyond them are others.
    if (joining === 'equal') this.#edges.cut((h, twin) => limits.some((limit) => this.#jump(limit, h, twin) > 0));
  }

  /** The edges whose flip would shift an attribute too far, with vertices of one triangle. */
  edgesBeyond(): Edge[] {
    const indices = this.#indices;
    const found: Edge[] = [];
    this.#edges.twins.forEach((twin, h) => {
      if (twin === NONE || twin < h) return;
      const [a, b] = [indices[h]!, indices[next(h)]!];
      const [c, d] = [indices[next(next(h))]!, indices[next(next(twin))]!];
      const crossing = this.#crossingOf(a, b, c, d);
      const isBeyond = this.#limits.some((limit, i) => {
        if (this.#jump(limit, h, twin) > limit.most) return true;
        if (!crossing) return false;
        const { s, t, scale } = crossing;
        const shift = differenceOf(limit, [a, b, s], [c, d, t]);
        return shift + this.#parallax(i, [a, b, s], [c, d, t], [h, twin]) > limit.most * scale;
      });
      if (isBeyond) found.push(edgeOf(a, b));
    });
    return found;
  }

  /** How far an attribute jumps from one triangle of an edge to the other. */
  #jump(limit: Limit, h: number, twin: number): number {
    const [indices, corners] = [this.#indices, this.#corners];
    const [from, to] = corners[twin] === corners[h] ? [twin, next(twin)] : [next(twin), twin];
    return Math.max(jumpOf(limit, indices[h]!, indices[from]!), jumpOf(limit, indices[next(h)]!, indices[to]!));
  }

  /** How steep an attribute is on a triangle at most: its change for each unit of length. */
  #slope(limit: Limit, triangle: number): number {
    const [i, indices] = [3 * triangle, this.#indices];
    const [a, b, c] = [indices[i]!, indices[i + 1]!, indices[i + 2]!];
    const [u, v] = [this.#between(a, b), this.#between(a, c)];
    const [uu, uv, vv] = [dot(u, u), dot(u, v), dot(v, v)];
    const { values, width } = limit;
    let [ff, fg, gg] = [0, 0, 0];
    for (let k = 0; k < width; k++) {
      const [f, g] = [values[width * b + k]! - values[width * a + k]!, values[width * c + k]! - values[width * a + k]!];
      ff += f * f;
      fg += f * g;
      gg += g * g;
    }
    const area = uu * vv - uv * uv;
    const half = (ff * vv - 2 * fg * uv + gg * uu) / area / 2;
    const slope = Math.sqrt(half + Math.sqrt(Math.max(0, half * half - (ff * gg - fg * fg) / area)));
    return Number.isFinite(slope) ? slope : 0;
  }

  /**
   * How far a picture shifts attribute `i` because a point between two vertices is above one between two others, with
   * the slopes of two triangles, named by half-edges.
   */
  #parallax(i: number, [a, b, s]: Vector, [c, d, t]: Vector, [g, h]: Edge): number {
    const points = this.#points;
    let square = 0;
    for (let axis = 0; axis < 3; axis++) {
      const at = (vertex: number) => points[3 * vertex + axis]!;
      square += ((1 - s) * at(a) + s * at(b) - (1 - t) * at(c) - t * at(d)) ** 2;
    }
    const slopes = this.#slopes[i]!;
    return BESIDE * Math.sqrt(square) * Math.max(slopes[Math.floor(g / 3)]!, slopes[Math.floor(h / 3)]!);
  }

  /**
   * Where the lines `ab` and `cd` come closest: the shares of `ab` and `cd`; and the largest of the weights of the four
   * points, which exceeds 1 if the diagonals do not cross. `undefined` for parallel lines.
   */
  #crossingOf(a: number, b: number, c: number, d: number): { s: number; t: number; scale: number } | undefined {
    const [u, v, w] = [this.#between(a, b), this.#between(c, d), this.#between(c, a)];
    const [uu, uv, vv, uw, vw] = [dot(u, u), dot(u, v), dot(v, v), dot(u, w), dot(v, w)];
    const size = uu * vv - uv * uv;
    const [s, t] = [(uv * vw - vv * uw) / size, (uu * vw - uv * uw) / size];
    const scale = Math.max(1, Math.abs(s), Math.abs(1 - s), Math.abs(t), Math.abs(1 - t));
    return size > 0 && Number.isFinite(scale) ? { s, t, scale } : undefined;
  }

  /** Compares the attributes at the crossings of each new edge with edges of the input. */
  compare(indices: Uint32Array): Comparison {
    const comparison: Comparison = { largest: this.#limits.map(() => 0), crossed: [] };
    const old = this.#indices;
    const corners = indices.map((v) => this.#places[v]!);
    const result = new Edges(corners, this.#places.length);
    result.twins.forEach((twin, h) => {
      const [g, f] = [next(h), next(next(h))];
      if (indices[h] === old[h] && indices[g] === old[g] && indices[f] === old[f]) return;
      // A new edge has two half-edges.
      if (twin < h || twin === NONE || this.#edges.has(corners[h]!, corners[g]!)) return;
      const [normal, other] = [h, twin].map((half) => this.#normal(indices, half - (half % 3))) as [Vector, Vector];
      this.#walk(indices[h]!, indices[g]!, sum(normal, other), result, comparison);
    });
    return comparison;
  }

  /** The normal of the triangle whose first corner is `i`; its length is twice the area. */
  #normal(indices: Uint32Array, i: number): Vector {
    const a = indices[i]!;
    return cross(this.#between(a, indices[i + 1]!), this.#between(a, indices[i + 2]!));
  }

  /** Goes along the new edge `cd` through the triangles of the input, as seen along `normal`. */
  #walk(c: number, d: number, normal: Vector, result: Edges, comparison: Comparison): void {
    const along = this.#between(c, d);
    const across = cross(normal, along);
    const length = dot(along, along);
    const [points, i] = [this.#points, 3 * c];
    const towards = ([x, y, z]: Vector, j: number) =>
      x * (points[j]! - points[i]!) + y * (points[j + 1]! - points[i + 1]!) + z * (points[j + 2]! - points[i + 2]!);
    const sideOf = (vertex: number) => towards(across, 3 * vertex);
    const shareOf = (vertex: number) => towards(along, 3 * vertex) / length;
    let edge = this.#firstOf(c, normal, sideOf, shareOf);
    let [worst, crossed] = [1, NONE];
    for (let steps = 0; edge !== NONE && steps < this.#indices.length; steps++) {
      const [x, y] = [this.#indices[edge]!, this.#indices[next(edge)]!];
      const [sx, sy] = [sideOf(x), sideOf(y)];
      const r = sx / (sx - sy);
      const t = shareOf(x) + r * (shareOf(y) - shareOf(x));
      const twin = this.#edges.twins[edge]!;
      if (twin === NONE || !(t >= 0 && t <= 1)) break;
      // Edges of the result cross only edges that have flipped. Where the surface is bent, it may look otherwise.
      if (result.has(this.#places[x]!, this.#places[y]!)) break;
      this.#limits.forEach((limit, i) => {
        const shift = differenceOf(limit, [x, y, r], [c, d, t]) + this.#parallax(i, [x, y, r], [c, d, t], [edge, twin]);
        comparison.largest[i] = Math.max(comparison.largest[i]!, shift);
        if (shift > worst * limit.most) [worst, crossed] = [shift / limit.most, Math.min(edge, twin)];
      });
      const tip = next(next(twin));
      if (this.#corners[tip] === this.#places[d]) break;
      // The edge from the tip to the end on the other side of `cd`.
      const isTwins = sideOf(this.#indices[tip]!) < 0 === sideOf(this.#indices[twin]!) < 0;
      edge = isTwins ? next(twin) : tip;
    }
    if (crossed === NONE) return;
    comparison.crossed.push(edgeOf(this.#indices[crossed]!, this.#indices[next(crossed)]!));
  }

  /** The half-edge of the input that a line from a vertex crosses first, as seen along `normal`. */
  #firstOf(c: number, normal: Vector, sideOf: (v: number) => number, shareOf: (v: number) => number): number {
    const { starts, halfEdges } = this.#stars;
    const place = this.#places[c]!;
    let [edge, best] = [NONE, -1];
    for (let i = starts[place]!; i < starts[place + 1]!; i++) {
      const h = halfEdges[i]!;
      const [x, y] = [this.#indices[next(h)]!, this.#indices[next(next(h))]!];
      const [sx, sy] = [sideOf(x), sideOf(y)];
      if (sx < 0 === sy < 0 || (shareOf(x) * sy - shareOf(y) * sx) / (sy - sx) < 0) continue;
      // A flat triangle faces nowhere.
      const facing = Math.abs(dot(normal, unit(cross(this.#between(c, x), this.#between(c, y))))) || 0;
      if (facing > best && this.#isAlike(this.#indices[h]!, c)) [edge, best] = [next(h), facing];
    }
    return edge;
  }

  /** Whether two vertices have the same limited attributes. */
  #isAlike(u: number, v: number): boolean {
    return u === v || this.#limits.every((limit) => jumpOf(limit, u, v) === 0);
  }

  /** From one vertex to another. */
  #between(from: number, to: number): Vector {
    const [points, i, j] = [this.#points, 3 * from, 3 * to];
    return [points[j]! - points[i]!, points[j + 1]! - points[i + 1]!, points[j + 2]! - points[i + 2]!];
  }
}

/** Two vertices, the smaller one first. */
export type Edge = [number, number];

const edgeOf = (u: number, v: number): Edge => (u < v ? [u, v] : [v, u]);

type Vector = [number, number, number];
/** How far the values of two vertices are apart: those that are not numbers are equal, as `weld` compares them. */
function jumpOf({ values, width }: Limit, u: number, v: number): number {
  let square = 0;
  for (let k = 0; k < width; k++) {
    const [x, y] = [values[width * u + k]!, values[width * v + k]!];
    if (!Object.is(x, y)) square += (x - y) ** 2;
  }
  return distanceOf(square);
}

/** The root; a value that is not finite shifts infinitely far. */
const distanceOf = (square: number): number => (Number.isNaN(square) ? Infinity : Math.sqrt(square));

/** How far a value between two vertices is from one between two others; the third number is the share. */
function differenceOf({ values, width }: Limit, [a, b, s]: Vector, [c, d, t]: Vector): number {
  let square = 0;
  for (let k = 0; k < width; k++) {
    const at = (vertex: number) => values[width * vertex + k]!;
    square += ((1 - s) * at(a) + s * at(b) - (1 - t) * at(c) - t * at(d)) ** 2;
  }
  return distanceOf(square);
}

const sum = (a: Vector, b: Vector): Vector => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];

const dot = (a: Vector, b: Vector): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

const cross = ([a, b, c]: Vector, [x, y, z]: Vector): Vector => [b * z - c * y, c * x - a * z, a * y - b * x];

const unit = (a: Vector): Vector => {
  const length = Math.sqrt(dot(a, a));
  return [a[0] / length, a[1] / length, a[2] / length];
};
