/** The drawing of a fingerprint. */

import { create } from 'd3-selection';
import { fingerprintOf } from '../shell/digest.ts';

/** Edges in a row of the drawing. */
const ROW = 8;
const CELL = 7.5;

const bitsOf = (digest: string) =>
  [...fingerprintOf(digest)].flatMap((digit) => [8, 4, 2, 1].map((bit) => (Number.parseInt(digit, 16) & bit) !== 0));

/**
 * Draws the first 64 bits of a digest as the edges of a mesh of 8 × 8 squares: a bit chooses one of the diagonals of its square.
 * The edges that differ from those of `expected` stand out.
 */
export function draw(digest: string, expected: string): SVGSVGElement {
  const wanted = bitsOf(expected);
  const edges = bitsOf(digest).map((bit, i) => {
    const [x, y] = [(i % ROW) * CELL, Math.floor(i / ROW) * CELL];
    return { isEqual: bit === wanted[i], d: bit ? `M${x} ${y}l${CELL} ${CELL}` : `M${x + CELL} ${y}l${-CELL} ${CELL}` };
  });
  const svg = create('svg').attr('viewBox', '-1 -1 62 62').attr('aria-hidden', 'true');
  svg
    .append('path')
    .attr('class', 'engines-frame')
    .attr('d', `M0 0H${ROW * CELL}V${ROW * CELL}H0Z`);
  for (const isEqual of [true, false]) {
    const path = edges.filter((edge) => edge.isEqual === isEqual).map(({ d }) => d);
    svg
      .append('path')
      .attr('class', isEqual ? 'engines-same' : 'engines-other')
      .attr('d', path.join(''));
  }
  return svg.node()!;
}
