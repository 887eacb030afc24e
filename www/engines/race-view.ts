/** The race: a button, a row for each engine, and whether all results are equal. */

import { made } from '../shell/elements.ts';
import { ResultRow, type Ran } from './result-row.ts';
import { ALL, ONE_THREAD, type Contender, type NamedMesh } from './contenders.ts';
import { runOn, sampleMesh } from './race.ts';
import { sentenceOf } from './timer.ts';
import { stillness } from '../shell/stillness.ts';
import type { OneAtATime } from './one-at-a-time.ts';
import { count } from './words.ts';

const BEFORE =
  'Each engine runs the mesh that is open above, or else the paper’s mesh 3, from your arrays to the result. See which one is first here.';
const PROMISE = 'Nothing runs until you press the button.';

/** Milliseconds that the slowest engine takes in the replay. */
const REPLAY = 2400;

const names = new Intl.ListFormat('en');

export class RaceView {
  readonly #lede = made('p', 'engines-lede', BEFORE);
  readonly #button = made('button', 'engines-button engines-main', 'Race');
  readonly #note = made('p', 'engines-note', PROMISE);
  readonly #verdict = made('p', 'engines-verdict');
  readonly #rows = new Map(ALL.map((contender) => [contender, new ResultRow(contender)]));
  readonly #openMesh: () => NamedMesh | undefined;

  constructor(host: HTMLElement, oneAtATime: OneAtATime, openMesh: () => NamedMesh | undefined) {
    this.#openMesh = openMesh;
    this.#button.type = 'button';
    for (const live of [this.#note, this.#verdict]) live.setAttribute('role', 'status');
    const titles = ['Engine', '', 'Time', 'Speed-up', 'Fingerprint of the result'];
    const heads = made('div', 'engines-heads', ...titles.map((title) => made('span', '', title)));
    heads.setAttribute('aria-hidden', 'true');
    const rows = made('ul', 'engines-results', ...[...this.#rows.values()].map(({ element }) => element));
    // Safari takes lists without markers for no lists.
    rows.setAttribute('role', 'list');
    const head = made('header', 'engines-head', made('h2', '', 'Three engines, one answer.'), this.#lede);
    head.append(made('div', 'engines-row', this.#button, this.#note));
    host.append(head, heads, rows, this.#verdict);
    oneAtATime.offer(this.#button, 'Race again', (signal) => this.#race(signal));
  }

  async #race(signal: AbortSignal): Promise<void> {
    for (const row of this.#rows.values()) row.reset();
    this.#lede.textContent = BEFORE;
    this.#verdict.textContent = '';
    this.#verdict.classList.remove('engines-wrong');
    try {
      this.#note.textContent = 'The mesh is made ready.';
      const mesh = this.#openMesh() ?? (await sampleMesh(signal));
      const ran = new Map<Contender, Ran>();
      for (const [contender, row] of this.#rows) {
        this.#note.textContent = `${contender.name} runs.`;
        row.start();
        const outcome = await runOn(contender, mesh, signal);
        row.finish(outcome);
        if ('timing' in outcome) ran.set(contender, outcome);
      }
      this.#show(mesh, ran);
    } catch (error) {
      for (const row of this.#rows.values()) row.reset();
      this.#note.textContent = signal.aborted ? 'Stopped.' : sentenceOf(error);
    }
  }

  #show(mesh: NamedMesh, ran: Map<Contender, Ran>): void {
    const oneThread = ran.get(ONE_THREAD);
    const [fastest] = [...ran.values()].sort((a, b) => a.timing.median - b.timing.median);
    if (!fastest) {
      this.#note.textContent = 'No engine could run this mesh. Each row says why.';
      return;
    }
    const { digest } = oneThread ?? fastest;
    const slowest = Math.max(...[...ran.values()].map(({ timing }) => timing.median));
    const [slowness, replays] = replayOf(slowest);
    for (const [contender, one] of ran) {
      const row = this.#rows.get(contender)!;
      row.compare(one, slowest, oneThread, digest, one === fastest);
      if (!stillness.matches) row.replay(slowness * one.timing.median);
    }
    const runs = Math.min(...[...ran.values()].map(({ timing }) => timing.runs));
    const medians = runs === 5 ? 'Medians of 5 runs.' : 'Medians of 5 runs, or of fewer where a run takes over 2 s.';
    this.#note.textContent = stillness.matches ? medians : `${replays} ${medians}`;
    const others = [...ran].filter(([, one]) => one.digest !== digest).map(([{ name }]) => name);
    this.#judge(ran.size, others);
    const [triangles, { flips }] = [mesh.indices.length / 3, fastest.timing.result];
    const numbers = `, from your arrays to the result: ${count(triangles)} triangles, ${count(flips)} flips.`;
    const equal = others.length === 0 && ran.size > 1 ? ' The results are equal to the last bit.' : '';
    this.#lede.replaceChildren('Each engine here ran ', made('b', '', mesh.name), numbers, equal);
  }

  #judge(ran: number, others: string[]): void {
    const drawing = 'The squares draw the fingerprint: 64 bits, 64 edges.';
    this.#verdict.classList.toggle('engines-wrong', others.length > 0);
    if (others.length > 0) {
      this.#verdict.textContent = `Not equal: ${names.format(others)}. This is a fault of the engine or of its driver. The edges that differ are orange.`;
    } else if (ran === 1) {
      this.#verdict.textContent = `Only one engine ran, so there is nothing to compare. ${drawing}`;
    } else {
      const all = ran === 2 ? 'Both' : ran === 3 ? 'All three' : 'All four';
      this.#verdict.textContent = `✓ ${all} are equal, bit for bit. ${drawing}`;
    }
  }
}

/** How much slower the replay is than the run, in a round number, and the sentence for it. */
function replayOf(slowest: number): [number, string] {
  const exact = REPLAY / slowest;
  const round = (value: number) => Number(value.toPrecision(1));
  if (round(exact) > 1) return [round(exact), `Replayed ${count(round(exact))} times slower.`];
  if (round(1 / exact) > 1) return [1 / round(1 / exact), `Replayed ${count(round(1 / exact))} times faster.`];
  return [1, 'Replayed as fast as it ran.'];
}
