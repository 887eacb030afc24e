/** The legend: how many edges are in each state. The reasons of edges that stay unfold. */

import { EDGE_STATES, type EdgeState } from 'edgeflip';
import { element } from './controls.ts';
import { made } from '../shell/elements.ts';
import { number } from '../shell/numbers.ts';
import { countStates, COLOURED } from './run.ts';
import { isKept, LOOKS, swatch } from './states.ts';

/** Shown even where no edge is in this state, so that the rows do not jump. */
const ALWAYS: readonly EdgeState[] = ['delaunay', 'flips', 'waits'];

/** Whether the reasons are unfolded. It holds for all meshes. */
let isOpen = false;

/** Shows the states of the half-edges. Without them, says why no edge is coloured. `triangles` is the mesh's number. */
export function showLegend(states: Uint8Array | undefined, triangles: number, nonManifold: number | undefined): void {
  const uncoloured = element('uncoloured');
  uncoloured.hidden = states !== undefined || triangles <= COLOURED;
  element('legend').hidden = !uncoloured.hidden;
  uncoloured.textContent = `${number.format(triangles)} triangles: too many to colour their edges. The page colours up to ${number.format(COLOURED)}.`;
  if (!states) return element('legend').replaceChildren();
  const counts = new Map(countStates(states, nonManifold).map((count, state) => [EDGE_STATES[state]!, count] as const));
  const rows = ALWAYS.map((state) => row(state, counts.get(state) ?? 0));
  const kept = [...counts].filter(([state, count]) => count > 0 && isKept(state));
  const rim = counts.get('boundary') ?? 0;
  element('legend').replaceChildren(
    ...rows,
    ...(kept.length > 0 ? [keptRow(kept)] : []),
    ...(rim > 0 ? [row('boundary', rim)] : []),
  );
}

function words(word: string, gloss: string): HTMLElement {
  return made('span', '', word, ...(gloss ? [made('em', '', gloss)] : []));
}

function row(state: EdgeState, count: number): HTMLElement {
  const { word, gloss } = LOOKS[state];
  const item = made('li', 'row', swatch(state), words(word, gloss), made('b', '', number.format(count)));
  item.dataset['state'] = state;
  return item;
}

/** One row for all edges that stay, with a row for each reason below. */
function keptRow(kept: readonly (readonly [EdgeState, number])[]): HTMLElement {
  const sum = kept.reduce((total, [, count]) => total + count, 0);
  const [most] = kept.reduce((a, b) => (b[1] > a[1] ? b : a));
  const button = made(
    'button',
    'row',
    swatch(most),
    words('Kept', kept.every(([state]) => state === 'locked') ? LOOKS.locked.gloss : 'to keep the shape'),
    made('b', '', number.format(sum)),
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
