// The text and the tables of docs/paper.md, from the measurements of benches/paper.rs.

import { euler, judged, MESHES, speedUpFits } from './theirs.mjs';

const BENCH = 'cargo bench -p benches --bench paper';
const number = (n) => n.toLocaleString('en');
const seconds = (ms) => (ms === undefined ? '–' : String(Number((ms / 1000).toPrecision(3))));
const ms = (n) => String(Number(n.toPrecision(3)));
const ratio = (x) => (x < 10 ? x.toPrecision(2) : number(Math.round(x)));
const theirsOf = ({ id }) => MESHES.find((mesh) => mesh.id === id);
/** A number of the paper; – for a mesh that the paper does not have. */
const theirs = (mesh, key, show = String) => (theirsOf(mesh) ? show(theirsOf(mesh)[key]) : '–');

function table(head, rows) {
  const alignment = head.map((_, i) => (i === 0 ? '---' : '---:'));
  return [head, alignment, ...rows].map((cells) => `| ${cells.join(' | ')} |`).join('\n');
}

const title = ({ id, name }) => (id ? `${id}` : `\`${name}\``);

/** Table 2: the counts of our meshes, and of the paper's. */
function counts(data) {
  return table(
    ['mesh', 'vertices', 'paper', 'edges', 'paper', 'triangles', 'paper', 'boundary edges', 'V − E + T'],
    data.meshes
      .filter(({ id }) => id)
      .map((mesh) => [
        title(mesh),
        ...['vertices', 'edges', 'triangles'].flatMap((key) => [number(mesh[key]), theirs(mesh, key, number)]),
        number(mesh.boundary),
        number(euler(mesh).characteristic),
      ]),
  );
}

/** What does not fit in Table 2 and Table 3, one item each. */
export function misfits() {
  const swapped = MESHES.filter((mesh) => judged(mesh).kind === 'swapped');
  const items = [];
  if (swapped.length > 0) {
    const characteristics = swapped.map((mesh) => euler(judged(mesh).fitting).characteristic);
    const deficits = swapped.map((mesh) => number(-euler(mesh).boundary));
    items.push(
      `Meshes ${swapped.map(({ id }) => id).join(' and ')}: the columns of edges and triangles are swapped. Every edge has at most two triangles, so 3T ≤ 2E; as printed, 3T exceeds 2E by ${deficits.join(' and ')}. With the columns swapped, 3T = 2E: the meshes are closed, and V − E + T is ${characteristics.join(' and ')}, as on a double torus.`,
    );
  }
  for (const mesh of MESHES.filter((mesh) => judged(mesh).kind === 'open')) {
    const { boundary, characteristic } = euler(mesh);
    const closed = { ...mesh, triangles: (2 * mesh.edges) / 3 };
    items.push(
      `Mesh ${mesh.id}: 2E − 3T = ${number(boundary)}. If no edge has more than two triangles, that is the number of boundary edges, and V − E + T = ${number(characteristic)}: thousands of holes. A closed mesh with as many edges has ${number(closed.triangles)} triangles, and then V − E + T = ${euler(closed).characteristic}, as for ${euler(closed).characteristic / 2} spheres.`,
    );
  }
  const wrong = MESHES.filter((mesh) => !speedUpFits(mesh)).map(({ id }) => id);
  items.push(
    wrong.length === 0
      ? 'Table 3: each speed-up fits its two times, which are rounded to 0.0001 s.'
      : `Table 3: the speed-up of ${wrong.join(', ')} is not the quotient of its two times.`,
  );
  return items;
}

/** Table 3. */
function performance(data) {
  return table(
    [
      ...['mesh', 'edges', 'flips', 'iterations', 'paper', 'T_GPU s', 'flips alone s', 'paper', 'T_CPU s', 'paper'],
      ...['T_CPU : T_GPU', 'paper', 'Lawson s', 'Lawson : T_GPU'],
    ],
    data.meshes.map((mesh) => [
      title(mesh),
      ...[number(mesh.edges), number(mesh.flips), number(mesh.iterations), theirs(mesh, 'iterations')],
      ...[seconds(mesh.gpu.total), seconds(mesh.gpu.flips), theirs(mesh, 'gpu')],
      ...[seconds(mesh.cpu.total), theirs(mesh, 'cpu')],
      ...[ratio(mesh.cpu.total / mesh.gpu.total), theirs(mesh, 'speedUp')],
      ...[seconds(mesh.lawson.total), ratio(mesh.lawson.total / mesh.gpu.total)],
    ]),
  );
}

/** Selection on the GPU and on the CPU. */
function selections(data) {
  return table(
    [
      ...['mesh', 'edges', 'CPU : GPU, flips', 'CPU : GPU, total', 'iterations, GPU', 'iterations, CPU', 'paper'],
      ...['flips ms, GPU', 'flips ms, CPU', 'total ms, GPU', 'total ms, CPU', 'paper’s T_GPU ms', 'result, CPU'],
    ],
    data.meshes.map(({ gpu, baseline, ...mesh }) => [
      title(mesh),
      number(mesh.edges),
      ...[ratio(baseline.flips / gpu.flips), ratio(baseline.total / gpu.total)],
      ...[gpu.iterations, baseline.iterations, theirs(mesh, 'iterations')],
      ...[ms(gpu.flips), ms(baseline.flips), ms(gpu.total), ms(baseline.total)],
      theirs(mesh, 'gpu', (s) => ms(1000 * s)),
      baseline.fault ?? 'clean',
    ]),
  );
}

/** The number of edges from which on the GPU is faster at every size; `undefined` if it is not at the largest. */
export function paysFrom(rows, key) {
  let from;
  for (const row of [...rows].sort((a, b) => b.edges - a.edges)) {
    if (row.gpu >= row[key]) break;
    from = row.edges;
  }
  return from;
}

const FAMILIES = {
  random: 'random points (`random N`), many flips',
  uvsphere: 'sphere (`uvsphere N`), few flips',
  delaunay: 'random points, Delaunay already: no flips',
};

function crossover(data) {
  const pays = (rows, key) => {
    const from = paysFrom(rows, key);
    const largest = Math.max(...rows.map(({ edges }) => edges));
    return from === undefined ? `none up to ${number(largest)}` : number(from);
  };
  return table(
    ['meshes', 'edges, against one thread', `edges, against ${data.machine.threads} threads`, 'paper'],
    Object.entries(FAMILIES).map(([family, name]) => {
      const rows = data.crossover.filter((row) => row.family === family);
      return [name, pays(rows, 'cpu'), pays(rows, 'cores'), '“more than thousand”'];
    }),
  );
}

function strips(data) {
  return table(
    ['nodes', 'iterations', 'flips', 'most flips of an iteration', 'in iteration', 'paper'],
    data.strips.map(({ name, flips }) => {
      const most = Math.max(...flips);
      const isInPaper = flips.length < 100;
      return [
        number(Number(name.split(' ')[1])),
        number(flips.length),
        number(flips.reduce((sum, n) => sum + n, 0)),
        number(most),
        number(flips.indexOf(most) + 1),
        isInPaper ? 'most in the middle' : '–',
      ];
    }),
  );
}

const image = (name, text) => `![${text}](paper/${name}.svg)`;

/** The whole document. `file`: where the measurements are, from the root of the repository. */
export function document(data, file) {
  const { machine } = data;
  const fifth = data.meshes.find(({ id }) => id === '5');
  const faulty = data.meshes.filter(({ baseline }) => baseline.fault).map(title);
  const names = data.meshes.filter(({ id }) => id).map(({ id, name, beta }) => `| ${id} | ${name} | ${beta}° |`);
  return `# The paper's tests, measured again

The paper is *A Quasi-Parallel GPU-Based Algorithm for Delaunay Edge-Flips* by Navarro, Hitschfeld-Kahler and Scheihing (2011). This page repeats its tests with edgeflip. Columns named *paper* have the paper's numbers; – means that the paper has none.

- Machine: ${machine.cpu}, ${machine.threads} threads; GPU: ${machine.adapter}.${machine.software ? ' This is a software GPU, which runs on the cores of the CPU. **Its times do not tell when a GPU pays.**' : ''}
- The paper's machine: AMD Phenom x4 850; Nvidia GeForce 9800GTX+.
- Commit ${data.commit}, ${data.date}. The measurements are in [${file.split('/').at(-1)}](../${file}).
- Command: \`npm run paper\`. On a machine with a GPU but without npm, run \`${BENCH} > paper.json\` there, and \`node tools/paper.mjs --from paper.json\` here.
- Times are medians of up to ${data.runs} runs after one uncounted run; a first run of more than ${data.enough_s} s counts and is the only one. They are from the arrays of the caller to the arrays of the result; the device was open and its kernels were compiled. *Flips alone* are the iterations without copies and adjacency.
- T_CPU is the CPU engine on one thread, with the same result as the GPU, bit for bit. *Lawson* is Lawson's algorithm on one thread (\`--order any\`). The paper compares with a sequential algorithm of this kind.

## Table 2: the meshes

The paper does not publish its meshes. Ours have the same counts, but they are other meshes, so they need other flips and other iterations.

${counts(data)}

| mesh | ours | β |
|---|---|---:|
${names.join('\n')}

β is the largest angle between the normals of two triangles whose edge may flip. The paper does not give its β.

Which of the paper's numbers do not fit each other:

${misfits()
  .map((item) => `- ${item}`)
  .join('\n')}

## Table 3: the times

Seconds. Below the paper's five meshes are larger spheres, if they were measured.

${performance(data)}

${image('times', 'Seconds over edges; the paper in grey')}

## Figure 10: flips of each iteration, mesh 5

Our mesh 5 takes ${fifth.iterations} iterations, the paper's takes ${theirsOf(fifth).iterations}. The first three iterations have ${Math.round((100 * sum(fifth.flips_per_iteration.slice(0, 3))) / fifth.flips)} % of our ${number(fifth.flips)} flips; the paper says that the first three have most. It gives its flips only as a plot.

${image('figure10', 'Flips of each iteration of mesh 5; the grey line is the paper’s last iteration')}

## Figure 11: one of the worst cases

\`strips 8\`, before and after each iteration. New edges are blue.

${image('figure11', 'Eight nodes in two rows; each iteration flips edges between the rows')}

## Figure 12: flips of each iteration, worst case

The paper gives its flips only as a plot, and says that the middle iterations have most. The same is true here.

${strips(data)}

${image('figure12', 'Flips of each iteration with 8, 12 and 16 nodes')}

${image('figure12-1000', 'Flips of each iteration with 1,000 nodes')}

## The size from which the GPU pays

The paper leaves open from which number of edges the GPU is always faster, for any number of flips. This table has the smallest measured size from which the GPU is faster at all larger measured sizes.

${crossover(data)}

${image('crossover', 'Speed-up of the GPU over edges, one thread; the paper in grey')}

## Selection on the GPU and on the CPU

The paper selects on the CPU, and expects much from a faster Selection. edgeflip selects on the GPU. The baseline does as the paper: in each iteration the labels go to the host, the host takes edges one after another if both their triangles are free, and the selection goes back. A label is the best edge of a triangle. The baseline is behind the feature \`baseline\` of the crate, for benchmarks only. Ratios are the time with Selection on the CPU by the time with Selection on the GPU.

${selections(data)}

The last column has the audit of the baseline's result.${
    faulty.length === 0
      ? ''
      : ` On mesh ${faulty.join(' and ')} it is wrong: two flips of one iteration made the same edge. The paper's Selection has no guard against this; edgeflip's has one.`
  } The audit of every result of edgeflip was clean.
`;
}

const sum = (list) => list.reduce((total, n) => total + n, 0);
