/** Measures how far flips shift the attributes of a surface, such as texture coordinates. */

import { inSpace, type ReadMesh } from './mesh.js';
import type { Floats } from './plane.js';
import { Edges, next, NONE, placesOf } from './joined.js';
import { sequence } from './surface.js';

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

/** Points in the plane as points of the height 0. */
function raised(plan: Floats): Float64Array {
  const points = new Float64Array((plan.length / 2) * 3);
  for (let i = 0; 2 * i < plan.length; i++) points.set([plan[2 * i]!, plan[2 * i + 1]!], 3 * i);
  return points;
}

/** The tangent of the angle from the normal to the camera: 27 degrees. */
const BESIDE = 1 / 2;

/**
 * The attributes of a surface before a run. An attribute is linear on each triangle. A flip changes it inside the two
 * triangles, most of all where the two diagonals cross. Where the triangles are bent, one diagonal is above the other
 * there. The shift is then that of the picture from a camera beside the normal: the difference of the attribute,
 * and the distance times {@link BESIDE} times the slope of the attribute. Not measured are more oblique cameras, and how
 * a flip changes the silhouette and the light.
 */
export class Attributes {
  /** The coordinates, as an attribute. */
  readonly #points: Values;
  readonly #indices: Uint32Array;
  readonly #limits: readonly Limit[];
  readonly #places: Uint32Array;
  /** The triangles with places instead of vertices. */
  readonly #corners: Uint32Array;
  readonly #edges: Edges;
  /** For each limited attribute, its slope on each triangle. */
  readonly #slopes: Float64Array[];
  /** The edges that stay: the smaller half-edge of each. */
  readonly #locked = new Set<number>();

  /** Locks the edges whose flip would shift an attribute too far. The arrays must not change afterwards. */
  constructor(mesh: ReadMesh, limits: readonly Limit[], joining: Joining) {
    const { positions, indices } = inSpace(mesh);
    const vertices = positions.length / 3;
    this.#points = { values: mesh.space ? raised(mesh.positions) : new Float64Array(positions), width: 3 };
    this.#indices = indices;
    this.#limits = limits;
    this.#places = joining === 'none' ? sequence(0, vertices) : placesOf(positions);
    this.#corners = this.#placed(indices);
    this.#edges = new Edges(this.#corners, vertices);
    this.#slopes = limits.map((limit) => this.#slopesOf(limit));
    const { twins } = this.#edges;
    for (let h = 0; h < twins.length; h++) {
      const twin = twins[h]!;
      if (twin === NONE || twin < h) continue;
      // Seams stay, and the attributes beyond them are others.
      if (joining === 'equal' && !this.#isJoined(h, twin)) this.#edges.cut(h);
      else if (this.#isBeyond(h, twin)) this.#locked.add(h);
    }
  }

  /** Two vertices for each edge that stays. */
  get lockedEdges(): Uint32Array {
    const edges = new Uint32Array(2 * this.#locked.size);
    let i = 0;
    for (const h of this.#locked) {
      edges[i++] = this.#indices[h]!;
      edges[i++] = this.#indices[next(h)]!;
    }
    return edges;
  }

  /** The places of vertices. */
  #placed(vertices: Uint32Array): Uint32Array {
    const places = new Uint32Array(vertices.length);
    for (let i = 0; i < vertices.length; i++) places[i] = this.#places[vertices[i]!]!;
    return places;
  }

  /** Whether the flip of an edge would shift an attribute too far. */
  #isBeyond(h: number, twin: number): boolean {
    const indices = this.#indices;
    const a = indices[h]!;
    const b = indices[next(h)]!;
    const c = indices[next(next(h))]!;
    const d = indices[next(next(twin))]!;
    const crossing = crossingOf(this.#points.values, a, b, c, d);
    for (let i = 0; i < this.#limits.length; i++) {
      const { most } = this.#limits[i]!;
      if (this.#jump(this.#limits[i]!, h, twin) > most) return true;
      if (crossing && this.#shift(i, a, b, crossing.s, c, d, crossing.t, h, twin) > most * crossing.scale) return true;
    }
    return false;
  }

  /** Whether no limited attribute jumps from one triangle of an edge to the other. */
  #isJoined(h: number, twin: number): boolean {
    for (const limit of this.#limits) {
      if (this.#jump(limit, h, twin) > 0) return false;
    }
    return true;
  }

  /** How far an attribute jumps from one triangle of an edge to the other. */
  #jump(limit: Limit, h: number, twin: number): number {
    const [indices, corners] = [this.#indices, this.#corners];
    // Most triangles share their vertices.
    if (indices[h] === indices[next(twin)] && indices[next(h)] === indices[twin]) return 0;
    const isAlong = corners[twin] === corners[h];
    const from = isAlong ? twin : next(twin);
    const to = isAlong ? next(twin) : twin;
    return Math.max(jumpOf(limit, indices[h]!, indices[from]!), jumpOf(limit, indices[next(h)]!, indices[to]!));
  }

  /** How steep an attribute is on each triangle at most: its change for each unit of length. */
  #slopesOf(limit: Limit): Float64Array {
    const [indices, points] = [this.#indices, this.#points];
    const slopes = new Float64Array(indices.length / 3);
    for (let t = 0; t < slopes.length; t++) {
      const a = indices[3 * t]!;
      const b = indices[3 * t + 1]!;
      const c = indices[3 * t + 2]!;
      const uu = productOf(points, a, b, a, b);
      const uv = productOf(points, a, b, a, c);
      const vv = productOf(points, a, c, a, c);
      const ff = productOf(limit, a, b, a, b);
      const fg = productOf(limit, a, b, a, c);
      const gg = productOf(limit, a, c, a, c);
      const area = uu * vv - uv * uv;
      const half = (ff * vv - 2 * fg * uv + gg * uu) / area / 2;
      const slope = Math.sqrt(half + Math.sqrt(Math.max(0, half * half - (ff * gg - fg * fg) / area)));
      slopes[t] = Number.isFinite(slope) ? slope : 0;
    }
    return slopes;
  }

  /**
   * How far a picture shifts attribute `i` where a point between `a` and `b`, at the share `s`, and one between `c` and
   * `d`, at `t`, are seen as one, with the slopes of two triangles, named by half-edges.
   */
  #shift(i: number, a: number, b: number, s: number, c: number, d: number, t: number, g: number, h: number): number {
    const slopes = this.#slopes[i]!;
    const slope = Math.max(slopes[Math.floor(g / 3)]!, slopes[Math.floor(h / 3)]!);
    const distance = differenceOf(this.#points, a, b, s, c, d, t);
    return differenceOf(this.#limits[i]!, a, b, s, c, d, t) + BESIDE * distance * slope;
  }

  /**
   * Compares the attributes at the crossings of each new edge with edges of the input. If the edge shifts an attribute
   * too far, the edge that it crosses there is locked.
   *
   * @returns The largest shift of each limited attribute.
   */
  compare(indices: Uint32Array): number[] {
    const largest = this.#limits.map(() => 0);
    const old = this.#indices;
    const corners = this.#placed(indices);
    const result = new Edges(corners, this.#places.length);
    const { twins } = result;
    for (let h = 0; h < twins.length; h++) {
      const twin = twins[h]!;
      const g = next(h);
      const f = next(g);
      if (indices[h] === old[h] && indices[g] === old[g] && indices[f] === old[f]) continue;
      // A new edge has two half-edges.
      if (twin < h || twin === NONE || this.#edges.has(corners[h]!, corners[g]!)) continue;
      const normal = sum(this.#normal(indices, h), this.#normal(indices, twin));
      this.#walk(new Line(this.#points.values, indices[h]!, indices[g]!, normal), result, largest);
    }
    return largest;
  }

  /** The normal of the triangle of a half-edge; its length is twice the area. */
  #normal(indices: Uint32Array, h: number): Vector {
    const i = h - (h % 3);
    const { values } = this.#points;
    const a = indices[i]!;
    return cross(between(values, a, indices[i + 1]!), between(values, a, indices[i + 2]!));
  }

  /** Goes along a new edge through the triangles of the input. */
  #walk(line: Line, result: Edges, largest: number[]): void {
    const [indices, { twins }] = [this.#indices, this.#edges];
    const { from, to } = line;
    let edge = this.#firstOf(line);
    let [worst, crossed] = [1, NONE];
    for (let steps = 0; edge !== NONE && steps < indices.length; steps++) {
      const x = indices[edge]!;
      const y = indices[next(edge)]!;
      const sx = line.side(x);
      const r = sx / (sx - line.side(y));
      const t = line.share(x) + r * (line.share(y) - line.share(x));
      const twin = twins[edge]!;
      if (twin === NONE || !(t >= 0 && t <= 1)) break;
      // Edges of the result cross only edges that have flipped. Where the surface is bent, it may look otherwise.
      if (result.has(this.#places[x]!, this.#places[y]!)) break;
      for (let i = 0; i < largest.length; i++) {
        const { most } = this.#limits[i]!;
        const shift = this.#shift(i, x, y, r, from, to, t, edge, twin);
        largest[i] = Math.max(largest[i]!, shift);
        if (shift > worst * most) [worst, crossed] = [shift / most, Math.min(edge, twin)];
      }
      const tip = next(next(twin));
      if (this.#corners[tip] === this.#places[to]) break;
      // The edge from the tip to the end on the other side of the line.
      const isTwins = line.side(indices[tip]!) < 0 === line.side(indices[twin]!) < 0;
      edge = isTwins ? next(twin) : tip;
    }
    if (crossed !== NONE) this.#locked.add(crossed);
  }

  /** The half-edge of the input that a line crosses first. */
  #firstOf(line: Line): number {
    const { starts, halfEdges } = this.#edges;
    const [indices, { values }, c] = [this.#indices, this.#points, line.from];
    const place = this.#places[c]!;
    let [edge, best] = [NONE, -1];
    for (let i = starts[place]!; i < starts[place + 1]!; i++) {
      const h = halfEdges[i]!;
      const x = indices[next(h)]!;
      const y = indices[next(next(h))]!;
      const sx = line.side(x);
      const sy = line.side(y);
      if (sx < 0 === sy < 0 || (line.share(x) * sy - line.share(y) * sx) / (sy - sx) < 0) continue;
      // A flat triangle faces nowhere.
      const facing = Math.abs(dot(line.normal, unit(cross(between(values, c, x), between(values, c, y))))) || 0;
      if (facing > best && this.#isAlike(indices[h]!, c)) [edge, best] = [next(h), facing];
    }
    return edge;
  }

  /** Whether two vertices have the same limited attributes. */
  #isAlike(u: number, v: number): boolean {
    return u === v || this.#limits.every((limit) => jumpOf(limit, u, v) === 0);
  }
}

type Vector = [number, number, number];

type Values = Pick<Limit, 'values' | 'width'>;

/** A line from one vertex to another, as seen along a normal. */
class Line {
  readonly #points: Float64Array;
  readonly #start: Vector;
  readonly #along: Vector;
  readonly #across: Vector;
  readonly #length: number;

  constructor(
    points: Float64Array,
    readonly from: number,
    readonly to: number,
    readonly normal: Vector,
  ) {
    this.#points = points;
    this.#start = [points[3 * from]!, points[3 * from + 1]!, points[3 * from + 2]!];
    this.#along = between(points, from, to);
    this.#across = cross(normal, this.#along);
    this.#length = dot(this.#along, this.#along);
  }

  /** The sign says on which side a vertex is. */
  side(vertex: number): number {
    return this.#towards(this.#across, vertex);
  }

  /** Where a vertex is beside the line: 0 at its start, 1 at its end. */
  share(vertex: number): number {
    return this.#towards(this.#along, vertex) / this.#length;
  }

  #towards(direction: Vector, vertex: number): number {
    const [points, start, i] = [this.#points, this.#start, 3 * vertex];
    return (
      direction[0] * (points[i]! - start[0]) +
      direction[1] * (points[i + 1]! - start[1]) +
      direction[2] * (points[i + 2]! - start[2])
    );
  }
}

/**
 * Where the lines `ab` and `cd` come closest: the shares of `ab` and `cd`; and the largest of the weights of the four
 * points, which exceeds 1 if the diagonals do not cross. `undefined` for parallel lines.
 */
function crossingOf(
  points: Float64Array,
  a: number,
  b: number,
  c: number,
  d: number,
): { s: number; t: number; scale: number } | undefined {
  const [i, j, k, l] = [3 * a, 3 * b, 3 * c, 3 * d];
  const ux = points[j]! - points[i]!;
  const uy = points[j + 1]! - points[i + 1]!;
  const uz = points[j + 2]! - points[i + 2]!;
  const vx = points[l]! - points[k]!;
  const vy = points[l + 1]! - points[k + 1]!;
  const vz = points[l + 2]! - points[k + 2]!;
  const wx = points[i]! - points[k]!;
  const wy = points[i + 1]! - points[k + 1]!;
  const wz = points[i + 2]! - points[k + 2]!;
  const uu = ux * ux + uy * uy + uz * uz;
  const uv = ux * vx + uy * vy + uz * vz;
  const vv = vx * vx + vy * vy + vz * vz;
  const uw = ux * wx + uy * wy + uz * wz;
  const vw = vx * wx + vy * wy + vz * wz;
  const size = uu * vv - uv * uv;
  const s = (uv * vw - vv * uw) / size;
  const t = (uu * vw - uv * uw) / size;
  const scale = Math.max(1, Math.abs(s), Math.abs(1 - s), Math.abs(t), Math.abs(1 - t));
  return size > 0 && Number.isFinite(scale) ? { s, t, scale } : undefined;
}

/** The scalar product of the difference from `a` to `b` and that from `c` to `d`. */
function productOf({ values, width }: Values, a: number, b: number, c: number, d: number): number {
  let sum = 0;
  for (let k = 0; k < width; k++) {
    sum += (values[width * b + k]! - values[width * a + k]!) * (values[width * d + k]! - values[width * c + k]!);
  }
  return sum;
}

/** How far the values of two vertices are apart: those that are not numbers are equal, as `weld` compares them. */
function jumpOf({ values, width }: Values, u: number, v: number): number {
  if (u === v) return 0;
  let square = 0;
  for (let k = 0; k < width; k++) {
    const x = values[width * u + k]!;
    const y = values[width * v + k]!;
    if (!Object.is(x, y)) square += (x - y) ** 2;
  }
  return distanceOf(square);
}

/** The root; a value that is not finite shifts infinitely far. */
const distanceOf = (square: number): number => (Number.isNaN(square) ? Infinity : Math.sqrt(square));

/** How far a value between `a` and `b`, at the share `s`, is from one between `c` and `d`, at `t`. */
function differenceOf(
  { values, width }: Values,
  a: number,
  b: number,
  s: number,
  c: number,
  d: number,
  t: number,
): number {
  let square = 0;
  for (let k = 0; k < width; k++) {
    const first = (1 - s) * values[width * a + k]! + s * values[width * b + k]!;
    const difference = first - (1 - t) * values[width * c + k]! - t * values[width * d + k]!;
    square += difference * difference;
  }
  return distanceOf(square);
}

/** From one vertex to another. */
function between(points: Float64Array, from: number, to: number): Vector {
  const [i, j] = [3 * from, 3 * to];
  return [points[j]! - points[i]!, points[j + 1]! - points[i + 1]!, points[j + 2]! - points[i + 2]!];
}

const sum = (a: Vector, b: Vector): Vector => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];

const dot = (a: Vector, b: Vector): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

const cross = ([a, b, c]: Vector, [x, y, z]: Vector): Vector => [b * z - c * y, c * x - a * z, a * y - b * x];

const unit = (a: Vector): Vector => {
  const length = Math.sqrt(dot(a, a));
  return [a[0] / length, a[1] / length, a[2] / length];
};
