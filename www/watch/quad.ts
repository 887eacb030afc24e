/** An edge of a mesh with its triangles, its angles and its state, for the inspector. */

import { EDGE_STATES, type EdgeState } from 'edgeflip';
import type { IndexedMesh } from 'edgeflip/files';

type Point = readonly [number, number, number];

export interface Quad {
  /** The half-edge that was chosen. */
  half: number;
  /** The ends of the edge. */
  a: number;
  b: number;
  /** The vertices opposite to the edge: one for each of its triangles. */
  opposite: readonly number[];
  /** The angle at each opposite vertex, in degrees. */
  angles: readonly number[];
  /** How far the normals of its two triangles differ, and of those after a flip, in degrees; 0 in the plane. */
  bend: number;
  bendAfter: number;
  /** `undefined` as long as it is not known. */
  state: EdgeState | undefined;
}

/** The next half-edge of the same triangle. */
export const next = (h: number) => (h % 3 === 2 ? h - 2 : h + 1);
const subtract = (u: Point, v: Point): Point => [u[0] - v[0], u[1] - v[1], u[2] - v[2]];
const dot = (u: Point, v: Point) => u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
const cross = ([a, b, c]: Point, [x, y, z]: Point): Point => [b * z - c * y, c * x - a * z, a * y - b * x];
const DEGREES = 180 / Math.PI;

/** The angle between two directions, in degrees. */
function between(u: Point, v: Point): number {
  return Math.atan2(Math.hypot(...cross(u, v)), dot(u, v)) * DEGREES;
}

/** A vertex of a mesh in the plane or in space. */
export function pointOf({ positions, dimension }: IndexedMesh, v: number): Point {
  const at = dimension * v;
  return [positions[at]!, positions[at + 1]!, dimension === 3 ? positions[at + 2]! : 0];
}

/** A normal of the triangle of a half-edge; its length is twice the area. */
export function normalOf(mesh: IndexedMesh, half: number): Point {
  const corners = [0, 1, 2].map((k) => pointOf(mesh, mesh.indices[half - (half % 3) + k]!)) as [Point, Point, Point];
  return cross(subtract(corners[1], corners[0]), subtract(corners[2], corners[0]));
}

/** The edge of a half-edge. */
export function quadAt(mesh: IndexedMesh, indices: Uint32Array, states: Uint8Array | undefined, half: number): Quad {
  const [a, b] = [indices[half]!, indices[next(half)]!];
  const opposite = [indices[next(next(half))]!];
  for (let h = 0; h < indices.length; h++) {
    const [from, to] = [indices[h]!, indices[next(h)]!];
    if (h !== half && ((from === a && to === b) || (from === b && to === a))) opposite.push(indices[next(next(h))]!);
  }
  const [p, q] = [pointOf(mesh, a), pointOf(mesh, b)];
  const others = opposite.map((v) => pointOf(mesh, v));
  const angles = others.map((r) => between(subtract(p, r), subtract(q, r)));
  const [c, d] = others;
  const normal = (x: Point, y: Point, z: Point) => cross(subtract(y, x), subtract(z, x));
  const state = states && EDGE_STATES[states[half]!];
  return {
    half,
    a,
    b,
    opposite,
    angles,
    state,
    bend: c && d ? between(normal(p, q, c), normal(q, p, d)) : 0,
    bendAfter: c && d ? between(normal(c, p, d), normal(d, q, c)) : 0,
  };
}

/** The half-edge of the next edge after `half` that is in one of these states, or of the previous one. */
export function nextIn(states: Uint8Array, wanted: (state: EdgeState) => boolean, half: number, by: 1 | -1): number {
  const count = states.length;
  for (let step = 1; step <= count; step++) {
    const h = (half + by * step + (step + 1) * count) % count;
    if (wanted(EDGE_STATES[states[h]!]!)) return h;
  }
  return -1;
}
