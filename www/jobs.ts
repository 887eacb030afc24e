/** What goes on and takes a while, one job at a time: shown, with a way to cancel it, and with the error that ended it. */

import { element } from './controls.ts';
import { Cancelled } from './engines.ts';

export class Jobs {
  #job: AbortController | undefined;
  readonly #begun: () => void;
  readonly #ended: () => void;

  /** `begun` and `ended` are called when a job takes the place of another, and when none goes on any more. */
  constructor(begun: () => void, ended: () => void) {
    this.#begun = begun;
    this.#ended = ended;
  }

  get isBusy(): boolean {
    return this.#job !== undefined;
  }

  /** Does the work, under a text that says what it is; cancels what was begun before. */
  async attempt(text: string, work: (signal: AbortSignal) => Promise<void>): Promise<void> {
    const overtaken = this.#job;
    const job = new AbortController();
    this.#job = job;
    overtaken?.abort(new Cancelled());
    job.signal.addEventListener('abort', () => this.#end(job));
    element('error').hidden = true;
    showProgress(text);
    element('busy').hidden = false;
    this.#begun();
    try {
      await work(job.signal);
    } catch (error) {
      if (!job.signal.aborted) showError(error);
    } finally {
      this.#end(job);
    }
  }

  cancel(): void {
    this.#job?.abort(new Cancelled());
  }

  #end(job: AbortController): void {
    if (this.#job !== job) return;
    this.#job = undefined;
    element('busy').hidden = true;
    this.#ended();
  }
}

/** The text of the job that goes on, and how much of it is done, from 0 to 1, where that is known. */
export function showProgress(text: string, share = 1): void {
  element('busy-text').textContent = text;
  const bar = element<HTMLProgressElement>('progress');
  if (share < 1) bar.value = share;
  else bar.removeAttribute('value');
}

/** Shows the message of an error unchanged: it may begin with the name of a file. */
export function showError(error: unknown): void {
  element('error-text').textContent = error instanceof Error ? error.message : String(error);
  element('error').hidden = false;
}
