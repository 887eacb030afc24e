// A GLB file with a skin, morph targets and textures is written with other indices and is otherwise unchanged, and the
// validator of the Khronos Group finds no error in it. Uses the existing dist/.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { makeDelaunay } from '../../dist/index.js';
import { generate, readMesh, writeMesh } from '../../dist/files.js';
import { faults, riggedGlb } from './gltf.mjs';

async function flipped(bytes, name, files) {
  const mesh = await readMesh(bytes, name, { files });
  const { indices, flips, remaining } = await makeDelaunay(mesh);
  return { mesh, after: { ...mesh, indices }, flips, remaining };
}

test('only the indices of a rigged GLB change', async () => {
  const { bytes, ranges } = riggedGlb();
  assert.deepEqual(await faults(bytes), []);
  const { mesh, after, flips, remaining } = await flipped(bytes, 'rigged.glb');
  assert.equal(mesh.dimension, 3);
  assert.ok(flips > 20 && Object.keys(remaining).length === 0, `${flips} flips, ${JSON.stringify(remaining)}`);
  const out = await writeMesh(after, 'out.glb', { original: { bytes, name: 'rigged.glb' } });
  assert.deepEqual(await faults(out), []);
  assert.equal(out.length, bytes.length);
  const differ = [...out.keys()].filter((i) => out[i] !== bytes[i]);
  assert.ok(differ.every((i) => ranges.some(([from, to]) => from <= i && i < to)));
  for (const [from, to] of ranges) assert.ok(differ.some((i) => from <= i && i < to));
  assert.deepEqual((await readMesh(out, 'out.glb')).indices, after.indices);
});

test('a rigged GLB becomes a valid glTF, and a strip a valid list', async () => {
  const { bytes } = riggedGlb();
  const { after } = await flipped(bytes, 'rigged.glb');
  const text = await writeMesh(after, 'out.gltf', { original: { bytes, name: 'rigged.glb' } });
  assert.deepEqual(await faults(text), []);
  const json = JSON.parse(Buffer.from(text).toString());
  assert.deepEqual(json.asset.extras, { 'made by': 'a test', numbers: [1, 2.5, -1e-7] });
  // The buffer is in a separate file, and the first primitive is a strip over its first vertices.
  const buffer = Buffer.from(json.buffers[0].uri.split(',')[1], 'base64');
  json.buffers[0].uri = 'a%20b.bin';
  const primitive = json.meshes[0].primitives[0];
  primitive.mode = 5;
  const strip = Buffer.from(JSON.stringify(json));
  const files = { 'a b.bin': new Uint8Array(buffer) };
  await assert.rejects(readMesh(strip, 'strip.gltf'), {
    code: 'parse',
    message: /buffer 0: .*`a b.bin`: it is not among the `files` given/,
  });
  const { mesh, after: again } = await flipped(strip, 'strip.gltf', files);
  // A function finds the file too, and its error comes through.
  const asked = [];
  const find = (name) => {
    asked.push(name);
    return files[name];
  };
  assert.deepEqual((await readMesh(strip, 'strip.gltf', { files: find })).indices, mesh.indices);
  assert.deepEqual(asked, ['a b.bin']);
  const fails = () => {
    throw new RangeError('no room');
  };
  await assert.rejects(readMesh(strip, 'strip.gltf', { files: fails }), RangeError('no room'));
  // The same triangle from another corner.
  const indices = mesh.indices.slice();
  [indices[0], indices[1], indices[2]] = [indices[1], indices[2], indices[0]];
  const original = { bytes: new Uint8Array(strip), name: 'strip.gltf', files };
  for (const [name, changed] of [
    ['out.glb', again],
    ['out.gltf', { ...mesh, indices }],
  ]) {
    const out = await writeMesh(changed, name, { original });
    assert.deepEqual(
      (await faults(out, files)).filter(({ severity }) => severity === 0),
      [],
    );
    assert.deepEqual((await readMesh(out, name, { files })).indices, changed.indices);
  }
  await assert.rejects(writeMesh(mesh, 'out.glb', { original: { ...original, maxBytes: 100 } }), {
    code: 'file-too-large',
  });
  await assert.rejects(writeMesh({ ...mesh, indices: indices.slice(3) }, 'out.glb', { original }), {
    code: 'triangle-count',
  });
});

test('a generated mesh becomes a valid file', async () => {
  for (const spec of ['uvsphere 8', 'random 9']) {
    for (const name of ['mesh.glb', 'mesh.gltf']) {
      const mesh = await generate(spec);
      const out = await writeMesh(mesh, name);
      assert.deepEqual(await faults(out), [], `${spec} as ${name}`);
      const again = await readMesh(out, name);
      assert.deepEqual(again.indices, mesh.indices);
      assert.equal(again.positions.length, (mesh.positions.length / mesh.dimension) * 3);
    }
  }
});
