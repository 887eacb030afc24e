/** Plays a run in one loop at a time. A pause, a step or the slider ends the loop. */

import { controls } from './controls.ts';
import type { Run } from './run.ts';

/** What it needs of the page. */
export interface Playing {
  run(): Run | undefined;
  /** The flips of all iterations, if they are known before they are run. */
  ahead(): readonly unknown[] | undefined;
  isBusy(): boolean;
  redraw(): Promise<void>;
  /** Looks one iteration ahead, if that shows more. */
  lookAhead(): Promise<void>;
  /** A loop has begun, or the run has paused. */
  began(): void;
  paused(): void;
  fail(error: unknown): void;
}

/** With at least so many milliseconds from one iteration to the next, flips slide, and there is time to look ahead. */
export const SLOW = 250;

export class Player {
  readonly #page: Playing;
  /** The present loop. A loop that is not the present one stops. */
  #loop: object | undefined;
  #isStepping = false;

  constructor(page: Playing) {
    this.#page = page;
  }

  get isPlaying(): boolean {
    return this.#loop !== undefined;
  }

  /** Whether no iteration is running or scheduled. */
  get isAtRest(): boolean {
    return !this.isPlaying && !this.#isStepping;
  }

  /** Plays to the end, or pauses. */
  async toggle(): Promise<void> {
    if (this.isPlaying) return this.pause();
    const run = this.#page.run();
    if (!run) return;
    if (run.isOver) run.seek(0);
    const loop = this.#begin();
    while (this.#loop === loop) {
      const start = performance.now();
      if (!(await this.#forward(run)) || run.isOver) break;
      await nextFrame();
      if (Number(controls.speed.value) >= SLOW) await this.#page.lookAhead();
      await pause(Number(controls.speed.value) - (performance.now() - start));
    }
    if (this.#loop === loop) this.pause();
  }

  /** Runs one iteration, unless one is running. */
  async step(): Promise<void> {
    const run = this.#page.run();
    this.#loop = undefined;
    if (this.#isStepping || !run) return;
    this.#isStepping = true;
    try {
      await this.#forward(run);
    } finally {
      this.#isStepping = false;
    }
    if (!this.isPlaying) this.#page.paused();
  }

  /** Shows the state after `at` iterations, and first runs those that are missing, without drawing them. */
  async seek(at: number): Promise<void> {
    const run = this.#page.run();
    if (this.#page.isBusy() || !run) return;
    const newest = run.iterations.length;
    run.seek(Math.max(0, Math.min(at, newest)));
    if (at <= newest || run.hasEnded) {
      this.pause();
      return this.#page.redraw();
    }
    const loop = this.#begin();
    while (this.#loop === loop && run.at < at && (await this.#forward(run, run.at === at - 1)));
    if (this.#loop === loop) this.pause();
  }

  async seekBy(iterations: number): Promise<void> {
    const run = this.#page.run();
    if (run) await this.seek(run.at + iterations);
  }

  pause(): void {
    this.#loop = undefined;
    this.#page.paused();
  }

  #begin(): object {
    this.#loop = {};
    this.#page.began();
    return this.#loop;
  }

  /** Moves forward by one iteration and draws it if `isShown`. Returns whether there was one. */
  async #forward(run: Run, isShown = true): Promise<boolean> {
    const page = this.#page;
    try {
      const went = await run.forward();
      // The engine learns only from another call that this was the last iteration.
      if (run === page.run() && page.ahead()?.length === run.iterations.length && !run.hasEnded) await run.forward();
      if (run === page.run() && (isShown || !went)) await page.redraw();
      return went && run === page.run();
    } catch (error) {
      if (run === page.run()) page.fail(error);
      return false;
    }
  }
}

const pause = (ms: number) => new Promise((resolve) => setTimeout(resolve, Math.max(0, ms)));
const nextFrame = () => new Promise(requestAnimationFrame);
