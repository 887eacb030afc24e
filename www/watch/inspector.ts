/** The inspector: an edge with its two triangles laid flat, its opposite angles beside each other, and a sentence. */

import type { IndexedMesh } from 'edgeflip/files';
import { element } from './controls.ts';
import { made } from '../shell/elements.ts';
import { angleFan, lens } from './lens.ts';
import type { Quad } from './quad.ts';
import { isOpen, sayingOf, type Seam } from './seam.ts';
import { sentenceOf } from './sentences.ts';
import { LOOKS, swatch } from './states.ts';

export interface Limits {
  maxNormalAngle: number;
  maxDeviation: number | undefined;
  /** Whether borders between groups of triangles keep edges. */
  keepsGroups: boolean;
}

/** Shows an edge, as the picture shows it: `turn` is its angle on screen. `seams` lie along it, once they are known. */
export function showEdge(
  quad: Quad,
  mesh: IndexedMesh,
  limits: Limits,
  turn: number,
  seams: readonly Seam[] | undefined,
): void {
  const { state, a, b, angles, opposite } = quad;
  const rounded = angles.map((angle) => `${Math.round(angle)}°`);
  const sum = Math.round(angles.reduce((total, angle) => total + angle, 0));
  const isSeam = seams?.some(isOpen) === true;
  const name = isSeam ? 'Seam' : state ? LOOKS[state].word : sum > 180 ? 'Not Delaunay' : 'Delaunay';
  const colour = state ? LOOKS[state].colour : 'edge';
  const parts: Node[] = [
    made('header', '', swatch(state ?? 'delaunay'), name, made('small', '', `edge ${a}–${b}`), closer()),
    lens(quad, mesh, colour, turn),
  ];
  const numbers = made('div', 'sum');
  if (opposite.length === 2) {
    numbers.append(angleFan(angles, colour), made('strong', '', `${sum}°`), made('span', '', rounded.join(' + ')));
  } else if (opposite.length === 1) {
    numbers.append(made('strong', '', rounded[0]!), made('span', '', 'one angle'));
  }
  const why = isSeam ? '' : sentenceOf(quad, limits.maxNormalAngle, limits.maxDeviation, seams?.length === 0);
  parts.push(numbers, made('p', '', [why, sayingOf(seams ?? [])].filter(Boolean).join(' ')));
  const box = element('inspect');
  box.replaceChildren(...parts);
  box.dataset['edge'] = `${a} ${b}`;
  box.hidden = false;
}

/** The button that closes the card; where the inspector is a part of the side, there is none. */
function closer(): HTMLButtonElement {
  const button = made('button', 'icon close', '✕');
  button.type = 'button';
  button.ariaLabel = 'Close';
  return button;
}

export function hideEdge(): void {
  element('inspect').hidden = true;
  drawThread(undefined);
}

/** A line from the inspector to the edge at `point` of the picture, where the inspector is beside it. */
export function drawThread(point: readonly [x: number, y: number] | undefined): void {
  const path = element('thread').querySelector('path');
  const [stage, box] = [element('stage').getBoundingClientRect(), element('inspect').getBoundingClientRect()];
  const isBeside = box.left > stage.width / 2 && box.width > 0;
  if (!point || !isBeside) return path?.setAttribute('d', '');
  const [x, y] = [box.left - stage.left - 10, box.top - stage.top + 26];
  path?.setAttribute('d', `M${x} ${y}h-20L${point[0]} ${point[1]}`);
}
