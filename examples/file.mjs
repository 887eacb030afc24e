// Makes the mesh in a file Delaunay and keeps its attributes: `node examples/file.mjs IN OUT`, after `npm run build`.

import { readFile, writeFile } from 'node:fs/promises';
import { makeDelaunay } from 'edgeflip';
import { readMesh, writeMesh } from 'edgeflip/files';

const [input, output] = process.argv.slice(2);
if (!output) {
  console.error('usage: node examples/file.mjs IN OUT');
  process.exit(2);
}

const original = { bytes: await readFile(input), name: input };
const mesh = await readMesh(original.bytes, input);
// These locks keep attributes of faces and corners valid, for a file of the same format.
const { groups, lockedEdges, lockedTriangles } = mesh;
const { indices, flips } = await makeDelaunay(mesh, { groups, lockedEdges, lockedTriangles });
await writeFile(output, await writeMesh({ ...mesh, indices }, output, { original }));
console.log(`${flips} flips`);
