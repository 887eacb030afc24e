// Tests the memory of the package in Node: an error says that memory ran out, and what to do. Sessions that are freed or
// collected make room.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { setTimeout as pause } from 'node:timers/promises';
import { setFlagsFromString } from 'node:v8';
import { runInNewContext } from 'node:vm';
import { FlipSession, makeDelaunay } from 'edgeflip';
import { generate, readMesh, writeMesh } from 'edgeflip/files';
import { full as isFull } from '../full.mjs';

setFlagsFromString('--expose-gc');
const gc = runInNewContext('gc');

/** Fewer than 260 sessions of this mesh fill the 4 GiB of WebAssembly. */
const mesh = await generate('grid 600');

for (const threads of isFull ? [1, 2] : [2]) {
  const options = { backend: 'cpu', threads };

  test(`sessions fill the memory on ${threads} threads, and still work`, async () => {
    const held = [];
    const fill = async () => {
      for (let i = 0; i < 260; i++) held.push(await FlipSession.create(mesh, options));
    };
    const full = {
      name: 'EdgeflipError',
      code: 'too-large',
      message:
        /^up to \d+ bytes of memory are needed, and WebAssembly has 4294967296 for all meshes: free\(\) sessions /,
    };
    await assert.rejects(fill(), full);
    assert.ok(held.length > 50, `${held.length}`);
    const small = await generate('random 12');
    assert.equal((await makeDelaunay(small, options)).status, 'done');
    held.slice(1, 20).forEach((session) => session.free());
    assert.equal((await held[0].run()).status, 'done');
    assert.equal((await makeDelaunay(mesh, options)).status, 'done');
    await assert.rejects(fill(), full);
    // Sessions that nobody holds make room once JavaScript has collected them.
    held.length = 0;
    for (let i = 0; i < 3; i++) {
      gc();
      await pause(5);
    }
    for (let i = 0; i < 50; i++) held.push(await FlipSession.create(mesh, options));
    held.forEach((session) => session.free());
  });
}

test('a generated mesh that does not fit is refused, and the next mesh is generated', async () => {
  await assert.rejects(generate('random 9000'), { code: 'too-large', message: /bytes of memory are needed/ });
  assert.equal((await generate('grid 3')).indices.length, 24);
});

test('`writeMesh` with `original` refuses other positions', async () => {
  for (const name of ['a.obj', 'a.ply', 'a.glb']) {
    const written = await generate('uvsphere 4');
    const original = { bytes: await writeMesh(written, name), name };
    const read = await readMesh(original.bytes, name);
    await writeMesh(read, name, { original });
    const positions = read.positions.map((x) => x + 1);
    await assert.rejects(writeMesh({ ...read, positions }, name, { original }), {
      code: 'invalid-option',
      message: /^option original: /,
    });
    await assert.rejects(writeMesh({ ...read, positions: read.positions.slice(3) }, name, { original }), {
      code: 'invalid-option',
    });
  }
});
