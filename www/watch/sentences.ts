/** What the page says of an edge and of a run. */

import type { EdgeState, Reasons } from 'edgeflip';
import { counted, number } from '../shell/numbers.ts';
import type { Quad } from './quad.ts';
import type { Run, Summary } from './run.ts';
import type { Flips } from './mesh-worker.ts';

/** What an edge does next, and why. `beta` is in degrees, `deviation` in the mesh's units. */
export function sentenceOf(quad: Quad, beta: number, deviation: number | undefined): string {
  const sum = Math.round(quad.angles.reduce((total, angle) => total + angle, 0));
  const bends =
    quad.bend > beta
      ? `the surface bends by ${Math.round(quad.bend)}° here. Flipping would change the shape`
      : `after a flip the surface would bend by ${Math.round(quad.bendAfter)}° here`;
  const sentences: Record<EdgeState, string> = {
    delaunay:
      sum === 180
        ? '180°, to the nearest degree. It is not more, so this edge is Delaunay and stays.'
        : `${sum}° is not more than 180°, so this edge is Delaunay and stays.`,
    flips: `${sum}° is more than 180°, so this edge flips in the next iteration.`,
    waits: `${sum}° is more than 180°. A neighbour shares a triangle with it and flips first; it is looked at again after that.`,
    angle: `Not Delaunay, but ${bends}; β allows ${beta}°.`,
    locked: 'Not Delaunay, but locked: drawn by you, a sharp feature, or the border of a material.',
    fold: 'Not Delaunay, but flipping would turn a triangle upside down.',
    duplicate: 'Not Delaunay, but the other diagonal is an edge of this mesh already.',
    deviation: `Not Delaunay, but flipping would move the surface further than your limit of ${deviation}.`,
    'non-manifold': `${counted(quad.opposite.length, 'triangle')} meet at this edge. It is unclear which two to turn, so it stays.`,
    inconsistent: 'Its two triangles face opposite ways, so it stays.',
    boundary: 'The rim of the mesh. With a triangle on one side only, there is nothing to flip.',
  };
  if (quad.state) return sentences[quad.state];
  if (quad.opposite.length === 1) return sentences.boundary;
  if (quad.opposite.length > 2) return sentences['non-manifold'];
  return sum > 180 ? `${sum}° is more than 180°, so this edge is not Delaunay.` : sentences.delaunay;
}

const sumOf = (reasons: Reasons) => Object.values(reasons).reduce((sum, count) => sum + count, 0);

/**
 * A bold beginning and the rest: what the shown iteration is. `ahead` has the flips of all iterations, where they are
 * known before they are run.
 */
export function statusOf(
  run: Run,
  summary: Summary | undefined,
  ahead: Flips[] | undefined,
): [bold: string, rest: string] {
  const { at, isOver, iterations } = run;
  if (isOver && summary?.iterations === iterations.length) {
    const [kept, turned] = [keptOf(summary.remaining), turnedOf(summary.inverted)];
    if (at === 0) return ['', (kept ? `Nothing can flip. ${kept}` : 'Already Delaunay. Try “Scramble”.') + turned];
    return ['Done.', (kept ? `Every edge is Delaunay, but for ${kept}` : 'Every edge is Delaunay.') + turned];
  }
  const next = iterations[at] ?? ahead?.[at];
  if (at === 0) return ['', next ? `${counted(next.labelled, 'edge')} can flip. Press play.` : 'Press play.'];
  const flips = iterations.slice(0, at).reduce((sum, iteration) => sum + iteration.flips, 0);
  if (!next) return [`After iteration ${number.format(at)}.`, `${counted(flips, 'flip')} so far.`];
  const of = ahead ? ` of ${number.format(ahead.length)}` : '';
  const waits = next.labelled - next.flips;
  const rest = waits > 0 ? `, ${number.format(waits)} ${waits === 1 ? 'waits' : 'wait'} for a neighbour.` : '.';
  return [
    `Iteration ${number.format(at + 1)}${of}.`,
    `${counted(next.flips, 'edge')} ${next.flips === 1 ? 'flips' : 'flip'} at once${rest}`,
  ];
}

/** A sentence about triangles that are turned over, after another one; nothing if there are none. */
function turnedOf(inverted: number): string {
  return inverted > 0 ? ` ${counted(inverted, 'triangle')} ${inverted === 1 ? 'is' : 'are'} turned over.` : '';
}

/** The edges that stay; nothing if there are none. */
function keptOf(remaining: Reasons): string {
  const kept = sumOf(remaining);
  if (kept === 0) return '';
  if (kept > (remaining.locked ?? 0)) return `${number.format(kept)} kept to save the shape.`;
  return `${number.format(kept)} kept because ${kept === 1 ? 'it is' : 'they are'} locked.`;
}
