/** How the states of edges look, and what they are called. */

import type { EdgeState } from 'edgeflip';
import { create } from 'd3-selection';

interface Look {
  word: string;
  /** Says more in a few words. */
  gloss: string;
  /** The colour in `tokens.css`. */
  colour: string;
  /** A stroke and a gap, in pixels; none for a solid line. */
  dash?: readonly [number, number];
}

export const LOOKS: Record<EdgeState, Look> = {
  delaunay: { word: 'Delaunay', gloss: 'nothing to do', colour: 'edge' },
  flips: { word: 'Flips now', gloss: '', colour: 'flips' },
  waits: { word: 'Waits', gloss: 'a neighbour flips first', colour: 'waits', dash: [6, 3] },
  angle: { word: 'Kept: crease', gloss: 'the surface bends here', colour: 'crease', dash: [2, 4] },
  locked: { word: 'Kept: locked', gloss: 'seam, border, or as asked', colour: 'locked', dash: [11, 3] },
  fold: { word: 'Kept: fold', gloss: 'a triangle would turn over', colour: 'fold', dash: [4, 3] },
  duplicate: { word: 'Kept: double', gloss: 'the new edge exists already', colour: 'duplicate', dash: [2, 2] },
  deviation: { word: 'Kept: too far', gloss: 'a flip moves the surface', colour: 'deviation', dash: [3, 6] },
  'non-manifold': { word: 'Kept: crowded', gloss: 'more than two triangles', colour: 'non-manifold', dash: [9, 2] },
  inconsistent: { word: 'Kept: turned', gloss: 'its triangles face apart', colour: 'inconsistent', dash: [2, 5] },
  boundary: { word: 'Boundary', gloss: 'one triangle only', colour: 'rim' },
};

/** Whether an edge in this state is not Delaunay, or cannot be decided, and stays for that reason. */
export function isKept(state: EdgeState): boolean {
  return LOOKS[state].word.startsWith('Kept');
}

/** A piece of line as the picture draws it. */
export function swatch(state: EdgeState): SVGSVGElement {
  const { colour, dash } = LOOKS[state];
  const svg = create('svg').attr('viewBox', '0 0 30 12').attr('aria-hidden', 'true');
  svg
    .append('path')
    .attr('d', 'M1 6H29')
    .attr('stroke', `var(--${colour})`)
    .attr('stroke-width', state === 'delaunay' ? 1.5 : 3)
    .attr('stroke-dasharray', dash?.join(' ') ?? null);
  return svg.node()!;
}
