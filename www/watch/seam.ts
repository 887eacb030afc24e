/** The seams of a mesh by their edges, and what the inspector says of them. */

import { counted, staying } from '../shell/numbers.ts';
import { wordsFor } from './attributes.ts';

/** An attribute of a file that keeps edges. */
export interface Seam {
  /** Its name in the file; empty if the vertices have the same attributes. */
  name: string;
  /** How many edges stay for it. */
  edges: number;
  /**
   * `seam`: the corners of a vertex differ, and `border`: the faces differ; these edges are locked. The others are
   * boundaries that meet, because each side has vertices of its own: `split`, whose attributes differ; `meeting`, of different
   * primitives; `equal`, which differ in nothing; `unknown`, which are not compared.
   */
  kind: 'seam' | 'border' | 'split' | 'meeting' | 'equal' | 'unknown';
}

export interface Seams {
  seams: Seam[];
  /** The edges along seams, by {@link keyOf}, in ascending order, and for each a bit for each of its seams. */
  edges: Float64Array;
  bits: Uint32Array;
  vertices: number;
}

/** A number for the edge between two vertices. */
export const keyOf = (a: number, b: number, vertices: number) => Math.min(a, b) * vertices + Math.max(a, b);

/** The seams along an edge. `keepsGroups`: whether borders keep edges. */
export function seamsAt({ seams, edges, bits, vertices }: Seams, a: number, b: number, keepsGroups: boolean): Seam[] {
  const key = keyOf(a, b, vertices);
  const place = placeOf(key, edges);
  if (edges[place] !== key) return [];
  return seams.filter(({ kind }, i) => (bits[place]! >> i) & 1 && (keepsGroups || kind !== 'border'));
}

/** The place of a number in ascending numbers, or where it would be. */
export function placeOf(x: number, numbers: Float64Array): number {
  let [low, high] = [0, numbers.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (numbers[middle]! < x) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** Whether the edge is on the boundary for the run, and its other triangle is there nevertheless. */
export const isOpen = ({ kind }: Seam) => kind !== 'seam' && kind !== 'border';

/** A sentence for each seam along an edge, and before them, for a boundary, why it is one. */
export function sayingOf(seams: readonly Seam[]): string {
  if (seams.length === 0) return '';
  const open = seams.some(isOpen)
    ? 'This is a seam, not the end of the surface: each side has vertices of its own, so the edge stays. '
    : '';
  return open + seams.map(sentence).join(' ');
}

function sentence({ name, edges, kind }: Seam): string {
  const words = wordsFor(name);
  const named = `“${name}”${words ? ` (${words})` : ''}`;
  switch (kind) {
    case 'equal':
      return `Their attributes are equal: the option “weld” joins such vertices, and frees ${counted(edges, 'edge')}.`;
    case 'unknown':
      return `${counted(edges, 'edge')} ${edges === 1 ? 'is a seam' : 'are seams'} of this kind.`;
    case 'meeting':
      return `It lies between two ${name === 'material' ? 'materials' : 'primitives'}, as ${counted(edges, 'edge')} ${edges === 1 ? 'does' : 'do'}.`;
    case 'split':
      return `They differ in the attribute ${named}: ${staying(edges)} to keep it.`;
    default:
      return `It is a ${kind} of the attribute ${named}: ${staying(edges)} to keep it.`;
  }
}
