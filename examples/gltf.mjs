// Makes the meshes of a glTF file Delaunay with glTF-Transform: `node examples/gltf.mjs IN OUT`, after `npm run build`.

import { NodeIO } from '@gltf-transform/core';
import { ALL_EXTENSIONS } from '@gltf-transform/extensions';
import { delaunay } from 'edgeflip/gltf-transform';

const [input, output] = process.argv.slice(2);
if (!output) {
  console.error('usage: node examples/gltf.mjs IN OUT');
  process.exit(2);
}

const io = new NodeIO().registerExtensions(ALL_EXTENSIONS);
const document = await io.read(input);
await document.transform(delaunay({ maxNormalAngle: 10 })); // the logger prints the flips
await io.write(output, document);
