/** Which edge is inspected: the one under the pointer, the one that was tapped, or the next one of a state. */

import type { EdgeState } from 'edgeflip';
import type { IndexedMesh } from 'edgeflip/files';
import { select } from 'd3-selection';
import { element } from './controls.ts';
import { drawThread, hideEdge, showEdge, type Limits } from './inspector.ts';
import { next, nextIn, quadAt, type Quad } from './quad.ts';
import { COLOURED } from './run.ts';
import type { Scene } from './scene.ts';

/** The triangles that are shown, once they are in main memory. */
export interface Triangles {
  mesh: IndexedMesh;
  indices: Uint32Array;
  states: Uint8Array | undefined;
  limits: Limits;
}

/** A pointer that moves further than this between press and release, in pixels, turns the mesh. */
const STILL = 6;

export class Looking {
  readonly #scene: () => Scene | undefined;
  #shown: Triangles | undefined;
  #quad: Quad | undefined;
  /** Whether the edge stays when the pointer leaves it. */
  #isHeld = false;

  constructor(scene: () => Scene | undefined) {
    this.#scene = scene;
    const view = element('view');
    let pressed: PointerEvent | undefined;
    view.addEventListener('pointerdown', (event) => (pressed = event));
    view.addEventListener('pointermove', (event) => {
      // Searching a large mesh at each move would be slow.
      if (event.buttons === 0 && !this.#isHeld && this.#shown && this.#shown.indices.length <= 3 * COLOURED) {
        this.#lookAt(event);
      }
    });
    view.addEventListener('pointerup', (event) => {
      if (!pressed || Math.hypot(event.clientX - pressed.clientX, event.clientY - pressed.clientY) > STILL) return;
      this.#isHeld = this.#lookAt(event);
    });
    view.addEventListener('pointerleave', () => this.#isHeld || this.close());
  }

  /** Takes the triangles of another state. An edge that is held stays, if the mesh still has it. */
  show(shown: Triangles): void {
    const held = this.#isHeld && this.#shown?.mesh === shown.mesh ? this.#quad : undefined;
    this.#shown = shown;
    if (!held) return this.close();
    const { indices } = shown;
    const half = indices.findIndex((from, h) => from === held.a && indices[next(h)] === held.b);
    if (half >= 0) this.#inspect(half);
    else this.close();
  }

  /** Forgets the triangles, which are about to change. */
  forget(): void {
    this.#shown = undefined;
  }

  close(): void {
    this.#isHeld = false;
    this.#quad = undefined;
    hideEdge();
    this.draw();
  }

  /** Inspects the next edge that is not Delaunay, or the previous one. */
  next(by: 1 | -1): void {
    const { states } = this.#shown ?? {};
    if (!states) return;
    const isWanted = (state: EdgeState) => state !== 'delaunay' && state !== 'boundary';
    const half = nextIn(states, isWanted, this.#quad?.half ?? 0, by);
    if (half < 0) return;
    this.#isHeld = true;
    this.#inspect(half);
  }

  /** Draws the quad of the edge over the picture, where the camera sees it now. */
  draw(): void {
    const [quad, shown, scene] = [this.#quad, this.#shown, this.#scene()];
    const marks = select(element('thread')).selectAll<SVGPathElement, [string, string]>('path.mark');
    if (!quad || !shown || !scene) {
      marks.remove();
      return drawThread(undefined);
    }
    const [a, b] = [scene.positionOf(quad.a), scene.positionOf(quad.b)];
    const middle: [x: number, y: number] = [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
    const around = quad.opposite.map((c) => `M${a}L${scene.positionOf(c)}L${b}`).join('');
    const [x, y] = middle;
    const ring = `M${x - 22} ${y}a22 22 0 1 0 44 0a22 22 0 1 0 -44 0`;
    marks
      .data<[string, string]>([
        ['around', around],
        ['edge', `M${a}L${b}`],
        ['ring', ring],
      ])
      .join('path')
      .attr('class', ([name]) => `mark ${name}`)
      .attr('d', ([, d]) => d);
    drawThread(middle);
  }

  /** Inspects the edge under the pointer. Returns whether there is one. */
  #lookAt({ offsetX, offsetY }: PointerEvent): boolean {
    const [shown, scene] = [this.#shown, this.#scene()];
    const half = shown && scene?.pick(offsetX, offsetY, shown.indices);
    if (half === undefined) {
      this.close();
      return false;
    }
    if (half !== this.#quad?.half) this.#inspect(half);
    return true;
  }

  #inspect(half: number): void {
    const [shown, scene] = [this.#shown, this.#scene()];
    if (!shown || !scene) return;
    const { mesh, indices, states, limits } = shown;
    const quad = quadAt(mesh, indices, states, half);
    this.#quad = quad;
    const [[ax, ay], [bx, by]] = [scene.positionOf(quad.a), scene.positionOf(quad.b)];
    showEdge(quad, mesh, limits, Math.atan2(ay - by, bx - ax));
    this.draw();
  }
}
