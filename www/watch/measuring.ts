/** Measures what is shown, when nothing changes for a while. */

import { digestOf, fingerprintOf } from '../shell/digest.ts';
import { element } from './controls.ts';
import type { Display } from './display.ts';
import { BINS, type Opened } from './opening.ts';
import { canScramble, type Run, type Summary } from './run.ts';
import { statusOf, type Smallest } from './sentences.ts';
import type { Shown } from './shown.ts';
import type { RunStatus } from './transport.ts';

/** Milliseconds without a change after which a state is measured. */
const QUIET = 150;

/** What it needs of the page. */
export interface MeasuringHost {
  readonly display: Display;
  status(): RunStatus;
  shown(): Shown | undefined;
  /** Takes the summary of the run. */
  setSummary(summary: Summary): void;
  /** Takes the angles of the shown state. */
  setSmallest(smallest: Smallest): void;
  /** Whether the edges have no colours. */
  isPlain(): boolean;
  /** Everything is measured. */
  handOver(): void;
  fail(error: unknown): void;
}

export class Measuring {
  readonly #host: MeasuringHost;
  /** The number of calls so far. A call stops when a later call begins. */
  #calls = 0;

  constructor(host: MeasuringHost) {
    this.#host = host;
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
    const host = this.#host;
    const shown = host.shown();
    if (!shown) return;
    const { run, opened } = shown;
    const call = ++this.#calls;
    const isOutdated = () => call !== this.#calls || host.status().isPlaying || run !== host.shown()?.run;
    delete document.body.dataset['measured'];
    await new Promise((resolve) => setTimeout(resolve, QUIET));
    // The picture comes first, because a measurement would hold it up.
    await host.display.painted();
    if (isOutdated()) return;
    try {
      if (host.status().summary?.iterations !== run.iterations.length) {
        const summary = await run.result();
        if (run === host.shown()?.run) host.setSummary(summary);
        // The engine learns only from another call that no edge can flip.
        if (run.isNewest && !run.hasEnded && !summary.remaining.stopped && !isOutdated()) await run.forward();
      }
      if (isOutdated()) return;
      await host.display.lookAhead(shown);
      if (isOutdated()) return;
      const indices = await run.triangles();
      const fingerprint = fingerprintOf(await digestOf(indices));
      if (isOutdated()) return;
      host.display.showNumbers(shown, host.status(), fingerprint);
      if (!run.states || host.isPlain()) host.display.lookInto(shown, indices);
      host.display.measureEdges(indices);
      if (news === undefined) await this.#measure(opened, run, indices, isOutdated);
      if (isOutdated()) return;
      const { summary, ahead, smallest } = host.status();
      const status = statusOf(run, summary, ahead, smallest, canScramble(opened.mesh)).join(' ').trim();
      announce(news ?? `${status} ${element('note').textContent}`);
      document.body.dataset['measured'] = `${run.at}`;
      host.handOver();
      await host.display.findStates(shown, isOutdated);
    } catch (error) {
      if (!isOutdated()) host.fail(error);
    }
  }

  /** Measures `indices`, the shown triangles of `run`, and shows the numbers unless they are outdated by then. */
  async #measure(
    { mesh, client, before: measureInput }: Opened,
    run: Run,
    indices: Uint32Array,
    isOutdated: () => boolean,
  ): Promise<void> {
    const { panel } = this.#host.display;
    const before = await measureInput();
    const now = run.at === 0 ? before : await client.call((worker) => worker.measure({ ...mesh, indices }, BINS));
    if (isOutdated()) return;
    panel.showQuality(before, now);
    this.#host.setSmallest({ at: run.at, before: before.angles.meanMin, now: now.angles.meanMin });
    if (!run.isOver) return;
    const change = await client.call((worker) => worker.compare(mesh, indices));
    if (!isOutdated()) panel.showQuality(before, now, change);
  }
}

/** Has screen readers say something, once: what is measured again is not said again. */
function announce(words: string): void {
  const region = element('announcement');
  if (region.textContent !== words) region.textContent = words;
}
