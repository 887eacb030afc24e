/** Figure 4: an edge becomes the other diagonal. */

import { type D3DragEvent, drag } from 'd3-drag';
import { drawDots, drawLabels, drawShapes, layer, polygon, polyline, turned } from './draw.ts';
import type { Figure, Stage } from './figure.ts';
import { addKnob } from './handles.ts';
import { glide } from './loop.ts';
import { corners, type Frame, flipping, type Point, record } from './mesh.ts';

// biome-ignore format: left, right, top, bottom
const POINTS: Point[] = [[58, 132], [326, 110], [176, 38], [214, 206]];
const TRIANGLES = [0, 1, 2, 1, 0, 3];
const NAMES = ['p', 'q', 'r', 's'];
// biome-ignore format: beside the points
const NAMES_AT: Point[] = [[36, 137], [348, 115], [176, 24], [214, 230]];
const KEYS: Record<string, number> = { ArrowLeft: 0, ArrowDown: 0, Home: 0, ArrowRight: 1, ArrowUp: 1, End: 1 };

/** The triangles as the engine holds them. */
const named = (frame: Frame) =>
  corners(frame)
    .map((triangle) => triangle.map((corner) => NAMES[corner]).join(''))
    .join(' and ');

/** How far along the way from `from` to `to` the point is. */
function share([x, y]: Point, from: Point, to: Point): number {
  const [ux, uy] = [to[0] - from[0], to[1] - from[1]];
  return Math.min(1, Math.max(0, ((x - from[0]) * ux + (y - from[1]) * uy) / (ux * ux + uy * uy)));
}

async function start({ svg, say }: Stage): Promise<void> {
  const [before, after] = (await record(POINTS, TRIANGLES)) as [Frame, Frame];
  const edge = flipping(before)[0]!;
  const starts = turned(edge, POINTS, 0);
  const goals = turned(edge, POINTS, 1);
  const shapes = layer(svg, '');
  drawDots(layer(svg, 'explain-dots'), POINTS);
  drawLabels(
    layer(svg, 'explain-labels explain-centred'),
    NAMES.map((text, point) => ({ text, at: NAMES_AT[point]! })),
  );
  const handle = svg
    .append('g')
    .attr('class', 'explain-handle')
    .attr('tabindex', 0)
    .attr('role', 'slider')
    .attr('aria-label', 'The edge')
    .attr('aria-valuemin', 0)
    .attr('aria-valuemax', 100);
  const line = handle.append('path').attr('class', 'explain-turning');
  const reach = handle.append('path').attr('class', 'explain-reach');
  const knobs = [0, 1].map(() => handle.append('g'));
  for (const knob of knobs) addKnob(knob);

  let at = 0;
  let stop = () => {};
  const draw = (now: number) => {
    at = now;
    const ends = turned(edge, POINTS, at);
    const frame = at === 0 ? before : after;
    const swept = Array.from({ length: 10 }, (_, i) => i / 10).filter((t) => t < at && at < 1);
    drawShapes(shapes, [
      { d: polygon([starts[0], goals[0], starts[1], goals[1]]), kind: 'explain-outline' },
      ...corners(frame).map((triangle, slot) => ({
        d: at > 0 && at < 1 ? '' : polygon(triangle.map((corner) => POINTS[corner]!)),
        kind: `explain-slot-${slot}`,
      })),
      { d: polyline(starts), kind: 'explain-other' },
      { d: polyline(goals), kind: 'explain-other' },
      ...swept.map((t) => ({ d: polyline(turned(edge, POINTS, t)), kind: 'explain-trail' })),
    ]);
    for (const part of [line, reach]) part.attr('d', polyline(ends));
    line.classed('explain-done', at === 1);
    knobs.forEach((knob, end) => void knob.attr('transform', `translate(${ends[end]})`));
    const words =
      at > 0 && at < 1
        ? 'The edge turns; no point moves'
        : `${at === 0 ? 'Before' : 'After'}: triangles ${named(frame)}`;
    handle.attr('aria-valuenow', Math.round(100 * at)).attr('aria-valuetext', words);
    say(words, at === 0);
  };
  const goTo = (goal: number) => {
    stop();
    stop = glide(at, goal, draw);
  };
  handle.call(
    drag<SVGGElement, undefined>()
      .container(() => svg.node()!)
      // The end that is nearer to the pointer is the one that is held.
      .subject(({ x, y }: { x: number; y: number }) => {
        const [near, far] = turned(edge, POINTS, at);
        const held = Math.hypot(x - near[0], y - near[1]) < Math.hypot(x - far[0], y - far[1]) ? 0 : 1;
        return { x, y, held };
      })
      .on('start', () => stop())
      .on('drag', ({ x, y, subject }: D3DragEvent<SVGGElement, undefined, { held: 0 | 1 }>) =>
        draw(share([x, y], starts[subject.held], goals[subject.held])),
      )
      .on('end', () => goTo(Math.round(at))),
  );
  handle.on('keydown', (event: KeyboardEvent) => {
    const goal = KEYS[event.key];
    if (goal === undefined || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    event.stopPropagation();
    goTo(goal);
  });
  draw(0);
}

export const flip: Figure = {
  title: 'Flip: turn the diagonal',
  words:
    'The edge lets go of its two corners and takes the other two. No point moves and none is added, so colours, normals and everything else stored at the points stay right. The two new triangles take the place of the two old ones in memory, so the mesh neither grows nor shrinks. Thousands of edges turn in the same instant.',
  hint: 'Drag the edge round.',
  label: 'Four points, two triangles, and the edge between them, which turns',
  start,
};
