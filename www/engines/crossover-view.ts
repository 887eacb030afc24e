/** The crossover: from which size of the mesh on a GPU is first on this computer. */

import { made } from '../shell/elements.ts';
import { crossoverOf, type Crossover } from './crossover.ts';
import { plot } from './plot.ts';
import { recordedCrossover, SERIES, WHAT } from './recorded.ts';
import { sentenceOf } from './timer.ts';
import { emptySeries, measureSizes, type Series } from './sizes.ts';
import type { OneAtATime } from './one-at-a-time.ts';
import { about, count, timeText } from './words.ts';

const QUESTION = 'When is the GPU first?';
const BEFORE = `Random points in the plane. Grey: ${WHAT}. There the GPU is first from ${recordedCrossover()} triangles on.`;

export class CrossoverView {
  readonly #title = made('h3', 'engines-title', QUESTION);
  readonly #chart = made('div', 'engines-chart');
  readonly #button = made('button', 'read-button engines-button', 'Measure this computer');
  readonly #note = made('p', 'engines-note', BEFORE);
  readonly #progress = made('progress', 'engines-progress');
  readonly #notes = made('ul', 'engines-notes');
  readonly #table = made('table', '');
  readonly #details = made('details', 'engines-details', made('summary', '', 'The numbers'));
  #series: Series[] = emptySeries();
  #crossover: Crossover | undefined;

  constructor(host: HTMLElement, oneAtATime: OneAtATime) {
    this.#button.type = 'button';
    this.#title.ariaLive = 'polite';
    this.#progress.setAttribute('aria-label', 'Sizes measured');
    this.#progress.hidden = true;
    this.#details.append(made('div', 'engines-scroll', this.#table));
    this.#details.hidden = true;
    const row = made('div', 'engines-row', this.#button, made('div', 'engines-state', this.#note, this.#progress));
    host.append(this.#title, row, this.#chart, this.#notes, this.#details);
    new ResizeObserver(() => this.#draw()).observe(this.#chart);
    oneAtATime.offer(this.#button, 'Measure again', (signal) => this.#measure(signal));
  }

  async #measure(signal: AbortSignal): Promise<void> {
    this.#series = emptySeries();
    this.#crossover = undefined;
    this.#title.textContent = QUESTION;
    this.#notes.replaceChildren();
    this.#progress.hidden = false;
    this.#progress.value = 0;
    try {
      await measureSizes(this.#series, signal, (share, what) => {
        this.#progress.value = share;
        this.#note.textContent = what;
        this.#draw();
      });
      this.#crossover = crossoverOf(this.#series);
      this.#title.textContent = headline(this.#crossover);
      this.#note.textContent = BEFORE;
    } catch (error) {
      this.#note.textContent = signal.aborted ? 'Stopped. These sizes were measured.' : sentenceOf(error);
    }
    this.#progress.hidden = true;
    this.#notes.append(...notesOf(this.#series).map((note) => made('li', '', note)));
    this.#draw();
    this.#tabulate();
  }

  #draw(): void {
    plot(
      this.#chart,
      this.#series,
      SERIES,
      this.#crossover && 'from' in this.#crossover ? this.#crossover.from : undefined,
    );
  }

  #tabulate(): void {
    const sizes = [...new Set(this.#series.flatMap(({ points }) => points.map(({ triangles }) => triangles)))];
    const measured = this.#series.filter(({ points }) => points.length > 0);
    const cell = (words: string) => made('td', '', words);
    const head = (words: string, scope: 'col' | 'row') => {
      const th = made('th', '', words);
      th.scope = scope;
      return th;
    };
    const names = measured.map(({ contender }) => head(contender.name, 'col'));
    const rows = sizes
      .sort((a, b) => a - b)
      .map((size) => {
        const times = measured.map(({ points }) => points.find(({ triangles }) => triangles === size)?.ms);
        return made(
          'tr',
          '',
          head(count(size), 'row'),
          ...times.map((ms) => cell(ms === undefined ? '–' : timeText(ms))),
        );
      });
    this.#table.replaceChildren(made('tr', '', head('Triangles', 'col'), ...names), ...rows);
    this.#details.hidden = sizes.length === 0;
  }
}

function headline(crossover: Crossover): string {
  if ('from' in crossover)
    return `From ${about(crossover.from.triangles)} triangles on, the GPU is first on this computer`;
  if (crossover.first === 'gpu') return 'On this computer the GPU is first at every size measured';
  if (crossover.first === 'cpu') return 'On this computer the CPU is first at every size measured';
  return `Only the ${crossover.first === 'only the cpu' ? 'CPU' : 'GPU'} was measured on this computer`;
}

/** Why engines are missing in the chart, or end early. */
function notesOf(series: readonly Series[]): string[] {
  return series.filter(({ whyNot }) => whyNot).map(({ contender, whyNot }) => `${contender.name}: ${whyNot}`);
}
