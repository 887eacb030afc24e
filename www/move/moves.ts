/** The meshes that move, in place of a run: starts and ends the motion, as the controls say. */

import { controls, element } from '../watch/controls.ts';
import { download, save } from '../watch/download.ts';
import { markSample } from '../watch/gallery.ts';
import { showError } from '../watch/jobs.ts';
import type { Page } from '../watch/page.ts';
import { palette } from '../watch/palette.ts';
import type { Backend } from '../watch/run.ts';
import type { MovingSample } from '../models/samples.js';
import { stillness } from '../shell/stillness.ts';
import { onTheme } from '../shell/theme.ts';
import { Board } from './board.ts';
import { codeFor } from './code.ts';
import { MOTIONS } from './motions.ts';
import { Move } from './move.ts';
import { startMover } from './starting.ts';

const many = element<HTMLSelectElement>('many');

export class Moves {
  readonly #page: Page;
  #sample: MovingSample | undefined;
  #board: Board | undefined;
  #move: Move | undefined;

  constructor(page: Page) {
    this.#page = page;
    onTheme(() => {
      this.#move?.mover.skin.setPalette(palette());
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
    const board = new Board(sample.name);
    this.#board = board;
    board.state = 'busy';
    await this.#page.attempt('Preparing the mesh…', (signal) => this.#begin(sample, board, signal));
    if (board === this.#board && !this.#move) board.state = 'paused';
  }

  /** Begins again, with the engine and the size that are chosen now. */
  async restart(): Promise<void> {
    if (this.#sample) await this.show(this.#sample);
  }

  /** Ends the motion, for a mesh that does not move. */
  leave(): void {
    if (!this.#sample) return;
    this.#end();
    this.#sample = this.#board = undefined;
    markSample('');
    element('no-mesh').hidden = false;
    delete document.body.dataset['moving'];
  }

  async toggle(): Promise<void> {
    const [move, board] = [this.#move, this.#board];
    if (!move || !board) return this.restart();
    board.state = move.isPlaying ? 'paused' : 'moving';
    if (!move.isPlaying) return move.play();
    await move.pause().catch((error: unknown) => move === this.#move && this.#fail(error));
  }

  /** Writes the present mesh into a file. */
  async save(extension = '.ply'): Promise<void> {
    const [move, sample] = [this.#move, this.#sample];
    if (!move || !sample) return;
    await this.#page.attempt('Writing the file…', async (signal) => {
      await download(await move.mover.mesh(), `${sample.kind}${extension}`, undefined, signal);
    });
    if (this.#board) this.#board.state = move.isPlaying ? 'moving' : 'paused';
  }

  async picture(): Promise<void> {
    const { scene } = this.#page;
    if (scene && this.#sample) save(await scene.picture(palette().ground), `${this.#sample.kind}.png`);
  }

  /** Copies a link. Returns what to say. */
  async link(): Promise<string> {
    const url = new URL(location.href);
    url.hash = `watch?${new URLSearchParams({ mesh: this.#sample?.spec ?? '' })}`;
    await navigator.clipboard.writeText(url.href);
    return 'Link copied. It opens this mesh.';
  }

  /** Copies the lines of JavaScript that keep such a mesh Delaunay. Returns what to say. */
  async code(): Promise<string> {
    if (this.#sample) await navigator.clipboard.writeText(codeFor(MOTIONS[this.#sample.kind], Number(many.value)));
    return 'Code copied.';
  }

  async #begin(sample: MovingSample, board: Board, signal: AbortSignal): Promise<void> {
    const motion = MOTIONS[sample.kind];
    await this.#page.ready;
    const { scene, gpu } = this.#page;
    if (!scene) throw new Error('This browser cannot draw the mesh: it has no WebGPU and no WebGL2.');
    const backend = controls.backend.value as Backend;
    const { mover, triangles, vertices, remark } = await startMover(
      motion,
      Number(many.value),
      backend,
      gpu,
      (attribute, buffer, count) => scene.share(attribute, buffer, count),
      signal,
    );
    mover.skin.setPalette(palette());
    board.begin(triangles, vertices, mover.engine, remark);
    const move: Move = new Move(
      mover,
      motion,
      scene,
      element('view'),
      (numbers) => move === this.#move && board.show(numbers, move.isPlaying),
      (error) => move === this.#move && this.#fail(error),
    );
    this.#move = move;
    element('no-mesh').hidden = true;
    await move.still();
    board.state = stillness.matches ? 'paused' : 'moving';
    if (!stillness.matches) move.play();
  }

  #fail(error: unknown): void {
    this.#end();
    if (this.#board) this.#board.state = 'paused';
    showError(error);
  }

  /** Begins again after the page's GPU was lost, with a mesh that asks less of it. */
  #resume(reason: string): void {
    many.value = '20000';
    void this.restart().then(() => showError(new Error(`The GPU was lost (${reason}). The mesh began again.`)));
  }

  #end(): void {
    this.#move?.free();
    this.#move = undefined;
  }
}
