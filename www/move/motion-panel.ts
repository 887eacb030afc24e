/** What the page says of a mesh that moves, or of points: numbers, and a bar for the flips of each of the last frames. */

import { controls, element } from '../watch/controls.ts';
import { facts } from '../watch/panel.ts';
import { made } from '../shell/elements.ts';
import { counted, ms, number } from '../shell/numbers.ts';
import type { Numbers } from './frame-loop.ts';

/** The most bars, and the pixels from one to the next. */
const [MOST, PITCH] = [240, 5];
/** Milliseconds from one change of the words to the next. */
const CALM = 250;

/** What is said of what moves. */
export interface Words {
  /** How large it is, and what can be dragged. */
  size: string;
  drag: string;
  engine: string;
  /** What its bars count. */
  unit: 'flips' | 'new edges';
  /** Its size in numbers, and what else is counted in a frame. */
  facts(numbers: Numbers): Record<string, string>;
}

/** The words for a mesh. */
export function wordsForMesh(triangles: number, vertices: number, engine: string): Words {
  return {
    size: counted(triangles, 'triangle'),
    drag: 'Drag a point of the mesh.',
    engine,
    unit: 'flips',
    facts: ({ left, kept, inverted, flat }) => ({
      Triangles: number.format(triangles),
      Vertices: number.format(vertices),
      'Left for the next frame': number.format(left),
      'Not Delaunay, and cannot flip': number.format(kept),
      'Turned over': number.format(inverted),
      'No area': number.format(flat),
    }),
  };
}

export class MotionPanel {
  readonly #name: string;
  #words: Words | undefined;
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
  begin(words: Words, remark: string): void {
    this.#words = words;
    element('about').textContent = `${words.size}. ${words.drag}`;
    element('moving').ariaLabel = `${words.unit === 'flips' ? 'Flips' : 'New edges'} in each of the last frames`;
    element('note').textContent = remark;
    element('note').hidden = remark === '';
    element('announcement').textContent = `${this.#name}, ${words.size}. ${remark}`;
  }

  /** Shows whether the mesh moves, and whether it can. */
  set state(state: 'busy' | 'moving' | 'paused') {
    controls.play.ariaLabel = state === 'moving' ? 'Pause' : 'Play';
    controls.play.disabled = state === 'busy';
    controls.take.disabled = state === 'busy';
    Object.assign(document.body.dataset, { state, mesh: this.#name });
  }

  show(numbers: Numbers, isPlaying: boolean): void {
    const { flips, left, kept, each, work } = numbers;
    const words = this.#words;
    if (!words) return;
    if (isPlaying) this.#flips.push(flips);
    if (this.#flips.length > MOST) this.#flips.shift();
    this.#draw();
    const now = performance.now();
    if (isPlaying && now - this.#said < CALM) return;
    this.#said = now;
    const rate = each > 0 ? `${number.format(Math.round(1000 / each))} frames a second` : '';
    const state = isPlaying ? rate : left === 0 && kept === 0 ? 'Every edge is Delaunay.' : 'Paused.';
    const mean = `${number.format(Math.round(this.#mean))} ${words.unit} a frame`;
    element('status').replaceChildren(made('b', '', isPlaying ? `${mean},` : state), ' ', isPlaying ? state : mean);
    facts('facts', {
      ...words.facts(numbers),
      Engine: words.engine,
      'From frame to frame': each > 0 ? `${ms.format(each)} ms` : '…',
      'Work of a frame': work > 0 ? `${ms.format(work)} ms` : '…',
      [words.unit === 'flips' ? 'Flips a frame' : 'New edges a frame']: number.format(Math.round(this.#mean)),
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
