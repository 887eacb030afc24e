/** Measures what is shown, when nothing changes for a while. */

import { digestOf, fingerprintOf } from '../shell/digest.ts';
import { element } from './controls.ts';
import type { Display } from './display.ts';
import { measure } from './measure.ts';
import type { Run, Summary } from './run.ts';
import { statusOf } from './sentences.ts';
import type { Shown } from './shown.ts';
import type { Standing } from './transport.ts';

/** Milliseconds without a change after which a state is measured. */
const QUIET = 150;

/** What it needs of the page. */
export interface Resting {
  readonly display: Display;
  standing(): Standing;
  shown(): Shown | undefined;
  /** Takes the summary of the run. */
  sum(summary: Summary): void;
  /** Whether the edges have no colours. */
  isPlain(): boolean;
  /** Everything is measured. */
  handOver(): void;
  fail(error: unknown): void;
}

export class Rest {
  readonly #page: Resting;
  /** The number of calls so far. A call stops when a later call begins. */
  #calls = 0;

  constructor(page: Resting) {
    this.#page = page;
  }

  /** Whether the shown state of the run is measured. */
  isMeasured(run: Run | undefined): boolean {
    return document.body.dataset['measured'] === `${run?.at}`;
  }

  /** Nothing is measured. */
  forget(): void {
    this.#calls++;
    delete document.body.dataset['measured'];
  }

  /**
   * Measures the run and the shown triangles, unless something changes. With `news`, announces it and does not measure
   * the triangles.
   */
  async begin(news?: string): Promise<void> {
    const page = this.#page;
    const shown = page.shown();
    if (!shown) return;
    const { run, opened } = shown;
    const call = ++this.#calls;
    const isOutdated = () => call !== this.#calls || page.standing().isPlaying || run !== page.shown()?.run;
    delete document.body.dataset['measured'];
    await new Promise((resolve) => setTimeout(resolve, QUIET));
    // The picture comes first, because a measurement would hold it up.
    await page.display.painted();
    if (isOutdated()) return;
    try {
      if (page.standing().summary?.iterations !== run.iterations.length) {
        const summary = await run.result();
        if (run === page.shown()?.run) page.sum(summary);
      }
      if (isOutdated()) return;
      const indices = await run.triangles();
      const fingerprint = fingerprintOf(await digestOf(indices));
      if (isOutdated()) return;
      page.display.showNumbers(shown, page.standing(), fingerprint);
      if (!run.states || page.isPlain()) page.display.lookInto(shown, indices);
      if (news === undefined) await measure(page.display.panel, opened, run, indices, isOutdated);
      if (isOutdated()) return;
      const { summary, ahead } = page.standing();
      const status = statusOf(run, summary, ahead).join(' ').trim();
      element('announcement').textContent = news ?? `${status} ${element('note').textContent}`;
      document.body.dataset['measured'] = `${run.at}`;
      page.handOver();
    } catch (error) {
      if (!isOutdated()) page.fail(error);
    }
  }
}
