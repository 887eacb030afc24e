/** Repeats a run after a loss: of the page's device with the pictures on it, or of the worker's context. */

import type { Choices } from './choices.ts';
import { element } from './controls.ts';
import type { Graphics } from './graphics.ts';
import { showError, type Jobs } from './jobs.ts';
import type { Opened, Opening } from './opening.ts';
import type { Run } from './run.ts';
import type { Source } from './sources.ts';

/** What the recovery needs of the page. */
export interface Patient {
  readonly graphics: Graphics;
  readonly jobs: Jobs;
  readonly choices: Choices;
  /** The mesh that is being opened, the open mesh and its run, and the last source. */
  at(): { opening: Opening | undefined; opened: Opened | undefined; run: Run | undefined; source: Source | undefined };
  begin(opened: Opened, signal: AbortSignal): Promise<void>;
  open(source: Source): Promise<void>;
  redraw(): Promise<void>;
  fail(error: unknown): void;
  pause(): void;
  /** Who is shown in place of a run, and begins again by itself. */
  guest(): ((reason: string) => void) | undefined;
}

export class Recovery {
  readonly #patient: Patient;
  /** The mesh whose run has lost a GPU before. */
  #lost: Opened | undefined;

  constructor(patient: Patient) {
    this.#patient = patient;
  }

  /** Repeats the present run. The triangles are the same, bit for bit. */
  async recover(reason: string, isOfPage: boolean): Promise<void> {
    const { graphics, jobs } = this.#patient;
    const guest = this.#patient.guest();
    if (guest) {
      graphics.open();
      return guest(reason);
    }
    const { run, opening } = this.#patient.at();
    let hasRecovered = false;
    await jobs.attempt('The GPU was lost; starting again…', async (signal) => {
      if (isOfPage) {
        graphics.open();
        await graphics.ready;
      }
      const opened = (await opening?.read) ?? this.#patient.at().opened;
      signal.throwIfAborted();
      if (!opened) return;
      this.#chooseEngine(opened, isOfPage, opening === undefined ? run : undefined);
      await this.#patient.begin(opened, signal);
      if (!opening && run) await this.#goThere(run, signal);
      hasRecovered = true;
    });
    // The user has started another job meanwhile.
    if (jobs.isBusy) return;
    await this.#tell(reason, hasRecovered, opening !== undefined);
  }

  /**
   * A mesh that lost the GPU twice would probably lose it again. `auto` does not repeat a run on the GPU that it lost.
   * `run` is the run that was lost; `undefined` if its mesh was being opened.
   */
  #chooseEngine(opened: Opened, isOfPage: boolean, run: Run | undefined): void {
    const { choices } = this.#patient;
    const { settings } = choices;
    const isAgain = this.#lost === opened;
    this.#lost = opened;
    const isOpening = this.#patient.at().opening !== undefined;
    const [isAuto, isOnGpu] = [settings.backend === 'auto', !isOpening && !run?.isInWorker];
    const isHopeless = isAgain ? isOpening || isOnGpu || isAuto : isOnGpu && isAuto;
    if (!isOfPage || isHopeless) choices.set({ ...settings, backend: 'cpu' });
  }

  /** Repeats the iterations of the previous run. */
  async #goThere(before: Run, signal: AbortSignal): Promise<void> {
    try {
      await this.#patient.at().run?.follow(before, signal);
    } catch (error) {
      this.#patient.fail(error);
    }
    await this.#patient.redraw();
  }

  async #tell(reason: string, hasRecovered: boolean, wasOpening: boolean): Promise<void> {
    const { opened, source } = this.#patient.at();
    const lost = `The GPU was lost (${reason}).`;
    if (hasRecovered) {
      this.#patient.pause();
      const andNow = wasOpening ? 'The mesh was opened nevertheless' : 'The run was repeated, with the same triangles';
      showError(new Error(`${lost} ${andNow}.`));
    } else if (!opened && source) {
      await this.#patient.open(source);
    } else if (element('error').hidden) {
      showError(new Error(`${lost} Choose an engine to continue.`));
    }
  }
}
