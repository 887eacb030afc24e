/** The page between its controls and its engines: opens meshes, begins runs, draws and measures what they do. */

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
import { palette } from './palette.ts';
import { Panel } from './panel.ts';
import { Player } from './player.ts';
import type { OpenMesh, Run, Summary } from './run.ts';
import { sample, splitName, type Source } from './sources.ts';
import { showTransport, statusOf } from './transport.ts';
import { unitPositions } from './unit.ts';

/** Meshes of up to so many triangles are shown with their edges from the start. */
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
  /** The mesh that was asked for last. */
  #source: Source | undefined;
  /** It, until a run of it has begun, or that has failed or was cancelled. */
  #opening: Opening | undefined;
  /** The mesh that is open, its run, and what that was begun with. */
  #opened: Opened | undefined;
  #run: Run | undefined;
  #settings: Settings | undefined;
  /** Puts the run on the GPU, where it waits for that. */
  #handover: Handover | undefined;
  /** What the run said of itself when it last came to rest. */
  #summary: Summary | undefined;
  /** Count the states that are drawn and that come to rest: what has been overtaken gives way. */
  #draws = 0;
  #rests = 0;
  /** Whose run has lost a GPU before. */
  #lost: Opened | undefined;

  async start(spec: string): Promise<void> {
    this.#panel.setPalette(palette());
    this.#panel.clear();
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.#recolour());
    this.#graphics.open();
    const opening = this.open(sample(spec));
    startWorker();
    await opening;
  }

  /** Opens a mesh in place of the one that is open or being opened. */
  async open(source: Source): Promise<void> {
    this.#opening?.close();
    const opening = new Opening(source, showProgress);
    this.#opening = opening;
    this.#source = source;
    await this.#jobs.attempt(`Opening ${source.name}…`, async (signal) => {
      const opened = await opening.read;
      signal.throwIfAborted();
      showProgress('Preparing the mesh…');
      await this.#begin(opened, signal);
    });
  }

  /** Takes the engine and β that were chosen: for the mesh that is being opened, else for the one that is open. */
  async begin(): Promise<void> {
    try {
      this.#choices.enter();
    } catch (error) {
      return showError(error);
    }
    // What is still being read begins with them.
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

  /** Draws the state that the run is in. */
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

  /** Draws the triangles, and their lines where no edges are coloured; returns the states of those that are. */
  #showTriangles(run: Run, { mesh }: Opened): Uint8Array | undefined {
    const states = controls.wireframe.checked ? run.states : undefined;
    const lines = controls.wireframe.checked && !states ? run.lines() : undefined;
    this.#graphics.scene?.show(run.drawn, mesh.indices.length, lines);
    return states;
  }

  /** Begins a run; the one before it stays if this fails. */
  async #begin(opened: Opened, signal: AbortSignal): Promise<void> {
    const { settings } = this.#choices;
    const { mesh } = opened;
    if (waitsForGpu(mesh, settings.backend)) await this.#graphics.ready;
    signal.throwIfAborted();
    const compiles =
      settings.backend === 'webgpu' &&
      typeof this.#graphics.gpu === 'object' &&
      !this.#graphics.gpu.kernels.areReadyFor(mesh);
    if (compiles) showProgress('Compiling the GPU’s programs…');
    const run = await beginRun(mesh, settings, this.#graphics.gpu, signal);
    // What draws comes with it.
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

  /** Makes the GPU ready behind a run that `auto` has begun on the CPU, or lets it say why it stays there. */
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

  /** Goes over to the GPU that is ready, as soon as nothing goes on. The picture is the same. */
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
    // What was being measured may have been cancelled with it.
    if (!this.#player.isPlaying) void this.#rest();
  }

  /** One iteration on, drawn. Returns whether there was one. */
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

  /** A lost device of the page is told by the device itself, which also sees to what follows. */
  #showFailure(error: unknown): void {
    if (error instanceof Error && error.name === LOST) {
      // What goes on may be the recovery; else the measurement after it asks the worker again.
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

  /** What was chosen in vain gives way to what the run was begun with. */
  #showChoices(): void {
    const [opened, settings] = [this.#opened, this.#settings];
    if (!opened || !settings) return;
    // The empty value stands for a file.
    const names = Array.from(controls.sample.options, ({ value }) => value);
    controls.sample.value = names.find((name) => name === opened.name) ?? '';
    this.#choices.set(settings);
  }

  /** Measures the run and the state that is shown, once nothing has changed for a while; where there is news, only the run. */
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
   * The device is gone, and with it what was drawn; or the context of the worker is. The run goes the same way again,
   * to the same bits.
   */
  async #recover(reason: string, isOfPage: boolean): Promise<void> {
    const [run, opening] = [this.#run, this.#opening];
    let hasRecovered = false;
    await this.#jobs.attempt('The GPU was lost; going on from the input…', async (signal) => {
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
      // What has lost the GPU twice would go on losing it; `auto` does not go back to it with what was on it.
      const [isAuto, isOnGpu] = [settings.backend === 'auto', !opening && !run?.isInWorker];
      const isHopeless = isAgain ? opening || isOnGpu || isAuto : isOnGpu && isAuto;
      if (!isOfPage || isHopeless) this.#choices.set({ ...settings, backend: 'cpu' });
      await this.#begin(opened, signal);
      if (!opening && run) await this.#goThere(run, signal);
      hasRecovered = true;
    });
    // What was chosen meanwhile has taken its place.
    if (this.#jobs.isBusy) return;
    const lost = `The GPU was lost (${reason}).`;
    if (hasRecovered) {
      this.#player.pause();
      const andNow = opening
        ? 'The mesh was opened all the same'
        : 'The run went the same way again, to the same triangles';
      showError(new Error(`${lost} ${andNow}.`));
    } else if (!this.#opened && this.#source) {
      await this.open(this.#source);
    } else if (element('error').hidden) {
      showError(new Error(`${lost} Choose an engine to go on.`));
    }
  }

  /** Lets the run go the way of the one before it. */
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
