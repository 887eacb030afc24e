// meshoptimizer removes triangles, and edgeflip makes the remaining ones rounder: `node examples/simplify.mjs`, after
// `npm run build`.

import { makeDelaunay } from 'edgeflip';
import { angles, generate } from 'edgeflip/files';
import { MeshoptSimplifier } from 'meshoptimizer';

await MeshoptSimplifier.ready;
const mesh = await generate('uvsphere 100');
const wanted = 3 * Math.floor(mesh.indices.length / 30); // a tenth of the triangles
const [simple, error] = MeshoptSimplifier.simplify(mesh.indices, mesh.positions, 3, wanted, 0.05);
const before = { ...mesh, indices: simple };
// No flip moves the surface by more than the simplification did.
const maxDeviation = error * MeshoptSimplifier.getScale(mesh.positions, 3);
const { indices, flips } = await makeDelaunay(before, { maxNormalAngle: 45, maxDeviation });
const thin = async (given) => {
  const { counts } = await angles({ ...mesh, indices: given }, 9);
  return counts[0];
};
console.log(`${mesh.indices.length / 3} triangles become ${simple.length / 3}`);
console.log(`${flips} flips; angles below 20°: ${await thin(simple)} before, ${await thin(indices)} after`);
