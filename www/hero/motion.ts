/** Where the points of the first view are at a moment: rings run outwards, and the pointer pushes. */

import type { Scatter, Spacing } from './points.ts';

/** A ring that runs outwards from a place. */
interface Ring {
  x: number;
  y: number;
  /** Seconds at its start. */
  since: number;
}

/** Seconds from one ring to the next. */
const BEAT = 3.1;
/** Seconds that a ring lives. */
const LIFE = 9;
/** Rings start at these places, in turn: parts of the width and of the height. */
const PLACES = [
  [0.8, 0.4],
  [0.62, 0.74],
] as const;

export class Motion {
  /** Present positions, two numbers for each point. */
  readonly positions: Float32Array<ArrayBuffer>;
  /** The height of each point above the plane, for the light. */
  readonly heights: Float32Array;
  readonly #rest: Float32Array;
  readonly #fixed: number;
  readonly #spacings: Float32Array;
  readonly #size: readonly [number, number];
  readonly #finest: number;
  #rings: Ring[] = [];
  #beats = 0;
  /** The first ring is on its way already, so that edges flip in the first frame. */
  #time = 1.2;
  #pointer = { x: 0, y: 0, strength: 0 };

  constructor({ positions, fixed }: Scatter, size: readonly [number, number], spacing: Spacing) {
    this.#rest = positions;
    this.positions = positions.slice();
    this.heights = new Float32Array(positions.length / 2);
    this.#fixed = fixed;
    this.#size = size;
    this.#spacings = this.heights.map((_, i) => spacing(positions[2 * i]!, positions[2 * i + 1]!));
    this.#finest = this.#spacings.reduce((least, each) => Math.min(least, each), Infinity);
  }

  /** The pointer has moved to a place by so many pixels. */
  stir(x: number, y: number, distance: number): void {
    this.#pointer = { x, y, strength: Math.min(1, this.#pointer.strength + distance / 160) };
  }

  /** A ring starts here. */
  drop(x: number, y: number): void {
    this.#rings.push({ x, y, since: this.#time - 0.2 });
  }

  advance(seconds: number): void {
    this.#time += seconds;
    while (this.#beats * BEAT <= this.#time) {
      const [u, v] = PLACES[this.#beats % 2]!;
      this.#rings.push({ x: u * this.#size[0], y: v * this.#size[1], since: this.#beats * BEAT });
      this.#beats++;
    }
    this.#rings = this.#rings.filter(({ since }) => this.#time - since < LIFE);
    for (let i = this.#fixed; i < this.heights.length; i++) this.#move(i);
    this.#pointer.strength *= Math.exp(-1.6 * seconds);
  }

  #move(i: number): void {
    const [x, y, spacing] = [this.#rest[2 * i]!, this.#rest[2 * i + 1]!, this.#spacings[i]!];
    // Coarse triangles move less: there a flip is large and would distract from the words.
    const softness = Math.min(1, Math.max(0.1, 22 / spacing));
    let [dx, dy] = [0, 0];
    let height =
      20 * Math.sin(0.005 * x + 0.5 * this.#time) * Math.cos(0.006 * y - 0.4 * this.#time) +
      12 * Math.sin(0.009 * (x + y) - 0.6 * this.#time);
    for (const ring of this.#rings) {
      const [rx, ry, age] = [x - ring.x, y - ring.y, this.#time - ring.since];
      const distance = Math.hypot(rx, ry) + 1e-3;
      const breadth = 3 * this.#finest + 0.03 * distance;
      const across = (distance - 118 * age) / breadth;
      if (Math.abs(across) > 4) continue;
      const fading = Math.min(1, distance / 70, 1.6 * age) * Math.exp(-distance / Math.max(...this.#size));
      const bell = fading * Math.exp(-0.5 * across * across);
      const push = (0.8 * softness * breadth * across * bell) / distance;
      dx += push * rx;
      dy += push * ry;
      height += 19 * bell * (0.4 + 0.6 * softness);
    }
    const { strength } = this.#pointer;
    if (strength > 0.01) {
      const [px, py, reach] = [x - this.#pointer.x, y - this.#pointer.y, 9 * this.#finest];
      const near = strength * Math.exp(-(px * px + py * py) / (reach * reach));
      dx += 0.55 * softness * near * px;
      dy += 0.55 * softness * near * py;
      height += 20 * near;
    }
    this.positions[2 * i] = x + dx;
    this.positions[2 * i + 1] = y + dy;
    this.heights[i] = height;
  }
}
