/** The section "The paper, run again": our numbers beside the paper's, and its two plots, run here. */

import './paper.css';
import { WorkerClient } from '../watch/worker-client.ts';
import { made } from '../shell/elements.ts';
import { number } from '../shell/numbers.ts';
import { timeText } from '../engines/words.ts';
import { bars } from './bars.ts';
import { crossoverOf, ours, rowsOf } from './measured.ts';
import { reference } from './reference.ts';

const LEDE =
  'In 2011, Navarro, Hitschfeld-Kahler and Scheihing flipped edges in parallel on a GPU. These are their tests with edgeflip on a newer GPU. Their numbers are grey. They did not publish their meshes, so we built others with as many vertices, edges and triangles.';
const MISFITS =
  'Two things in the paper do not fit. For meshes 1 and 2, the columns of edges and triangles are swapped. Mesh 4 has 70,290 edges and 40,648 triangles, so 18,636 of its edges are on the boundary; the mesh that we built has as many. The paper’s machine: GeForce 9800 GTX+ and Phenom X4 850.';
const NATIVE = 'Run natively, without a browser. The section “Engines” has the sizes in browsers.';
const significant = new Intl.NumberFormat('en', { maximumSignificantDigits: 3 });

/** The runs of the plots: the mesh of the first, and the worst cases of the second. */
const MESH_5 = 'uvsphere 600';
const WORST = [8, 12, 16, 1000];

/** The milliseconds after which a run for a plot stops. A slow phone needs time. */
const LONGEST = 60_000;

/** Puts the section into `host`. The plots run when they are near the view. */
export function mountPaper(host: HTMLElement): void {
  host.append(made('h2', '', 'The paper, run again'), made('p', 'lede', LEDE));
  if (ours) host.append(tableOf(ours), made('p', 'paper-note', MISFITS), openQuestions(ours));
  const five = made('figure', '', made('h3', '', 'Flips in each iteration, mesh 5'));
  const worst = made('figure', '', made('h3', '', 'Flips in each iteration, the worst case'));
  const choices = made('div', 'paper-choices');
  worst.append(choices);
  host.append(made('div', 'paper-pair', five, worst), reference());
  for (const nodes of WORST) {
    const button = made('button', '', `${number.format(nodes)} vertices`);
    button.type = 'button';
    button.addEventListener('click', () => void show(nodes));
    button.dataset['nodes'] = `${nodes}`;
    choices.append(button);
  }
  const show = async (nodes: number) => {
    for (const button of choices.querySelectorAll('button')) {
      button.ariaPressed = `${button.dataset['nodes'] === `${nodes}`}`;
    }
    await run(worst, `strips ${nodes}`);
  };
  new IntersectionObserver(([entry], observer) => {
    if (!entry?.isIntersecting) return;
    observer.disconnect();
    void run(five, MESH_5);
    void show(16);
  }).observe(five);
}

/** Runs the package on a mesh and draws the flips of its iterations. */
async function run(figure: HTMLElement, spec: string): Promise<void> {
  const caption = figure.querySelector('figcaption') ?? figure.appendChild(made('figcaption', ''));
  caption.textContent = 'Running on this computer…';
  figure.dataset['spec'] = spec;
  const client = new WorkerClient();
  try {
    const mesh = await client.call((worker) => worker.generate(spec));
    // The start of the engine is no part of the run.
    await client.call((worker) => worker.load());
    const start = performance.now();
    const flips = await client.call((worker) => worker.lookAhead(mesh, { backend: 'cpu' }, LONGEST));
    // Another choice came first.
    if (figure.dataset['spec'] !== spec) return;
    const took = timeText(performance.now() - start);
    if (!flips) throw new Error('it takes more than a minute here');
    figure.querySelector('svg')?.remove();
    caption.before(bars(flips.map((each) => each.flips)));
    const sum = flips.reduce((total, each) => total + each.flips, 0);
    caption.textContent = `${number.format(sum)} flips in ${number.format(flips.length)} iterations, in ${took} on this computer’s CPU.`;
  } catch (error) {
    caption.textContent = `It could not be run here: ${error instanceof Error ? error.message : String(error)}.`;
  } finally {
    client.close();
  }
}

type Measured = NonNullable<typeof ours>;

function tableOf(measured: Measured): HTMLElement {
  const head = made('tr', '');
  for (const [name, isOurs] of [
    ['Mesh', true],
    ['Triangles', true],
    ['Iterations, theirs', false],
    ['ours', true],
    ['GPU ms, theirs', false],
    ['ours', true],
    ['CPU ms, theirs', false],
    ['ours', true],
    ['Speed-up, theirs', false],
    ['ours', true],
  ] as const) {
    const cell = made('th', isOurs ? '' : 'theirs', name);
    cell.scope = 'col';
    head.append(cell);
  }
  const body = made('tbody', '');
  for (const { mesh, theirs } of rowsOf(measured)) {
    const { gpu, lawson } = mesh;
    const numbers: [theirs: number | undefined, ours: number][] = [
      [theirs?.iterations, mesh.iterations],
      [theirs && 1000 * theirs.gpu, gpu.total],
      [theirs && 1000 * theirs.cpu, lawson.total],
      [theirs?.speedUp, lawson.total / gpu.total],
    ];
    const row = made('tr', '', made('td', '', mesh.id ? `Mesh ${mesh.id}` : mesh.name));
    row.append(made('td', '', number.format(mesh.triangles)));
    for (const [old, now] of numbers) {
      row.append(made('td', 'theirs', old === undefined ? '–' : significant.format(old)));
      row.append(made('td', '', significant.format(now)));
    }
    body.append(row);
  }
  const caption = made(
    'caption',
    '',
    // In view while the table scrolls.
    made(
      'span',
      '',
      `Ours: ${measured.machine.adapter.split(',')[0]}, Lawson’s algorithm on one thread of its host’s CPU, ${measured.date}.`,
    ),
  );
  const box = made('div', 'paper-table', made('table', '', caption, made('thead', '', head), body));
  Object.assign(box, { tabIndex: 0, role: 'region', ariaLabel: 'Table 3: iterations and times' });
  return box;
}

/** What the paper leaves open. */
function openQuestions(measured: Measured): HTMLElement {
  const largest = measured.meshes.at(-1)!;
  const { baseline, gpu } = largest;
  const [flips, all] = [baseline.flips / gpu.flips, baseline.total / gpu.total].map((factor) =>
    significant.format(factor),
  );
  const wrong = measured.meshes.find((mesh) => mesh.baseline.fault !== null);
  const fault = wrong
    ? ` The paper does not say what to do if two flips make the same edge, so its way gives a wrong result for mesh ${wrong.id}.`
    : '';
  return made(
    'ul',
    'paper-open',
    made('li', '', made('b', '', 'From which size is the GPU faster?'), sizesTable(measured), NATIVE),
    made(
      'li',
      '',
      made('b', '', 'Select on the GPU or on the CPU?'),
      `The paper selects on the CPU, edgeflip on the GPU. On a mesh of ${number.format(largest.edges)} edges, the paper’s way takes ${flips} times as long for the flips, and ${all} times as long for the whole run.${fault}`,
    ),
  );
}

/** From which size on the GPU is faster: where many edges flip or none does, against one thread or all. */
function sizesTable(measured: Measured): HTMLElement {
  const cell = (words: string, scope: 'col' | 'row') => {
    const head = made('th', '', words);
    head.scope = scope;
    return head;
  };
  const against = [
    ['cpu', 'than 1 CPU thread'],
    ['cores', `than ${measured.machine.threads} CPU threads`],
  ] as const;
  const rows = [
    ['random', 'Many edges flip'],
    ['delaunay', 'No edge flips'],
  ].map(([family, words]) => {
    const sizes = against.map(([cpu]) => crossoverOf(measured, family!, cpu));
    const cells = sizes.map((size) => made('td', '', size === undefined ? '–' : `${number.format(size)} triangles`));
    return made('tr', '', cell(words!, 'row'), ...cells);
  });
  const heads = made('tr', '', made('td', ''), ...against.map(([, words]) => cell(words, 'col')));
  return made('table', 'paper-sizes', made('thead', '', heads), made('tbody', '', ...rows));
}
