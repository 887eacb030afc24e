/** The meshes that move, in place of a run: chooses the engine, and starts and ends the motion. */

import type { IndexedMesh } from 'edgeflip/files';
import { controls, element } from '../watch/controls.ts';
import { download, save } from '../watch/download.ts';
import { forAuto, Office, type Gpu } from '../watch/engines.ts';
import { markSample } from '../watch/gallery.ts';
import { showError } from '../watch/jobs.ts';
import type { Page } from '../watch/page.ts';
import { palette } from '../watch/palette.ts';
import type { Backend } from '../watch/run.ts';
import type { MovingSample } from '../models/samples.js';
import { onTheme } from '../shell/theme.ts';
import { Board } from './board.ts';
import { codeFor } from './code.ts';
import { MOTIONS, type Motion, type Point } from './motions.ts';
import { Move } from './move.ts';
import type { Mover } from './mover.ts';
import { moveInArrays } from './on-arrays.ts';
import { moveOnDevice } from './on-device.ts';

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
    const office = new Office();
    signal.addEventListener('abort', () => office.close());
    const mesh = await office
      .ask((desk) => desk.generate(motion.spec(Number(many.value))))
      .then((mesh) => begun(mesh, motion))
      .finally(() => office.close());
    await this.#page.ready;
    const { scene, gpu } = this.#page;
    if (!scene) throw new Error('This browser cannot draw the mesh: it has no WebGPU and no WebGL2.');
    const backend = controls.backend.value as Backend;
    const [engine, remark] = engineFor(backend, gpu);
    const mover: Mover =
      typeof engine === 'string'
        ? await moveInArrays(mesh, motion, engine)
        : await moveOnDevice(mesh, motion, engine.device, (attribute, buffer, count) =>
            scene.share(attribute, buffer, count),
          );
    if (signal.aborted) {
      mover.free();
      throw signal.reason;
    }
    mover.skin.setPalette(palette());
    board.begin(mesh.indices.length / 3, mesh.positions.length / mesh.dimension, mover.engine, remark);
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
    const moves = !matchMedia('(prefers-reduced-motion: reduce)').matches;
    board.state = moves ? 'moving' : 'paused';
    if (moves) move.play();
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

/** The GPU, or an engine on arrays; and why the GPU is not used. */
function engineFor(backend: Backend, gpu: Gpu | string | undefined): [engine: Gpu | 'cpu' | 'webgl2', remark: string] {
  if (backend === 'cpu' || backend === 'webgl2') return [backend, ''];
  const usable = backend === 'auto' && gpu ? forAuto(gpu) : (gpu ?? 'WebGPU is not ready');
  if (typeof usable !== 'string') return [usable, ''];
  if (backend === 'webgpu') throw new Error(`The WebGPU engine is not available: ${usable}.`);
  return ['cpu', `On the CPU: ${usable}.`];
}

/** The mesh of a family, where the motion begins, in 32-bit floats as GPUs take them. */
function begun({ positions, indices, dimension }: IndexedMesh, motion: Motion): IndexedMesh {
  const start = new Float32Array(positions.length);
  for (let i = 0; i < positions.length; i += dimension) {
    const vertex = [0, 1, 2].map((k) => (k < dimension ? positions[i + k]! : 0)) as Point;
    start.set(motion.start(vertex).slice(0, dimension), i);
  }
  return { positions: start, indices, dimension };
}
