/** When a run that `auto` has started on the CPU moves to the GPU, or why it stays. */

import type { Options } from 'edgeflip';
import { beginBehind, forAuto, type Gpu } from './engines.ts';
import { Handover, type Successor } from './handover.ts';
import type { Opened } from './opening.ts';
import type { Backend, Run } from './run.ts';

/** What it needs of the page. */
export interface Throne {
  /** The present run. */
  run(): Run | undefined;
  /** Whether no job and no iteration is running, and the shown state of the run is measured. */
  isIdle(): boolean;
  /** Replaces the present run. The picture stays the same. */
  succeed(next: Successor): void;
  /** Shows what has changed about the run. */
  tell(): void;
}

export class Succession {
  readonly #throne: Throne;
  #handover: Handover | undefined;

  constructor(throne: Throne) {
    this.#throne = throne;
  }

  /** Prepares the GPU during a run on the CPU, or sets the reason why the run stays there. */
  expect(run: Run, { mesh }: Opened, options: Options & { backend: Backend }, gpu: Gpu | string | undefined): void {
    this.#handover?.close();
    this.#handover = undefined;
    if (options.backend !== 'auto' || !run.isInWorker || run.fallback !== undefined || gpu === undefined) return;
    const usable = forAuto(gpu);
    if (typeof usable === 'string') {
      run.fallback = usable;
      return;
    }
    run.awaitsGpu = true;
    this.#handover = new Handover(
      () => beginBehind(mesh, options, usable),
      () => void this.handOver(),
      (error) => this.#stay(run, error),
    );
  }

  /** Moves the run to the GPU if the GPU is ready and the page is idle. */
  async handOver(): Promise<void> {
    const [run, handover] = [this.#throne.run(), this.#handover];
    if (!run || !handover) return;
    try {
      const next = await handover.follow(run, () => run === this.#throne.run() && this.#throne.isIdle());
      if (!next) return;
      this.#handover = undefined;
      this.#throne.succeed(next);
    } catch (error) {
      if (handover === this.#handover) this.#stay(run, error);
    }
  }

  #stay(run: Run, error: unknown): void {
    this.#handover?.close();
    this.#handover = undefined;
    run.awaitsGpu = false;
    run.fallback = error instanceof Error ? error.message : String(error);
    this.#throne.tell();
  }
}
