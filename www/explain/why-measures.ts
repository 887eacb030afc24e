/** What a person does with a mesh, and how far the result is from the exact one. */

import type { Point } from './mesh.ts';
import { cornersOf, halvesOf, next, turn } from './planar.ts';
import { height, SIZE, temperature, TIME } from './why-fields.ts';

/** Points in the plane, joined. */
export interface Joined {
  points: readonly Point[];
  triangles: readonly number[];
}

/** A picture of the triangles: for each pixel, in rows, its triangle and how near it is to each corner. */
interface Raster {
  width: number;
  height: number;
  triangle: Int32Array;
  nearness: Float32Array;
}

const corner = ({ points }: Joined, corners: readonly number[]) =>
  corners.map((v) => points[v]!) as [Point, Point, Point];

/** The exact slopes of the land in a picture of this size: two numbers for each pixel. */
export function slopesOf(width: number, rows: number): Float32Array {
  const slopes = new Float32Array(2 * width * rows);
  for (let pixel = 0; pixel < width * rows; pixel++) {
    const [column, row] = [pixel % width, Math.floor(pixel / width)];
    const [, dx, dy] = height([((column + 0.5) * SIZE[0]) / width, ((row + 0.5) * SIZE[1]) / rows]);
    slopes.set([dx, dy], 2 * pixel);
  }
  return slopes;
}

/** Draws the triangles into a picture of this size, which they fill. */
export function rasterOf(mesh: Joined, width: number, height: number): Raster {
  const triangle = new Int32Array(width * height);
  const nearness = new Float32Array(3 * width * height);
  const [sx, sy] = [width / SIZE[0], height / SIZE[1]];
  for (const [t, corners] of cornersOf(mesh.triangles).entries()) {
    const [[ax, ay], [bx, by], [cx, cy]] = corner(mesh, corners);
    const area = turn([ax, ay], [bx, by], [cx, cy]);
    const [top, bottom] = [Math.floor(Math.min(ay, by, cy) * sy), Math.ceil(Math.max(ay, by, cy) * sy)];
    const [left, right] = [Math.floor(Math.min(ax, bx, cx) * sx), Math.ceil(Math.max(ax, bx, cx) * sx)];
    for (let row = top; row < bottom; row++) {
      const y = (row + 0.5) / sy;
      for (let column = left; column < right; column++) {
        const x = (column + 0.5) / sx;
        const u = ((cx - bx) * (y - by) - (cy - by) * (x - bx)) / area;
        const v = ((ax - cx) * (y - cy) - (ay - cy) * (x - cx)) / area;
        if (u < 0 || v < 0 || u + v > 1) continue;
        const pixel = row * width + column;
        triangle[pixel] = t;
        nearness[3 * pixel] = u;
        nearness[3 * pixel + 1] = v;
        nearness[3 * pixel + 2] = 1 - u - v;
      }
    }
  }
  return { width, height, triangle, nearness };
}

/** Interpolates a number of each point to all pixels. */
export function interpolated(mesh: Joined, { triangle, nearness }: Raster, numbers: ArrayLike<number>): Float32Array {
  return Float32Array.from(triangle, (t, pixel) => {
    let sum = 0;
    for (let k = 0; k < 3; k++) sum += nearness[3 * pixel + k]! * numbers[mesh.triangles[3 * t + k]!]!;
    return sum;
  });
}

/** From where the light comes: from the upper left. */
const LIGHT = [-0.62, -0.48, 0.62] as const;

/**
 * The light on the land by the normals of its points: for each pixel from 0 to 1; and how far the normals are off on
 * average, in degrees.
 */
export function shading(mesh: Joined, raster: Raster, slopes: Float32Array): { light: Float32Array; error: number } {
  const normals = [0, 1, 2].map(() => new Float64Array(mesh.points.length));
  const [xs, ys, zs] = normals as [Float64Array, Float64Array, Float64Array];
  const heights = mesh.points.map((point) => height(point)[0]);
  for (const corners of cornersOf(mesh.triangles)) {
    const [a, b, c] = corner(mesh, corners);
    const [za, zb, zc] = corners.map((v) => heights[v]!) as [number, number, number];
    for (const v of corners) {
      xs[v]! += (b[1] - a[1]) * (zc - za) - (zb - za) * (c[1] - a[1]);
      ys[v]! += (zb - za) * (c[0] - a[0]) - (b[0] - a[0]) * (zc - za);
      zs[v]! += turn(a, b, c);
    }
  }
  for (let v = 0; v < mesh.points.length; v++) {
    const length = Math.hypot(xs[v]!, ys[v]!, zs[v]!);
    for (const part of normals) part[v]! /= length;
  }
  const [nx, ny, nz] = normals.map((part) => interpolated(mesh, raster, part)) as [
    Float32Array,
    Float32Array,
    Float32Array,
  ];
  let sum = 0;
  const light = Float32Array.from(nx, (x, pixel) => {
    const [y, z] = [ny[pixel]!, nz[pixel]!];
    const length = Math.sqrt(x * x + y * y + z * z);
    const [dx, dy] = [slopes[2 * pixel]!, slopes[2 * pixel + 1]!];
    const cosine = (z - x * dx - y * dy) / (length * Math.sqrt(dx * dx + dy * dy + 1));
    sum += Math.acos(Math.min(1, cosine));
    return Math.max(0, (LIGHT[0] * x + LIGHT[1] * y + LIGHT[2] * z) / length);
  });
  return { light, error: ((180 / Math.PI) * sum) / light.length };
}

/** The weight of each inner edge for heat: half the sum of the cotangents of the two angles that face it. */
function weightsOf(mesh: Joined): { ends: [number, number]; weight: number }[] {
  const { points, triangles } = mesh;
  const halves = halvesOf(triangles);
  const cotangent = (h: number) => {
    const [a, b, c] = [h, next(h), next(next(h))].map((x) => points[triangles[x]!]!) as [Point, Point, Point];
    const [ux, uy, vx, vy] = [a[0] - c[0], a[1] - c[1], b[0] - c[0], b[1] - c[1]];
    return (ux * vx + uy * vy) / turn(a, b, c);
  };
  return triangles.flatMap((from, h) => {
    const to = triangles[next(h)]!;
    const twin = halves.get(`${to} ${from}`);
    if (twin === undefined || twin < h) return [];
    return [{ ends: [from, to] as [number, number], weight: (cotangent(h) + cotangent(twin)) / 2 }];
  });
}

const isOnBorder = ([x, y]: Point) => x === 0 || y === 0 || x === SIZE[0] || y === SIZE[1];

/** Eliminates a symmetric, positive definite matrix, whose rows it overwrites. Returns what solves it for a right side. */
function eliminated(rows: Float64Array[]): (right: Float64Array) => Float64Array {
  const n = rows.length;
  for (let i = 0; i < n; i++) {
    for (let j = i + 1; j < n; j++) {
      const factor = (rows[j]![i]! /= rows[i]![i]!);
      if (factor === 0) continue;
      for (let k = i + 1; k < n; k++) rows[j]![k]! -= factor * rows[i]![k]!;
    }
  }
  return (right) => {
    for (let i = 0; i < n; i++) for (let k = 0; k < i; k++) right[i]! -= rows[i]![k]! * right[k]!;
    for (let i = n - 1; i >= 0; i--) {
      for (let k = i + 1; k < n; k++) right[i]! -= rows[i]![k]! * right[k]!;
      right[i]! /= rows[i]![i]!;
    }
    return right;
  };
}

/** Steps of time. With four times as many, the errors change by a fiftieth at most. */
const STEPS = 16;

/**
 * The temperature of each point after heat has flowed for a time, with the exact one on the border; how far it is off on
 * average, in percent of its top; and on how many edges heat flows from cold to hot. By cotangent weights, a third of
 * the area of each triangle for its corners, and the rule of Crank and Nicolson.
 */
export function heat(mesh: Joined): { values: number[]; error: number; backwards: number } {
  const { points } = mesh;
  const areas = new Float64Array(points.length);
  for (const corners of cornersOf(mesh.triangles)) {
    for (const v of corners) areas[v]! += turn(...corner(mesh, corners)) / 6;
  }
  const weights = weightsOf(mesh);
  const inner = points.map((_, v) => v).filter((v) => !isOnBorder(points[v]!));
  const rowOf = new Map(inner.map((v, row) => [v, row]));
  const step = TIME / STEPS;
  const rows = inner.map((v, row) => {
    const numbers = new Float64Array(inner.length);
    numbers[row] = areas[v]! / step;
    return numbers;
  });
  for (const { ends, weight } of weights) {
    const [one, other] = ends.map((v) => rowOf.get(v));
    for (const row of [one, other]) if (row !== undefined) rows[row]![row]! += weight / 2;
    if (one === undefined || other === undefined) continue;
    rows[one]![other]! -= weight / 2;
    rows[other]![one]! -= weight / 2;
  }
  const solve = eliminated(rows);
  let values = points.map((point) => temperature(point, 0));
  for (let i = 1; i <= STEPS; i++) {
    const later = points.map((point) => temperature(point, i * step));
    const right = Float64Array.from(inner, (v) => (areas[v]! / step) * values[v]!);
    for (const { ends, weight } of weights) {
      for (const [v, other] of [ends, ends.toReversed()] as [number, number][]) {
        const row = rowOf.get(v);
        if (row === undefined) continue;
        const known = rowOf.has(other) ? 0 : later[other]!;
        right[row]! += (weight / 2) * (values[other]! - values[v]! + known);
      }
    }
    values = later;
    solve(right).forEach((value, row) => (values[inner[row]!] = value));
  }
  const off = inner.reduce((sum, v) => sum + Math.abs(values[v]! - temperature(points[v]!, TIME)), 0) / inner.length;
  const top = Math.max(...points.map((point) => temperature(point, TIME)));
  return { values, error: (100 * off) / top, backwards: weights.filter(({ weight }) => weight < 0).length };
}

/** A piece of a contour line in a triangle. */
type Piece = [Point, Point];

/** The contour lines of the land at these levels, and how far they are off on average, in percent of the width. */
export function contours(mesh: Joined, levels: readonly number[]): { pieces: Piece[]; error: number } {
  const pieces: Piece[] = [];
  let [sum, length] = [0, 0];
  for (const level of levels) {
    for (const piece of piecesOf(mesh, level)) {
      const [from, to] = piece;
      const long = Math.hypot(to[0] - from[0], to[1] - from[1]);
      for (const t of [1 / 6, 1 / 2, 5 / 6]) {
        const [value, dx, dy] = height([from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])]);
        // To first order, the distance to the exact line.
        sum += (Math.abs(value - level) / Math.hypot(dx, dy)) * (long / 3);
      }
      length += long;
      pieces.push(piece);
    }
  }
  return { pieces, error: (100 * sum) / length / SIZE[0] };
}

/** A contour line: a piece for each triangle that it crosses. */
function piecesOf(mesh: Joined, level: number): Piece[] {
  const values = mesh.points.map((point) => height(point)[0] - level);
  return cornersOf(mesh.triangles).flatMap((corners): Piece[] => {
    const crossed = corners.flatMap((from, k): Point[] => {
      const to = corners[(k + 1) % 3]!;
      const [u, v] = [values[from]!, values[to]!];
      if (u < 0 === v < 0) return [];
      const [p, q, t] = [mesh.points[from]!, mesh.points[to]!, u / (u - v)];
      return [[p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])]];
    });
    const [from, to] = crossed;
    return from && to ? [[from, to]] : [];
  });
}
