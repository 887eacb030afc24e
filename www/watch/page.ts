/** The page: opens meshes, starts runs, and draws and measures their iterations. */

import { EdgeflipError } from 'edgeflip';
import { Choices, type Settings } from './choices.ts';
import { controls, element } from './controls.ts';
import { LOST } from './crash.ts';
import { download } from './download.ts';
import { beginBehind, beginRun, Cancelled, forAuto, startWorker, waitsForGpu } from './engines.ts';
import { Graphics } from './graphics.ts';
import { Handover } from './handover.ts';
import { Jobs, showError, showProgress } from './jobs.ts';
import { fingerprintOf, measure } from './measure.ts';
import { Opening, type Opened } from './opening.ts';
import { onTheme } from '../shell/theme.ts';
import { palette } from './palette.ts';
import { Panel } from './panel.ts';
import { Player } from './player.ts';
import type { OpenMesh, Run, Summary } from './run.ts';
import { splitName, type Source } from './sources.ts';
import { showTransport, statusOf } from './transport.ts';
import { unitPositions } from './unit.ts';

/** The most triangles of a mesh that is first shown with its edges. */
const EDGES_SEEN = 50_000;
/** Milliseconds without a change after which a state is measured. */
const QUIET = 150;

export class Page {
  readonly #panel = new Panel((at) => this.seek(at));
  readonly #player = new Player(
    (run) => this.#forward(run),
    () => {
      this.#showTransport();
      void this.#rest();
    },
  );
  readonly #graphics = new Graphics((reason) => void this.#recover(reason, true));
  readonly #jobs = new Jobs(
    () => this.#showTransport(),
    () => this.#endOfJob(),
  );
  readonly #choices = new Choices();
  /** The source of the last mesh that the user chose. */
  #source: Source | undefined;
  /** The mesh that is being opened, until its run starts or fails or is cancelled. */
  #opening: Opening | undefined;
  /** The open mesh, its run, and the settings of that run. */
  #opened: Opened | undefined;
  #run: Run | undefined;
  #settings: Settings | undefined;
  /** Moves the run to the GPU, if it waits for the GPU. */
  #handover: Handover | undefined;
  /** The summary of the run when it last paused. */
  #summary: Summary | undefined;
  /** The numbers of calls of `redraw` and of `#rest` so far. A call stops when a later call begins. */
  #draws = 0;
  #rests = 0;
  /** The mesh whose run has lost a GPU before. */
  #lost: Opened | undefined;

  async start(source: Source): Promise<void> {
    this.#panel.setPalette(palette());
    this.#panel.clear();
    onTheme(() => this.#recolour());
    this.#graphics.open();
    const opening = this.open(source);
    startWorker();
    await opening;
  }

  /** Opens a mesh, which replaces the open mesh, or the mesh that is being opened. */
  async open(source: Source): Promise<void> {
    this.#opening?.close();
    const opening = new Opening(source, showProgress);
    this.#opening = opening;
    this.#source = source;
    this.#choices.suggest(source.beta);
    await this.#jobs.attempt(`Opening ${source.name}…`, async (signal) => {
      const opened = await opening.read;
      signal.throwIfAborted();
      showProgress('Preparing the mesh…');
      await this.#begin(opened, signal);
    });
  }

  /** Starts a run with the chosen engine and β: of the mesh that is being opened, else of the open mesh. */
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

  async play(): Promise<void> {
    if (this.#player.isPlaying) return this.#player.pause();
    if (!this.#run) return;
    const playing = this.#player.play(this.#run, () => Number(controls.speed.value));
    this.#showTransport();
    await playing;
  }

  async step(): Promise<void> {
    if (this.#run) await this.#player.step(this.#run);
  }

  seek(at: number): void {
    if (this.#jobs.isBusy || !this.#run) return;
    this.#run.seek(Math.max(0, Math.min(at, this.#run.iterations.length)));
    this.#player.pause();
    void this.redraw();
  }

  seekBy(iterations: number): void {
    if (this.#run) this.seek(this.#run.at + iterations);
  }

  async download(): Promise<void> {
    const [run, opened] = [this.#run, this.#opened];
    if (!run || !opened) return;
    const [stem, extension] = splitName(opened.name);
    const name = `${stem.replaceAll(' ', '-')}-after-${run.at}${extension}`;
    await this.#jobs.attempt('Writing the file…', async (signal) => {
      const mesh = { ...opened.mesh, indices: await run.triangles() };
      signal.throwIfAborted();
      await download(mesh, name, opened.kept, signal);
    });
  }

  /** Draws the shown iteration of the run. */
  async redraw(): Promise<void> {
    const [run, opened, scene] = [this.#run, this.#opened, this.#graphics.scene];
    if (!run || !opened) return;
    const draw = ++this.#draws;
    this.#panel.showIterations(run.iterations, run.at);
    this.#panel.showFacts(opened.mesh, run, this.#summary, this.#settings?.maxNormalAngle, undefined);
    this.#panel.showLegend(run.states, this.#summary);
    this.#showTransport();
    if (!this.#player.isPlaying) void this.#rest();
    if (!scene) return;
    const states = this.#showTriangles(run, opened);
    try {
      const indices = states && (await run.triangles());
      if (draw === this.#draws) scene.showEdges(indices, states);
    } catch (error) {
      if (draw === this.#draws) this.#showFailure(error);
    }
  }

  /** Draws the triangles. If edges are coloured, returns their states; else draws the outlines of the triangles. */
  #showTriangles(run: Run, { mesh }: Opened): Uint8Array | undefined {
    const states = controls.wireframe.checked ? run.states : undefined;
    const lines = controls.wireframe.checked && !states ? run.lines() : undefined;
    this.#graphics.scene?.show(run.drawn, mesh.indices.length, lines);
    return states;
  }

  /** Starts a run. If this fails, the previous run stays. */
  async #begin(opened: Opened, signal: AbortSignal): Promise<void> {
    const { settings } = this.#choices;
    const { mesh } = opened;
    if (waitsForGpu(mesh, settings.backend)) await this.#graphics.ready;
    signal.throwIfAborted();
    const compiles =
      settings.backend === 'webgpu' &&
      typeof this.#graphics.gpu === 'object' &&
      !this.#graphics.gpu.kernels.areReadyFor(mesh);
    if (compiles) showProgress('Compiling the kernels for the GPU…');
    const run = await beginRun(mesh, settings, this.#graphics.gpu, signal);
    // The scene opens together with the GPU.
    await this.#graphics.ready;
    if (signal.aborted) {
      run.free();
      throw signal.reason;
    }
    const isNew = this.#opened !== opened;
    this.#graphics.scene?.clear();
    this.#run?.free();
    this.#run = run;
    if (isNew) this.#opened?.office.close();
    this.#opened = opened;
    if (this.#opening?.opened === opened) this.#opening = undefined;
    this.#settings = settings;
    this.#summary = undefined;
    this.#graphics.scene?.setMesh(unitPositions(mesh), mesh.dimension);
    if (isNew || !this.#graphics.scene?.isLooking) this.#graphics.scene?.lookAtAll();
    if (isNew) controls.wireframe.checked = mesh.indices.length <= 3 * EDGES_SEEN;
    element('no-mesh').hidden = this.#graphics.scene !== undefined;
    element('beta-label').hidden = mesh.dimension === 2;
    this.#panel.clear();
    this.#expectGpu(run, mesh, settings);
    await this.redraw();
    this.#player.pause();
  }

  /** Prepares the GPU during a run that `auto` has started on the CPU, or sets the reason why the run stays there. */
  #expectGpu(run: Run, mesh: OpenMesh, settings: Settings): void {
    this.#handover?.close();
    this.#handover = undefined;
    if (
      settings.backend !== 'auto' ||
      !run.isInWorker ||
      run.fallback !== undefined ||
      this.#graphics.gpu === undefined
    )
      return;
    const gpu = forAuto(this.#graphics.gpu);
    if (typeof gpu === 'string') {
      run.fallback = gpu;
      return;
    }
    run.awaitsGpu = true;
    const begin = () => beginBehind(mesh, settings, gpu);
    this.#handover = new Handover(
      begin,
      () => void this.#handOver(),
      (error) => this.#stayOnCpu(run, error),
    );
  }

  /** Moves the run to the GPU when the GPU is ready and the page is idle. The picture stays the same. */
  async #handOver(): Promise<void> {
    const [run, opened, handover] = [this.#run, this.#opened, this.#handover];
    if (!run || !opened || !handover) return;
    const isMeasured = () => document.body.dataset['measured'] === `${run.at}`;
    const isAtRest = () => run === this.#run && !this.#jobs.isBusy && this.#player.isAtRest && isMeasured();
    try {
      const next = await handover.follow(run, isAtRest);
      if (!next) return;
      [this.#run, this.#summary, this.#handover] = [next.run, next.summary, undefined];
      this.#showTriangles(next.run, opened);
      run.free();
      this.#panel.showTimes(next.run.iterations);
      void this.#rest('Now on WebGPU.');
    } catch (error) {
      if (handover === this.#handover) this.#stayOnCpu(run, error);
    }
  }

  #stayOnCpu(run: Run, error: unknown): void {
    this.#handover?.close();
    this.#handover = undefined;
    run.awaitsGpu = false;
    run.fallback = error instanceof Error ? error.message : String(error);
    if (!this.#player.isPlaying) void this.#rest();
  }

  #endOfJob(): void {
    this.#opening?.close();
    this.#opening = undefined;
    this.#showChoices();
    this.#showTransport();
    // The job may have cancelled a measurement, so measure again.
    if (!this.#player.isPlaying) void this.#rest();
  }

  /** Moves forward by one iteration and draws it. Returns whether there was one. */
  async #forward(run: Run): Promise<boolean> {
    try {
      const went = await run.forward();
      if (run === this.#run) await this.redraw();
      return went && run === this.#run;
    } catch (error) {
      if (run === this.#run) this.#showFailure(error);
      return false;
    }
  }

  /** Shows an error, unless the page's device was lost: `Graphics` reports that, and the page recovers. */
  #showFailure(error: unknown): void {
    if (error instanceof Error && error.name === LOST) {
      // A present job may be the recovery. If not, the measurement after it calls the worker again, and fails again.
      if (!this.#jobs.isBusy) void this.#recover(error.message, false);
      return;
    }
    const isLost = error instanceof EdgeflipError && error.code === 'device-failed';
    if (!isLost && !(error instanceof Cancelled) && !(error instanceof DOMException)) showError(error);
  }

  #showTransport(): void {
    const [run, opened, summary] = [this.#run, this.#opened, this.#summary];
    showTransport({ run, opened, summary, isBusy: this.#jobs.isBusy, isPlaying: this.#player.isPlaying });
  }

  /** Shows the mesh and the settings of the run again, after another choice has failed. */
  #showChoices(): void {
    const [opened, settings] = [this.#opened, this.#settings];
    if (!opened || !settings) return;
    // The empty value stands for a file.
    const names = Array.from(controls.sample.options, ({ value }) => value);
    controls.sample.value = names.find((name) => name === opened.name) ?? '';
    this.#choices.set(settings);
  }

  /**
   * Measures the run and the shown triangles, if nothing changes for a while. With `news`, announces it and does not
   * measure the triangles.
   */
  async #rest(news?: string): Promise<void> {
    const [run, opened] = [this.#run, this.#opened];
    if (!run || !opened) return;
    const rest = ++this.#rests;
    const isOutdated = () => rest !== this.#rests || this.#player.isPlaying || run !== this.#run;
    delete document.body.dataset['measured'];
    await new Promise((resolve) => setTimeout(resolve, QUIET));
    if (isOutdated()) return;
    try {
      if (this.#summary?.iterations !== run.iterations.length) {
        const summary = await run.result();
        if (run === this.#run) this.#summary = summary;
      }
      if (isOutdated()) return;
      const indices = await run.triangles();
      const fingerprint = await fingerprintOf(indices);
      if (isOutdated()) return;
      this.#panel.showFacts(opened.mesh, run, this.#summary, this.#settings?.maxNormalAngle, fingerprint);
      this.#panel.showLegend(run.states, this.#summary);
      this.#showTransport();
      if (news === undefined) await measure(this.#panel, opened, run, indices, isOutdated);
      if (isOutdated()) return;
      element('announcement').textContent = news ?? `${statusOf(run)}. ${element('note').textContent}`;
      document.body.dataset['measured'] = `${run.at}`;
      void this.#handOver();
    } catch (error) {
      if (!isOutdated()) this.#showFailure(error);
    }
  }

  /**
   * Repeats the run after a loss: of the page's device with the pictures on it, or of the worker's context. The
   * triangles are the same, bit for bit.
   */
  async #recover(reason: string, isOfPage: boolean): Promise<void> {
    const [run, opening] = [this.#run, this.#opening];
    let hasRecovered = false;
    await this.#jobs.attempt('The GPU was lost; starting again…', async (signal) => {
      if (isOfPage) {
        this.#graphics.open();
        await this.#graphics.ready;
      }
      const opened = (await opening?.read) ?? this.#opened;
      signal.throwIfAborted();
      if (!opened) return;
      const { settings } = this.#choices;
      const isAgain = this.#lost === opened;
      this.#lost = opened;
      // A mesh that lost the GPU twice would probably lose it again. `auto` does not repeat a run on the GPU that it
      // lost.
      const [isAuto, isOnGpu] = [settings.backend === 'auto', !opening && !run?.isInWorker];
      const isHopeless = isAgain ? opening || isOnGpu || isAuto : isOnGpu && isAuto;
      if (!isOfPage || isHopeless) this.#choices.set({ ...settings, backend: 'cpu' });
      await this.#begin(opened, signal);
      if (!opening && run) await this.#goThere(run, signal);
      hasRecovered = true;
    });
    // The user has started another job meanwhile.
    if (this.#jobs.isBusy) return;
    const lost = `The GPU was lost (${reason}).`;
    if (hasRecovered) {
      this.#player.pause();
      const andNow = opening ? 'The mesh was opened nevertheless' : 'The run was repeated, with the same triangles';
      showError(new Error(`${lost} ${andNow}.`));
    } else if (!this.#opened && this.#source) {
      await this.open(this.#source);
    } else if (element('error').hidden) {
      showError(new Error(`${lost} Choose an engine to continue.`));
    }
  }

  /** Repeats the iterations of the previous run. */
  async #goThere(before: Run, signal: AbortSignal): Promise<void> {
    try {
      await this.#run?.follow(before, signal);
    } catch (error) {
      this.#showFailure(error);
    }
    await this.redraw();
  }

  #recolour(): void {
    const colours = palette();
    this.#graphics.scene?.setPalette(colours);
    this.#panel.setPalette(colours);
    void this.redraw();
  }
}
