/** What the playground says: of its stops, and of an edge. */

import { counted } from '../shell/numbers.ts';
import { angle } from './angles.ts';
import type { Point } from './mesh.ts';
import { type Inner, relinked } from './phases.ts';
import type { Place } from './stops.ts';

type About = [name: string, words: string];

/** What each phase is about: its name, and how it works. */
export const ABOUT: Record<Exclude<Place['stop'], 'start'>, About> = {
  label: [
    'Label',
    'Each edge adds the two angles that face it. More than 180° means that it is not Delaunay and can flip.',
  ],
  select: [
    'Select',
    'A flip changes both triangles of its edge, so a triangle takes part in one flip only. The edges that can flip have numbers, shuffled in each round. Each triangle points to the one of its edges with the smallest number. If both triangles of an edge point to it, it flips. The others wait.',
  ],
  flip: [
    'Flip',
    'The edge lets go of its two ends and joins the two corners that faced it. No point moves, and the two new triangles take the places of the two old ones in memory.',
  ],
  update: [
    'Update',
    'A triangle knows which triangle lies behind each of its sides. Where that has changed, it is put right. Then the next round begins.',
  ],
};

const EMPTY: About = ['No triangle yet', 'Click to set points. Three that are not on one line make a triangle.'];

const BEGIN: About = [
  'Points, joined somehow',
  'Click to add a point, drag one to move it. Then run a round, which is one iteration, phase by phase. All triangles act at the same time.',
];

const BETWEEN: About = [
  'After a round',
  'The next round begins with these triangles. If you add or move a point, rounds are counted anew.',
];

const END: About = [
  'Delaunay',
  'No edge can flip: no two angles that face an edge add up to more than 180°. Move a point or add one, and edges can flip again.',
];

/** What the place is about: its name, and how it works. */
export function aboutOf({ stop, planar, tested, phase }: Place): About {
  if (stop !== 'start') return ABOUT[stop];
  if (planar.triangles.length === 0) return EMPTY;
  if (tested.flips.length === 0) return END;
  return phase === 0 ? BEGIN : BETWEEN;
}

const edges = (count: number, one: string, many: string) => `${counted(count, 'edge')} ${count === 1 ? one : many}`;

/** The caption of a stop. */
export function captionOf(place: Place): string {
  const { planar, phase, stop, round, rounds, tested } = place;
  const candidates = round.inner.filter(({ rank }) => rank > 0).length;
  const flips = round.flips.length;
  if (planar.triangles.length === 0) {
    return planar.points.length < 3 ? 'Set three points to make a triangle' : 'All points are on one line';
  }
  if (stop === 'label') {
    if (candidates === 0) return 'Delaunay: no edge can flip';
    return `${edges(candidates, 'is', 'are')} not Delaunay`;
  }
  if (stop === 'select') {
    const waits = candidates - flips;
    return `${edges(flips, 'flips', 'flip')}${waits > 0 ? `, ${waits} ${waits === 1 ? 'waits' : 'wait'}` : ''}`;
  }
  if (stop === 'flip') return edges(flips, 'has flipped', 'have flipped');
  if (stop === 'update') {
    const sides = relinked(round).length;
    return `${counted(sides, 'side')} of triangles ${sides === 1 ? 'has' : 'have'} a new neighbour`;
  }
  const end = tested.flips.length === 0 ? 'Delaunay: no edge can flip. ' : '';
  const done = rounds.slice(0, phase / 4);
  if (done.length === 0)
    return `${end}${counted(planar.points.length, 'point')}, ${counted(planar.triangles.length / 3, 'triangle')}`;
  const so = done.reduce((sum, { flips }) => sum + flips.length, 0);
  return `${end}After ${counted(done.length, 'round')}: ${counted(so, 'flip')}`;
}

const degrees = (number: number) => `${number.toFixed(1)}°`;

/** The two angles that face an edge, in degrees, to one decimal. */
export function anglesOf({ ends, facing }: Inner, points: readonly Point[]): [number, number] {
  const [from, to] = ends.map((v) => points[v]!) as [Point, Point];
  return facing.map((v) => Math.round(10 * angle(points[v]!, from, to)) / 10) as [number, number];
}

/** The sum of two angles. A sum that is rounded to 180° may still be more or less. */
export function sumOf({ excess }: Inner, [one, other]: [number, number]): string {
  const text = degrees(one + other);
  if (text !== degrees(180)) return text;
  return excess === 0 ? 'exactly 180°' : excess > 0 ? 'just over 180°' : 'just under 180°';
}

/** Why an edge flips, waits or stays; `inner` is nothing for an edge of the boundary. */
export function whyOf(place: Place, inner: Inner | undefined): string {
  if (!inner) return 'An edge of the boundary has a triangle on one side only. There is nothing to flip, so it stays.';
  const angles = anglesOf(inner, place.planar.points);
  const sum = `${angles.map(degrees).join(' + ')} is ${sumOf(inner, angles)}`;
  if (inner.excess === 0) return `${sum}. Both diagonals are equally good, so the edge stays.`;
  if (inner.excess < 0) return `${sum}, not more than 180°. The edge is Delaunay and stays.`;
  const when = place.stop === 'label' || place.stop === 'select' ? 'this round' : 'the next round';
  const { flips, choices } = place.tested;
  if (flips.includes(inner)) {
    return `${sum}, more than 180°. Its number, ${inner.rank}, is the smallest in both of its triangles, so it flips in ${when}.`;
  }
  const ranks = inner.halves.map((half) => choices[Math.floor(half / 3)]!.rank);
  const ahead = Math.min(...ranks.filter((rank) => rank < inner.rank));
  return `${sum}, more than 180°. But one of its triangles points to the edge with number ${ahead}, and this one has ${inner.rank}. So it waits in ${when} and is tested again after it.`;
}
