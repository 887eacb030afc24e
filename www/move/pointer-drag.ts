/** Drags points of the mesh with the pointer. Beside the mesh, the pointer moves the camera. */

import { Ray, Vector3 } from 'three/webgpu';
import type { Scene } from '../watch/scene.ts';
import { HALF, type Drag, type Point } from './motions.ts';
import type { Grip } from './moving-mesh.ts';

/** The longest way in a frame: a longer one would turn many triangles over. */
const LONGEST = 0.06;
/** The mesh is in a square with this half side, or in a ball with this radius. */
const REACH = 1.15 * HALF;

export class PointerDrag implements Grip {
  readonly #view: HTMLElement;
  readonly #scene: Scene;
  readonly #dimension: 2 | 3;
  readonly #listening = new AbortController();
  readonly #changed: (isHeld: boolean) => void;
  #pointer: number | undefined;
  /** Where along the line of sight the pointer holds the mesh, and how far along it reaches. */
  #along = 0;
  #depth = 0;
  /** The line of sight in the last frame, and now. They stay after the pointer has let go, until the mesh is there. */
  #last: Ray | undefined;
  #now: Ray | undefined;

  /** `changed` is called when the pointer takes hold of the mesh, and when it lets go. */
  constructor(view: HTMLElement, scene: Scene, dimension: 2 | 3, changed: (isHeld: boolean) => void) {
    this.#changed = changed;
    this.#view = view;
    this.#scene = scene;
    this.#dimension = dimension;
    // Before the camera's own listeners.
    const options = { signal: this.#listening.signal, capture: true };
    view.addEventListener('pointerdown', (event) => this.#press(event), options);
    view.addEventListener('pointermove', (event) => this.#move(event), options);
    for (const name of ['pointerup', 'pointercancel'] as const) {
      view.addEventListener(name, ({ pointerId }) => pointerId === this.#pointer && this.#letGo(), options);
    }
  }

  get isHeld(): boolean {
    return this.#pointer !== undefined;
  }

  get isBehind(): boolean {
    return this.#last !== this.#now;
  }

  /** What is too much for a frame is left for the next one. */
  take(): Drag | undefined {
    const [last, now] = [this.#last, this.#now];
    if (!last || !now || last === now) return undefined;
    const by = now.at(this.#along, new Vector3()).sub(last.at(this.#along, new Vector3()));
    const share = LONGEST / by.length();
    this.#last = share < 1 ? between(last, now, share) : now;
    by.clampLength(0, LONGEST);
    return {
      origin: last.origin.toArray() as Point,
      way: last.direction.toArray() as Point,
      depth: this.#depth,
      by: by.toArray() as Point,
    };
  }

  dispose(): void {
    this.#listening.abort();
    this.#scene.camera.isFree = true;
  }

  #press(event: PointerEvent): void {
    if (this.isHeld || event.button !== 0) return;
    const ray = this.#rayOf(event);
    if (!this.#hits(ray)) return;
    this.#scene.camera.isFree = false;
    this.#pointer = event.pointerId;
    this.#last = this.#now = ray;
    this.#scene.canvas.setPointerCapture(event.pointerId);
    this.#changed(true);
  }

  #move(event: PointerEvent): void {
    if (event.pointerId === this.#pointer) this.#now = this.#rayOf(event);
  }

  #letGo(): void {
    this.#pointer = undefined;
    this.#scene.camera.isFree = true;
    this.#changed(false);
  }

  #rayOf({ clientX, clientY }: PointerEvent): Ray {
    const { left, top } = this.#view.getBoundingClientRect();
    return this.#scene.camera.rayAt(clientX - left, clientY - top).clone();
  }

  /** Whether the line of sight meets the mesh. */
  #hits({ origin, direction }: Ray): boolean {
    if (this.#dimension === 2) {
      [this.#along, this.#depth] = [0, 1e9];
      return Math.max(Math.abs(origin.x), Math.abs(origin.y)) < REACH;
    }
    const nearest = -origin.dot(direction);
    const square = REACH ** 2 - (origin.lengthSq() - nearest ** 2);
    if (square < 0) return false;
    [this.#along, this.#depth] = [nearest - Math.sqrt(square), nearest];
    return true;
  }
}

/** The line of sight a share of the way from one to the other. */
function between(from: Ray, to: Ray, share: number): Ray {
  const direction = from.direction.clone().lerp(to.direction, share).normalize();
  return new Ray(from.origin.clone().lerp(to.origin, share), direction);
}
