/** What the page says of a mesh that moves: its numbers, and a bar for the flips of each of the last frames. */

import { controls, element } from '../watch/controls.ts';
import { facts } from '../watch/panel.ts';
import { made } from '../shell/elements.ts';
import { counted, ms, number } from '../shell/numbers.ts';
import type { Numbers } from './frame-loop.ts';

/** The most bars, and the pixels from one to the next. */
const [MOST, PITCH] = [240, 5];
/** Milliseconds from one change of the words to the next. */
const CALM = 250;

export class MotionPanel {
  readonly #name: string;
  #triangles = 0;
  #vertices = 0;
  #engine = '';
  readonly #flips: number[] = [];
  #said = -Infinity;

  constructor(name: string) {
    this.#name = name;
    element('caption').textContent = name;
    element('about').textContent = '';
    element('status').textContent = '';
    element('note').hidden = true;
    element('facts').replaceChildren();
    this.#draw();
  }

  /** The mesh is ready. */
  begin(triangles: number, vertices: number, engine: string, remark: string): void {
    [this.#triangles, this.#vertices, this.#engine] = [triangles, vertices, engine];
    element('about').textContent = `${counted(triangles, 'triangle')}. Drag a point of the mesh.`;
    element('note').textContent = remark;
    element('note').hidden = remark === '';
    element('announcement').textContent = `${this.#name}, ${counted(triangles, 'triangle')}. ${remark}`;
  }

  /** Shows whether the mesh moves, and whether it can. */
  set state(state: 'busy' | 'moving' | 'paused') {
    controls.play.ariaLabel = state === 'moving' ? 'Pause' : 'Play';
    controls.play.disabled = state === 'busy';
    controls.take.disabled = state === 'busy';
    Object.assign(document.body.dataset, { state, mesh: this.#name });
  }

  show(numbers: Numbers, isPlaying: boolean): void {
    const { flips, left, kept, inverted, flat, each, work } = numbers;
    if (isPlaying) this.#flips.push(flips);
    if (this.#flips.length > MOST) this.#flips.shift();
    this.#draw();
    const now = performance.now();
    if (isPlaying && now - this.#said < CALM) return;
    this.#said = now;
    const rate = each > 0 ? `${number.format(Math.round(1000 / each))} frames a second` : '';
    const words = isPlaying ? rate : left === 0 && kept === 0 ? 'Every edge is Delaunay.' : 'Paused.';
    const bold = `${number.format(Math.round(this.#mean))} flips a frame`;
    element('status').replaceChildren(made('b', '', isPlaying ? `${bold},` : words), ' ', isPlaying ? words : bold);
    facts('facts', {
      Triangles: number.format(this.#triangles),
      Vertices: number.format(this.#vertices),
      Engine: this.#engine,
      'From frame to frame': each > 0 ? `${ms.format(each)} ms` : '…',
      'Work of a frame': work > 0 ? `${ms.format(work)} ms` : '…',
      'Flips a frame': number.format(Math.round(this.#mean)),
      'Left for the next frame': number.format(left),
      'Not Delaunay, and cannot flip': number.format(kept),
      'Turned over': number.format(inverted),
      'No area': number.format(flat),
    });
  }

  /** The mean of the last frames. */
  get #mean(): number {
    const last = this.#flips.slice(-30);
    return last.reduce((sum, each) => sum + each, 0) / Math.max(1, last.length);
  }

  #draw(): void {
    const box = element('moving');
    const { clientWidth: width, clientHeight: height } = box;
    const bars = this.#flips.slice(-Math.max(1, Math.floor(width / PITCH)));
    const most = Math.sqrt(Math.max(1, ...bars));
    const lines = bars.map((flips, i) => {
      const x = PITCH * (i + 0.5);
      return `M${x} ${height}v${-Math.max(2, ((height - 8) * Math.sqrt(flips)) / most)}`;
    });
    const [past, present] = box.querySelectorAll('path');
    past?.setAttribute('d', lines.slice(0, -1).join(''));
    present?.setAttribute('d', lines.at(-1) ?? '');
  }
}
