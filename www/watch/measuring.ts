/** Measures what is shown, when nothing changes for a while. */

import { digestOf, fingerprintOf } from '../shell/digest.ts';
import { element } from './controls.ts';
import type { Display } from './display.ts';
import type { Quality } from './mesh-worker.ts';
import { BINS, type Opened } from './opening.ts';
import { canScramble, COLOURED, type Run, type Summary } from './run.ts';
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
  /** The measures that were taken last, and of which state. */
  #last: { run: Run; at: number; quality: Quality } | undefined;
  #isGlancing = false;

  constructor(host: MeasuringHost) {
    this.#host = host;
  }

  /** Whether the shown state of the run is measured. */
  isMeasured(run: Run | undefined): boolean {
    return document.body.dataset['measured'] === `${run?.at}`;
  }

  /** Whether the angles of the shown state of the run are those that were measured last. */
  knowsAngles(run: Run): boolean {
    return this.#last?.run === run && this.#last.at === run.at;
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
      await host.display.countLocks(shown);
      if (isOutdated()) return;
      const indices = await run.triangles();
      const fingerprint = fingerprintOf(await digestOf(indices));
      if (isOutdated()) return;
      host.display.showNumbers(shown, host.status(), fingerprint);
      if (!run.states || host.isPlain()) host.display.lookInto(shown, indices);
      host.display.measureEdges(indices);
      const measured = news === undefined ? await this.#measure(opened, run, indices, isOutdated) : undefined;
      if (measured) await this.#compare(opened, run, indices, measured, isOutdated);
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

  /** Measures the angles of the shown state of a small mesh while it plays. A state that comes meanwhile is left out. */
  async glance(): Promise<void> {
    const host = this.#host;
    const shown = host.shown();
    if (!shown || this.#isGlancing || shown.opened.mesh.indices.length > 3 * COLOURED) return;
    const { run, opened } = shown;
    const { at } = run;
    this.#isGlancing = true;
    try {
      await this.#measure(opened, run, await run.triangles(), () => run !== host.shown()?.run || run.at !== at);
    } catch (error) {
      if (run === host.shown()?.run) host.fail(error);
    } finally {
      this.#isGlancing = false;
    }
  }

  /** Measures `indices`, the shown triangles of `run`, and shows the angles unless they are outdated by then. */
  async #measure(
    { mesh, client, before: measureInput }: Opened,
    run: Run,
    indices: Uint32Array,
    isOutdated: () => boolean,
  ): Promise<[before: Quality, now: Quality] | undefined> {
    const { at } = run;
    const before = await measureInput();
    const known = at === 0 ? before : this.knowsAngles(run) ? this.#last?.quality : undefined;
    const now = known ?? (await client.call((worker) => worker.measure({ ...mesh, indices }, BINS)));
    if (isOutdated()) return undefined;
    this.#last = { run, at, quality: now };
    this.#host.display.panel.showQuality(before, now);
    this.#host.setSmallest({ at, before: before.angles.meanMin, now: now.angles.meanMin });
    return [before, now];
  }

  /** Compares the last state with the input, and shows how far they differ. */
  async #compare(
    { mesh, client }: Opened,
    run: Run,
    indices: Uint32Array,
    measured: [before: Quality, now: Quality],
    isOutdated: () => boolean,
  ): Promise<void> {
    if (!run.isOver) return;
    const change = await client.call((worker) => worker.compare(mesh, indices));
    if (!isOutdated()) this.#host.display.panel.showQuality(...measured, change);
  }
}

/** Has screen readers say something, once: what is measured again is not said again. */
function announce(words: string): void {
  const region = element('announcement');
  if (region.textContent !== words) region.textContent = words;
}
