/** What `npm run paper` has measured on a machine with a GPU, and the numbers of the paper. */

import { MESHES } from '../../tools/paper/theirs.mjs';

interface Times {
  total: number;
  flips: number;
}

/** Times are in milliseconds. */
interface Measured {
  date: string;
  machine: { adapter: string; cpu: string; threads: number; software: boolean };
  meshes: {
    id: string;
    name: string;
    edges: number;
    triangles: number;
    iterations: number;
    gpu: Times;
    /** Lawson's algorithm on one thread, a sequential algorithm as the paper's. */
    lawson: Times;
    /** Selection on the CPU, as in the paper. */
    baseline: Times & { fault: string | null };
  }[];
  crossover: { family: string; edges: number; gpu: number; cpu: number; cores: number }[];
}

const files = import.meta.glob<Measured>('../../benches/results/*-paper-*.json', { eager: true, import: 'default' });

/** The newest measurements of a hardware GPU. */
const newest = Object.entries(files)
  .sort(([a], [b]) => (a < b ? 1 : -1))
  .map(([, measured]) => measured)
  .find(({ machine }) => !machine.software);

/** The measurements. */
export const ours: Measured | undefined = newest;

/** A row of the table: a mesh with our numbers, and the paper's if it has the mesh. */
export function rowsOf({ meshes }: Measured) {
  return meshes.map((mesh) => ({ mesh, theirs: MESHES.find(({ id }) => id === mesh.id) }));
}

/** The smallest size measured from which the GPU is faster at all larger sizes, in triangles. */
export function crossoverOf({ crossover }: Measured, family: string, against: 'cpu' | 'cores'): number | undefined {
  const sizes = crossover.filter((size) => size.family === family).sort((a, b) => a.edges - b.edges);
  const last = sizes.findLastIndex((size) => size.gpu >= size[against]);
  const edges = sizes[last + 1]?.edges;
  return edges === undefined ? undefined : trianglesOf(edges);
}

/** The triangles of a square of n × n cells with so many edges: 3n² + 2n edges, and 2n² triangles. */
const trianglesOf = (edges: number) => 2 * Math.round((Math.sqrt(1 + 3 * edges) - 1) / 3) ** 2;
