/** Advice about a run whose mesh or page seems to be set up in a way that its developer does not want. */

import type { Layout } from './mesh.js';
import type { IndexArray, Result } from './types.js';

/** The fields of a result that advice is based on. */
type Outcome = Pick<Result, 'indices' | 'flips' | 'edges' | 'boundaryEdges' | 'nonManifoldEdges'>;

/**
 * Advice, as sentences, or `undefined`.
 *
 * @param seams - The number of edges that `weld` locked; `undefined` without `weld`.
 * @param alone - Why the CPU engine has one thread, if it could use more.
 */
export function hintOf(
  { indices, flips, edges, boundaryEdges, nonManifoldEdges }: Outcome,
  layout: Layout<IndexArray>,
  seams: number | undefined,
  alone: string | undefined,
): string | undefined {
  const hints: string[] = [];
  const inner = edges - boundaryEdges - nonManifoldEdges;
  if (seams === undefined && inner === 0 && edges > 3) {
    hints.push(
      'No two triangles share an edge, so no edge can flip. If vertices at the same position are stored once for each triangle, pass the option weld.',
    );
  }
  if (seams && seams >= inner) {
    hints.push(
      'Every inner edge is a seam, so no edge can flip: the attributes differ at all vertices that weld could join. Leave out normals of flat triangles, or pass weld: true.',
    );
  }
  if (flips === 0 && areTriples(indices, layout)) {
    hints.push(
      'No triangle uses the last third of the vertices. If positions have three coordinates per vertex, pass dimension: 3, or stride: 3 for a mesh in the plane.',
    );
  }
  if (alone !== undefined) hints.push(`The CPU engine ran on one thread: ${alone}.`);
  return hints.length > 0 ? hints.join(' ') : undefined;
}

/** Whether the positions of a mesh in the plane could have three coordinates per vertex. */
function areTriples(indices: Uint32Array, { dimension, stride, vertices }: Layout<IndexArray>): boolean {
  if (dimension !== 2 || stride !== 2 || vertices % 3 !== 0) return false;
  return indices.length > 0 && indices.every((vertex) => 3 * vertex < 2 * vertices);
}
