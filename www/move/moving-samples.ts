/** The meshes that move, in place of a run: starts and ends the motion, as the controls say. */

import { controls, element } from '../watch/controls.ts';
import { download, save } from '../watch/download.ts';
import { markSample } from '../watch/gallery.ts';
import { withLecture } from '../watch/lecture.ts';
import { showError } from '../watch/jobs.ts';
import type { Page } from '../watch/page.ts';
import { palette } from '../watch/palette.ts';
import type { Backend } from '../watch/run.ts';
import type { Scene } from '../watch/scene.ts';
import type { MovingSample } from '../models/samples.js';
import { stillness } from '../shell/stillness.ts';
import { onTheme } from '../shell/theme.ts';
import { MotionPanel } from './motion-panel.ts';
import { codeFor, CODE_FOR_POINTS } from './code.ts';
import { MOTIONS } from './motions.ts';
import { FrameLoop } from './frame-loop.ts';
import { startMovingMesh, type Started } from './starting.ts';

const many = element<HTMLSelectElement>('many');

export class MovingSamples {
  readonly #page: Page;
  #sample: MovingSample | undefined;
  #panel: MotionPanel | undefined;
  #loop: FrameLoop | undefined;

  constructor(page: Page) {
    this.#page = page;
    onTheme(() => {
      this.#loop?.moving.surface.setPalette(palette());
      page.scene?.redraw();
    });
    many.addEventListener('change', () => void this.restart());
  }

  get isShown(): boolean {
    return this.#sample !== undefined;
  }

  /** Shows a mesh that moves, in place of what the page shows. */
  async show(sample: MovingSample): Promise<void> {
    this.#end();
    this.#sample = sample;
    document.body.dataset['moving'] = sample.kind;
    this.#page.leave((reason) => this.#resume(reason));
    markSample(sample.spec);
    const panel = new MotionPanel(sample.name);
    this.#panel = panel;
    panel.state = 'busy';
    await this.#page.attempt('Preparing the mesh…', (signal) => this.#begin(sample, panel, signal));
    if (panel === this.#panel && !this.#loop) panel.state = 'paused';
  }

  /** Begins again, with the engine and the size that are chosen now. */
  async restart(): Promise<void> {
    if (this.#sample) await this.show(this.#sample);
  }

  /** Ends the motion, for a mesh that does not move. */
  leave(): void {
    if (!this.#sample) return;
    this.#end();
    this.#sample = this.#panel = undefined;
    markSample('');
    element('no-mesh').hidden = false;
    delete document.body.dataset['moving'];
  }

  async toggle(): Promise<void> {
    const [loop, panel] = [this.#loop, this.#panel];
    if (!loop || !panel) return this.restart();
    panel.state = loop.isPlaying ? 'paused' : 'moving';
    if (!loop.isPlaying) return loop.play();
    await loop.pause().catch((error: unknown) => loop === this.#loop && this.#fail(error));
  }

  /** Writes the present mesh into a file. */
  async save(extension = '.ply'): Promise<void> {
    const [loop, sample] = [this.#loop, this.#sample];
    if (!loop || !sample) return;
    await this.#page.attempt('Writing the file…', async (signal) => {
      await download(await loop.moving.mesh(), `${sample.kind}${extension}`, undefined, signal);
    });
    if (this.#panel) this.#panel.state = loop.isPlaying ? 'moving' : 'paused';
  }

  async picture(): Promise<void> {
    const { scene } = this.#page;
    if (scene && this.#sample) save(await scene.picture(palette().ground), `${this.#sample.kind}.png`);
  }

  /** Copies a link. Returns what to say. */
  async link(): Promise<string> {
    const url = new URL(location.href);
    url.hash = `watch?${new URLSearchParams({ mesh: this.#sample?.spec ?? '' })}`;
    await navigator.clipboard.writeText(withLecture(url.href));
    return 'Link copied. It opens this mesh.';
  }

  /** Copies the lines of JavaScript that keep such a mesh Delaunay. Returns what to say. */
  async code(): Promise<string> {
    const kind = this.#sample?.kind;
    if (kind) {
      const code = kind === 'points' ? CODE_FOR_POINTS : codeFor(MOTIONS[kind], Number(many.value));
      await navigator.clipboard.writeText(code);
    }
    return 'Code copied.';
  }

  async #begin(sample: MovingSample, panel: MotionPanel, signal: AbortSignal): Promise<void> {
    await this.#page.ready;
    const { scene } = this.#page;
    if (!scene) throw new Error('This browser cannot draw the mesh: it has no WebGPU and no WebGL2.');
    const { moving, words, remark, view, grip } = await this.#start(sample, scene, signal);
    moving.surface.setPalette(palette());
    panel.begin(words, remark);
    const loop: FrameLoop = new FrameLoop(
      moving,
      view,
      scene,
      (changed) => grip(element('view'), scene, changed),
      (numbers) => loop === this.#loop && panel.show(numbers, loop.isPlaying),
      (error) => loop === this.#loop && this.#fail(error),
    );
    this.#loop = loop;
    element('no-mesh').hidden = true;
    await loop.still();
    panel.state = stillness.matches ? 'paused' : 'moving';
    if (!stillness.matches) loop.play();
  }

  async #start({ kind }: MovingSample, scene: Scene, signal: AbortSignal): Promise<Started> {
    if (kind === 'points') {
      const { startPoints } = await import('./moving-points.ts');
      return startPoints(() => scene.camera.pixel, signal);
    }
    return startMovingMesh(
      MOTIONS[kind],
      Number(many.value),
      controls.backend.value as Backend,
      this.#page.gpu,
      (attribute, buffer, count) => scene.share(attribute, buffer, count),
      signal,
    );
  }

  #fail(error: unknown): void {
    this.#end();
    if (this.#panel) this.#panel.state = 'paused';
    showError(error);
  }

  /** Begins again after the page's GPU was lost, with a mesh that asks less of it. */
  #resume(reason: string): void {
    many.value = '20000';
    void this.restart().then(() => showError(new Error(`The GPU was lost (${reason}). The mesh began again.`)));
  }

  #end(): void {
    this.#loop?.free();
    this.#loop = undefined;
  }
}
