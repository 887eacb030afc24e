/** The elements of the playground: buttons, drawing, words. */

import { create } from 'd3-selection';
import { made } from '../shell/elements.ts';
import { layer, type Svg } from './draw.ts';
import { AREA, STOPS } from './stops.ts';
import { ABOUT } from './playground-words.ts';

function button(text: string, kind: string, title: string): HTMLButtonElement {
  const element = made('button', `read-button playground-button ${kind}`, text);
  element.type = 'button';
  element.title = title;
  return element;
}

function group(label: string, kind: string, buttons: readonly HTMLButtonElement[]): HTMLElement {
  const element = made('div', kind, ...buttons);
  element.role = 'group';
  element.ariaLabel = label;
  return element;
}

/** Makes the elements; `number` is the number of the figure. */
export function makeParts(number: number) {
  const steps = {
    back: button('Back', '', 'One phase back (←)'),
    label: button(ABOUT.label[0], '', 'Which edges are not Delaunay?'),
    select: button(ABOUT.select[0], '', 'Which of them flip in this round?'),
    flip: button(ABOUT.flip[0], '', 'They flip at once'),
    update: button(ABOUT.update[0], '', 'The neighbours learn of it'),
    round: button('Round', 'playground-round', 'All four phases of a round'),
  };
  const tools = {
    why: button('Explain an edge', '', 'Explain the next edge (N); a click explains any'),
    add: button('Add a point', '', 'In the largest triangle; a click adds one anywhere'),
    remove: button('Remove the point', '', 'The point that is chosen (Delete)'),
    clear: button('Clear', '', 'Remove all points'),
    reset: button('Start again', '', 'The points of the beginning'),
    link: button('Copy the link', '', 'It opens these points, triangles and marks'),
  };
  const svg: Svg = create('svg')
    .attr('class', 'explain-drawing playground-drawing')
    .attr('viewBox', `0 0 ${AREA.join(' ')}`)
    .attr('role', 'group')
    .attr('aria-label', 'Points and their triangles. Each point can be moved.');
  const layers = {
    under: layer(svg, ''),
    edges: layer(svg, ''),
    reach: layer(svg, 'playground-reach'),
    over: layer(svg, 'explain-arrows'),
    points: layer(svg, ''),
    labels: layer(svg, 'explain-labels explain-centred playground-labels'),
  };
  const caption = made('p', 'explain-caption');
  caption.ariaLive = 'polite';
  const says = made('p', 'playground-says');
  says.role = 'status';
  const stop = made('p', 'explain-words playground-stop');
  const why = made('div', 'playground-why');
  why.ariaLive = 'polite';
  const dial = create('svg')
    .attr('class', 'explain-drawing')
    .attr('viewBox', '0 0 120 124')
    .attr('aria-hidden', 'true');
  const dialShapes = layer(dial as Svg, '');
  const whyWords = made('p', 'explain-words');
  why.append(dial.node()!, whyWords);
  const phases = group('Phases of a round', 'playground-steps', [
    steps.back,
    ...STOPS.map((name) => steps[name]),
    steps.round,
  ]);
  const card = made('div', 'explain-card', phases, svg.node()!, made('div', 'explain-bar', caption));
  const title = made(
    'h3',
    'explain-title',
    made('span', 'explain-number', `${number}`),
    'A playground: set your own points',
  );
  const side = made(
    'div',
    'playground-side',
    stop,
    why,
    group('Points', 'playground-tools', Object.values(tools)),
    says,
  );
  const element = made('figure', 'explain-figure playground', title, card, side);
  return { element, steps, tools, svg, layers, caption, says, stop, why, dialShapes, whyWords };
}
