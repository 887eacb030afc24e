/** The four phases of an iteration, as the engine has them in `src/phases/`, for a few points in the plane. */

import { cornersOf, halvesOf, inCircle, next, type Planar } from './planar.ts';
import type { Point } from './mesh.ts';

/** An edge between two triangles. */
export interface Inner {
  /** Its half-edges, the lower one first. */
  halves: [number, number];
  ends: [number, number];
  /** The corners that face it, in the triangles of its half-edges: the ends of the other diagonal. */
  facing: [number, number];
  /** Positive if it is not Delaunay, 0 if both diagonals are equally good. */
  excess: number;
  /** Among the edges that are not Delaunay, its place in the order of this iteration, from 1; else 0. */
  rank: number;
}

/** An iteration from beginning to end. */
export interface Round {
  before: readonly number[];
  inner: Inner[];
  /** The edge that each triangle has chosen. */
  choices: (Inner | undefined)[];
  flips: Inner[];
  after: readonly number[];
}

/** A side whose triangle has another neighbour than before. */
interface Relinked {
  triangle: number;
  neighbour: number;
  ends: [number, number];
}

/** The number of an edge in an iteration, as in `src/phases/state.rs`. The smallest one wins. */
export function keyOf(half: number, iteration: number): number {
  let x = half ^ Math.imul(iteration, 0x9e3779b9);
  x = Math.imul(x ^ (x >>> 16), 0x7feb352d);
  x = Math.imul(x ^ (x >>> 15), 0x846ca68b);
  return (x ^ (x >>> 16)) >>> 0;
}

const prev = (h: number) => next(next(h));
const triangleOf = (h: number) => Math.floor(h / 3);

/** The edges between two triangles, tested, in the order of this iteration's numbers. */
function label({ points, triangles }: Planar, iteration: number): Inner[] {
  const halves = halvesOf(triangles);
  const inner: Inner[] = [];
  for (const [h, a] of triangles.entries()) {
    const b = triangles[next(h)]!;
    const g = halves.get(`${b} ${a}`);
    if (g === undefined || g < h) continue;
    const [c, d] = [triangles[prev(h)]!, triangles[prev(g)]!];
    const [p, q, r, s] = [a, b, c, d].map((v) => points[v]!) as [Point, Point, Point, Point];
    inner.push({ halves: [h, g], ends: [a, b], facing: [c, d], excess: inCircle(p, q, r, s), rank: 0 });
  }
  const key = ({ halves: [lower] }: Inner) => keyOf(lower, iteration);
  inner.sort((one, other) => key(one) - key(other));
  for (const [i, edge] of inner.filter(({ excess }) => excess > 0).entries()) edge.rank = i + 1;
  return inner;
}

/** Runs an iteration. */
function roundOf(planar: Planar, iteration: number): Round {
  const { triangles } = planar;
  const inner = label(planar, iteration);
  const candidates = inner.filter(({ rank }) => rank > 0);
  // Select. The candidates are in their order, so the first one of a triangle is its best.
  const choices = cornersOf(triangles).map((_, t) =>
    candidates.find(({ halves }) => halves.map(triangleOf).includes(t)),
  );
  const flips = candidates.filter((edge) => edge.halves.every((half) => choices[triangleOf(half)] === edge));
  // Flip. Each new triangle takes the place of an old one.
  const after = [...triangles];
  for (const { halves, facing } of flips) {
    after[next(halves[0])] = facing[1];
    after[next(halves[1])] = facing[0];
  }
  return { before: triangles, inner, choices, flips, after };
}

/** Update: the sides whose triangle has to learn of another neighbour. */
export function relinked({ before, after }: Pick<Round, 'before' | 'after'>): Relinked[] {
  const [old, now] = [halvesOf(before), halvesOf(after)];
  return after.flatMap((from, half) => {
    const to = after[next(half)]!;
    const [was, is] = [old.get(`${to} ${from}`), now.get(`${to} ${from}`)];
    if (was === undefined || is === undefined || triangleOf(was) === triangleOf(is)) return [];
    return [{ triangle: triangleOf(half), neighbour: triangleOf(is), ends: [from, to] as [number, number] }];
  });
}

/** All iterations, until one has nothing to flip. */
export function runOf({ points, triangles }: Planar): Round[] {
  const rounds: Round[] = [];
  let present = triangles;
  do {
    rounds.push(roundOf({ points, triangles: present }, rounds.length));
    present = rounds.at(-1)!.after;
  } while (rounds.at(-1)!.flips.length > 0);
  return rounds;
}
