/** The functions of the first figure. They are known exactly, so the error of a mesh is what differs from them. */

import type { Point } from './mesh.ts';

/** The rectangle of the points: whole numbers, the width first. */
export const SIZE: Point = [1000, 750];

/** A value with its slopes along x and y. */
export type Sample = [value: number, dx: number, dy: number];

/** Hills: where, how wide and how high, in the units of the points. */
const HILLS = [
  [260, 250, 190, 150],
  [720, 460, 170, 190],
  [640, 120, 120, 80],
  [200, 640, 150, 90],
  [470, 430, 130, -70],
] as const;

/** The height of the land. */
export function height([x, y]: Point): Sample {
  const sum: Sample = [0, 0, 0];
  for (const [hx, hy, width, high] of HILLS) {
    const [u, v] = [(x - hx) / width, (y - hy) / width];
    const value = high * Math.exp(-u * u - v * v);
    sum[0] += value;
    sum[1] -= (2 * u * value) / width;
    sum[2] -= (2 * v * value) / width;
  }
  return sum;
}

/** A hot spot: where it is, how wide it is at first and at the end, and the time between. */
const SPOT: Point = [460, 380];
const [NARROW, WIDE] = [110, 190];
export const TIME = (WIDE ** 2 - NARROW ** 2) / 2;

/** The temperature after a time. It solves the heat equation: a bell curve spreads as one. At first its top is 1. */
export function temperature([x, y]: Point, time: number): number {
  const width = NARROW ** 2 + 2 * time;
  return (NARROW ** 2 / width) * Math.exp(-((x - SPOT[0]) ** 2 + (y - SPOT[1]) ** 2) / (2 * width));
}
