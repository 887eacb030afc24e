/** The timeline: its stops are the states, the bars between them the flips. A range control lies over it. */

import { select } from 'd3-selection';
import type { Flips } from './mesh-worker.ts';
import { controls, element } from './controls.ts';
import { number } from '../shell/numbers.ts';

/** Half of the knob of the range control, in pixels. */
const EDGE = 9;
/** The most stops that have a dot and a label. */
const FEW = 16;
const WIDEST = 44;
/** The least room between two labels, in pixels. */
const BETWEEN = 6;

export class Timeline {
  readonly #svg = select(element('bars')).select<SVGSVGElement>('svg');
  #last: [readonly Flips[], number, boolean] = [[], 0, false];

  constructor() {
    new ResizeObserver(() => this.show(...this.#last)).observe(element('bars'));
  }

  /** Shows all iterations that are known, and the position `at`. `isWhole`: whether no more are coming. */
  show(flips: readonly Flips[], at: number, isWhole: boolean): void {
    this.#last = [flips, at, isWhole];
    const { clientWidth: width, clientHeight: height } = element('bars');
    // Hidden text has no size; it is drawn when it shows.
    if (width === 0) return;
    const [count, line] = [flips.length, height - 33];
    const x = (stop: number) => EDGE + (count === 0 ? 0 : (stop / count) * (width - 2 * EDGE));
    const most = Math.sqrt(Math.max(1, ...flips.map((each) => each.flips)));
    const tall = (each: Flips) => Math.max(2, (Math.sqrt(each.flips) / most) * (line - 26));
    const each = count > 0 ? (width - 2 * EDGE) / count : 0;
    const wide = Math.max(1, Math.min(WIDEST, each * 0.6));
    this.#svg.selectAll('*').remove();
    const track = (to: number, colour: string) =>
      this.#svg
        .append('path')
        .attr('d', `M${EDGE} ${line}H${to}`)
        .attr('stroke', `var(--${colour})`)
        .attr('stroke-width', 2);
    track(width - EDGE, 'hair');
    track(x(at), 'text');
    this.#svg
      .selectAll('rect')
      .data(flips)
      .join('rect')
      .attr('x', (_, i) => x(i + 0.5) - wide / 2)
      .attr('y', (bar) => line - 5 - tall(bar))
      .attr('width', wide)
      .attr('height', tall)
      .attr('rx', Math.min(3, wide / 2))
      .attr('fill', (_, i) => (i === at ? 'var(--spark)' : 'var(--text)'))
      .attr('opacity', (_, i) => (i === at ? 1 : i < at ? 0.5 : 0.2));
    const next = flips[at];
    if (next) this.#text(x(at + 0.5), line - tall(next) - 11, number.format(next.flips), 'here');
    const isFew = count <= FEW;
    if (isFew) this.#dots(count, at, x, line);
    const others = isFew ? Array.from({ length: count + 1 }, (_, i) => i) : [];
    const taken: [from: number, to: number][] = [];
    // A label that would touch one before it is left out.
    for (const stop of new Set([0, count, at, ...others])) {
      const words = stop === 0 ? 'Input' : stop === count && isWhole ? 'Result' : number.format(stop);
      const anchor = stop === 0 ? 'start' : stop === count ? 'end' : 'middle';
      const label = this.#text(x(stop), line + 24, words, stop === at ? 'here' : '', anchor);
      const { x: left, width: size } = label.node()!.getBBox();
      if (taken.some(([from, to]) => left < to + BETWEEN && from < left + size + BETWEEN)) label.remove();
      else taken.push([left, left + size]);
    }
  }

  #dots(count: number, at: number, x: (stop: number) => number, line: number): void {
    this.#svg
      .selectAll('circle')
      .data(Array.from({ length: count + 1 }, (_, i) => i))
      .join('circle')
      .attr('cx', x)
      .attr('cy', line)
      .attr('r', 2.5)
      .attr('fill', (stop) => (stop <= at ? 'var(--text)' : 'var(--muted)'));
  }

  #text(x: number, y: number, words: string, className: string, anchor = 'middle') {
    const shift = anchor === 'start' ? -EDGE : anchor === 'end' ? EDGE : 0;
    return this.#svg
      .append('text')
      .attr('x', x + shift)
      .attr('y', y)
      .attr('text-anchor', anchor)
      .attr('class', className)
      .text(words);
  }
}

/** Sets the range of the control to the stops that are known. */
export function showPosition(at: number, stops: number, isEnabled: boolean): void {
  const { slider } = controls;
  slider.max = `${stops}`;
  slider.value = `${at}`;
  slider.disabled = !isEnabled || stops === 0;
  slider.setAttribute('aria-valuetext', at === 0 ? 'the input' : `after iteration ${at} of ${stops}`);
}
