/** The colours of the page, for the canvas and the charts, which style sheets cannot reach. */

import type { EdgeState } from 'edgeflip';

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

/** What the custom properties in `colours.css` say now. */
export function palette(): Palette {
  const style = getComputedStyle(document.documentElement);
  const colour = (name: string) => style.getPropertyValue(`--${name}`).trim();
  return {
    ground: colour('ground'),
    surface: colour('surface'),
    line: colour('edge-delaunay'),
    text: colour('text'),
    grid: colour('grid'),
    accent: colour('accent'),
    muted: colour('muted'),
    states: {
      delaunay: colour('edge-delaunay'),
      flips: colour('edge-flips'),
      waits: colour('edge-waits'),
      angle: colour('edge-angle'),
      fold: colour('edge-fold'),
      duplicate: colour('edge-duplicate'),
      locked: colour('edge-locked'),
      deviation: colour('edge-deviation'),
      'non-manifold': colour('edge-non-manifold'),
      inconsistent: colour('edge-inconsistent'),
      boundary: colour('edge-boundary'),
    },
  };
}
