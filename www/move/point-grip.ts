/** Takes hold of single points with the pointer. Beside them, the pointer moves the camera. */

import type { Scene } from '../watch/scene.ts';
import type { Grip } from './moving-mesh.ts';

/** How far the pointer may be from a point that it takes, in pixels. */
const REACH = 22;

/** Points that can be held. */
interface Points {
  /** The point that is nearest to a place, and where it is. */
  nearest(x: number, y: number): [index: number, x: number, y: number];
  /** The one that the pointer holds stands still. */
  held: number | undefined;
  moveTo(index: number, x: number, y: number): void;
}

export class PointGrip implements Grip {
  readonly #view: HTMLElement;
  readonly #scene: Scene;
  readonly #points: Points;
  readonly #changed: (isHeld: boolean) => void;
  readonly #listening = new AbortController();
  /** The pointer, the point that it holds, and the way from the one to the other. */
  #held: { pointer: number; index: number; x: number; y: number } | undefined;
  isBehind = false;

  /** `changed` is called when the pointer takes hold of a point, and when it lets go. */
  constructor(view: HTMLElement, scene: Scene, points: Points, changed: (isHeld: boolean) => void) {
    [this.#view, this.#scene, this.#points, this.#changed] = [view, scene, points, changed];
    // Before the camera's own listeners.
    const options = { signal: this.#listening.signal, capture: true };
    view.addEventListener('pointerdown', (event) => this.#press(event), options);
    view.addEventListener('pointermove', (event) => this.#move(event), options);
    for (const name of ['pointerup', 'pointercancel'] as const) {
      view.addEventListener(name, ({ pointerId }) => pointerId === this.#held?.pointer && this.#letGo(), options);
    }
  }

  get isHeld(): boolean {
    return this.#held !== undefined;
  }

  /** The point is already where the pointer is. The next frame draws it there. */
  take(): undefined {
    this.isBehind = false;
  }

  dispose(): void {
    this.#listening.abort();
    this.#scene.camera.isFree = true;
  }

  #press(event: PointerEvent): void {
    if (this.isHeld || event.button !== 0) return;
    const [x, y] = this.#placeOf(event);
    const [index, px, py] = this.#points.nearest(x, y);
    if (Math.hypot(px - x, py - y) > REACH * this.#scene.camera.pixel) return;
    this.#scene.camera.isFree = false;
    this.#scene.canvas.setPointerCapture(event.pointerId);
    this.#held = { pointer: event.pointerId, index, x: px - x, y: py - y };
    this.#points.held = index;
    this.#changed(true);
  }

  #move(event: PointerEvent): void {
    if (event.pointerId !== this.#held?.pointer) return;
    const [x, y] = this.#placeOf(event);
    this.#points.moveTo(this.#held.index, x + this.#held.x, y + this.#held.y);
    this.isBehind = true;
  }

  #letGo(): void {
    this.#held = this.#points.held = undefined;
    // The next frame draws the point as the others.
    this.isBehind = true;
    this.#scene.camera.isFree = true;
    this.#changed(false);
  }

  #placeOf({ clientX, clientY }: PointerEvent): [x: number, y: number] {
    const { left, top } = this.#view.getBoundingClientRect();
    const { x, y } = this.#scene.camera.rayAt(clientX - left, clientY - top).origin;
    return [x, y];
  }
}
