/** Draws the times of the engines by size, on logarithmic scales. */

import { select } from 'd3-selection';
import type { Point, Series } from './sizes.ts';
import { about } from './words.ts';

const SIZES = { 100: '100', 1e3: '1,000', 1e4: '10,000', 1e5: '100,000', 1e6: '1 million' };

/** The least and the greatest size that is drawn. */
const [LEAST, MOST] = [100, 1e6];

/** Pixels between the names of two lines. */
const LINE = 18;

/**
 * Puts the drawing into `host`, as wide as it is: the times of this computer over the recorded ones. `crossing` is where
 * a GPU becomes first.
 */
export function plot(
  host: HTMLElement,
  series: readonly Series[],
  recorded: readonly Series[],
  crossing: Point | undefined,
): void {
  const width = Math.max(280, host.clientWidth);
  const isSlim = width < 520;
  const height = isSlim ? 320 : 400;
  const [left, right, top, bottom] = [68, isSlim ? 84 : 132, 20, 60];
  const [low, high] = decades([...series, ...recorded]);
  const scale = (value: number, from: number, to: number) => Math.log10(value / from) / Math.log10(to / from);
  const x = (triangles: number) => left + scale(triangles, LEAST, MOST) * (width - left - right);
  const y = (ms: number) => height - bottom - scale(ms, low, high) * (height - top - bottom);

  const svg = select(host).selectAll('svg').data([0]).join('svg');
  svg.attr('viewBox', `0 0 ${width} ${height}`).attr('role', 'img').attr('aria-label', labelOf(series));
  svg.selectAll('*').remove();
  const line = (d: string, kind: string) => svg.append('path').attr('class', `engines-${kind}`).attr('d', d);
  const text = (words: string, at: [number, number], anchor: 'start' | 'middle' | 'end', kind = 'axis') =>
    svg
      .append('text')
      .attr('class', `engines-${kind}`)
      .attr('x', at[0])
      .attr('y', at[1])
      .attr('text-anchor', anchor)
      .text(words);

  for (let ms = low; ms < 1.01 * high; ms *= 10) {
    line(`M${left} ${y(ms)}H${width - right}`, 'grid');
    text(ms < 999 ? `${Number(ms.toPrecision(1))} ms` : `${Math.round(ms / 1000)} s`, [left - 12, y(ms) + 4], 'end');
  }
  for (const [size, name] of Object.entries(SIZES)) {
    const isLeftOut = isSlim && (size === '1000' || size === '100000');
    if (!isLeftOut) text(name, [x(Number(size)), height - bottom + 24], 'middle');
  }
  text('triangles', [(left + width - right) / 2, height - 8], 'middle');

  const drawn = series.filter(({ points }) => points.length > 0);
  const pathOf = ({ points }: Series) => `M${points.map(({ triangles, ms }) => `${x(triangles)} ${y(ms)}`).join('L')}`;
  for (const one of recorded) line(pathOf(one), `line engines-old engines-${one.contender.options.backend}`);
  if (crossing) {
    line(`M${x(crossing.triangles)} ${top}V${height - bottom}`, 'crossing');
    const isLate = crossing.triangles > 20_000;
    const at: [number, number] = [x(crossing.triangles) + (isLate ? -10 : 10), top + 6];
    text(`${about(crossing.triangles)} triangles`, at, isLate ? 'end' : 'start', 'at');
  }
  for (const one of drawn) {
    const kind = one.contender.options.backend;
    line(pathOf(one), `line engines-${kind}`);
    for (const { triangles, ms } of one.points) {
      svg
        .append('circle')
        .attr('class', `engines-dot engines-${kind}`)
        .attr('cx', x(triangles))
        .attr('cy', y(ms))
        .attr('r', 3.2);
    }
  }
  if (crossing) {
    const [cx, cy] = [x(crossing.triangles), y(crossing.ms)];
    svg.append('circle').attr('class', 'engines-ring').attr('cx', cx).attr('cy', cy).attr('r', 7);
  }
  // The names stand at the ends of their lines, from above to below, and never on each other.
  const named = drawn.length > 0 ? drawn : recorded;
  const ends = named.map(({ contender, points }) => ({ contender, end: points.at(-1)! }));
  let above = -Infinity;
  for (const { contender, end } of ends.sort((a, b) => b.end.ms - a.end.ms)) {
    const at = Math.max(y(end.ms) + 5, above + LINE);
    above = at;
    const name = isSlim || named === recorded ? contender.name.replace(/,.*/, '') : contender.name;
    text(name, [x(end.triangles) + 12, at], 'start', `end engines-${contender.options.backend}`);
  }
}

/** The powers of ten around all times. */
function decades(series: readonly Series[]): [number, number] {
  const logs = series.flatMap(({ points }) => points.map(({ ms }) => Math.log10(ms)));
  const low = Math.floor(Math.min(...logs));
  return [10 ** low, 10 ** Math.max(Math.ceil(Math.max(...logs)), low + 1)];
}

function labelOf(series: readonly Series[]): string {
  const drawn = series.filter(({ points }) => points.length > 0).map(({ contender }) => contender.name);
  if (drawn.length === 0) return 'The recorded times by the size of the mesh, for CPU, WebGPU and WebGL2';
  const names = new Intl.ListFormat('en').format(drawn);
  return `The times by the size of the mesh: ${names}. The table below has the numbers.`;
}
