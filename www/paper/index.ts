/** The section "The paper, run again": our numbers beside the paper's, and its two plots, run here. */

import './paper.css';
import { WorkerClient } from '../watch/worker-client.ts';
import { made } from '../shell/elements.ts';
import { number } from '../shell/numbers.ts';
import { bars } from './bars.ts';
import { crossoverOf, ours, rowsOf } from './measured.ts';

const LEDE =
  'Navarro, Hitschfeld-Kahler and Scheihing showed in 2011 that edges can flip in parallel. They did not publish their meshes; ours have the same counts. Their numbers stand in grey beside ours.';
const MISFITS =
  'Meshes 1 and 2: the paper’s columns of edges and triangles are swapped. Mesh 4: 70,290 edges on 40,648 triangles mean 18,636 edges on the boundary; ours has them. Theirs: GeForce 9800 GTX+ and Phenom X4 850.';
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
  const worst = made('figure', '', made('h3', '', 'The worst case'));
  const choices = made('div', 'paper-choices');
  worst.append(choices);
  host.append(made('div', 'paper-pair', five, worst));
  for (const nodes of WORST) {
    const button = made('button', '', `${number.format(nodes)} points`);
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
    const start = performance.now();
    const flips = await client.call((worker) => worker.lookAhead(mesh, { backend: 'cpu' }, LONGEST));
    // Another choice came first.
    if (figure.dataset['spec'] !== spec) return;
    if (!flips) throw new Error('it takes more than a minute here');
    figure.querySelector('svg')?.remove();
    caption.before(bars(flips.map((each) => each.flips)));
    const sum = flips.reduce((total, each) => total + each.flips, 0);
    const took = significant.format((performance.now() - start) / 1000);
    caption.textContent = `${number.format(sum)} flips in ${number.format(flips.length)} iterations, run on this computer’s CPU in ${took} s.`;
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
  const [many, none, manyAll, noneAll] = (['cpu', 'cores'] as const).flatMap((against) =>
    ['random', 'delaunay'].map((family) => crossoverOf(measured, family, against)),
  );
  const largest = measured.meshes.at(-1)!;
  const { baseline, gpu } = largest;
  const [flips, all] = [baseline.flips / gpu.flips, baseline.total / gpu.total];
  const wrong = measured.meshes.find((mesh) => mesh.baseline.fault !== null);
  const fault = wrong
    ? ` It has no guard against two flips that make the same edge: its result for mesh ${wrong.id} is wrong.`
    : '';
  const size = (edges: number | undefined) =>
    edges === undefined ? 'no size measured' : `${number.format(edges)} edges`;
  return made(
    'ul',
    'paper-open',
    made(
      'li',
      '',
      made('b', '', 'From which size does the GPU pay?'),
      ` Against one thread of the CPU, from ${size(many)} where many flip, and from ${size(none)} where none does; against ${measured.machine.threads} threads, from ${size(manyAll)} and ${size(noneAll)}.`,
    ),
    made(
      'li',
      '',
      made('b', '', 'Selection on the GPU or on the CPU?'),
      ` The paper selects on the CPU. On ${number.format(largest.edges)} edges its way takes ${significant.format(flips)} times as long for the flips, and ${significant.format(all)} times as long from input to result.${fault}`,
    ),
  );
}
