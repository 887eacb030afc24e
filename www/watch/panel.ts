/** The numbers beside the mesh: the angles, the facts and the table of iterations. */

import type { Engine, Iteration, Reasons } from 'edgeflip';
import type { IndexedMesh, Measures } from 'edgeflip/files';
import { AnglesChart } from './charts.ts';
import { element } from './controls.ts';
import type { Quality } from './mesh-worker.ts';
import { counted, degrees, digits, ms, number } from '../shell/numbers.ts';
import type { Palette } from './palette.ts';
import type { Run, Summary } from './run.ts';

/** The most rows of the table; the timeline shows all iterations. */
const MOST_ROWS = 2000;

export const ENGINES: Record<Engine, string> = { webgpu: 'WebGPU', webgl2: 'WebGL2', cpu: 'CPU' };

export class Panel {
  readonly #angles = new AnglesChart(element('angles-chart'));
  readonly #rows = element('rows');
  readonly #seek: (at: number) => void;
  /** The measures of the input, once they are known. */
  #before: Quality | undefined;

  /** `seek` is called with the iteration whose row the user clicks. */
  constructor(seek: (at: number) => void) {
    this.#seek = seek;
    const details = element<HTMLDetailsElement>('details');
    details.addEventListener('toggle', () => {
      // They open below what fits beside the mesh.
      const side = details.parentElement;
      if (side && details.open) side.scrollTop = details.offsetTop - side.offsetTop;
    });
  }

  setPalette(palette: Palette): void {
    this.#angles.setPalette(palette);
  }

  /** Removes all numbers, for a new run. */
  clear(): void {
    this.#rows.replaceChildren();
    this.showQuality(undefined);
    element('facts').replaceChildren();
  }

  /** Shows the iterations so far, and marks iteration `at`. */
  showIterations(iterations: readonly Iteration[], at: number): void {
    for (const iteration of iterations.slice(this.#rows.childElementCount, MOST_ROWS)) this.#addRow(iteration);
    this.#rows.querySelector('[aria-current]')?.removeAttribute('aria-current');
    const row = this.#rows.children[at - 1];
    row?.setAttribute('aria-current', 'true');
    if (row instanceof HTMLElement) {
      // `scrollIntoView` would scroll the page too.
      const box = row.closest('.table');
      if (box) box.scrollTop = row.offsetTop - box.clientHeight / 2;
    }
  }

  /** Replaces the times by those of the same iterations on another engine. */
  showTimes(iterations: readonly Iteration[]): void {
    iterations.slice(0, MOST_ROWS).forEach((iteration, i) => {
      const [, , , , time] = this.#rows.children[i]?.children ?? [];
      if (time) time.textContent = ms.format(iteration.ms);
    });
  }

  /** `fingerprint` belongs to the shown triangles. Without it, facts that take time to compute are shown as `…`. */
  showFacts(
    mesh: IndexedMesh,
    run: Run,
    summary: Summary | undefined,
    beta: number | undefined,
    fingerprint: string | undefined,
  ): void {
    if (!summary) return element('facts').replaceChildren();
    const { timings } = summary;
    const measured = (text: string) => (fingerprint === undefined ? '…' : text);
    const done = run.iterations.slice(0, run.at);
    const flips = done.reduce((sum, iteration) => sum + iteration.flips, 0);
    const watched = done.reduce((sum, iteration) => sum + iteration.ms, 0);
    facts('facts', {
      Triangles: number.format(mesh.indices.length / 3),
      Vertices: number.format(mesh.positions.length / mesh.dimension),
      Edges: `${number.format(summary.edges)}, ${number.format(summary.boundaryEdges)} on the boundary`,
      ...frozen('Non-manifold', summary.nonManifoldEdges),
      ...frozen('Inconsistent', summary.inconsistentEdges),
      ...(mesh.dimension === 3 ? { 'Crease limit β': `${beta}°` } : {}),
      ...(run.awaitsGpu
        ? { Engine: 'CPU, until WebGPU is ready', Adapter: '…', Dispatches: '…' }
        : { Engine: `${ENGINES[summary.backend]}${run.isInWorker ? ', in a worker' : ''}` }),
      ...(summary.backend !== 'cpu'
        ? {
            Adapter: summary.adapter || 'the browser gives no name',
            Dispatches: measured(number.format(summary.dispatches)),
          }
        : {}),
      Iterations: number.format(done.length),
      Flips: number.format(flips),
      'Not Delaunay': run.isNewest ? measured(reasons(summary.remaining)) : reasons(notDelaunayAt(run)),
      ...(run.isNewest && summary.inverted > 0 ? { 'Turned over': counted(summary.inverted, 'triangle') } : {}),
      'Set-up': `${ms.format(timings.upload + timings.adjacency)} ms`,
      'Flips and counts': `${ms.format(watched)} ms`,
      Fingerprint: fingerprint ?? '…',
    });
  }

  /** Shows the measures of the input and of the shown triangles, and in `change` how far they differ, when known. */
  showQuality(before: Quality | undefined, now?: Quality, change?: { moved: number; distance: number }): void {
    this.#before = before;
    this.#angles.show(before?.angles, now?.angles);
    element('angles').classList.remove('is-past');
    this.#writeQuality(before, now, change);
  }

  /** Another state is shown, which has not been measured: the chart of the state before is pale until then. */
  awaitQuality(): void {
    if (!this.#before) return;
    element('angles').classList.add('is-past');
    this.#writeQuality(this.#before);
  }

  #writeQuality(before: Quality | undefined, now?: Quality, change?: { moved: number; distance: number }): void {
    element('angles-typical').textContent = before ? onAverage(before, now) : '';
    if (!before) {
      for (const id of ['angles-facts', 'surface-facts']) element(id).replaceChildren();
      return;
    }
    const both = (key: 'min' | 'meanMin') =>
      `${degrees.format(before.angles[key])}° → ${now ? `${degrees.format(now.angles[key])}°` : '…'}`;
    facts('angles-facts', { Smallest: both('min'), 'Smallest on average': both('meanMin') });
    const measured = (key: keyof Measures) =>
      `${digits.format(before.measures[key])} → ${now ? digits.format(now.measures[key]) : '…'}`;
    facts('surface-facts', {
      'Mean aspect ratio': measured('meanAspect'),
      Area: measured('area'),
      ...(before.measures.volume === 0 ? {} : { Volume: measured('volume') }),
      ...(before.measures.flat + (now?.measures.flat ?? 0) > 0 ? { 'Flat triangles': measured('flat') } : {}),
      ...(change ? { 'Changed triangles': number.format(change.moved) } : {}),
      ...(change && change.distance > 0 ? { 'Moved by up to': digits.format(change.distance) } : {}),
    });
  }

  #addRow({ index, labelled, flips, blocked, ms: time }: Iteration): void {
    const row = document.createElement('tr');
    const stopped = Object.values(blocked).reduce((sum, count) => sum + count, 0);
    for (const text of [
      number.format(index + 1),
      number.format(labelled),
      number.format(flips),
      number.format(stopped),
      ms.format(time),
    ]) {
      row.insertCell().textContent = text;
    }
    const button = document.createElement('button');
    button.textContent = number.format(index + 1);
    button.ariaLabel = `Show iteration ${button.textContent}`;
    button.addEventListener('click', () => this.#seek(index + 1));
    row.cells[0]?.replaceChildren(button);
    row.title = stopped > 0 ? `Kept: ${reasons(blocked)}` : '';
    this.#rows.append(row);
  }
}

/** The mean smallest angle of the input and, unless that is shown, of the shown triangles. */
function onAverage(before: Quality, now: Quality | undefined): string {
  const whole = ({ angles }: Quality) => `${Math.round(angles.meanMin)}°`;
  return `smallest on average ${whole(before)}${now === before ? '' : ` → ${now ? whole(now) : '…'}`}`;
}

/** What is said of edges that are not Delaunay, by the reason. */
const LEFT: Record<string, string> = {
  angle: 'at a crease',
  fold: 'would fold',
  duplicate: 'exist already',
  locked: 'locked',
  deviation: 'too far',
  stopped: 'can flip',
};

/** A text with the number of edges by reason. */
export function reasons(by: Reasons): string {
  const parts = Object.entries(by).filter(([, count]) => count > 0);
  const sum = parts.reduce((total, [, count]) => total + count, 0);
  const texts = parts.map(([reason, count]) => `${number.format(count)} ${LEFT[reason] ?? reason}`);
  return texts.length > 1 ? `${number.format(sum)}: ${texts.join(', ')}` : (texts[0] ?? 'none');
}

/** The edges of the shown state that are not Delaunay, as the next iteration counted them. */
function notDelaunayAt({ at, iterations }: Run): Reasons {
  const after = iterations[at];
  return after ? { ...after.blocked, stopped: after.labelled } : {};
}

function frozen(name: string, count: number): Record<string, string> {
  return count > 0 ? { [name]: `${number.format(count)} edges, left as they are` } : {};
}

/** Fills a description list; each value has its term as `data-fact`. */
export function facts(id: string, entries: Record<string, string>): void {
  const items = Object.entries(entries).map(([term, value]) => {
    const item = document.createElement('div');
    const [name, text] = [document.createElement('dt'), document.createElement('dd')];
    name.textContent = term;
    text.textContent = value;
    text.dataset['fact'] = term;
    item.append(name, text);
    return item;
  });
  element(id).replaceChildren(...items);
}
