/** The page: opens meshes, starts runs, and draws and measures their iterations. */

import { EdgeflipError, type EdgeState } from 'edgeflip';
import { Choices, type Settings } from './choices.ts';
import { LOST } from './crash.ts';
import type { Flips } from './mesh-worker.ts';
import { element } from './controls.ts';
import { Display, type EdgeLook } from './display.ts';
import type { Gpu } from './engines.ts';
import { markSample } from './gallery.ts';
import { Graphics } from './graphics.ts';
import type { Replacement } from './handover.ts';
import { Jobs, showError, showProgress } from './jobs.ts';
import type { Place } from './link.ts';
import { Opening, type Opened } from './opening.ts';
import { onTheme } from '../shell/theme.ts';
import { Phases } from './phases.ts';
import { Player } from './player.ts';
import { Recovery } from './recovery.ts';
import { Measuring } from './measuring.ts';
import type { Run, Summary } from './run.ts';
import { captionOf, type Smallest } from './sentences.ts';
import type { Scene } from './scene.ts';
import type { Shown } from './shown.ts';
import { HALF } from './snapshot.ts';
import type { Source } from './sources.ts';
import { flipsAhead, startRun } from './starting.ts';
import { AutoHandover } from './auto-handover.ts';
import type { RunStatus } from './transport.ts';
import { Cancelled } from './worker-client.ts';

export class Page {
  readonly player: Player = new Player({
    run: () => this.#run,
    ahead: () => this.#ahead,
    isBusy: () => this.#jobs.isBusy,
    redraw: () => this.redraw(),
    lookAhead: async () => this.shown && this.#display.lookAhead(this.shown),
    began: () => this.#showTransport(),
    paused: () => {
      this.#showTransport();
      void this.#measuring.begin();
    },
    fail: (error) => this.#showFailure(error),
  });
  readonly #graphics: Graphics = new Graphics(
    (reason) => void this.#recovery.recover(reason, true),
    () => {
      this.#display.pictured();
      this.phases.draw();
    },
  );
  readonly #display: Display = new Display(
    this.#graphics,
    (at) => void this.player.seek(at),
    (from, to) => this.#draw(from, to),
  );
  /** The stops between the phases of an iteration. */
  readonly phases: Phases = new Phases({
    scene: () => this.scene,
    shown: () => this.shown,
    step: async () => (this.isBusy ? undefined : this.player.step()),
    back: () => this.player.seekBy(-1),
    redraw: () => this.redraw(),
    colour: () => void (this.#display.look = 'coloured'),
  });
  readonly #draw: (from: number, to: number) => void;
  readonly #jobs = new Jobs(
    () => this.#showTransport(),
    () => this.#endOfJob(),
  );
  readonly #choices = new Choices();
  readonly #recovery = new Recovery({
    graphics: this.#graphics,
    jobs: this.#jobs,
    choices: this.#choices,
    state: () => ({ opening: this.#opening, opened: this.#opened, run: this.#run, source: this.#source }),
    begin: (opened, signal) => this.#begin(opened, signal),
    open: (source) => this.open(source),
    redraw: () => this.redraw(),
    fail: (error) => this.#showFailure(error),
    pause: () => this.player.pause(),
    onGpuLost: () => this.#onGpuLost,
  });
  readonly #handover = new AutoHandover({
    run: () => this.#run,
    isIdle: () => !this.#jobs.isBusy && this.player.isAtRest && this.#measuring.isMeasured(this.#run),
    replaceRun: (next) => this.#replaceRun(next),
    showRun: () => void (this.player.isPlaying || this.#measuring.begin()),
  });
  readonly #measuring: Measuring = new Measuring({
    display: this.#display,
    status: () => this.#status,
    shown: () => this.shown,
    setSummary: (summary) => (this.#summary = summary),
    setSmallest: (smallest) => {
      this.#smallest = smallest;
      this.#showTransport();
    },
    isPlain: () => this.edges !== 'coloured',
    handOver: () => void this.#handover.handOver(),
    fail: (error) => this.#showFailure(error),
  });
  /** The source of the last mesh that the user chose. */
  #source: Source | undefined;
  /** The mesh that is being opened, until its run starts or fails or is cancelled. */
  #opening: Opening | undefined;
  /** The open mesh, its run, and the settings of that run. */
  #opened: Opened | undefined;
  #run: Run | undefined;
  #settings: Settings | undefined;
  /** The summary of the run when it last paused. */
  #summary: Summary | undefined;
  #smallest: Smallest | undefined;
  /** The flips of all its iterations, once they have been counted. */
  #ahead: Flips[] | undefined;
  /** Called with the reason when the GPU is lost while something else is shown in place of a run. */
  #onGpuLost: ((reason: string) => void) | undefined;

  /** `draw` is called with the ends of an edge that the user draws. */
  constructor(draw: (from: number, to: number) => void) {
    this.#draw = draw;
    this.#display.phases = this.phases;
  }

  /** Starts the page, with a mesh unless something else is shown in place of a run. */
  async start(source: Source | undefined): Promise<void> {
    this.#display.recolour();
    this.#display.panel.clear();
    onTheme(() => {
      this.#display.recolour();
      void this.redraw();
    });
    this.#graphics.open();
    if (source) await this.open(source);
  }

  /** Ends the run, and shows nothing. `lost` is called with the reason when the GPU is lost meanwhile. */
  leave(lost: (reason: string) => void): void {
    this.#onGpuLost = lost;
    this.player.pause();
    this.closeAll();
    this.#display.clear();
    this.#run?.free();
    this.#opened?.close();
    this.#opened?.extras?.close();
    this.#run = this.#opened = this.#settings = this.#summary = this.#ahead = this.#source = undefined;
    this.#smallest = undefined;
    this.#jobs.cancel();
    this.#measuring.forget();
  }

  /** Takes the engine and the limits of a link for the next mesh. */
  prefer({ engine, beta, deviation, features }: Place): void {
    this.#choices.prefer({ backend: engine, maxNormalAngle: beta, maxDeviation: deviation, features });
  }

  /** Opens a mesh, which replaces the open mesh, or the mesh that is being opened. */
  async open(source: Source): Promise<void> {
    this.#opening?.close();
    this.#onGpuLost = undefined;
    const opening = new Opening(source, showProgress);
    this.#opening = opening;
    this.#source = source;
    this.#choices.suggest(source.beta);
    await this.#jobs.attempt(`Opening ${source.title ?? source.name}…`, async (signal) => {
      const opened = await opening.read;
      signal.throwIfAborted();
      showProgress('Preparing the mesh…');
      await this.#begin(opened, signal);
    });
  }

  /** Starts a run with the chosen engine and limits: of the mesh that is being opened, else of the open mesh. */
  async begin(): Promise<void> {
    try {
      this.#choices.enter();
    } catch (error) {
      return showError(error);
    }
    // A mesh that is still being read will start with these settings.
    if (this.#opening && !this.#opening.opened) return;
    const opened = this.#opening?.opened ?? this.#opened;
    if (opened) await this.#jobs.attempt('Preparing the mesh…', (signal) => this.#begin(opened, signal));
  }

  cancel(): void {
    this.#jobs.cancel();
  }

  /** Shows the input beside the shown state, or ends that. The input itself is compared with the result. */
  async compare(): Promise<void> {
    const { comparison, inspection } = this.#display;
    const run = this.#run;
    if (!run || this.isBusy) return;
    inspection.close();
    if (comparison.isShown) return comparison.show(false);
    if (run.at === 0) {
      this.player.pause();
      await this.#jobs.attempt('Running to the end…', (signal) => this.#runToEnd(run, signal));
      await this.redraw();
    }
    // The run may have moved to the GPU meanwhile, or another mesh is being opened.
    if (this.#run && this.#run.at > 0 && !this.isBusy) comparison.show(true);
  }

  /** Shows the last state, and first runs what is missing. If that fails or is cancelled, shows the input. */
  async #runToEnd(run: Run, signal: AbortSignal): Promise<void> {
    try {
      run.seek(run.iterations.length);
      while (!signal.aborted && (await run.forward()));
    } catch (error) {
      this.#showFailure(error);
    }
    if (!run.hasEnded) run.seek(0);
  }

  inspectNext(by: 1 | -1): void {
    this.#display.inspection.next(by);
  }

  /**
   * Closes what lies on top: a message, the inspector, before and now, or the drawing of edges. Returns whether there was
   * something to close.
   */
  closeTopmost(): boolean {
    const { inspection, comparison, edgeDrawing } = this.#display;
    const { isHeld } = inspection;
    if (!element('error').hidden) element('error').hidden = true;
    else if (comparison.isShown && !isHeld) comparison.show(false);
    else if (edgeDrawing.isOn && !isHeld) edgeDrawing.show(false);
    else {
      inspection.close();
      return isHeld;
    }
    return true;
  }

  /** Inspects an edge in this state, near the middle of the picture. */
  inspectNearest(state: EdgeState): void {
    this.#display.inspection.nearest(state);
  }

  /** Closes the inspector, shows one mesh only, and draws no edges. */
  closeAll(): void {
    this.#display.edgeDrawing.show(false);
    this.#display.inspection.close();
    this.#display.comparison.show(false);
  }

  set edges(look: EdgeLook) {
    this.#display.look = look;
    void this.redraw();
  }

  /** Shows the colours of the file, or a plain surface, if there is a choice. */
  toggleSurface(): void {
    this.#display.surface.toggle();
  }

  get edges(): EdgeLook {
    return this.#display.look;
  }

  /** What is shown; `undefined` before the first mesh. */
  get shown(): Shown | undefined {
    const [opened, run, settings] = [this.#opened, this.#run, this.#settings];
    return opened && run && settings && { opened, run, settings };
  }

  get scene(): Scene | undefined {
    return this.#graphics.scene;
  }

  /** Whether a job is running. */
  get isBusy(): boolean {
    return this.#jobs.isBusy;
  }

  /** A picture of iteration `at`, which is shown from then on. */
  async pictureAt(at: number): Promise<OffscreenCanvas | undefined> {
    const [shown, scene] = [this.shown, this.scene];
    if (!shown || !scene) return undefined;
    shown.run.seek(at);
    await this.#display.draw(shown);
    return scene.freePicture(HALF);
  }

  /** What is written under the picture of the shown state, once that is measured. */
  async caption(): Promise<string> {
    if (!this.#measuring.isMeasured(this.#run)) await this.#measuring.begin();
    const { run, summary, ahead, smallest } = this.#status;
    return run ? captionOf(run, summary, ahead, smallest) : '';
  }

  get gpu(): Gpu | string | undefined {
    return this.#graphics.gpu;
  }

  /** Settles when `scene` and `gpu` have their final values. */
  get ready(): Promise<void> {
    return this.#graphics.ready;
  }

  /** Settles when no job runs, and the screen shows what the jobs have led to. */
  async drawn(): Promise<void> {
    do {
      await this.#jobs.idle();
      await this.#graphics.ready;
      await this.scene?.shown();
    } while (this.#jobs.isBusy);
  }

  /** Runs a long job that can be cancelled, and shows its error. */
  attempt(text: string, work: (signal: AbortSignal) => Promise<void>): Promise<void> {
    return this.#jobs.attempt(text, work);
  }

  /** Draws the shown iteration of the run. */
  async redraw(): Promise<void> {
    const shown = this.shown;
    if (!shown) return;
    this.#display.inspection.forget();
    this.#display.showNumbers(shown, this.#status);
    if (!this.#measuring.knowsAngles(shown.run)) this.#display.panel.awaitQuality();
    void (this.player.isPlaying ? this.#measuring.glance() : this.#measuring.begin());
    try {
      await this.#display.draw(shown);
    } catch (error) {
      this.#showFailure(error);
    }
  }

  /** Starts a run. If this fails, the previous run stays. */
  async #begin(opened: Opened, signal: AbortSignal): Promise<void> {
    const { settings } = this.#choices;
    const { run, options } = await startRun(opened, settings, this.#graphics, signal);
    const isNew = this.#opened !== opened;
    // Scrambled triangles have the same vertices, and the camera stays.
    const isOther = this.#opened?.mesh.positions !== opened.mesh.positions;
    this.#graphics.scene?.clear();
    this.#run?.free();
    this.#run = run;
    if (isNew) this.#opened?.close();
    if (this.#opened?.extras !== opened.extras) this.#opened?.extras?.close();
    this.#opened = opened;
    if (this.#opening?.opened === opened) this.#opening = undefined;
    this.#settings = settings;
    this.#summary = undefined;
    this.#smallest = undefined;
    this.#ahead = undefined;
    this.#display.begin(opened, isOther);
    this.#handover.prepare(run, opened, options, this.#graphics.gpu);
    await this.redraw();
    this.player.pause();
    void this.#lookAhead(run, opened, options);
    void this.#findColours(opened);
  }

  /** Finds the colours of the file after the first picture, and says which are not drawn. */
  async #findColours(opened: Opened): Promise<void> {
    await this.scene?.shown();
    if (opened !== this.#opened) return;
    try {
      await this.#display.surface.find();
    } catch (error) {
      this.#showFailure(error);
    }
    if (opened === this.#opened) this.#showTransport();
  }

  /** Counts the flips of all iterations, after the first picture is seen: counting would hold it up. */
  async #lookAhead(run: Run, ...settings: Parameters<typeof flipsAhead>): Promise<void> {
    await this.scene?.seen();
    const ahead = await flipsAhead(...settings);
    if (run !== this.#run || !ahead) return;
    this.#ahead = ahead;
    this.#showTransport();
  }

  /** Replaces the run by the same run on the GPU. */
  #replaceRun(next: Replacement): void {
    const before = this.#run;
    [this.#run, this.#summary] = [next.run, next.summary];
    if (this.shown) this.#display.replaceRun(this.shown, next);
    before?.free();
    void this.#measuring.begin('Now on WebGPU.');
  }

  #endOfJob(): void {
    this.#opening?.close();
    this.#opening = undefined;
    this.#showChoices();
    this.#showTransport();
    // The job may have cancelled a measurement, so measure again.
    if (!this.player.isPlaying) void this.#measuring.begin();
  }

  /** Shows an error, unless the page's device was lost: `Graphics` reports that, and the page recovers. */
  #showFailure(error: unknown): void {
    if (error instanceof Error && error.name === LOST) {
      // A present job may be the recovery. If not, the measurement after it calls the worker again, and fails again.
      if (!this.#jobs.isBusy) void this.#recovery.recover(error.message, false);
      return;
    }
    const isLost = error instanceof EdgeflipError && error.code === 'device-failed';
    if (!isLost && !(error instanceof Cancelled) && !(error instanceof DOMException)) showError(error);
  }

  get #status(): RunStatus {
    const [run, opened, summary, ahead] = [this.#run, this.#opened, this.#summary, this.#ahead];
    const [smallest, isBusy, isPlaying] = [this.#smallest, this.#jobs.isBusy, this.player.isPlaying];
    return { run, opened, summary, ahead, smallest, isBusy, isPlaying };
  }

  #showTransport(): void {
    if (this.#onGpuLost) return;
    this.#display.showTransport(this.#status);
  }

  /** Shows the mesh and the settings of the run again, after another choice has failed. */
  #showChoices(): void {
    const shown = this.shown;
    if (!shown) return;
    markSample(shown.opened.origin ?? '');
    this.#choices.set(shown.settings);
  }
}
