/** Plays a run in one loop at a time. A pause, a step or the slider ends the loop. */

import type { Run } from './run.ts';

export class Player {
  /** Runs one iteration, draws it if `isShown`, and returns whether there was one. */
  readonly #forward: (run: Run, isShown?: boolean) => Promise<boolean>;
  /** Called when the run pauses. */
  readonly #rest: () => void;
  /** The present loop. A loop that is not the present one stops. */
  #loop: object | undefined;
  #isStepping = false;

  constructor(forward: (run: Run, isShown?: boolean) => Promise<boolean>, rest: () => void) {
    this.#forward = forward;
    this.#rest = rest;
  }

  get isPlaying(): boolean {
    return this.#loop !== undefined;
  }

  /** Whether no iteration is running or scheduled. */
  get isAtRest(): boolean {
    return !this.isPlaying && !this.#isStepping;
  }

  /** Plays to the end. `interval` returns the milliseconds from one iteration to the next. */
  async play(run: Run, interval: () => number): Promise<void> {
    const loop = {};
    this.#loop = loop;
    if (run.isOver) run.seek(0);
    while (this.#loop === loop) {
      const start = performance.now();
      if (!(await this.#forward(run))) break;
      await nextFrame();
      await pause(interval() - (performance.now() - start));
    }
    if (this.#loop === loop) this.pause();
  }

  /** Runs iterations up to `at` without drawing them, and then draws that state. */
  async reach(run: Run, at: number): Promise<void> {
    const loop = {};
    this.#loop = loop;
    run.seek(run.iterations.length);
    while (this.#loop === loop && run.at < at && (await this.#forward(run, run.at === at - 1)));
    if (this.#loop === loop) this.pause();
  }

  /** Runs one iteration, unless one is running. */
  async step(run: Run): Promise<void> {
    this.#loop = undefined;
    if (this.#isStepping) return;
    this.#isStepping = true;
    try {
      await this.#forward(run);
    } finally {
      this.#isStepping = false;
    }
    if (!this.isPlaying) this.#rest();
  }

  pause(): void {
    this.#loop = undefined;
    this.#rest();
  }
}

const pause = (ms: number) => new Promise((resolve) => setTimeout(resolve, Math.max(0, ms)));
const nextFrame = () => new Promise(requestAnimationFrame);
