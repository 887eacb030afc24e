/** What the playground draws at each stop. */

import { wedge } from './angles.ts';
import { arrow, between, type Label, middle, polygon, polyline, type Shape, towards, turned } from './draw.ts';
import type { Point } from './mesh.ts';
import { type Inner, relinked } from './phases.ts';
import { cornersOf, halvesOf, next, turn } from './planar.ts';
import { labelsOn } from './playground-labels.ts';
import { anglesOf, sumOf } from './playground-words.ts';
import type { Place } from './stops.ts';

export interface Marks {
  /** Warm triangles, and what lies under the edges. */
  under: Shape[];
  edges: Shape[];
  /** Arrows, and what lies on the edges. */
  over: Shape[];
  labels: Label[];
}

/** An edge now, with its ends in the order of a half-edge. */
export interface Side {
  ends: [number, number];
  isOutline: boolean;
}

/** Each edge of these triangles once. */
export function sidesOf(triangles: readonly number[]): Side[] {
  const halves = halvesOf(triangles);
  return triangles.flatMap((from, half) => {
    const to = triangles[next(half)]!;
    const twin = halves.get(`${to} ${from}`);
    return twin !== undefined && twin < half
      ? []
      : [{ ends: [from, to] as [number, number], isOutline: twin === undefined }];
  });
}

/** The circle through three points, as a path. */
function circlePath([ax, ay]: Point, [bx, by]: Point, [cx, cy]: Point): string {
  const [ux, uy, vx, vy] = [bx - ax, by - ay, cx - ax, cy - ay];
  const [u, v, twice] = [ux * ux + uy * uy, vx * vx + vy * vy, 2 * (ux * vy - uy * vx)];
  const [x, y] = [(vy * u - uy * v) / twice, (ux * v - vx * u) / twice];
  const r = Math.hypot(x, y);
  return `M${ax + x - r} ${ay + y}a${r} ${r} 0 1 0 ${2 * r} 0a${r} ${r} 0 1 0 ${-2 * r} 0Z`;
}

/** The marks of a place. `unit` is a pixel of the screen; `flipped` is how far the edges have turned, up to 1. */
export function marksOf(place: Place, unit: number, flipped: number): Marks {
  const { planar, stop, round, triangles } = place;
  const { points } = planar;
  const at = (...corners: number[]) => corners.map((v) => points[v]!);
  const centres = (corners: readonly number[]) => cornersOf(corners).map((triangle) => middle(...at(...triangle)));
  const candidates = round.inner.filter(({ rank }) => rank > 0);
  const quad = ({ ends, facing }: Inner) => polygon(at(ends[0], facing[1], ends[1], facing[0]));
  const middleOf = ({ ends }: Pick<Inner, 'ends'>) => middle(...at(...ends));
  const marks: Marks = { under: [], edges: [], over: [], labels: [] };

  const marked = new Map<string, string>();
  const mark = (ends: number[], kind: string) => marked.set(ends.toSorted((a, b) => a - b).join(), kind);
  if (stop === 'label') {
    for (const edge of candidates) mark(edge.ends, 'explain-bold explain-candidate');
    const texts = candidates.map((edge) => ({ text: sumOf(edge, anglesOf(edge, points)), ends: edge.ends }));
    marks.labels = labelsOn(texts, 0.5, points, unit);
  } else if (stop === 'select') {
    for (const edge of candidates) {
      mark(edge.ends, `explain-bold explain-${round.flips.includes(edge) ? 'flips' : 'waits'}`);
    }
    marks.under = round.flips.map((edge) => ({ d: quad(edge), kind: 'explain-warm' }));
    const from = centres(round.before);
    marks.over = round.choices.flatMap((choice, t) =>
      choice
        ? [{ d: arrow(from[t]!, towards(middleOf(choice), from[t]!, 5 * unit), 7 * unit), kind: 'explain-choice' }]
        : [],
    );
    // Beside the tips of the arrows.
    const texts = candidates.map(({ rank, ends }) => ({ text: `${rank}`, ends }));
    marks.labels = labelsOn(texts, 0.3, points, unit);
  } else if (stop === 'flip') {
    for (const { facing } of round.flips) mark(facing, 'explain-bold explain-fresh');
    marks.under = round.flips.flatMap((edge) => [
      { d: quad(edge), kind: 'explain-warm' },
      { d: polyline(at(...edge.ends)), kind: 'explain-other' },
    ]);
  } else if (stop === 'update') {
    const to = centres(round.after);
    const changed = relinked(round);
    for (const { ends } of changed) mark(ends, 'explain-bold explain-side');
    marks.over = changed.map(({ triangle, neighbour, ends }) => {
      const side = middle(...at(...ends));
      const tip = between(side, to[neighbour]!, 0.55);
      return { d: arrow(between(to[triangle]!, side, 0.45), tip, 7 * unit), kind: 'explain-link' };
    });
  }
  // Drawn last, on top: the edges with marks.
  const sides = sidesOf(triangles).map(({ ends, isOutline }): Shape => {
    const kind = marked.get(ends.toSorted((a, b) => a - b).join());
    const flip = kind?.endsWith('fresh') && flipped < 1 ? flipOf(round.flips, ends) : undefined;
    return {
      d: polyline(flip ? turned(flip, points, flipped) : at(...ends)),
      kind: `explain-edge ${flip ? 'explain-bold explain-flips' : (kind ?? (isOutline ? 'explain-bold explain-boundary' : 'explain-delaunay'))}`,
    };
  });
  marks.edges = sides.sort((a, b) => rankOf(a) - rankOf(b));
  explain(place, unit, marks);
  return marks;
}

const rankOf = ({ kind }: Shape) => (kind.includes('explain-bold') ? (kind.includes('boundary') ? 1 : 2) : 0);

/** The flip that makes this edge. */
const flipOf = (flips: readonly Inner[], ends: number[]) =>
  flips.find(({ facing }) => facing.every((v) => ends.includes(v)));

/** Adds the marks of the edge that is explained: its two angles, and the circle of one of its triangles. */
function explain({ planar: { points }, edge, tested }: Place, unit: number, marks: Marks): void {
  if (!edge) return;
  const [from, to] = edge.map((v) => points[v]!) as [Point, Point];
  marks.under.push({ d: polyline([from, to]), kind: 'explain-chosen' });
  const inner = tested.inner.find(({ ends }) => ends.every((v) => edge.includes(v)));
  if (!inner) return;
  const [c, d] = inner.facing.map((v) => points[v]!) as [Point, Point];
  marks.under.push({ d: circlePath(from, to, c), kind: 'explain-around' });
  const length = Math.hypot(to[0] - from[0], to[1] - from[1]);
  for (const [corner, kind] of [
    [c, 'one'],
    [d, 'two'],
  ] as const) {
    // In a flat triangle, a large sector would reach over the edge.
    const reach = (0.8 * Math.abs(turn(from, to, corner))) / length;
    const radius = Math.max(10 * unit, Math.min(26 * unit, reach));
    marks.under.push({ d: wedge(corner, from, to, radius), kind: `explain-angle-${kind}` });
  }
}
