/** The section "How a mesh becomes Delaunay": words and five figures. */

import './explain.css';
import './drawings.css';
import { made } from '../shell/elements.ts';
import { circle } from './circle.ts';
import { ends } from './ends.ts';
import { mountFigure } from './figure.ts';
import { label } from './label.ts';
import { Playground } from './playground.ts';
import { mountWhy } from './why.ts';

const TITLE = 'How a mesh becomes Delaunay';
const LEDE =
  'A mesh is points joined into triangles. The same points can be joined in many ways. Long, thin triangles shade, simulate and interpolate badly, and one way avoids them best. Here is how the edges find it, all at once.';
const END =
  'Label, select, flip, update: that is one iteration. The engine iterates until no edge can flip. It keeps the creases of a surface and the edges that you lock, so a few edges may stay that are not Delaunay. It counts them, with the reason for each.';

/** Puts the section into `host`. */
export function mountExplanation(host: HTMLElement): void {
  const head = document.createElement('header');
  head.className = 'explain-head';
  head.append(made('h2', '', TITLE), made('p', '', LEDE));
  const figures = document.createElement('div');
  figures.className = 'explain-figures';
  figures.append(...[circle, label, ends].map((figure, i) => mountFigure(figure, i + 2)));
  const playground = new Playground(5);
  host.append(head, mountWhy(1), figures, playground.element, made('p', 'explain-end', END));
  if (location.hash.startsWith('#explain?')) playground.element.scrollIntoView();
}
