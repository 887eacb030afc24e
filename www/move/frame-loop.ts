/** Plays a mesh that moves: in each frame its vertices move, edges flip, and it is drawn. */

import type { Scene } from '../watch/scene.ts';
import type { Motion, Point } from './motions.ts';
import type { Grip, MovingMesh } from './moving-mesh.ts';

/** The longest step of the motion, in seconds: after a pause the mesh does not jump. */
const LONGEST = 1 / 30;
/** Frames that the device may still have to do when the next one begins. */
const AHEAD = 2;
/** How much a frame counts in the mean times. */
const SHARE = 0.05;
/** Numbers of the last frames. */
export interface Numbers {
  /** Flips in a frame. */
  flips: number;
  /** Edges that the next frames flip, and edges that no flip makes Delaunay. */
  left: number;
  kept: number;
  /** Triangles that are turned over, and triangles of no area. */
  inverted: number;
  flat: number;
  /** Milliseconds from a frame to the next, and until the work of a frame is done. */
  each: number;
  work: number;
}

export class FrameLoop {
  readonly moving: MovingMesh;
  readonly #scene: Scene;
  readonly #pointer: Grip;
  readonly #told: (numbers: Numbers) => void;
  readonly #failed: (error: unknown) => void;
  #time = 0;
  #each = 0;
  #work = 0;
  #counted = { flips: 0, updates: 0 };
  #counting: Promise<void> | undefined;
  /** The number of the last start. A loop of an earlier one ends. */
  #starts = 0;
  #isPlaying = false;

  /**
   * `grip` makes the pointer, which calls `changed` when it takes hold of the mesh and when it lets go. `told` is called
   * with new numbers, and `failed` with the error that ends the motion.
   */
  constructor(
    moving: MovingMesh,
    { dimension, box }: Pick<Motion, 'dimension' | 'box'>,
    scene: Scene,
    grip: (changed: (isHeld: boolean) => void) => Grip,
    told: (numbers: Numbers) => void,
    failed: (error: unknown) => void,
  ) {
    this.moving = moving;
    this.#scene = scene;
    this.#told = told;
    this.#failed = failed;
    this.#pointer = grip((isHeld) => void (this.#isPlaying || this.#drag(isHeld)));
    scene.showMoving(moving.surface.object, endsOf(box), dimension);
  }

  get isPlaying(): boolean {
    return this.#isPlaying;
  }

  play(): void {
    this.#isPlaying = true;
    this.#run(1);
  }

  /** Stops, and flips what is left. */
  async pause(): Promise<void> {
    this.#starts++;
    this.#isPlaying = false;
    await this.moving.finish();
    this.#scene.redraw();
    await this.#counting?.catch(() => {});
    await this.#count();
  }

  /** Draws the first frame. */
  async still(): Promise<void> {
    await this.#frame(0);
    this.#scene.draw();
    await this.#count();
  }

  free(): void {
    this.#starts++;
    this.#isPlaying = false;
    this.#pointer.dispose();
    this.#scene.clear();
    this.moving.free();
  }

  /** While the mesh is paused, time stands still, but points can be dragged. */
  #drag(isHeld: boolean): void {
    if (isHeld) this.#run(0);
    else this.#letGo().catch(this.#failed);
  }

  /** Drags the mesh to where the pointer has left it, and pauses again. */
  async #letGo(): Promise<void> {
    const start = ++this.#starts;
    while (this.#pointer.isBehind) {
      await this.#frame(0);
      if (start !== this.#starts) return;
    }
    await this.pause();
  }

  /** Plays at this speed. */
  #run(speed: 0 | 1): void {
    const start = ++this.#starts;
    this.#loop(start, speed).catch((error: unknown) => {
      if (start !== this.#starts) return;
      this.#isPlaying = false;
      this.#failed(error);
    });
  }

  async #loop(start: number, speed: 0 | 1): Promise<void> {
    const flying: Promise<void>[] = [];
    let last = performance.now();
    for (;;) {
      const now = await new Promise(requestAnimationFrame);
      if (start !== this.#starts) return;
      const between = now - last;
      last = now;
      if (!this.#isSeen) continue;
      this.#each = mean(this.#each, between);
      const begin = performance.now();
      await this.#frame(speed * Math.min(LONGEST, between / 1000));
      if (start !== this.#starts) return;
      this.#scene.draw();
      const done = this.moving.settled().then(() => void (this.#work = mean(this.#work, performance.now() - begin)));
      done.catch(() => {});
      flying.push(done);
      if (flying.length > AHEAD) await flying.shift();
      // Counting never delays a frame.
      this.#count().catch(() => {});
    }
  }

  #frame(seconds: number): Promise<void> {
    this.#time += seconds;
    return this.moving.frame({ time: this.#time, seconds, drag: this.#pointer.take(), isHeld: this.#pointer.isHeld });
  }

  /** Counts, unless the last count is still on its way. */
  #count(): Promise<void> {
    return (this.#counting ??= this.#ask().finally(() => (this.#counting = undefined)));
  }

  async #ask(): Promise<void> {
    const start = this.#starts;
    const { flips, updates, remaining, inverted, flat } = await this.moving.counters();
    const frames = Math.max(1, updates - this.#counted.updates);
    const inFrame = (flips - this.#counted.flips) / frames;
    this.#counted = { flips, updates };
    const { stopped: left = 0, ...others } = remaining;
    const kept = Object.values(others).reduce((sum, count) => sum + count, 0);
    // Counts of frames before a pause come too late.
    if (start === this.#starts)
      this.#told({ flips: inFrame, left, kept, inverted, flat, each: this.#each, work: this.#work });
  }

  /** Whether the mesh is on the screen. */
  get #isSeen(): boolean {
    const { bottom, height } = this.#scene.canvas.getBoundingClientRect();
    return bottom > 0 && height > 0;
  }
}

function mean(before: number, now: number): number {
  return before === 0 ? now : before + SHARE * (now - before);
}

/** The middles of the sides of a box, 3 numbers each: the camera fits them. */
function endsOf(box: Point): Float32Array {
  const ends = box.flatMap((half, k) => [half, -half].map((at) => [0, 1, 2].map((axis) => (axis === k ? at : 0))));
  return new Float32Array(ends.flat());
}
