/** Where the labels of edges go in the playground: on their edge, beside points and other labels. */

import { between, type Label } from './draw.ts';
import type { Point } from './mesh.ts';

/** Half of a label's height, the most of half a character's width, and the radius of a point, in pixels. */
const [HALF, CHARACTER, RADIUS] = [8, 4, 8];
const STEPS = [0, 0.08, -0.08, 0.16, -0.16, 0.24, -0.24];

/**
 * The labels, each as near as it can be to `share` of the way along its edge. Where all places are taken, it goes where it
 * covers least. `unit` is a pixel of the screen.
 */
export function labelsOn(
  texts: readonly { text: string; ends: readonly [number, number] }[],
  share: number,
  points: readonly Point[],
  unit: number,
): Label[] {
  const placed: Label[] = [];
  for (const { text, ends } of texts) {
    const [from, to] = ends.map((v) => points[v]!) as [Point, Point];
    /** The pixels between the label there and what is nearest; negative where they overlap. */
    const room = ([x, y]: Point) => {
      const gap = ([u, v]: Point, wide: number, high: number) =>
        Math.max(Math.abs(x - u) / unit - wide, Math.abs(y - v) / unit - high);
      const half = CHARACTER * text.length;
      return Math.min(
        ...points.map((point) => gap(point, half + RADIUS, HALF + RADIUS)),
        ...placed.map((other) => gap(other.at, half + CHARACTER * other.text.length, 2 * HALF)),
      );
    };
    const places = STEPS.map((step) => between(from, to, share + step));
    const free = places.find((place) => room(place) >= 0);
    placed.push({ text, at: free ?? places.toSorted((one, other) => room(other) - room(one))[0]! });
  }
  return placed;
}
