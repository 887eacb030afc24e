/** Figure 2: the two angles that face an edge. */

import { angle, dial, wedge } from './angles.ts';
import { drawLabels, drawShapes, layer, polygon, polyline } from './draw.ts';
import type { Figure, Stage } from './figure.ts';
import { addHandles, type Handle } from './handles.ts';
import { flat, open, type Point, statesOf } from './mesh.ts';

const POINTS: Point[] = [
  [52, 120],
  [324, 104],
  [176, 42],
  [206, 172],
];
/** The edge is the first side of the first triangle. */
const TRIANGLES = [0, 1, 2, 1, 0, 3];
const HANDLES: Handle[] = [
  { point: 0, name: 'Left end of the edge', box: { x: [24, 132], y: [92, 138] } },
  { point: 1, name: 'Right end of the edge', box: { x: [246, 356], y: [92, 138] } },
  { point: 2, name: 'Upper corner', box: { x: [140, 238], y: [30, 80] } },
  { point: 3, name: 'Lower corner', box: { x: [140, 238], y: [150, 198] } },
];
/** Where the two angles lie side by side. */
const DIAL: Point = [336, 206];
const DIAL_RADIUS = 30;

async function start({ svg, say }: Stage): Promise<void> {
  const points = [...POINTS];
  const session = await open(points, TRIANGLES);
  let states = await statesOf(session);
  const shapes = layer(svg, '');
  const labels = layer(svg, 'explain-labels');

  const draw = () => {
    const [a, b, c, d] = points as [Point, Point, Point, Point];
    const flips = states[0] === 'flips';
    const heat = flips ? 'hot' : 'calm';
    const [upper, lower] = [angle(c, a, b), angle(d, a, b)].map((degrees) => Math.round(10 * degrees) / 10);
    const sum = upper! + lower!;
    drawShapes(shapes, [
      { d: polygon([a, d, b, c]), kind: 'explain-outline' },
      { d: wedge(c, a, b, 30), kind: 'explain-angle-one' },
      { d: wedge(d, a, b, 30), kind: 'explain-angle-two' },
      { d: polyline([a, b]), kind: `explain-edge explain-bold explain-${flips ? 'flips' : 'fresh'}` },
      ...dial(DIAL, DIAL_RADIUS, [upper!, lower!], flips),
    ]);
    drawLabels(labels, [
      { text: `${upper!.toFixed(1)}°`, at: [c[0] + 15, c[1] - 6] },
      { text: `${lower!.toFixed(1)}°`, at: [d[0] + 15, d[1] + 17] },
      { text: `${sum.toFixed(1)}°`, at: [20, 226], kind: `explain-sum explain-${heat}` },
    ]);
    drawHandles();
    say(flips ? 'More than 180°: the edge flips' : 'Not more than 180°: the edge stays', flips);
  };
  const moved = async () => {
    await session.setPositions(flat(points));
    states = await statesOf(session);
    draw();
  };
  const drawHandles = addHandles(svg, points, HANDLES, () => void moved());
  draw();
}

export const label: Figure = {
  title: 'Label: add two angles',
  words:
    'An edge can tell without a circle. It looks at the two angles that face it, one on each side. Laid side by side, they must not go past a straight line, 180°. If they do, the edge can flip. Each iteration begins so: all triangles label their edges at the same time. The answer is exact, because rounding never decides it. A tie stays: both diagonals are equally good.',
  hint: 'Drag any corner.',
  label: 'An edge between two triangles, and the two angles that face it',
  start,
};
