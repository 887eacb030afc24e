/** Figure 5: which neighbours learn of a flip. */

import {
  arrow,
  between,
  drawDots,
  drawLabels,
  drawShapes,
  layer,
  middle,
  polygon,
  polyline,
  towards,
  turned,
} from './draw.ts';
import type { Figure, Stage } from './figure.ts';
import { loop } from './loop.ts';
import { corners, type Frame, flipping, type Point, record } from './mesh.ts';

const POINTS: Point[] = [
  [108, 126],
  [276, 118],
  [180, 44],
  [208, 200],
  [40, 34],
  [334, 22],
  [350, 206],
  [48, 218],
];
/** The two triangles of the edge, then the neighbours 1 to 4 behind their sides. */
const TRIANGLES = [0, 1, 2, 1, 0, 3, 0, 2, 4, 2, 1, 5, 1, 3, 6, 3, 0, 7];
const NEIGHBOURS = [2, 3, 4, 5];

const centre = (frame: Frame, triangle: number) =>
  middle(...corners(frame)[triangle]!.map((corner) => POINTS[corner]!));

/** The triangle of the edge, 0 or 1, that a neighbour has behind one of its sides. */
const partner = (frame: Frame, neighbour: number) =>
  frame.behind.slice(3 * neighbour, 3 * neighbour + 3).find((triangle) => triangle === 0 || triangle === 1)!;

async function start(stage: Stage): Promise<void> {
  const [before, after] = (await record(POINTS, TRIANGLES)) as [Frame, Frame];
  const edge = flipping(before)[0]!;
  const changes = NEIGHBOURS.filter((neighbour) => partner(before, neighbour) !== partner(after, neighbour));
  const numbers = changes.map((neighbour) => neighbour - 1).join(' and ');
  const shapes = layer(stage.svg, '');
  const links = layer(stage.svg, 'explain-links');
  const labels = layer(stage.svg, 'explain-labels explain-centred');
  drawDots(layer(stage.svg, 'explain-dots'), POINTS);

  // First the edge turns; then the links of the neighbours that change follow.
  loop(stage, 3, [2, 0], (beat, turn) => {
    const turns = beat === 0 ? turn : 1;
    const follows = beat === 0 ? 0 : beat === 1 ? turn : 1;
    const frame = turns < 1 ? before : after;
    const home = [0, 1].map((triangle) => between(centre(before, triangle), centre(after, triangle), turns));
    drawShapes(shapes, [
      ...NEIGHBOURS.map((neighbour) => ({
        d: polygon(corners(frame)[neighbour]!.map((corner) => POINTS[corner]!)),
        kind: 'explain-outer',
      })),
      ...[0, 1].map((triangle) => ({
        d: turns > 0 && turns < 1 ? '' : polygon(corners(frame)[triangle]!.map((corner) => POINTS[corner]!)),
        kind: `explain-slot-${triangle}`,
      })),
      { d: polygon([0, 3, 1, 2].map((point) => POINTS[point]!)), kind: 'explain-rim' },
      {
        d: polyline(turned(edge, POINTS, turns)),
        kind: `explain-edge explain-bold explain-${turns < 1 ? 'flips' : 'fresh'}`,
      },
    ]);
    const from = (neighbour: number) => centre(before, neighbour);
    drawShapes(
      links,
      NEIGHBOURS.map((neighbour) => {
        const [old, now] = [home[partner(before, neighbour)]!, home[partner(after, neighbour)]!];
        const isHot = changes.includes(neighbour) && beat > 0;
        const to = towards(between(old, now, follows), from(neighbour), 18);
        return { d: arrow(from(neighbour), to), kind: isHot ? 'explain-hot' : '' };
      }),
    );
    drawLabels(labels, [
      ...home.map((at, slot) => ({ text: 'AB'[slot]!, at, kind: 'explain-slot' })),
      ...NEIGHBOURS.map((neighbour, i) => ({ text: `${i + 1}`, at: between(from(neighbour), [192, 116], -0.22) })),
    ]);
    const captions = [
      'Each neighbour knows A or B',
      `${numbers} still point to the old partner`,
      `${numbers} have changed partners`,
    ];
    stage.say(captions[beat]!, beat === 1);
  });
}

export const update: Figure = {
  title: 'Update: tell the neighbours',
  words:
    'Every triangle knows who lies behind each of its sides. In a flip, the two triangles swap a side each, so two of the four neighbours get a new partner and have to learn it. A neighbour may flip in the same instant. Even then nobody waits for an answer: where each side went follows from the old picture alone. Then the next round begins.',
  label: 'Two triangles A and B flip their edge. Of the four neighbours, two change their partner.',
  start,
};
