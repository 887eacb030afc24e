/** The full reference of the paper, and where its authors published more about the method. */

import { made } from '../shell/elements.ts';

const AUTHORS = 'Cristobal A. Navarro, Nancy Hitschfeld-Kahler, Eliana Scheihing: ';

/** The three texts: the title, and the place. The first one is what edgeflip follows. */
const TEXTS = [
  [
    'A Quasi-Parallel GPU-Based Algorithm for Delaunay Edge-Flips',
    'Sent to ACM Transactions on Graphics in August 2010. We follow the manuscript of 28 February 2011, and know of no DOI.',
  ],
  ['A Parallel GPU-based Algorithm for Delaunay Edge-flips', 'EuroCG 2011, Morschach, 28–30 March 2011.'],
  [
    'Quasi-Delaunay Triangulations Using GPU-Based Edge-Flips',
    'Communications in Computer and Information Science 458, Springer. DOI 10.1007/978-3-662-44911-0_3.',
  ],
] as const;

/** The paper, and two later texts about the method. */
export function reference(): HTMLElement {
  const items = TEXTS.map(([title, place]) => made('li', '', AUTHORS, made('cite', '', title), `. ${place}`));
  const more = made('a', '', 'All tests of the paper, measured again');
  more.href = 'docs/paper.html';
  const heading = made('h3', '', 'The paper, and what followed');
  return made('section', 'paper-reference', heading, made('ol', '', ...items), made('p', '', more));
}
