/** A plot of the flips in each iteration. */

import { create } from 'd3-selection';
import { number } from '../shell/numbers.ts';

const [WIDTH, HEIGHT, BOTTOM, TOP] = [560, 260, 28, 22];
/** The most bars that have their numbers. */
const FEW = 16;

export function bars(flips: readonly number[]): SVGSVGElement {
  const most = Math.max(...flips, 1);
  const step = WIDTH / flips.length;
  const wide = Math.max(0.5, Math.min(40, step * 0.7));
  const tall = (value: number) => Math.max(1, (value / most) * (HEIGHT - BOTTOM - TOP));
  const svg = create('svg')
    .attr('viewBox', `0 0 ${WIDTH} ${HEIGHT}`)
    .attr('role', 'img')
    .attr('aria-label', `Flips in each of ${flips.length} iterations, at most ${number.format(most)}`);
  svg
    .append('path')
    .attr('d', `M0 ${HEIGHT - BOTTOM}H${WIDTH}`)
    .attr('stroke', 'var(--hair)');
  svg
    .selectAll('rect')
    .data(flips)
    .join('rect')
    .attr('x', (_, i) => (i + 0.5) * step - wide / 2)
    .attr('y', (value) => HEIGHT - BOTTOM - tall(value))
    .attr('width', wide)
    .attr('height', tall)
    .attr('rx', Math.min(3, wide / 2))
    .attr('fill', 'var(--text)');
  const isFew = flips.length <= FEW;
  const labels = isFew ? flips.map((_, i) => i) : [0, Math.floor(flips.length / 2), flips.length - 1];
  for (const i of labels) {
    const anchor = isFew || (i > 0 && i < flips.length - 1) ? 'middle' : i === 0 ? 'start' : 'end';
    const text = (y: number, words: string) =>
      svg
        .append('text')
        .attr('x', (i + 0.5) * step)
        .attr('y', y)
        .attr('text-anchor', anchor)
        .text(words);
    text(HEIGHT - 8, number.format(i + 1));
    if (isFew) text(HEIGHT - BOTTOM - tall(flips[i]!) - 6, number.format(flips[i]!)).attr('class', 'count');
  }
  return svg.node()!;
}
