/** The points of a file without triangles become a mesh. */

import type { FileMesh } from 'edgeflip/files';
import { counted } from '../shell/numbers.ts';
import { GLTF } from './files.ts';
import type { PointsWorker } from './points-worker.ts';
import { WorkerClient } from './worker-client.ts';

/** A mesh whose triangles are not in its file, but made of its points. */
export interface PointMesh extends FileMesh {
  isTriangulated: true;
}

/** Whether a file has points, and no triangles. In glTF, nodes may place points apart from each other. */
export function hasPointsOnly({ positions, indices }: FileMesh, name: string): boolean {
  return indices.length === 0 && positions.length > 0 && !GLTF.test(name);
}

/**
 * The mesh with the Delaunay triangulation of x and y: with heights, a terrain. A file of it is written anew, with
 * positions and triangles only.
 *
 * @throws if there is no triangle.
 */
export async function triangulated(mesh: FileMesh, name: string): Promise<PointMesh> {
  const { positions, dimension } = mesh;
  const worker = new Worker(new URL('./points-worker.ts', import.meta.url), { type: 'module' });
  const client = new WorkerClient<PointsWorker>(worker);
  const { triangles, equal, hint } = await client
    .call(({ triangulate }) => triangulate(positions, dimension))
    .finally(() => client.close());
  if (triangles.length === 0) throw new Error(`${name}: ${hint}`);
  const by = dimension === 3 ? ' by x and y' : '';
  const repeats = equal === 1 ? 'repeats the x and y of another' : 'repeat the x and y of others';
  const notes = [
    `Triangulated from ${counted(positions.length / dimension, 'point')}${by}`,
    ...(equal > 0 ? [`${counted(equal, 'point')} ${repeats}`] : []),
    ...mesh.notes,
  ];
  const terrain = dimension === 3 ? ({ dimension: 2, plane: 'xy' } as const) : {};
  return { ...mesh, ...terrain, indices: triangles, notes, keeps: false, isTriangulated: true };
}
