/** The colours of the page, for the canvas and the charts, which style sheets cannot reach. */

import type { EdgeState } from 'edgeflip';
import { colourReader } from '../shell/theme.ts';

export interface Palette {
  /** Behind the mesh. */
  ground: string;
  surface: string;
  /** Plain edges. */
  line: string;
  text: string;
  grid: string;
  accent: string;
  muted: string;
  states: Record<EdgeState, string>;
}

/** What the custom properties in `tokens.css` say now. */
export function palette(): Palette {
  const colour = colourReader();
  return {
    ground: colour('ground'),
    surface: colour('surface'),
    line: colour('edge'),
    text: colour('text'),
    grid: colour('hair'),
    accent: colour('spark'),
    muted: colour('muted'),
    states: {
      delaunay: colour('edge'),
      flips: colour('flips'),
      waits: colour('waits'),
      angle: colour('crease'),
      fold: colour('fold'),
      duplicate: colour('duplicate'),
      locked: colour('locked'),
      deviation: colour('deviation'),
      'non-manifold': colour('non-manifold'),
      inconsistent: colour('inconsistent'),
      boundary: colour('rim'),
    },
  };
}
