/** The page: opens meshes, plays their runs and shows what happens. */

import { EdgeflipError } from 'edgeflip';
import { FORMATS, type Angles, type FileMesh, type Mesh32 } from 'edgeflip/files';
import { element } from './element.ts';
import { beginRun, Cancelled, Office, openGpu, type Backend, type Gpu } from './engines.ts';
import { palette } from './palette.ts';
import { number, Panel, reasons } from './panel.ts';
import type { Run, Summary } from './run.ts';
import { FIRST, SAMPLES } from './samples.ts';
import { Scene } from './scene.ts';
import { unitPositions } from './unit.ts';

/** Meshes of up to so many triangles are shown with their edges from the start. */
const EDGES_SEEN = 50_000;
/** Bins of the histogram of angles: 5° each. */
const BINS = 36;

interface Opened {
  mesh: Mesh32;
  name: string;
  /** What reading the file did to it. */
  remark: string;
  before: Angles;
}

const view = element('view');
const controls = {
  file: element<HTMLInputElement>('file'),
  sample: element<HTMLSelectElement>('sample'),
  backend: element<HTMLSelectElement>('backend'),
  beta: element<HTMLInputElement>('beta'),
  reset: element<HTMLButtonElement>('reset'),
  play: element<HTMLButtonElement>('play'),
  step: element<HTMLButtonElement>('step'),
  slider: element<HTMLInputElement>('slider'),
  speed: element<HTMLSelectElement>('speed'),
  wireframe: element<HTMLInputElement>('wireframe'),
  download: element<HTMLButtonElement>('download'),
};

class Page {
  readonly #panel = new Panel((at) => this.seek(at));
  #gpu: Gpu | string = 'not looked for yet';
  #scene: Scene | undefined;
  #files = new Office();
  #opened: Opened | undefined;
  #run: Run | undefined;
  /** What goes on and can be cancelled. */
  #job: AbortController | undefined;
  #isPlaying = false;
  /** What the run said of itself when it last came to rest. */
  #summary: Summary | undefined;
  /** Counts the states that came to rest: only the newest is measured. */
  #rests = 0;

  async start(): Promise<void> {
    this.#panel.setPalette(palette());
    this.#panel.clear();
    this.#showTransport();
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.#recolour());
    await this.#attempt('Looking for a GPU…', () => this.#openGpu());
    await this.openSample(FIRST);
  }

  openSample(spec: string): Promise<void> {
    return this.#open(spec, () => this.#files.ask((desk) => desk.generate(spec)));
  }

  openFile(file: File): Promise<void> {
    return this.#open(file.name, async () => {
      const bytes = new Uint8Array(await file.arrayBuffer());
      return this.#files.ask((desk) => desk.read(bytes, file.name));
    });
  }

  /** Begins again with the same mesh, for another engine or β. */
  async begin(): Promise<void> {
    const opened = this.#opened;
    if (opened) await this.#attempt('Preparing the mesh…', (signal) => this.#begin(opened, signal));
  }

  cancel(): void {
    this.#job?.abort();
  }

  async play(): Promise<void> {
    if (this.#isPlaying) return this.pause();
    const run = this.#run;
    if (!run) return;
    if (run.isOver) run.seek(0);
    this.#isPlaying = true;
    await this.#draw();
    while (this.#isPlaying && run === this.#run) {
      const start = performance.now();
      if (!(await this.#forward(run))) break;
      await nextFrame();
      await pause(Number(controls.speed.value) - (performance.now() - start));
    }
    if (run === this.#run) this.pause();
  }

  pause(): void {
    this.#isPlaying = false;
    this.#showTransport();
    void this.#rest();
  }

  async step(): Promise<void> {
    this.#isPlaying = false;
    if (this.#run && (await this.#forward(this.#run), true)) this.pause();
  }

  seek(at: number): void {
    this.#isPlaying = false;
    this.#run?.seek(Math.max(0, Math.min(at, this.#run.iterations.length)));
    void this.#draw();
    this.pause();
  }

  seekBy(iterations: number): void {
    if (this.#run) this.seek(this.#run.at + iterations);
  }

  redraw(): void {
    void this.#draw();
  }

  async download(): Promise<void> {
    const [run, opened] = [this.#run, this.#opened];
    if (!run || !opened) return;
    const extension = FORMATS.find((known) => opened.name.toLowerCase().endsWith(known)) ?? '.off';
    const stem = opened.name.replace(/\.(off|obj)$/i, '').replaceAll(' ', '-');
    const name = `${stem}-after-${run.at}${extension}`;
    await this.#attempt('Writing the file…', async () => {
      const mesh = { ...opened.mesh, indices: await run.triangles() };
      const bytes = await this.#files.ask((desk) => desk.write(mesh, name));
      const link = document.createElement('a');
      link.href = URL.createObjectURL(new Blob([bytes]));
      link.download = name;
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
    });
  }

  showError(error: unknown): void {
    const message = error instanceof Error ? error.message : String(error);
    // Not β, whose capital looks like a B.
    element('error-text').textContent = message.replace(/^[a-z]/, (letter) => letter.toUpperCase());
    element('error').hidden = false;
  }

  #open(name: string, read: () => Promise<Mesh32 | FileMesh>): Promise<void> {
    return this.#attempt(`Opening ${name}…`, async (signal) => {
      // Reading stops where its worker does; a new one is there for what comes next.
      signal.addEventListener('abort', () => {
        this.#files.close();
        this.#files = new Office();
      });
      const mesh = await read();
      if (mesh.indices.length === 0) throw new Error(`There are no triangles in ${name}.`);
      const before = await this.#files.ask((desk) => desk.angles(mesh, BINS));
      await this.#begin({ mesh, name, remark: remarkOn(mesh), before }, signal);
    });
  }

  /** Begins a run; the one before it stays if this fails. */
  async #begin(opened: Opened, signal: AbortSignal): Promise<void> {
    const beta = controls.beta.valueAsNumber;
    if (!(beta >= 0 && beta <= 180)) throw new Error('β is an angle from 0 to 180 degrees.');
    const run = await beginRun(opened.mesh, beta, controls.backend.value as Backend, this.#gpu, signal);
    if (signal.aborted) return run.free();
    const isNew = this.#opened !== opened;
    this.#isPlaying = false;
    this.#scene?.clear();
    this.#run?.free();
    this.#run = run;
    this.#opened = opened;
    this.#summary = undefined;
    this.#scene?.setMesh(unitPositions(opened.mesh), opened.mesh.dimension);
    if (isNew) {
      this.#scene?.lookAtAll();
      controls.wireframe.checked = opened.mesh.indices.length <= 3 * EDGES_SEEN;
    }
    element('no-mesh').hidden = true;
    element('beta-label').hidden = opened.mesh.dimension === 2;
    this.#panel.clear();
    await this.#draw();
    this.pause();
  }

  /** Shows what goes on, with a way to cancel it; what was begun before is cancelled. */
  async #attempt(text: string, work: (signal: AbortSignal) => Promise<void>): Promise<void> {
    this.#job?.abort();
    const job = new AbortController();
    this.#job = job;
    element('error').hidden = true;
    element('busy-text').textContent = text;
    element('busy').hidden = false;
    this.#showTransport();
    try {
      await work(job.signal);
    } catch (error) {
      if (!job.signal.aborted && !(error instanceof Cancelled)) this.showError(error);
      // What was being measured may have been cancelled with it.
      if (this.#job === job && !this.#isPlaying) void this.#rest();
    } finally {
      if (this.#job === job) {
        this.#job = undefined;
        element('busy').hidden = true;
        this.#showTransport();
      }
    }
  }

  /** One iteration on, drawn. Returns whether there was one. */
  async #forward(run: Run): Promise<boolean> {
    try {
      const went = await run.forward();
      if (run === this.#run) await this.#draw();
      return went;
    } catch (error) {
      const isLost = error instanceof EdgeflipError && error.code === 'device-failed';
      // A lost device is told by the device itself, and a run that was taken away by nobody.
      if (run === this.#run && !isLost) this.showError(error);
      return false;
    }
  }

  async #draw(): Promise<void> {
    const [run, opened, scene] = [this.#run, this.#opened, this.#scene];
    if (!run || !opened || !scene) return;
    const { at } = run;
    const withEdges = controls.wireframe.checked;
    const states = withEdges ? run.states : undefined;
    scene.show(run.drawn, opened.mesh.indices.length, withEdges && !states ? run.lines() : undefined);
    this.#panel.showIterations(run.iterations, at);
    this.#panel.showFacts(opened.mesh, run, this.#summary, undefined);
    this.#panel.showLegend(run.states);
    this.#showTransport();
    const indices = states && (await run.triangles());
    if (run === this.#run && at === run.at) scene.showEdges(indices, states);
  }

  #showTransport(): void {
    const run = this.#run;
    const [at, newest] = [run?.at ?? 0, run?.iterations.length ?? 0];
    const isIdle = run !== undefined && this.#job === undefined;
    controls.play.textContent = this.#isPlaying ? 'Pause' : 'Play';
    controls.play.disabled = !isIdle;
    controls.step.disabled = !isIdle || run.isOver;
    controls.reset.disabled = !isIdle || at === 0;
    controls.slider.disabled = !isIdle || newest === 0;
    controls.slider.max = `${newest}`;
    controls.slider.value = `${at}`;
    controls.download.disabled = !isIdle;
    element('position').textContent = run ? `${number.format(at)} / ${number.format(newest)}${run.hasEnded ? '' : '…'}` : '';
    element('status').textContent = run ? this.#statusOf(run) : '';
    const remains = run?.isOver && this.#summary ? left(reasons(this.#summary.remaining)) : '';
    const onCpu = run?.fallback ? `On the CPU: ${run.fallback}.` : '';
    const note = [remains, onCpu, this.#opened?.remark].filter(Boolean).join(' ');
    element('note').hidden = note === '';
    element('note').textContent = note;
    element('caption').textContent = this.#opened?.name ?? '';
    if (!this.#job && this.#opened) {
      // The empty value stands for a file.
      const names = Array.from(controls.sample.options, ({ value }) => value);
      controls.sample.value = names.find((name) => name === this.#opened?.name) ?? '';
    }
    document.body.dataset['state'] = this.#job ? 'busy' : !run ? 'empty' : this.#isPlaying ? 'playing' : run.isOver ? 'done' : 'ready';
  }

  #statusOf(run: Run): string {
    const { at, iterations } = run;
    if (at === 0) return run.isOver ? 'Nothing to flip: the mesh is as Delaunay as it can be.' : 'The input';
    const flips = iterations.slice(0, at).reduce((sum, iteration) => sum + iteration.flips, 0);
    const so = `${number.format(flips)} flips in ${number.format(at)} ${at === 1 ? 'iteration' : 'iterations'}`;
    return run.isOver ? `Done: ${so}` : so;
  }

  /** Measures the state that is shown, once it is not about to change. */
  async #rest(): Promise<void> {
    const [run, opened] = [this.#run, this.#opened];
    if (!run || !opened) return;
    const rest = ++this.#rests;
    const isOutdated = () => rest !== this.#rests || this.#isPlaying || run !== this.#run;
    delete document.body.dataset['measured'];
    try {
      const summary = await run.result();
      if (isOutdated()) return;
      const indices = await run.triangles();
      const fingerprint = await fingerprintOf(indices);
      if (isOutdated()) return;
      this.#summary = summary;
      this.#panel.showFacts(opened.mesh, run, summary, fingerprint);
      this.#showTransport();
      const angles = await this.#files.ask((desk) => desk.angles({ ...opened.mesh, indices }, BINS));
      if (isOutdated()) return;
      this.#panel.showAngles(opened.before, angles);
      document.body.dataset['measured'] = `${run.at}`;
    } catch (error) {
      if (!isOutdated() && !(error instanceof Cancelled)) this.showError(error);
    }
  }

  async #openGpu(): Promise<void> {
    this.#gpu = await openGpu();
    const device = typeof this.#gpu === 'string' ? undefined : this.#gpu.device;
    this.#scene = await Scene.create(view, device, palette());
    void device?.lost.then(({ message }) => this.#recover(message));
  }

  /** The device is gone, and with it what was drawn. The run goes the same way again, to the same bits. */
  async #recover(message: string): Promise<void> {
    const [run, opened] = [this.#run, this.#opened];
    this.#isPlaying = false;
    await this.#attempt('The GPU was lost; going on from the input…', async (signal) => {
      this.#scene?.dispose();
      await this.#openGpu();
      this.#opened = undefined;
      if (!run || !opened) return;
      if (run.backend === 'webgpu' && controls.backend.value === 'auto') controls.backend.value = 'cpu';
      const { at } = run;
      await this.#begin(opened, signal);
      while (this.#run && this.#run.at < at && !signal.aborted && (await this.#forward(this.#run)));
      this.pause();
    });
    this.showError(new Error(`The GPU was lost (${message || 'no reason given'}). The run went on from the input.`));
  }

  #recolour(): void {
    const colours = palette();
    this.#scene?.setPalette(colours);
    this.#panel.setPalette(colours);
    void this.#draw();
  }
}

function remarkOn(mesh: Mesh32 | FileMesh): string {
  if (!('polygons' in mesh)) return '';
  const cut = mesh.polygons > 0 ? `${number.format(mesh.polygons)} faces were cut into triangles.` : '';
  const dropped = mesh.dropped.length > 0 ? `Not kept: ${mesh.dropped.join(', ')}.` : '';
  return `${cut} ${dropped}`.trim();
}

function left(what: string): string {
  return what === 'none' ? 'Every edge is Delaunay.' : `Not Delaunay, and may not flip: ${what}.`;
}

/** The first 64 bits of the SHA-256 of the triangles, as 32-bit little-endian words. */
async function fingerprintOf(indices: Uint32Array): Promise<string> {
  const digest = await crypto.subtle.digest('SHA-256', indices as Uint32Array<ArrayBuffer>);
  return Array.from(new Uint8Array(digest, 0, 8), (byte) => byte.toString(16).padStart(2, '0')).join('');
}

const pause = (ms: number) => new Promise((resolve) => setTimeout(resolve, Math.max(0, ms)));
const nextFrame = () => new Promise(requestAnimationFrame);

const page = new Page();

for (const { group, samples } of SAMPLES) {
  const options = document.createElement('optgroup');
  options.label = group;
  options.append(...samples.map(({ spec, name }) => new Option(name, spec, spec === FIRST, spec === FIRST)));
  controls.sample.append(options);
}
controls.sample.append(Object.assign(new Option('(a file)', ''), { hidden: true }));
controls.file.accept = FORMATS.join(',');

controls.sample.addEventListener('change', () => void page.openSample(controls.sample.value));
controls.file.addEventListener('change', () => {
  const [file] = controls.file.files ?? [];
  if (file) void page.openFile(file);
  controls.file.value = '';
});
for (const control of [controls.backend, controls.beta]) control.addEventListener('change', () => void page.begin());
controls.reset.addEventListener('click', () => page.seek(0));
controls.play.addEventListener('click', () => void page.play());
controls.step.addEventListener('click', () => void page.step());
controls.slider.addEventListener('input', () => page.seek(controls.slider.valueAsNumber));
controls.wireframe.addEventListener('change', () => page.redraw());
controls.download.addEventListener('click', () => void page.download());
element('cancel').addEventListener('click', () => page.cancel());
element('dismiss').addEventListener('click', () => (element('error').hidden = true));

document.addEventListener('keydown', (event) => {
  const target = event.target;
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  if (target instanceof HTMLInputElement || target instanceof HTMLSelectElement || target instanceof HTMLButtonElement) return;
  const action = { ' ': () => void page.play(), ArrowLeft: () => page.seekBy(-1), ArrowRight: () => void page.step() }[event.key];
  if (!action) return;
  event.preventDefault();
  action();
});

const dropHere = element('drop-here');
document.addEventListener('dragover', (event) => {
  event.preventDefault();
  dropHere.hidden = false;
});
document.addEventListener('dragleave', (event) => {
  if (!event.relatedTarget) dropHere.hidden = true;
});
document.addEventListener('drop', (event) => {
  event.preventDefault();
  dropHere.hidden = true;
  const file = event.dataTransfer?.files[0];
  if (file) void page.openFile(file);
});

void page.start();
