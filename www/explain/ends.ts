/** Figure 6: on a bowl, a flip lets the surface sink. */

import { arrow, between, drawDots, drawLabels, drawShapes, layer, polygon, polyline } from './draw.ts';
import type { Figure, Stage } from './figure.ts';
import { loop } from './loop.ts';
import { type Frame, flipping, type Point, record } from './mesh.ts';

const POINTS: Point[] = [
  [-1, 0.02],
  [1, 0],
  [0.06, 0.52],
  [-0.04, -0.56],
];
const TRIANGLES = [0, 1, 2, 1, 0, 3];
const RIM = 1.12;

const height = ([x, y]: Point) => x * x + y * y;

/** Where a point is drawn that lies `lift` above the plane. */
const seen = ([x, y]: Point, lift: number): Point => [190 + 132 * x + 24 * y, 206 - 42 * y - 112 * lift];

const lifted = (point: Point) => seen(point, height(point));

const onCircle = (radius: number, turn: number): Point => [
  radius * Math.cos(2 * Math.PI * turn),
  radius * Math.sin(2 * Math.PI * turn),
];

/** The bowl: circles and lines down to its lowest point. */
function bowl(): { d: string; kind: string }[] {
  const steps = (count: number, at: (step: number) => Point) =>
    Array.from({ length: count + 1 }, (_, i) => at(i / count));
  const circles = [0.25, 0.5, 0.75, 1].map((share) => steps(72, (turn) => lifted(onCircle(share * RIM, turn))));
  const lines = steps(15, (turn) => [turn, 0]).map(([turn]) =>
    steps(12, (share) => lifted(onCircle(share * RIM, turn * (15 / 16)))),
  );
  return [...circles, ...lines].map((line) => ({ d: polyline(line), kind: 'explain-bowl' }));
}

/** Where the lines through two pairs of points cross in the plane: how far along the first. */
function crossing([a, b]: [Point, Point], [c, d]: [Point, Point]): number {
  const [ux, uy, vx, vy] = [b[0] - a[0], b[1] - a[1], d[0] - c[0], d[1] - c[1]];
  return ((c[0] - a[0]) * vy - (c[1] - a[1]) * vx) / (ux * vy - uy * vx);
}

async function start(stage: Stage): Promise<void> {
  const [before] = (await record(POINTS, TRIANGLES)) as [Frame, Frame];
  const { ends, facing } = flipping(before)[0]!;
  const ridge = ends.map((end) => POINTS[end]!) as [Point, Point];
  const valley = facing.map((end) => POINTS[end]!) as [Point, Point];
  const [along, across] = [crossing(ridge, valley), crossing(valley, ridge)];
  const middle = between(...ridge, along);
  const top = between([0, height(ridge[0])], [0, height(ridge[1])], along)[1];
  const bottom = between([0, height(valley[0])], [0, height(valley[1])], across)[1];

  const low = seen(middle, bottom);

  drawShapes(layer(stage.svg, ''), bowl());
  const shapes = layer(stage.svg, '');
  drawDots(layer(stage.svg, 'explain-dots'), POINTS.map(lifted), 4.5);
  const labels = layer(stage.svg, 'explain-labels explain-centred');
  const [a, b, c, d] = [...ridge, ...valley].map(lifted) as [Point, Point, Point, Point];

  loop(stage, 2, [0, 0], (beat, turn) => {
    const sunk = beat === 0 ? turn : 1;
    // The surface bends where the two diagonals cross: from the ridge down to the valley.
    const fold = seen(middle, top + sunk * (bottom - top));
    const heat = sunk < 1 ? 'hot' : 'calm';
    drawShapes(shapes, [
      ...[
        [a, d],
        [d, b],
        [b, c],
        [c, a],
      ].map(([from, to]) => ({
        d: polygon([from!, to!, fold]),
        kind: `explain-sheet explain-${heat}`,
      })),
      { d: polygon([a, d, b, c]), kind: 'explain-border' },
      { d: polyline([c, d]), kind: sunk < 1 ? 'explain-other' : 'explain-edge explain-bold explain-fresh' },
      { d: polyline([a, b]), kind: sunk > 0 ? 'explain-other' : 'explain-edge explain-bold explain-flips' },
      { d: sunk > 0 && sunk < 1 ? polyline([a, fold, b]) + polyline([c, fold, d]) : '', kind: 'explain-trail' },
      { d: sunk > 0 ? '' : arrow(between(fold, low, 0.2), between(fold, low, 0.85)), kind: 'explain-sinks' },
    ]);
    drawLabels(labels, [
      { text: 'ridge', at: [a[0] * 0.25 + b[0] * 0.75, a[1] - 10], kind: sunk < 1 ? 'explain-hot' : '' },
      { text: 'valley', at: [c[0] + 28, c[1] + 32] },
    ]);
    stage.say(sunk < 1 ? 'A ridge: this edge is not Delaunay' : 'A valley: the surface has sunk', sunk < 1);
  });
}

export const ends: Figure = {
  title: 'Why it ends',
  words:
    'Lift the points onto a bowl. An edge that is not Delaunay is then a ridge, and the other diagonal is a valley below it. Each flip takes out the wedge between the two, so the surface only sinks. There are only so many ways to join the points, and none comes back, so the iterations come to an end. On a surface in space, its area plays that part.',
  label: 'Four points on a bowl. Before the flip the edge is a ridge; after it, the other diagonal is a valley below.',
  start,
};
