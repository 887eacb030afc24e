/** The edges that an iteration has flipped: each slides along the sides of its quad, and then cools. */

import { LineSegmentsGeometry } from 'three/addons/lines/LineSegmentsGeometry.js';
import { LineSegments2 } from 'three/addons/lines/webgpu/LineSegments2.js';
import type { InterleavedBufferAttribute, Line2NodeMaterial } from 'three/webgpu';
import { lineMaterial, MARKS } from './line-material.ts';

/** Milliseconds of the slide. */
const SLIDE = 260;
/** Milliseconds in which the heat falls to a third, and the heat below which an edge is cold. */
const [COOLING, COLD] = [380, 0.02];

/** Four vertices for each flip: the ends of the old edge, and those of the new one to which they slide. */
export function flipsBetween(before: Uint32Array, now: Uint32Array): Uint32Array {
  const flips: number[] = [];
  for (let h = 0; h < now.length; h++) {
    if (before[h] === now[h]) continue;
    // A flip gives each of its two triangles one new corner, at which the new edge begins.
    const first = h - (h % 3);
    const [next, last] = [first + ((h + 1) % 3), first + ((h + 2) % 3)];
    const [a, b, c, d] = [before[last]!, before[h]!, now[next]!, now[h]!];
    // The other triangle has the same flip the other way round.
    if (a < b) flips.push(a, b, c, d);
  }
  return Uint32Array.from(flips);
}

/** Which way edges slide: from the old edge to the new one, back, or not at all. */
export type SlideDirection = 'on' | 'back' | 'not';

export class FlipAnimation {
  readonly lines = new LineSegments2(new LineSegmentsGeometry(), lineMaterial({ linewidth: 2.4 }, MARKS.hot));
  #flips = new Uint32Array();
  #positions = new Float32Array();
  #start = 0;
  #isBack = false;

  constructor() {
    this.lines.visible = false;
    this.lines.frustumCulled = false;
    this.lines.renderOrder = 4;
  }

  /** Begins with flips, see {@link flipsBetween}. */
  show(positions: Float32Array, flips: Uint32Array, colour: string, way: SlideDirection): void {
    this.clear();
    if (flips.length === 0) return;
    [this.#positions, this.#flips] = [positions as Float32Array<ArrayBuffer>, flips as Uint32Array<ArrayBuffer>];
    this.#start = performance.now() - (way === 'not' ? SLIDE : 0);
    this.#isBack = way === 'back';
    this.lines.geometry = new LineSegmentsGeometry();
    this.lines.geometry.setPositions(new Float32Array(1.5 * flips.length));
    (this.lines.material as Line2NodeMaterial).color.set(colour);
    this.lines.visible = true;
    this.advance();
  }

  /** Moves on to the present moment. Returns whether the edges are still hot. */
  advance(): boolean {
    if (!this.lines.visible) return false;
    const past = performance.now() - this.#start;
    const heat = Math.exp(-Math.max(0, past - SLIDE) / COOLING);
    if (heat < COLD) {
      this.clear();
      return true;
    }
    (this.lines.material as Line2NodeMaterial).opacity = heat;
    const share = Math.min(1, past / SLIDE);
    const eased = share * share * (3 - 2 * share);
    this.#slide(this.#isBack ? 1 - eased : eased);
    return true;
  }

  clear(): void {
    if (!this.lines.visible) return;
    this.lines.visible = false;
    this.lines.geometry.dispose();
  }

  #slide(share: number): void {
    const { data } = this.lines.geometry.attributes['instanceStart'] as InterleavedBufferAttribute;
    const [flips, positions] = [this.#flips, this.#positions];
    for (let i = 0; i < flips.length; i += 4) {
      for (let end = 0; end < 2; end++) {
        const [from, to] = [3 * flips[i + end]!, 3 * flips[i + 2 + end]!];
        for (let k = 0; k < 3; k++) {
          const at = positions[from + k]!;
          data.array[(3 * i) / 2 + 3 * end + k] = at + share * (positions[to + k]! - at);
        }
      }
    }
    data.needsUpdate = true;
  }
}
