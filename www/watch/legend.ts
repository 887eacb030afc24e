/** The legend: how many edges are in each state. The reasons of edges that stay unfold. */

import { EDGE_STATES, type EdgeState } from 'edgeflip';
import { element } from './controls.ts';
import { made } from '../shell/elements.ts';
import { number } from '../shell/numbers.ts';
import { LEAST, MOST, ROUND } from './surface.ts';
import { isKept, LOOKS, swatch } from './states.ts';

/** Shown even where no edge is in this state, so that the rows do not jump. */
const ALWAYS: readonly EdgeState[] = ['delaunay', 'flips', 'waits'];

/** Whether the reasons are unfolded. It holds for all meshes. */
let isOpen = false;

/** The mesh of a legend. */
interface Of {
  /** Whether the legend has the same rows always, because the numbers of a large mesh come late. */
  isLarge: boolean;
  /** Whether it lies in the plane, where nothing has to be kept for the shape. */
  isPlane: boolean;
  /** The number of locked edges, once it is known. They are in the rows of other states too. */
  locks?: number | undefined;
}

/** Shows the number of edges in each state: `undefined` while they are not known, which hides it unless it is large. */
export function showLegend(numbers: readonly number[] | undefined, { isLarge, isPlane, locks = 0 }: Of): void {
  element('legend').hidden = !numbers && !isLarge;
  const counts = new Map(EDGE_STATES.map((state, k) => [state, numbers?.[k]] as const));
  const rows = ALWAYS.map((state) => row(state, counts.get(state)));
  const found = EDGE_STATES.filter((state) => isKept(state) && (counts.get(state) ?? 0) > 0);
  const kept = (found.length > 0 ? found : isLarge && !isPlane ? (['angle'] as const) : []).map(
    (state) => [state, counts.get(state)] as const,
  );
  const boundary = counts.get('boundary');
  element('legend').replaceChildren(
    ...rows,
    ...(kept.length > 0 ? [keptRow(kept)] : []),
    ...(isLarge || (boundary ?? 0) > 0 ? [row('boundary', boundary)] : []),
    ...(locks > 0 ? [locksRow(locks)] : []),
  );
}

/** A number, or a sign that it is not known yet. */
const written = (count: number | undefined) => (count === undefined ? '…' : number.format(count));

function words(word: string, gloss: string): HTMLElement {
  return made('span', '', word, ...(gloss ? [made('em', '', gloss)] : []));
}

function row(state: EdgeState, count: number | undefined): HTMLElement {
  const { word, gloss } = LOOKS[state];
  const item = made('li', 'row', swatch(state), words(word, gloss), made('b', '', written(count)));
  item.dataset['state'] = state;
  return item;
}

/** The locked edges, which are in other rows too: no line of the picture is theirs alone. */
function locksRow(count: number): HTMLElement {
  const item = made(
    'li',
    'row locks',
    made('span', ''),
    words('Locked', 'kept where they are'),
    made('b', '', written(count)),
  );
  item.title = 'They are counted above too, by their angles.';
  return item;
}

/** One row for all edges that stay, with a row for each reason below. */
function keptRow(kept: readonly (readonly [EdgeState, number | undefined])[]): HTMLElement {
  const isKnown = kept.every(([, count]) => count !== undefined);
  const sum = kept.reduce((total, [, count]) => total + (count ?? 0), 0);
  const [most] = kept.reduce((a, b) => ((b[1] ?? 0) > (a[1] ?? 0) ? b : a));
  const button = made(
    'button',
    'row',
    swatch(most),
    words('Kept', kept.every(([state]) => state === 'locked') ? LOOKS.locked.gloss : 'to keep the shape'),
    made('b', '', written(isKnown ? sum : undefined)),
  );
  button.type = 'button';
  const reasons = made('ul', '', ...kept.map(([state, count]) => row(state, count)));
  const show = () => {
    button.ariaExpanded = `${isOpen}`;
    reasons.hidden = !isOpen;
  };
  button.addEventListener('click', () => {
    isOpen = !isOpen;
    show();
  });
  show();
  return made('li', '', button, reasons);
}

/** What the picture of a large mesh has: nothing but the surface, its edges, tints, or some of both. */
export type Draws = 'nothing' | 'edges' | 'tints' | 'both';

/**
 * Says what is drawn of a large mesh; `undefined` for another mesh. `isAsInFile`: whether it has the colours of its file,
 * and so no tints.
 */
export function showDraws(draws: Draws | undefined, isColoured: boolean, isAsInFile: boolean): void {
  const says = element('uncoloured');
  says.hidden = draws === undefined;
  says.dataset['draws'] = draws ?? '';
  if (draws === undefined) return;
  const hot = isColoured ? [made('b', 'hot', 'Orange'), ': an edge flips. '] : [];
  const words = {
    nothing: ['The surface alone. Press E for its edges.'],
    edges: ['Edges. ', ...hot],
    tints: [
      `Edges are too short to draw here${isAsInFile ? '' : ': each triangle is tinted by its smallest angle'}. `,
      ...hot,
      'Zoom in for edges.',
    ],
    both: [
      `Edges where they are long enough. ${isAsInFile ? '' : 'Elsewhere each triangle is tinted by its smallest angle. '}`,
      ...hot,
    ],
  }[draws];
  says.replaceChildren(...words, ...(!isAsInFile && (draws === 'tints' || draws === 'both') ? [scale()] : []));
}

/** The scale of the tints. */
function scale(): HTMLElement {
  const bar = made('i', 'scale');
  bar.style.setProperty('--least', `${100 * LEAST}%`);
  bar.style.setProperty('--most', `${100 * MOST}%`);
  return made('span', 'tints', '0°', bar, `${ROUND}° and more`);
}
