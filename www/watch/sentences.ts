/** What the page says of an edge and of a run. */

import type { EdgeState, Reasons } from 'edgeflip';
import { counted, degrees, ms as tenths, number, staying } from '../shell/numbers.ts';
import { isLecture } from './lecture.ts';
import { ENGINES } from './panel.ts';
import type { Quad } from './quad.ts';
import type { Run, Summary } from './run.ts';
import type { Flips } from './mesh-worker.ts';

const whole = new Intl.NumberFormat('en', { maximumFractionDigits: 0 });

/**
 * What an edge does next, and why. `beta` is in degrees, `deviation` in the mesh's units. `isNoSeam`: whether it keeps no
 * attribute of a file.
 */
export function sentenceOf(quad: Quad, beta: number, deviation: number | undefined, isNoSeam: boolean): string {
  const sum = Math.round(quad.angles.reduce((total, angle) => total + angle, 0));
  const bends =
    quad.bend > beta
      ? `the surface bends by ${Math.round(quad.bend)}° here`
      : `after a flip the surface would bend by ${Math.round(quad.bendAfter)}° here`;
  const stays = 'Not Delaunay, but it stays:';
  const sentences: Record<EdgeState, string> = {
    delaunay:
      sum === 180
        ? 'The sum is 180°, rounded. Exactly, it is not more than 180°, so this edge is Delaunay and stays.'
        : `${sum}° is not more than 180°, so this edge is Delaunay and stays.`,
    flips: `${sum}° is more than 180°, so this edge flips in the next iteration.`,
    waits: `${sum}° is more than 180°, but another edge of its triangles flips first. This one is checked again after that.`,
    angle: `${stays} ${bends}, more than the limit of ${beta}°.`,
    locked: `${stays} it is locked.${isNoSeam ? ' You drew it, or it is sharp.' : ''}`,
    fold: `${stays} a flip would turn a triangle upside down.`,
    duplicate: `${stays} a flip would give an edge that the mesh has already.`,
    deviation: `${stays} a flip would move the surface by more than your limit of ${deviation}.`,
    'non-manifold': `${counted(quad.opposite.length, 'triangle')} meet at this edge. A flip needs exactly two, so it stays.`,
    inconsistent: 'Its two triangles face opposite ways. A flip needs two that face the same way, so it stays.',
    boundary: 'This edge is on the boundary of the mesh. A flip needs two triangles, and there is only one.',
  };
  if (quad.state) return sentences[quad.state];
  if (quad.opposite.length === 1) return sentences.boundary;
  if (quad.opposite.length > 2) return sentences['non-manifold'];
  return sum > 180 ? `${sum}° is more than 180°, so this edge is not Delaunay.` : sentences.delaunay;
}

const sumOf = (reasons: Reasons) => Object.values(reasons).reduce((sum, count) => sum + count, 0);

/** The mean smallest angle of the input and of the state after `at` iterations, in degrees. */
export interface Smallest {
  at: number;
  before: number;
  now: number;
}

/**
 * A bold beginning and the rest: what the shown iteration is. `ahead` has the flips of all iterations, where they are
 * known before they are run, and `smallest` the angles of the shown state, once they are measured. `canScramble`: whether
 * the mesh is small enough to scramble.
 */
export function statusOf(
  run: Run,
  summary: Summary | undefined,
  ahead: Flips[] | undefined,
  smallest: Smallest | undefined,
  canScramble: boolean,
): [bold: string, rest: string] {
  const { at, isOver, iterations } = run;
  if (isOver && summary?.iterations === iterations.length) {
    return at > 0
      ? resultOf(run, summary, smallest)
      : ['', isLecture() || !canScramble ? nothingOf(summary) : `${nothingOf(summary)} Try “Scramble”.`];
  }
  const next = iterations[at] ?? ahead?.[at];
  if (at === 0) return ['', next ? `${wrongOf(next)} Press play.` : 'Press play.'];
  const of = ahead ? ` of ${number.format(ahead.length)}` : '';
  const bold = `After iteration ${number.format(at)}${of}:`;
  if (!next) return [bold, `${counted(flipsOf(run), 'flip')} so far.`];
  const waits = next.labelled - next.flips;
  return [
    bold,
    `${counted(next.flips, 'edge')} ${next.flips === 1 ? 'flips' : 'flip'} next${waits > 0 ? `, ${waitOf(waits)}` : ''}.`,
  ];
}

/** What is written under a saved picture: before any iteration what is wrong, else what the iterations have done. */
export function captionOf(
  run: Run,
  summary: Summary | undefined,
  ahead: Flips[] | undefined,
  smallest: Smallest | undefined,
): string {
  const next = run.iterations[0] ?? ahead?.[0];
  if (run.at === 0 && next) return wrongOf(next);
  if (!summary) return '';
  return run.at === 0 ? nothingOf(summary) : resultOf(run, summary, smallest).join(' ');
}

/** What is said of a mesh without an edge that can flip. */
function nothingOf({ remaining, inverted }: Summary): string {
  return `${sumOf(remaining) > 0 ? 'Nothing can flip.' : 'Already Delaunay.'}${keptOf(remaining)}${turnedOf(inverted)}`;
}

/** What the iterations up to the shown one have done, and after the last one what stays. */
function resultOf(run: Run, summary: Summary, smallest: Smallest | undefined): [bold: string, rest: string] {
  const { at, isOver, iterations } = run;
  const time = iterations.slice(0, at).reduce((sum, iteration) => sum + iteration.ms, 0);
  const engine = summary.backend === 'cpu' ? 'the CPU' : ENGINES[summary.backend];
  const angles = smallest?.at === at ? ` Smallest angle on average ${changeOf(smallest)}.` : '';
  const stays = isOver ? keptOf(summary.remaining) + turnedOf(summary.inverted) : '';
  return [
    counted(flipsOf(run), 'flip'),
    `in ${counted(at, 'iteration')}, ${timeOf(time)} on ${engine}.${angles}${stays}`,
  ];
}

const flipsOf = ({ at, iterations }: Run) =>
  iterations.slice(0, at).reduce((sum, iteration) => sum + iteration.flips, 0);

/** Two angles, with as many digits as they need to differ. */
function changeOf({ before, now }: Smallest): string {
  for (const format of [whole, tenths, degrees]) {
    const [from, to] = [format.format(before), format.format(now)];
    if (from !== to) return `${from}° → ${to}°`;
  }
  return `${degrees.format(now)}°, as before`;
}

function timeOf(time: number): string {
  if (time >= 10_000) return `${tenths.format(time / 1000)} s`;
  if (time >= 10) return `${whole.format(time)} ms`;
  return time < 0.1 ? 'less than 0.1 ms' : `${tenths.format(time)} ms`;
}

/** The edges that the next iteration looks at. */
function wrongOf({ labelled, flips }: Flips): string {
  const wrong = `${counted(labelled, 'edge')} ${labelled === 1 ? 'is' : 'are'} wrong`;
  if (labelled === 1) return `${wrong}.`;
  if (labelled === flips) return `${wrong}, and all flip at once.`;
  return `${wrong}: ${number.format(flips)} ${flips === 1 ? 'flips' : 'flip'} first, ${waitOf(labelled - flips)}.`;
}

export const waitOf = (count: number) => `${number.format(count)} ${count === 1 ? 'waits' : 'wait'}`;

/** A sentence about triangles that are turned over, after another one; nothing if there are none. */
function turnedOf(inverted: number): string {
  return inverted > 0 ? ` ${counted(inverted, 'triangle')} ${inverted === 1 ? 'is' : 'are'} turned over.` : '';
}

/** A sentence about the edges that stay, after another one; nothing if there are none. */
function keptOf(remaining: Reasons): string {
  const kept = sumOf(remaining);
  if (kept === 0) return '';
  if (kept > (remaining.locked ?? 0)) return ` ${staying(kept)} to keep the shape.`;
  return ` ${staying(kept)}, because ${kept === 1 ? 'it is' : 'they are'} locked.`;
}
