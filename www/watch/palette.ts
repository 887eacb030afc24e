/** The colours of the page, for the canvas and the charts, which style sheets cannot reach. */

import { EDGE_STATES, type EdgeState } from 'edgeflip';
import { colourReader } from '../shell/theme.ts';
import { LOOKS } from './states.ts';

export interface Palette {
  ground: string;
  /** A surface where the light falls on it, and where it does not. */
  lit: string;
  shaded: string;
  /** A mesh in the plane. */
  plane: string;
  /** Plain edges. */
  line: string;
  text: string;
  hair: string;
  muted: string;
  states: Record<EdgeState, string>;
}

/** What the custom properties in `tokens.css` say now. */
export function palette(): Palette {
  const colour = colourReader();
  return {
    ground: colour('ground'),
    lit: colour('s0'),
    shaded: colour('s1'),
    plane: colour('card'),
    line: colour('edge'),
    text: colour('text'),
    hair: colour('hair'),
    muted: colour('muted'),
    states: Object.fromEntries(EDGE_STATES.map((state) => [state, colour(LOOKS[state].colour)])) as Palette['states'],
  };
}
