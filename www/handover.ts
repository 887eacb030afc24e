/** How a run that has begun on the CPU goes over to the GPU, once that has compiled its programs. */

import type { Run, Summary } from './run.ts';

/** The run on the GPU, where the other one stands, and what it says of itself there. */
export interface Successor {
  run: Run;
  summary: Summary;
}

export class Handover {
  readonly #next: Promise<Run>;
  #isReady = false;
  #isFollowing = false;
  #isClosed = false;

  /** `begin` begins the run on the GPU; then `ready` is called, or `failed` with the reason. */
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
   * Lets the new run go the way of `run`, and gives it where both stand at the same iteration: `undefined` where it is
   * not ready, or `isAtRest` says that `run` has gone on meanwhile.
   *
   * @throws what the GPU fails with.
   */
  async follow(run: Run, isAtRest: () => boolean): Promise<Successor | undefined> {
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

  /** Gives the run on the GPU up. */
  close(): void {
    this.#isClosed = true;
    if (this.#isReady) void this.#next.then((next) => next.free());
  }
}
