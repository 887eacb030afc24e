/** The race: a button, a row for each engine, and whether all results are equal. */

import { made } from '../shell/elements.ts';
import { ResultRow, type Ran } from './result-row.ts';
import { ALL, ONE_THREAD, type Contender, type NamedMesh } from './contenders.ts';
import { recordedMesh, runOn } from './race.ts';
import { RACE, recordedTime, recordedWords, RUNS, SOURCE, WHAT } from './recorded.ts';
import { sentenceOf } from './timer.ts';
import { stillness } from '../shell/stillness.ts';
import type { OneAtATime } from './one-at-a-time.ts';
import { count } from './words.ts';

const BEFORE = `Every engine flips the same mesh: ${RACE.name}. The CPU runs twice: on one thread, and on all. The time is from your arrays to the result. Press Race to see this computer.`;
const PROMISE = 'Nothing runs until you press a button.';
const OTHER_MESH = 'The record is of another mesh, so it is not shown.';

/** Milliseconds that the slowest engine takes in the replay. */
const REPLAY = 2400;

const names = new Intl.ListFormat('en');

export class RaceView {
  readonly #lede = made('p', 'engines-lede', BEFORE);
  readonly #button = made('button', 'read-button engines-button engines-main', 'Race');
  readonly #own = made('button', 'read-button engines-button engines-open', 'Race on the open mesh');
  readonly #source = made('p', 'engines-note engines-source');
  readonly #note = made('p', 'engines-note', PROMISE);
  readonly #verdict = made('p', 'engines-verdict');
  readonly #rows = new Map(ALL.map((contender) => [contender, new ResultRow(contender)]));
  readonly #openMesh: () => NamedMesh | undefined;

  constructor(host: HTMLElement, oneAtATime: OneAtATime, openMesh: () => NamedMesh | undefined) {
    this.#openMesh = openMesh;
    for (const button of [this.#button, this.#own]) button.type = 'button';
    for (const live of [this.#note, this.#verdict]) live.setAttribute('role', 'status');
    const titles = ['Engine', '', 'Time', 'Speed-up', 'Fingerprint of the result'];
    const heads = made('div', 'engines-heads', ...titles.map((title) => made('span', '', title)));
    heads.setAttribute('aria-hidden', 'true');
    const rows = made('ul', 'engines-results', ...[...this.#rows.values()].map(({ element }) => element));
    // Safari takes lists without markers for no lists.
    rows.setAttribute('role', 'list');
    const head = made('header', 'engines-head', made('h2', '', 'Three engines, one answer.'), this.#lede);
    head.append(made('div', 'engines-row', this.#button, this.#own, this.#note), this.#source);
    host.append(head, heads, rows, this.#verdict);
    oneAtATime.offer(this.#button, 'Race again', (signal) => this.#race(signal, () => recordedMesh(signal)));
    oneAtATime.offer(this.#own, 'Race on the open mesh', (signal) => this.#race(signal));
    const look = () => (this.#own.hidden = !openMesh());
    look();
    new IntersectionObserver(look).observe(head);
    this.#record(true);
  }

  /** Shows the recorded lanes, or hides them. */
  #record(isShown: boolean, slowest = 0): void {
    const times = ALL.map((contender) => (isShown ? recordedTime(contender) : undefined));
    const scale = Math.max(slowest, ...times.map((ms) => ms ?? 0));
    for (const [i, contender] of ALL.entries()) {
      this.#rows.get(contender)!.record(times[i], scale, isShown ? recordedWords(contender) : '');
    }
    if (isShown) {
      const source = made('a', '', 'The record');
      source.href = SOURCE;
      this.#source.replaceChildren(`Grey: ${WHAT}, medians of ${RUNS} runs. `, source);
    } else this.#source.textContent = OTHER_MESH;
  }

  /** Races on a mesh, or on the one that is open. The record is of the other. */
  async #race(signal: AbortSignal, other?: () => Promise<NamedMesh>): Promise<void> {
    for (const row of this.#rows.values()) row.reset();
    this.#record(other !== undefined);
    this.#lede.textContent = BEFORE;
    this.#verdict.textContent = '';
    this.#verdict.classList.remove('engines-wrong');
    try {
      this.#note.textContent = 'The mesh is made ready.';
      const mesh = other ? await other() : this.#openMesh();
      if (!mesh) throw new Error('no mesh is open');
      const ran = new Map<Contender, Ran>();
      for (const [contender, row] of this.#rows) {
        row.start();
        const outcome = await runOn(contender, mesh, signal, (what) => {
          this.#note.textContent = `${contender.name} ${what}.`;
        });
        row.finish(outcome);
        if ('timing' in outcome) ran.set(contender, outcome);
      }
      this.#show(mesh, ran, other !== undefined);
    } catch (error) {
      for (const row of this.#rows.values()) row.reset();
      this.#note.textContent = signal.aborted ? 'Stopped.' : sentenceOf(error);
    }
  }

  #show(mesh: NamedMesh, ran: Map<Contender, Ran>, isRecorded: boolean): void {
    const oneThread = ran.get(ONE_THREAD);
    const [fastest] = [...ran.values()].sort((a, b) => a.timing.median - b.timing.median);
    if (!fastest) {
      this.#note.textContent = 'No engine could run this mesh. Each row says why.';
      return;
    }
    const { digest } = oneThread ?? fastest;
    const slowest = Math.max(...[...ran.values()].map(({ timing }) => timing.median));
    this.#record(isRecorded, slowest);
    const scale = Math.max(slowest, ...ALL.map((one) => (isRecorded && recordedTime(one)) || 0));
    const [slowness, replays] = replayOf(slowest);
    for (const [contender, one] of ran) {
      const row = this.#rows.get(contender)!;
      row.compare(one, scale, oneThread, digest, one === fastest);
      if (!stillness.matches) row.replay(slowness * one.timing.median);
    }
    const runs = Math.min(...[...ran.values()].map(({ timing }) => timing.runs));
    const medians = runs === 5 ? 'Medians of 5 runs.' : 'Medians of 5 runs, or of as many as began in 2.5 s.';
    this.#note.textContent = stillness.matches ? medians : `${replays} ${medians}`;
    const others = [...ran].filter(([, one]) => one.digest !== digest).map(([{ name }]) => name);
    this.#judge(ran.size, others);
    const [triangles, { flips }] = [mesh.indices.length / 3, fastest.timing.result];
    const numbers = `: ${count(triangles)} triangles, ${count(flips)} flips. The time is from your arrays to the result.`;
    const equal = others.length === 0 && ran.size > 1 ? ' All results are equal, bit for bit.' : '';
    const name = isRecorded ? 'random points' : mesh.name;
    this.#lede.replaceChildren('This computer flipped ', made('b', '', name), numbers, equal);
  }

  #judge(ran: number, others: string[]): void {
    const drawing = 'Each square draws a fingerprint: 64 edges for 64 bits.';
    this.#verdict.classList.toggle('engines-wrong', others.length > 0);
    if (others.length > 0) {
      this.#verdict.textContent = `Not equal: ${names.format(others)}. The engine or its driver is at fault. The edges that differ are orange.`;
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
