/** Figure 1: a triangle and its circle. */

import { drawDots, drawShapes, layer, polygon, polyline, type Shape } from './draw.ts';
import type { Figure, Stage } from './figure.ts';
import { addHandles, type Handle } from './handles.ts';
import { corners, edgesOf, flat, open, type Point, statesOf } from './mesh.ts';

/** The triangle, the loose point, and the points around them. */
// biome-ignore format: one row for the inner points, two for the outer ones
const POINTS: Point[] = [
  [84, 128], [196, 44], [212, 204], [308, 118],
  [214, 14], [368, 26], [366, 222], [228, 232],
  [62, 222], [22, 132], [60, 24],
];
// biome-ignore format: the triangle, those of the loose point, and those on the left
const TRIANGLES = [
  0, 1, 2,
  3, 2, 1, 3, 1, 4, 3, 4, 5, 3, 5, 6, 3, 6, 7, 3, 7, 2,
  0, 10, 1, 10, 4, 1, 0, 9, 10, 0, 8, 9, 0, 2, 8, 2, 7, 8,
];
const LOOSE: Handle = { point: 3, name: 'Loose point', box: { x: [232, 346], y: [44, 206] } };

/** The circle through three points; only for the drawing. */
function circleThrough([ax, ay]: Point, [bx, by]: Point, [cx, cy]: Point) {
  const [ux, uy, vx, vy] = [bx - ax, by - ay, cx - ax, cy - ay];
  const [u, v, twice] = [ux * ux + uy * uy, vx * vx + vy * vy, 2 * (ux * vy - uy * vx)];
  const [x, y] = [(vy * u - uy * v) / twice, (ux * v - vx * u) / twice];
  return { x: ax + x, y: ay + y, r: Math.hypot(x, y) };
}

async function start({ svg, say }: Stage): Promise<void> {
  const points = [...POINTS];
  const session = await open(points, TRIANGLES);
  const frame = { triangles: Uint32Array.from(TRIANGLES), states: await statesOf(session) };
  const shapes = layer(svg, '');
  const dots = layer(svg, 'explain-dots');
  const { x, y, r } = circleThrough(points[0]!, points[1]!, points[2]!);
  const circle = svg.insert('circle', 'g').attr('cx', x).attr('cy', y).attr('r', r);

  const draw = () => {
    const isDelaunay = frame.states.slice(0, 3).every((state) => state === 'delaunay');
    const heat = isDelaunay ? 'calm' : 'hot';
    const edges = edgesOf(frame).map(
      ({ ends: [from, to], state }): Shape => ({
        d: polyline([points[from]!, points[to]!]),
        kind: `explain-quiet explain-${state}`,
      }),
    );
    drawShapes(shapes, [
      ...edges,
      { d: polygon(corners(frame)[0]!.map((corner) => points[corner]!)), kind: `explain-triangle explain-${heat}` },
    ]);
    circle.attr('class', `explain-circle explain-${heat}`);
    drawDots(
      dots,
      points.filter((_, point) => point !== LOOSE.point),
    );
    drawHandles();
    say(isDelaunay ? 'The circle is empty: Delaunay' : 'A point is inside: not Delaunay', !isDelaunay);
  };
  const moved = async () => {
    await session.setPositions(flat(points));
    frame.states = await statesOf(session);
    draw();
  };
  const drawHandles = addHandles(svg, points, [LOOSE], () => void moved());
  draw();
}

export const circle: Figure = {
  title: 'What Delaunay means',
  words:
    'Draw the circle through the three corners of a triangle. If no other point of the mesh lies inside, the triangle is Delaunay. If all triangles are, so is the mesh. In the plane, its smallest angle is then as large as these points allow. A surface in space bends, so no single plane holds its circles. There, each edge compares its own two triangles as if they were unfolded flat.',
  hint: 'Drag the loose point into the circle.',
  label: 'A triangle with the circle through its corners, and a loose point beside it',
  start,
};
