/** When a run that `auto` has started on the CPU moves to the GPU, or why it stays. */

import type { Options } from 'edgeflip';
import { beginBehind, forAuto, type Gpu } from './engines.ts';
import { Handover, type Replacement } from './handover.ts';
import type { Opened } from './opening.ts';
import type { Backend, Run } from './run.ts';

/** What it needs of the page. */
export interface HandoverHost {
  /** The present run. */
  run(): Run | undefined;
  /** Whether no job and no iteration is running, and the shown state of the run is measured. */
  isIdle(): boolean;
  /** Replaces the present run. The picture stays the same. */
  replaceRun(next: Replacement): void;
  /** Shows what has changed about the run. */
  showRun(): void;
}

export class AutoHandover {
  readonly #host: HandoverHost;
  #handover: Handover | undefined;

  constructor(host: HandoverHost) {
    this.#host = host;
  }

  /** Prepares the GPU during a run on the CPU, or sets the reason why the run stays there. */
  prepare(run: Run, { mesh }: Opened, options: Options & { backend: Backend }, gpu: Gpu | string | undefined): void {
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
      (error) => this.#stayOnCpu(run, error),
    );
  }

  /** Moves the run to the GPU if the GPU is ready and the page is idle. */
  async handOver(): Promise<void> {
    const [run, handover] = [this.#host.run(), this.#handover];
    if (!run || !handover) return;
    try {
      const next = await handover.follow(run, () => run === this.#host.run() && this.#host.isIdle());
      if (!next) return;
      this.#handover = undefined;
      this.#host.replaceRun(next);
    } catch (error) {
      if (handover === this.#handover) this.#stayOnCpu(run, error);
    }
  }

  #stayOnCpu(run: Run, error: unknown): void {
    this.#handover?.close();
    this.#handover = undefined;
    run.awaitsGpu = false;
    run.fallback = error instanceof Error ? error.message : String(error);
    this.#host.showRun();
  }
}
