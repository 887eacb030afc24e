/** Figure 3: which edges flip in a round, and which wait. */

import { arrow, drawDots, drawShapes, layer, middle, polygon, polyline, type Shape, towards, turned } from './draw.ts';
import type { Figure, Stage } from './figure.ts';
import { loop } from './loop.ts';
import { corners, type Edge, edgesOf, type Frame, flipping, type Point, record } from './mesh.ts';

// biome-ignore format: the points on the outline, and those inside
const POINTS: Point[] = [
  [316, 187], [220, 221], [75, 192], [28, 118], [122, 31], [270, 34], [341, 80],
  [189, 78], [162, 177], [287, 115],
];
// biome-ignore format: three corners each
const TRIANGLES = [
  4, 2, 7, 3, 2, 4, 2, 8, 7, 2, 1, 8, 8, 0, 7, 1, 0, 8, 7, 5, 4, 9, 5, 7, 0, 9, 7, 9, 6, 5, 0, 6, 9,
];

const across = ({ ends }: Edge, points: readonly Point[]) => ends.map((end) => points[end]!) as [Point, Point];

/** Where triangles point: to their edge that flips, else to the only one that waits. The engine tells no more. */
function arrows(frame: Frame): string[] {
  const candidates = edgesOf(frame).filter(({ state }) => state === 'flips' || state === 'waits');
  return corners(frame).flatMap((triangle) => {
    const mine = candidates.filter(({ ends }) => ends.every((end) => triangle.includes(end)));
    const best = mine.find(({ state }) => state === 'flips') ?? (mine.length === 1 ? mine[0] : undefined);
    const centre = middle(...triangle.map((corner) => POINTS[corner]!));
    return best ? [arrow(centre, towards(middle(...across(best, POINTS)), centre, 6))] : [];
  });
}

const count = (number: number, what: string) => (number === 1 ? `1 edge ${what}s` : `${number} edges ${what}`);

/** The caption of a round. */
function said(frame: Frame, round: number): string {
  const flips = flipping(frame).length;
  const waits = edgesOf(frame).filter(({ state }) => state === 'waits').length;
  if (flips === 0) return `After ${round} rounds: every edge is Delaunay`;
  return `Round ${round + 1}: ${count(flips, 'flip')}${waits > 0 ? `, ${waits} wait` : ''}`;
}

async function start(stage: Stage): Promise<void> {
  const frames = await record(POINTS, TRIANGLES);
  const edges = layer(stage.svg, '');
  const choices = layer(stage.svg, 'explain-arrows');
  drawDots(layer(stage.svg, 'explain-dots'), POINTS);

  loop(stage, frames.length, [0, 0], (round, turn) => {
    const frame = frames[round]!;
    // Drawn last, on top: the edges that flip.
    const order = edgesOf(frame).sort((a, b) => Number(a.state === 'flips') - Number(b.state === 'flips'));
    drawShapes(edges, [
      ...flipping(frame).map(({ ends: [from, to], facing: [left, right] }) => ({
        d: polygon([from, right!, to, left!].map((corner) => POINTS[corner]!)),
        kind: 'explain-warm',
      })),
      ...order.map(
        (edge): Shape => ({
          d: polyline(edge.state === 'flips' ? turned(edge, POINTS, turn) : across(edge, POINTS)),
          kind: `explain-edge explain-bold explain-${edge.state}`,
        }),
      ),
    ]);
    drawShapes(choices, turn === 0 ? arrows(frame).map((d) => ({ d, kind: '' })) : []);
    stage.say(said(frame, round));
  });
}

export const select: Figure = {
  title: 'Select: one flip a triangle',
  words:
    'A flip redraws both triangles beside its edge, so two flips must not share a triangle. Each triangle points to one of its candidates: the one with the smallest number, and the numbers are shuffled anew in each round. Where both triangles point to the same edge, it flips now. The others, dashed, wait. All this is read from one still picture of the mesh, so nobody has to be first, and every engine picks the same edges.',
  label:
    'A mesh of eleven triangles. In each round some edges flip, and others, which share a triangle with them, wait.',
  start,
};
