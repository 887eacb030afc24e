/** Runs one long job at a time. Shows its progress, a button to cancel it, and its error. */

import { element } from './controls.ts';
import { Cancelled } from './worker-client.ts';

export class Jobs {
  #job: AbortController | undefined;
  /** Called when no job runs any more. */
  #waiting: (() => void)[] = [];
  readonly #begun: () => void;
  readonly #ended: () => void;

  /** `begun` is called when a job starts, and `ended` when no job runs any more. */
  constructor(begun: () => void, ended: () => void) {
    this.#begun = begun;
    this.#ended = ended;
  }

  get isBusy(): boolean {
    return this.#job !== undefined;
  }

  /** Settles when no job runs. */
  idle(): Promise<void> {
    return new Promise((done) => (this.isBusy ? this.#waiting.push(done) : done()));
  }

  /** Runs `work` and shows `text` meanwhile. Cancels the job before it. */
  async attempt(text: string, work: (signal: AbortSignal) => Promise<void>): Promise<void> {
    const previous = this.#job;
    const job = new AbortController();
    this.#job = job;
    previous?.abort(new Cancelled());
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
    for (const done of this.#waiting.splice(0)) done();
  }
}

/** Shows the text of the present job, and its completed share from 0 to 1, if it is known. */
export function showProgress(text: string, share = 1): void {
  element('busy-text').textContent = text;
  const bar = element<HTMLProgressElement>('progress');
  if (share < 1) bar.value = share;
  else bar.removeAttribute('value');
}

/** Shows the message of an error unchanged: it may start with the name of a file. */
export function showError(error: unknown): void {
  element('error-text').textContent = error instanceof Error ? error.message : String(error);
  element('error').hidden = false;
}
