/** The row of an engine: its name, its bar, its time, its speed-up and the fingerprint of its result. */

import { made } from '../shell/elements.ts';
import { fingerprintOf } from '../shell/digest.ts';
import { draw } from './fingerprint.ts';
import type { Contender } from './contenders.ts';
import type { Outcome } from './race.ts';
import { about, timeOf, timeText } from './words.ts';

export type Ran = Extract<Outcome, { timing: unknown }>;

export class ResultRow {
  readonly element: HTMLElement;
  readonly #contender: Contender;
  readonly #where = made('p', 'engines-where');
  /** The recorded time, with this computer's over it. */
  readonly #record = made('i', 'engines-old');
  readonly #bar = made('i', 'engines-own');
  readonly #track = made('div', 'engines-track', this.#record, this.#bar);
  readonly #recorded = made('p', 'engines-recorded');
  readonly #why = made('p', 'engines-why');
  readonly #time = made('strong', 'engines-time');
  readonly #speed = made('span', 'engines-speed');
  readonly #print = made('div', 'engines-print');

  constructor(contender: Contender) {
    this.#contender = contender;
    const name = made('div', 'engines-name', made('h3', '', contender.name), this.#where);
    const middle = made('div', 'engines-middle', this.#track, this.#recorded, this.#why);
    this.element = made('li', 'engines-result', name, middle, this.#time, this.#speed, this.#print);
    this.reset();
  }

  /** Empties the row. An engine that cannot be here says why at once. */
  reset(): void {
    this.element.classList.remove('engines-first', 'engines-running');
    this.#bar.hidden = true;
    this.#where.textContent = this.#contender.where;
    this.#time.textContent = '–';
    this.#speed.textContent = '';
    this.#print.replaceChildren();
    this.#say(this.#contender.whyNot);
  }

  /** Shows the recorded milliseconds of this engine and the words for them. The longest bar has `scale` of them. */
  record(ms: number | undefined, scale: number, words = ''): void {
    this.#record.hidden = ms === undefined;
    this.#record.style.width = `${(100 * (ms ?? 0)) / scale}%`;
    this.#recorded.hidden = words === '';
    this.#recorded.textContent = words;
  }

  start(): void {
    this.element.classList.add('engines-running');
  }

  /** Shows the time, or why there is none. */
  finish(outcome: Outcome): void {
    this.element.classList.remove('engines-running');
    if ('whyNot' in outcome) {
      this.#say(outcome.whyNot);
      return;
    }
    const { median, isSoftware } = outcome.timing;
    const [time, unit] = timeOf(median);
    this.#time.replaceChildren(time, made('small', '', ` ${unit}`));
    const { where } = this.#contender;
    const place = isSoftware ? where.replace('Your GPU', 'Software GPU') : where;
    this.#where.replaceChildren(place, made('br', ''), `Start: ${timeText(outcome.start)}`);
  }

  /** Compares with one thread, and with the expected result. The longest bar has `scale` milliseconds. */
  compare(ran: Ran, scale: number, oneThread: Ran | undefined, expected: string, isFirst: boolean): void {
    const { median } = ran.timing;
    this.#bar.hidden = false;
    this.#bar.style.width = `${(100 * median) / scale}%`;
    this.element.classList.toggle('engines-first', isFirst);
    if (oneThread) {
      const factor = oneThread.timing.median / median;
      this.#speed.textContent = ran === oneThread ? '1×' : `${factor < 1 ? about(factor) : factor.toFixed(1)}×`;
    }
    const digits = fingerprintOf(ran.digest);
    const code = made('code', '', digits.slice(0, 8), made('wbr', ''), digits.slice(8));
    this.#print.replaceChildren(code, draw(ran.digest, expected));
  }

  /** Lets the bar grow for so many milliseconds. */
  replay(duration: number): void {
    this.#bar.animate([{ clipPath: 'inset(0 100% 0 0)' }, { clipPath: 'inset(0)' }], { duration });
  }

  #say(why: string | undefined): void {
    this.#why.textContent = why ?? '';
    this.#why.hidden = why === undefined;
  }
}
