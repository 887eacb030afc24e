/** The lane of an engine: its name, its bar, its time, its speed-up and the fingerprint of its result. */

import { draw, shown } from './fingerprint.ts';
import type { Contender } from './lineup.ts';
import type { Outcome } from './race.ts';
import { about, tag, timeOf, timeText } from './words.ts';

export type Ran = Extract<Outcome, { timing: unknown }>;

export class Lane {
  readonly element: HTMLElement;
  readonly #contender: Contender;
  readonly #where = tag('p', 'engines-where');
  readonly #bar = tag('i', '');
  readonly #track = tag('div', 'engines-track', this.#bar);
  readonly #why = tag('p', 'engines-why');
  readonly #time = tag('strong', 'engines-time');
  readonly #speed = tag('span', 'engines-speed');
  readonly #print = tag('div', 'engines-print');

  constructor(contender: Contender) {
    this.#contender = contender;
    const name = tag('div', 'engines-name', tag('h3', '', contender.name), this.#where);
    const middle = tag('div', 'engines-middle', this.#track, this.#why);
    this.element = tag('li', 'engines-lane', name, middle, this.#time, this.#speed, this.#print);
    this.reset();
  }

  /** Empties the lane. An engine that cannot be here says why at once. */
  reset(): void {
    this.element.classList.remove('engines-first', 'engines-running');
    this.#bar.hidden = true;
    this.#where.textContent = this.#contender.where;
    this.#time.textContent = '–';
    this.#speed.textContent = '';
    this.#print.replaceChildren();
    this.#say(this.#contender.whyNot);
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
    const { median, first, isSoftware } = outcome.timing;
    const [time, unit] = timeOf(median);
    this.#time.replaceChildren(time, tag('small', '', ` ${unit}`));
    const { where } = this.#contender;
    const place = isSoftware ? where.replace('Your GPU', 'Software GPU') : where;
    this.#where.replaceChildren(place, tag('br', ''), `First run: ${timeText(first)}`);
  }

  /** Compares with the slowest engine, with one thread, and with the expected result. */
  compare(ran: Ran, slowest: number, oneThread: Ran | undefined, expected: string, isFirst: boolean): void {
    const { median } = ran.timing;
    this.#bar.hidden = false;
    this.#bar.style.width = `${(100 * median) / slowest}%`;
    this.element.classList.toggle('engines-first', isFirst);
    if (oneThread) {
      const factor = oneThread.timing.median / median;
      this.#speed.textContent = ran === oneThread ? '1×' : `${factor < 1 ? about(factor) : factor.toFixed(1)}×`;
    }
    const digits = shown(ran.fingerprint);
    const code = tag('code', '', digits.slice(0, 8), tag('wbr', ''), digits.slice(8));
    this.#print.replaceChildren(code, draw(ran.fingerprint, expected));
  }

  /** Lets the bar grow for so many milliseconds. */
  replay(duration: number): void {
    this.#bar.animate([{ clipPath: 'inset(0 100% 0 0)' }, { clipPath: 'inset(0)' }], { duration });
  }

  #say(why: string | undefined): void {
    this.#why.textContent = why ?? '';
    this.#why.hidden = why === undefined;
    this.#track.hidden = why !== undefined;
  }
}
