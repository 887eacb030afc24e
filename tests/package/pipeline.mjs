// Runs in a project that has glTF-Transform and its functions: `weld(), delaunay(), reorder()` on a model in a GLB file,
// as it is and quantized for meshopt. Writes the document before and after it: `node pipeline.mjs IN BEFORE AFTER`.

import { readFile, writeFile } from 'node:fs/promises';
import { Logger, NodeIO } from '@gltf-transform/core';
import { ALL_EXTENSIONS } from '@gltf-transform/extensions';
import { dequantize, quantize, reorder, weld } from '@gltf-transform/functions';
import draco3d from 'draco3dgltf';
import { delaunay } from 'edgeflip/gltf-transform';
import { MeshoptEncoder } from 'meshoptimizer';

const [input, before, after, isQuantized] = process.argv.slice(2);
await MeshoptEncoder.ready;
const io = new NodeIO()
  .registerExtensions(ALL_EXTENSIONS)
  .registerDependencies({ 'draco3d.decoder': await draco3d.createDecoderModule() });
const document = await io.readBinary(new Uint8Array(await readFile(input)));
document.setLogger(new Logger(Logger.Verbosity.ERROR));
document.disposeExtension('KHR_draco_mesh_compression');
await document.transform(isQuantized ? quantize() : dequantize());
await writeFile(before, await io.writeBinary(document));
const lines = [];
document.setLogger({
  debug: () => {},
  info: (line) => lines.push(line),
  warn: () => {},
  error: (line) => lines.push(line),
});
await document.transform(weld(), delaunay({ maxNormalAngle: 30 }), reorder({ encoder: MeshoptEncoder }));
await writeFile(after, await io.writeBinary(document));
console.log(lines.filter((line) => line.startsWith('delaunay: ')).join('\n'));
