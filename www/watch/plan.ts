/** Terrains: meshes with a plane. Flips see them from above, pictures and files with their heights. */

import type { Plane } from 'edgeflip';
import type { IndexedMesh } from 'edgeflip/files';

/** The axes of each plane, counter-clockwise from above. */
const AXES: Record<Plane, readonly [number, number]> = { xy: [0, 1], xz: [2, 0], yz: [1, 2] };

/** The count of numbers of each vertex. */
export const widthOf = ({ dimension, plane }: IndexedMesh): 2 | 3 => (plane ? 3 : dimension);

/** The mesh as the flips see it: a terrain without its heights, another mesh as it is. */
export function planOf(mesh: IndexedMesh): IndexedMesh {
  const { positions, indices, plane } = mesh;
  if (!plane) return mesh;
  const axes = AXES[plane];
  const Floats = positions instanceof Float64Array ? Float64Array : Float32Array;
  const plan = new Floats((positions.length / 3) * 2).map((_, i) => positions[3 * (i >> 1) + axes[i & 1]!]!);
  return { positions: plan, indices, dimension: 2, plane: undefined };
}
