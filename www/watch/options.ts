/** The options of the package for a mesh and its settings. */

import type { Options } from 'edgeflip';
import type { Settings } from './choices.ts';
import type { Opened } from './opening.ts';
import type { Backend, OpenMesh } from './run.ts';

export async function optionsFor(opened: Opened, settings: Settings): Promise<Options & { backend: Backend }> {
  const { backend, maxNormalAngle, maxDeviation, features, keepsGroups } = settings;
  const mesh: OpenMesh = opened.mesh;
  const isSurface = mesh.dimension === 3;
  const sharp = isSurface && features !== undefined ? await featuresOf(opened, features) : undefined;
  return {
    backend,
    maxNormalAngle,
    ...(isSurface && maxDeviation !== undefined ? { maxDeviation } : {}),
    ...(sharp ? { lockedEdges: [...(mesh.lockedEdges ?? []), ...sharp] } : {}),
    ...(keepsGroups ? {} : { groups: undefined }),
  };
}

/** The sharp edges of the input, computed once for each angle. */
function featuresOf({ mesh, client, features }: Opened, degrees: number): Promise<Uint32Array> {
  let found = features.get(degrees);
  if (!found) features.set(degrees, (found = client.call((worker) => worker.features(mesh, degrees))));
  return found;
}
