/** Advice about a run whose mesh or page seems to be set up in a way that its developer does not want. */

import type { Layout } from './mesh.js';
import type { IndexArray, Plane, Result } from './types.js';

/** The longest stride that advice is given about. */
const MOST_STRIDE = 32;

const LISTED = 'verify lists these triangles.';

/** The fields of a result that advice is based on. */
type Outcome = Pick<Result, 'edges' | 'boundaryEdges' | 'nonManifoldEdges' | 'inverted' | 'flat'>;

/** What advice is also based on. */
interface Circumstances {
  /** The number of edges that `weld` locked; `undefined` without `weld`. */
  seams: number | undefined;
  /** Whether triangles that had turned over have become positive, where that was possible. */
  untangles: boolean | undefined;
  /** The plane in which no triangle is turned over, if it is another one than the mesh has. */
  rightPlane: Plane | undefined;
  /** Why the CPU engine has one thread, if it could use more. */
  alone: string | undefined;
}

/**
 * Advice, as sentences, or `undefined`.
 *
 * @param indices - The triangles, with the vertices of the mesh.
 */
export function hintOf(
  { edges, boundaryEdges, nonManifoldEdges, inverted, flat }: Outcome,
  indices: Uint32Array,
  layout: Layout<IndexArray>,
  { seams, untangles, rightPlane, alone }: Circumstances,
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
  const stride = forgottenStride(indices, layout);
  if (stride !== undefined) {
    const isSpace = layout.dimension === 2 && stride === 3;
    const pass = isSpace ? "dimension: 3, or for a terrain plane: 'xy', 'xz' or 'yz'" : `stride: ${stride}`;
    hints.push(
      `The triangles use only the first ${layout.dimension}/${stride} of the vertices. If positions have ${stride} numbers per vertex, pass ${pass}.`,
    );
  }
  if (inverted > 0) {
    const remedy = untangles
      ? 'no triangulation of these positions was found: problems says why, or another component has an edge that theirs would need'
      : 'no flip could turn them back; untangle: true does, where the positions have a triangulation';
    hints.push(`Triangles that are turned over: ${inverted}. They overlap their neighbours, and ${remedy}. ${LISTED}`);
    if (rightPlane) hints.push(`In the plane ${rightPlane} no triangle is turned over: pass plane: '${rightPlane}'.`);
    else if (!layout.plane && layout.dimension === 2 && layout.stride === 3) {
      hints.push("If z is not up, pass plane: 'xz' or 'yz'.");
    }
  }
  if (flat > 0) {
    const remedy = layout.dimension === 2 && !untangles ? 'Pass untangle: true, move' : 'Move';
    hints.push(
      `Triangles of no area: ${flat}. Their corners are on one line, and no flip removed them. ${remedy} a corner of each, or leave it out. ${LISTED}`,
    );
  }
  if (alone !== undefined) hints.push(`The CPU engine ran on one thread: ${alone}.`);
  return hints.length > 0 ? hints.join(' ') : undefined;
}

/**
 * The count of numbers from a vertex to the next, if the positions could have gaps that the mesh does not name: the
 * triangles then use only the first vertices.
 */
function forgottenStride(indices: Uint32Array, layout: Layout<IndexArray>): number | undefined {
  const { dimension, vertices, hasStride, stride, offset } = layout;
  if (hasStride || stride !== dimension || offset > 0 || indices.length === 0) return undefined;
  const numbers = dimension * vertices;
  let used = 0;
  // The last triangles of most meshes use the last vertices.
  for (let i = indices.length; i-- > 0; ) {
    used = Math.max(used, indices[i]! + 1);
    if (used * (dimension + 1) > numbers) return undefined;
  }
  if (numbers % used === 0 && numbers <= MOST_STRIDE * used) return numbers / used;
  // Vertices at the end may belong to no triangle.
  return dimension === 2 && vertices % 3 === 0 ? 3 : undefined;
}
