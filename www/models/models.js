// Writes the meshes that the page offers and that no family generates, from packages with free licences.

import { existsSync, mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import bunny from 'bunny';
import initManifold from 'manifold-3d';
import { writeMesh } from '../../dist/files.js';
import { scrambled } from './scramble.js';

/** The scan of a rabbit: package `bunny`, public domain, from the Stanford 3D Scanning Repository. */
function rabbit() {
  const mesh = { positions: Float32Array.from(bunny.positions.flat()), indices: bunny.cells.flat(), dimension: 3 };
  return { ...mesh, indices: scrambled(mesh, 2500, 25) };
}

/** A part made by cutting solids: package `manifold-3d`, Apache-2.0. */
async function flange() {
  const manifold = await initManifold();
  manifold.setup();
  const { Manifold } = manifold;
  const rod = (height, radius, sides = 48) => Manifold.cylinder(height, radius, radius, sides, true);
  const around = (count, radius, solid) =>
    Array.from({ length: count }, (_, i) => {
      const angle = (2 * Math.PI * (i + 0.5)) / count;
      return solid.translate([radius * Math.cos(angle), radius * Math.sin(angle), 0]);
    });
  const body = rod(0.24, 1, 72).add(rod(0.9, 0.52, 64).translate([0, 0, 0.4]));
  const part = [rod(3, 0.36, 56), ...around(8, 0.77, rod(1, 0.11, 24))].reduce(
    (solid, hole) => solid.subtract(hole),
    body,
  );
  const { vertProperties, triVerts, numProp } = part.getMesh();
  const positions = vertProperties.filter((_, i) => i % numProp < 3);
  return { positions, indices: triVerts, dimension: 3 };
}

/** Writes the files that are missing. */
export async function writeModels(folder) {
  mkdirSync(folder, { recursive: true });
  for (const [name, make] of Object.entries({ 'bunny.ply': rabbit, 'flange.ply': flange })) {
    const path = join(folder, name);
    if (!existsSync(path)) writeFileSync(path, await writeMesh(await make(), name));
  }
}
