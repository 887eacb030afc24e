/** The points of a file without triangles become a mesh. */

import type { FileMesh } from 'edgeflip/files';
import { triangulate } from 'edgeflip/points';
import { counted, number } from '../shell/numbers.ts';

/** A mesh whose triangles are not in its file, but made of its points. */
export interface PointMesh extends FileMesh {
  isTriangulated: true;
}

/**
 * The mesh with the Delaunay triangulation of x and y; heights stay. A file of it is written anew, with positions and
 * triangles only.
 *
 * @throws if there is no triangle.
 */
export async function triangulated(mesh: FileMesh, name: string): Promise<PointMesh> {
  const { positions, dimension } = mesh;
  const { triangles, duplicates, hint } = await triangulate(positions, { stride: dimension });
  if (triangles.length === 0) throw new Error(`${name}: ${hint}`);
  const equal = duplicates.length / 2;
  const by = dimension === 3 ? ' by x and y' : '';
  const notes = [
    `${counted(positions.length / dimension, 'point')} became triangles${by}`,
    ...(equal > 0
      ? [
          `${number.format(equal)} of them ${equal === 1 ? 'has' : 'have'} the x and y of an earlier one, and no triangle`,
        ]
      : []),
    ...mesh.notes,
  ];
  return { ...mesh, indices: triangles, notes, keeps: false, isTriangulated: true };
}
