/** Repeats a run after a loss: of the page's device with the pictures on it, or of the worker's context. */

import type { Choices } from './choices.ts';
import { element } from './controls.ts';
import type { Graphics } from './graphics.ts';
import { showError, type Jobs } from './jobs.ts';
import type { Opened, Opening } from './opening.ts';
import type { Run } from './run.ts';
import type { Source } from './sources.ts';

/** What the recovery needs of the page. */
export interface RecoveryHost {
  readonly graphics: Graphics;
  readonly jobs: Jobs;
  readonly choices: Choices;
  /** The mesh that is being opened, the open mesh and its run, and the last source. */
  state(): {
    opening: Opening | undefined;
    opened: Opened | undefined;
    run: Run | undefined;
    source: Source | undefined;
  };
  begin(opened: Opened, signal: AbortSignal): Promise<void>;
  open(source: Source): Promise<void>;
  redraw(): Promise<void>;
  fail(error: unknown): void;
  pause(): void;
  /** Begins again what is shown in place of a run; `undefined` for a run. */
  onGpuLost(): ((reason: string) => void) | undefined;
}

export class Recovery {
  readonly #host: RecoveryHost;
  /** The mesh whose run has lost a GPU before. */
  #lost: Opened | undefined;

  constructor(host: RecoveryHost) {
    this.#host = host;
  }

  /** Repeats the present run. The triangles are the same, bit for bit. */
  async recover(reason: string, isOfPage: boolean): Promise<void> {
    const { graphics, jobs } = this.#host;
    const onGpuLost = this.#host.onGpuLost();
    if (onGpuLost) {
      graphics.open();
      return onGpuLost(reason);
    }
    const { run, opening } = this.#host.state();
    let hasRecovered = false;
    await jobs.attempt('The GPU was lost; starting again…', async (signal) => {
      if (isOfPage) {
        graphics.open();
        await graphics.ready;
      }
      const opened = (await opening?.read) ?? this.#host.state().opened;
      signal.throwIfAborted();
      if (!opened) return;
      this.#chooseEngine(opened, isOfPage, opening === undefined ? run : undefined);
      await this.#host.begin(opened, signal);
      if (!opening && run) await this.#repeat(run, signal);
      hasRecovered = true;
    });
    // The user has started another job meanwhile.
    if (jobs.isBusy) return;
    await this.#report(reason, hasRecovered, opening !== undefined);
  }

  /**
   * A mesh that lost the GPU twice would probably lose it again. `auto` does not repeat a run on the GPU that it lost.
   * `run` is the run that was lost; `undefined` if its mesh was being opened.
   */
  #chooseEngine(opened: Opened, isOfPage: boolean, run: Run | undefined): void {
    const { choices } = this.#host;
    const { settings } = choices;
    const isAgain = this.#lost === opened;
    this.#lost = opened;
    const isOpening = this.#host.state().opening !== undefined;
    const [isAuto, isOnGpu] = [settings.backend === 'auto', !isOpening && !run?.isInWorker];
    const isHopeless = isAgain ? isOpening || isOnGpu || isAuto : isOnGpu && isAuto;
    if (!isOfPage || isHopeless) choices.set({ ...settings, backend: 'cpu' });
  }

  /** Repeats the iterations of the previous run. */
  async #repeat(before: Run, signal: AbortSignal): Promise<void> {
    try {
      await this.#host.state().run?.follow(before, signal);
    } catch (error) {
      this.#host.fail(error);
    }
    await this.#host.redraw();
  }

  async #report(reason: string, hasRecovered: boolean, wasOpening: boolean): Promise<void> {
    const { opened, source } = this.#host.state();
    const lost = `The GPU was lost (${reason}).`;
    if (hasRecovered) {
      this.#host.pause();
      const andNow = wasOpening ? 'The mesh was opened nevertheless' : 'The run was repeated, with the same triangles';
      showError(new Error(`${lost} ${andNow}.`));
    } else if (!opened && source) {
      await this.#host.open(source);
    } else if (element('error').hidden) {
      showError(new Error(`${lost} Choose an engine to continue.`));
    }
  }
}
