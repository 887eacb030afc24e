/** Moves a run from the CPU to the GPU, after the GPU has compiled its kernels. */

import type { Run, Summary } from './run.ts';

/** The run on the GPU, at the same iteration as the run on the CPU, and its summary there. */
export interface Replacement {
  run: Run;
  summary: Summary;
}

export class Handover {
  readonly #next: Promise<Run>;
  #isReady = false;
  #isFollowing = false;
  #isClosed = false;

  /** `begin` starts the run on the GPU; then `ready` is called, or `failed` with the reason. */
  constructor(begin: () => Promise<Run>, ready: () => void, failed: (error: unknown) => void) {
    this.#next = begin();
    this.#next.then(
      (next) => {
        if (this.#isClosed) return next.free();
        this.#isReady = true;
        ready();
      },
      (error: unknown) => {
        if (!this.#isClosed) failed(error);
      },
    );
  }

  /**
   * Repeats the iterations of `run` on the GPU, and returns the new run when both are at the same iteration. Returns
   * `undefined` if the GPU is not ready, or if `isAtRest` says that `run` has continued meanwhile.
   *
   * @throws the error of the GPU.
   */
  async follow(run: Run, isAtRest: () => boolean): Promise<Replacement | undefined> {
    if (!this.#isReady || this.#isFollowing) return undefined;
    this.#isFollowing = true;
    try {
      const next = await this.#next;
      while (!this.#isClosed && isAtRest()) {
        await next.follow(run);
        const summary = await next.result();
        const isThere = next.at === run.at && next.iterations.length === run.iterations.length;
        if (isThere && !this.#isClosed && isAtRest()) return { run: next, summary };
      }
      return undefined;
    } finally {
      this.#isFollowing = false;
    }
  }

  /** Ends the run on the GPU. */
  close(): void {
    this.#isClosed = true;
    if (this.#isReady) void this.#next.then((next) => next.free());
  }
}
