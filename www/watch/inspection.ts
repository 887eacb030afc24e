/** Which edge is inspected: the one under the pointer, the one that was tapped, or the next one of a state. */

import { EDGE_STATES, type EdgeState } from 'edgeflip';
import type { IndexedMesh } from 'edgeflip/files';
import { select } from 'd3-selection';
import { element, NARROW } from './controls.ts';
import type { FileExtras } from './file-extras.ts';
import { drawThread, hideEdge, showEdge, type Limits } from './inspector.ts';
import { next, nextIn, quadAt, type Quad } from './quad.ts';
import { COLOURED } from './run.ts';
import type { Scene } from './scene.ts';
import { seamsAt, type Seams } from './seam.ts';
import { LOOKS } from './states.ts';

/** The triangles that are shown, once they are in main memory. */
export interface Triangles {
  mesh: IndexedMesh;
  extras: FileExtras | undefined;
  indices: Uint32Array;
  /** The states of the half-edges, once they are known. */
  states: Uint8Array | undefined;
  limits: Limits;
}

/** A pointer that moves further than this between press and release, in pixels, turns the mesh. */
const STILL = 6;

export class Inspection {
  readonly #scene: () => Scene | undefined;
  #shown: Triangles | undefined;
  #quad: Quad | undefined;
  /** The seams of the file that was asked last. */
  #seams: { extras: FileExtras; found: Seams | undefined } | undefined;
  /** Whether the pointer is for something else. */
  isPaused = () => false;
  /** Whether the edge stays when the pointer leaves it. */
  #isHeld = false;

  constructor(scene: () => Scene | undefined) {
    this.#scene = scene;
    const view = element('view');
    let pressed: PointerEvent | undefined;
    view.addEventListener('pointerdown', (event) => (pressed = event));
    const narrow = matchMedia(NARROW);
    view.addEventListener('pointermove', (event) => {
      // Searching a large mesh at each move would be slow. On a narrow screen the mesh gives way to the inspector, and
      // would move under the pointer.
      if (
        event.buttons === 0 &&
        !narrow.matches &&
        !this.#isHeld &&
        !this.isPaused() &&
        this.#shown &&
        this.#shown.indices.length <= 3 * COLOURED
      ) {
        this.#lookAt(event);
      }
    });
    view.addEventListener('pointerup', (event) => {
      if (
        !pressed ||
        this.isPaused() ||
        Math.hypot(event.clientX - pressed.clientX, event.clientY - pressed.clientY) > STILL
      )
        return;
      this.#isHeld = this.#lookAt(event);
    });
    view.addEventListener('pointerleave', () => this.#isHeld || this.close());
    element('inspect').addEventListener('click', ({ target }) => {
      if (target instanceof Element && target.closest('.close')) this.close();
    });
  }

  /** Whether the edge stays until it is closed. */
  get isHeld(): boolean {
    return this.#isHeld;
  }

  /** Takes the triangles of another state. An edge that is held stays, if the mesh still has it. */
  show(shown: Triangles): void {
    const held = this.#isHeld && this.#shown?.mesh === shown.mesh ? this.#quad : undefined;
    this.#shown = shown;
    if (shown.extras !== this.#seams?.extras) this.#seams = undefined;
    if (!held) return this.close();
    const { indices } = shown;
    const half = indices.findIndex((from, h) => from === held.a && indices[next(h)] === held.b);
    if (half >= 0) this.#inspect(half);
    else this.close();
  }

  /** Takes the states of the shown triangles, which those of a large mesh get later. */
  know(states: Uint8Array): void {
    if (!this.#shown) return;
    this.#shown = { ...this.#shown, states };
    if (this.#quad) this.#inspect(this.#quad.half);
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

  /** Inspects the next edge that is not Delaunay, or the previous one; if all are, one near the middle of the picture. */
  next(by: 1 | -1): void {
    const { states } = this.#shown ?? {};
    if (!states) return;
    const isWanted = (state: EdgeState) => state !== 'delaunay' && state !== 'boundary';
    const half = this.#quad ? nextIn(states, isWanted, this.#quad.half, by) : this.#nearest(isWanted);
    if (half >= 0) this.#hold(half);
    else this.nearest('delaunay');
  }

  /** Inspects an edge in this state, near the middle of the picture, if there is one. */
  nearest(state: EdgeState): void {
    const half = this.#nearest((name) => name === state);
    if (half >= 0) this.#hold(half);
  }

  #hold(half: number): void {
    this.#isHeld = true;
    this.#inspect(half);
  }

  /** The half-edge in a wanted state that faces the camera nearest to the middle of the picture; -1 if there is none. */
  #nearest(isWanted: (state: EdgeState) => boolean): number {
    const [shown, scene] = [this.#shown, this.#scene()];
    if (!shown?.states || !scene) return -1;
    const { indices, states } = shown;
    const at = scene.projector();
    const [x, y] = scene.camera.middle;
    let [nearest, found, behind] = [Infinity, -1, -1];
    states.forEach((state, h) => {
      if (!isWanted(EDGE_STATES[state]!)) return;
      behind = h;
      const [a, b, c] = [h, next(h), next(next(h))].map((corner) => at(indices[corner]!));
      const [[ax, ay], [bx, by], [cx, cy]] = [a!, b!, c!];
      // The picture's y points down, so a triangle that faces the camera is clockwise.
      if ((bx - ax) * (cy - ay) - (by - ay) * (cx - ax) >= 0) return;
      const distance = Math.hypot((ax + bx) / 2 - x, (ay + by) / 2 - y);
      if (distance < nearest) [nearest, found] = [distance, h];
    });
    return found < 0 ? behind : found;
  }

  /** Draws the quad of the edge over the picture, where the camera sees it now. */
  draw(): void {
    const [quad, shown, scene] = [this.#quad, this.#shown, this.#scene()];
    const marks = select(element('thread')).selectAll<SVGPathElement, [string, string]>('path.mark');
    if (!quad || !shown || !scene) {
      marks.remove();
      return drawThread(undefined);
    }
    const at = scene.projector();
    const [a, b] = [at(quad.a), at(quad.b)];
    const middle: [x: number, y: number] = [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
    const around = quad.opposite.map((c) => `M${a}L${at(c)}L${b}`).join('');
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
      .attr('d', ([, d]) => d)
      .style('stroke', ([name]) => (name === 'edge' && quad.state ? `var(--${LOOKS[quad.state].colour})` : null));
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
    const { mesh, extras, indices, states, limits } = shown;
    const quad = quadAt(mesh, indices, states, half);
    this.#quad = quad;
    const at = scene.projector();
    const [[ax, ay], [bx, by]] = [at(quad.a), at(quad.b)];
    const found = this.#seams?.extras === extras ? this.#seams?.found : undefined;
    const along = found ? seamsAt(found, quad.a, quad.b, limits.keepsGroups) : extras ? undefined : [];
    showEdge(quad, mesh, limits, Math.atan2(ay - by, bx - ax), along);
    this.draw();
    if (extras && extras !== this.#seams?.extras) void this.#findSeams(extras);
  }

  /** Finds the seams of a file, and shows the inspected edge again. A file whose seams cannot be found has none. */
  async #findSeams(extras: FileExtras): Promise<void> {
    const seams: { extras: FileExtras; found: Seams | undefined } = { extras, found: undefined };
    this.#seams = seams;
    seams.found = await extras.seams().catch(() => undefined);
    if (this.#seams === seams && this.#quad && this.#shown?.extras === extras) this.#inspect(this.#quad.half);
  }
}
