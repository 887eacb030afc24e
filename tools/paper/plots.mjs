// The plots of docs/paper.md, as SVG: on a transparent ground, in the colours of a light and a dark page. What the
// paper gives is grey.

import * as Plot from '@observablehq/plot';
import { parseHTML } from 'linkedom';
import { judged, MESHES } from './theirs.mjs';

const GREY = '#888';
const BLUE = '#3b82c4';
const ORANGE = '#d97706';
const COLOURS = 'svg { color: #222 } @media (prefers-color-scheme: dark) { svg { color: #ddd } }';

function svg(title, options) {
  const { document } = parseHTML('<html></html>');
  const figure = Plot.plot({ document, width: 720, height: 320, marginLeft: 60, marginBottom: 40, ...options });
  figure.setAttribute('xmlns', 'http://www.w3.org/2000/svg');
  figure.setAttribute('role', 'img');
  figure.setAttribute('aria-label', title);
  const style = document.createElement('style');
  style.textContent = COLOURS;
  figure.append(style);
  return `${figure.outerHTML}\n`;
}

const flipsAxis = { label: 'flips', grid: true, zero: true };

/** Figure 10: the flips of mesh 5, and the number of iterations in the paper. */
export function figure10(data) {
  const flips = data.meshes.find(({ id }) => id === '5').flips_per_iteration;
  const { iterations } = MESHES.find(({ id }) => id === '5');
  const last = Math.max(flips.length, iterations);
  return svg('Flips of each iteration, mesh 5', {
    x: { label: 'iteration', domain: Array.from({ length: last }, (_, i) => i + 1) },
    y: flipsAxis,
    marks: [
      Plot.barY(flips, { x: (_, i) => i + 1, y: (n) => n, fill: BLUE }),
      Plot.text(flips, {
        x: (_, i) => i + 1,
        y: (n) => n,
        text: (n) => n.toLocaleString('en'),
        dy: -8,
        fill: 'currentColor',
      }),
      Plot.ruleX([iterations], { stroke: GREY, strokeDasharray: '4 3' }),
      Plot.text([iterations], {
        x: (n) => n,
        frameAnchor: 'top',
        dy: 6,
        dx: -6,
        textAnchor: 'end',
        fill: GREY,
        text: (n) => `paper: ends after ${n}`,
      }),
      Plot.ruleY([0], { stroke: 'currentColor' }),
    ],
  });
}

/** Figure 12: the flips of the worst case with 8, 12 and 16 nodes. */
export function figure12(data) {
  const rows = data.strips
    .filter(({ flips }) => flips.length < 100)
    .flatMap(({ name, flips }) => flips.map((n, i) => ({ nodes: nodes(name), iteration: i + 1, n })));
  const last = rows.filter((row, i) => rows[i + 1]?.nodes !== row.nodes);
  const peaks = [...new Set(rows.map((row) => row.nodes))].map((of) =>
    rows.filter((row) => row.nodes === of).reduce((best, row) => (row.n > best.n ? row : best)),
  );
  return svg('Flips of each iteration, worst case with 8, 12 and 16 nodes', {
    x: { label: 'iteration', ticks: last.at(-1).iteration },
    y: { ...flipsAxis, ticks: 8 },
    marks: [
      Plot.lineY(rows, { x: 'iteration', y: 'n', z: 'nodes', stroke: BLUE, marker: 'dot' }),
      Plot.text(peaks, {
        x: 'iteration',
        y: 'n',
        text: ({ nodes }) => `${nodes} nodes`,
        dy: -10,
        fill: 'currentColor',
      }),
      Plot.ruleY([0], { stroke: 'currentColor' }),
    ],
    marginTop: 30,
  });
}

/** The same with 1,000 nodes. */
export function figure12Large(data) {
  const { flips } = data.strips.find(({ name }) => name === 'strips 1000');
  return svg('Flips of each iteration, worst case with 1,000 nodes', {
    x: { label: 'iteration' },
    y: flipsAxis,
    marks: [
      Plot.lineY(flips, { x: (_, i) => i + 1, y: (n) => n, stroke: BLUE }),
      Plot.ruleY([0], { stroke: 'currentColor' }),
    ],
  });
}

const nodes = (name) => Number(name.split(' ')[1]);

/** Figure 11: the worst case with 8 nodes, before and after each iteration. New edges are blue. */
export function figure11(data) {
  const { positions, triangles } = data.figure11;
  const edgesIn = (list) => {
    const edges = new Map();
    for (let h = 0; h < list.length; h++) {
      const [a, b] = [list[h], list[h % 3 === 2 ? h - 2 : h + 1]].sort((a, b) => a - b);
      edges.set(`${a} ${b}`, [a, b]);
    }
    return edges;
  };
  const states = triangles.map(edgesIn);
  const rows = states.flatMap((edges, state) =>
    [...edges].map(([key, [a, b]]) => ({
      state: state === 0 ? 'input' : `iteration ${state}`,
      isNew: state > 0 && !states[state - 1].has(key),
      ...{ x1: positions[2 * a], y1: positions[2 * a + 1], x2: positions[2 * b], y2: positions[2 * b + 1] },
    })),
  );
  const ends = { x1: 'x1', y1: 'y1', x2: 'x2', y2: 'y2', fx: 'state' };
  return svg('The worst case with 8 nodes, before and after each iteration', {
    height: 150,
    marginTop: 26,
    marginLeft: 8,
    marginRight: 8,
    marginBottom: 8,
    fx: { axis: 'top', label: null, domain: [...new Set(rows.map(({ state }) => state))] },
    x: { axis: null },
    y: { axis: null },
    marks: [
      Plot.link(rows, {
        ...ends,
        stroke: ({ isNew }) => (isNew ? BLUE : 'currentColor'),
        strokeWidth: ({ isNew }) => (isNew ? 2 : 1),
      }),
    ],
  });
}

/** A logarithmic scale from a power of ten to another, for `values`; it marks only powers of ten. */
function logarithmic(label, values, tickFormat) {
  const first = Math.floor(Math.log10(Math.min(...values)));
  const last = Math.ceil(Math.log10(Math.max(...values)));
  const ticks = Array.from({ length: last - first + 1 }, (_, i) => 10 ** (first + i));
  return { type: 'log', grid: true, label, ticks, domain: [ticks[0], ticks.at(-1)], tickFormat };
}

/** Times over the size: ours, and the paper's in grey. */
export function times(data) {
  const line = (key, colour, name) => {
    const rows = data.meshes.map((mesh) => ({ edges: mesh.edges, seconds: mesh[key].total / 1000 }));
    return [
      Plot.line(rows, { x: 'edges', y: 'seconds', stroke: colour, marker: 'dot' }),
      Plot.text(rows.slice(-1), {
        x: 'edges',
        y: 'seconds',
        text: () => name,
        fill: colour,
        dx: 8,
        textAnchor: 'start',
      }),
    ];
  };
  const theirs = (key, name) => {
    const rows = MESHES.map((mesh) => ({ edges: edgesOf(mesh), seconds: mesh[key] }));
    return [
      Plot.line(rows, { x: 'edges', y: 'seconds', stroke: GREY, marker: 'dot' }),
      Plot.text(rows.slice(-1), { x: 'edges', y: 'seconds', text: () => name, fill: GREY, dx: 8, textAnchor: 'start' }),
    ];
  };
  const inSeconds = data.meshes.map(({ cpu, gpu }) => ({ cpu: cpu.total / 1000, gpu: gpu.total / 1000 }));
  return svg('Seconds over edges', {
    marginRight: 90,
    x: logarithmic('edges', [...MESHES.map(edgesOf), ...data.meshes.map(({ edges }) => edges)], '~s'),
    y: logarithmic(
      'seconds',
      [...MESHES, ...inSeconds].flatMap(({ cpu, gpu }) => [cpu, gpu]),
      '~g',
    ),
    marks: [
      ...theirs('cpu', 'CPU, paper'),
      ...theirs('gpu', 'GPU, paper'),
      ...line('cpu', ORANGE, 'CPU'),
      ...line('gpu', BLUE, 'GPU'),
    ],
  });
}

/** The time on one thread by that on the GPU, over the size. */
export function crossover(data) {
  const rows = data.crossover.map((row) => ({ ...row, ratio: row.cpu / row.gpu }));
  const colours = { random: BLUE, uvsphere: ORANGE, delaunay: 'currentColor' };
  const last = rows.filter((row, i) => rows[i + 1]?.family !== row.family).sort((a, b) => b.ratio - a.ratio);
  const theirs = MESHES.map((mesh) => ({ edges: edgesOf(mesh), ratio: mesh.speedUp }));
  const all = [...theirs, ...rows];
  const at = { x: 'edges', y: 'ratio' };
  const label = { ...at, dx: 8, textAnchor: 'start' };
  return svg('Speed-up of the GPU over edges', {
    marginRight: 100,
    x: logarithmic(
      'edges',
      all.map(({ edges }) => edges),
      '~s',
    ),
    y: logarithmic(
      'T_CPU : T_GPU',
      all.map(({ ratio }) => ratio),
      '~g',
    ),
    marks: [
      Plot.ruleY([1], { stroke: 'currentColor' }),
      Plot.line(theirs, { ...at, stroke: GREY, marker: 'dot' }),
      Plot.text(theirs.slice(-1), { ...label, text: () => 'paper', fill: GREY }),
      ...Object.entries(colours).map(([family, stroke]) =>
        Plot.line(
          rows.filter((row) => row.family === family),
          { ...at, stroke, marker: 'dot' },
        ),
      ),
      // From top to bottom, so that labels of near lines do not overlap.
      ...last.map((row, i) =>
        Plot.text([row], {
          ...label,
          dy: 12 * (i - 1),
          text: ({ family }) => (family === 'delaunay' ? 'Delaunay' : family),
          fill: colours[row.family],
        }),
      ),
    ],
  });
}

/** The edges of a mesh of the paper, from the columns in which they fit. */
function edgesOf(mesh) {
  return judged(mesh).fitting.edges;
}
