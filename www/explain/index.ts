/** The section "How a mesh becomes Delaunay": words, and six figures that run the engine. */

import './explain.css';
import './drawings.css';
import { made } from '../shell/elements.ts';
import { circle } from './circle.ts';
import { ends } from './ends.ts';
import { mountFigure } from './figure.ts';
import { flip } from './flip.ts';
import { label } from './label.ts';
import { select } from './select.ts';
import { update } from './update.ts';

const TITLE = 'How a mesh becomes Delaunay';
const LEDE =
  'A mesh is points joined into triangles. The same points can be joined in many ways, and some of them give long, thin triangles that shade, simulate and interpolate badly. One way is best. Here is how the edges find it, all at once. Each figure runs the real engine.';
const END =
  'Label, select, flip, update: that is one round. The engine runs round after round until no edge can flip. The creases of a surface and the edges that you lock are kept, so a few edges may stay that are not Delaunay. They are counted, with the reason for each.';

/** Puts the section into `host`. */
export function mountExplanation(host: HTMLElement): void {
  const head = document.createElement('header');
  head.className = 'explain-head';
  head.append(made('h2', '', TITLE), made('p', '', LEDE));
  const figures = document.createElement('div');
  figures.className = 'explain-figures';
  figures.append(...[circle, label, select, flip, update, ends].map((figure, i) => mountFigure(figure, i + 1)));
  const end = made('p', '', END);
  end.className = 'explain-end';
  host.append(head, figures, end);
}
