// Tests modules with little memory in Node: if memory runs out, calls are refused, and no memory is lost.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { FlipSession, init, makeDelaunay } from 'edgeflip';
import { generate, readMesh, weld, writeMesh } from 'edgeflip/files';

/**
 * The bytes of a module with at most `pages` pages of memory, of 64 KiB each. Changes section 5 of the binary format.
 */
function limited(name, pages) {
  const bytes = readFileSync(new URL(`../../dist/wasm/${name}_bg.wasm`, import.meta.url));
  const parts = [bytes.subarray(0, 8)];
  /** Reads a number with 7 bits per byte (LEB128). Returns it and the offset after it. */
  const number = (at) => {
    for (let value = 0, shift = 0; ; shift += 7) {
      const byte = bytes[at++];
      value += (byte & 127) * 2 ** shift;
      if (byte < 128) return [value, at];
    }
  };
  const written = (value) => (value < 128 ? [value] : [(value % 128) + 128, ...written(Math.floor(value / 128))]);
  for (let at = 8; at < bytes.length; ) {
    const [length, begin] = number(at + 1);
    const isMemory = bytes[at] === 5;
    const [least] = isMemory ? number(begin + 2) : [];
    const limits = isMemory && [1, 1, ...written(least), ...written(pages)];
    parts.push(isMemory ? Uint8Array.of(5, ...written(limits.length), ...limits) : bytes.subarray(at, begin + length));
    at = begin + length;
  }
  return Buffer.concat(parts);
}

await init({ core: limited('edgeflip', 100), files: limited('edgeflip_files', 3200) });
const mesh = await generate('random 60');
const options = { backend: 'cpu' };
const expected = await makeDelaunay(mesh, options);
const isRefused = { name: 'EdgeflipError', code: 'too-large', message: /bytes of memory are needed/ };

test('sessions that fill the memory again and again lose no memory', async () => {
  const counts = [];
  for (let round = 0; round < 4; round++) {
    const held = [];
    await assert.rejects(async () => {
      for (;;) held.push(await FlipSession.create(mesh, options));
    }, isRefused);
    counts.push(held.length);
    const asked = [
      (session) => session.run(),
      (session) => session.edges(),
      (session) => session.edgeStates(),
      (session) => session.setPositions(mesh.positions),
      (session) => session.triangles(),
      (session) => session.verify(),
    ];
    let refused = 0;
    for (const ask of asked) {
      for (const session of held) {
        const code = await ask(session).then(
          () => undefined,
          ({ code }) => code,
        );
        if (code) assert.equal(code, 'too-large');
        refused += code ? 1 : 0;
      }
    }
    assert.ok(refused > 0, 'the memory is full');
    held.slice(1).forEach((session) => session.free());
    await held[0].setPositions(mesh.positions);
    assert.equal((await held[0].run()).status, 'done');
    held[0].free();
    assert.deepEqual((await makeDelaunay(mesh, options)).indices, expected.indices);
  }
  // If calls have left free blocks elsewhere, one more session may fit.
  assert.ok(
    counts.every((count) => count >= counts[0]),
    `${counts}`,
  );
});

test('too many positions leave the session unchanged', async () => {
  const session = await FlipSession.create(mesh, options);
  await assert.rejects(session.setPositions(new Float32Array(3e6)), isRefused);
  assert.deepEqual((await session.run()).indices, expected.indices);
  session.free();
});

test('after a file that is too large, others can be read', async () => {
  const [small, large] = [
    await writeMesh(await generate('grid 100'), 'a.obj'),
    await writeMesh(await generate('grid 500'), 'a.obj'),
  ];
  const huge = Buffer.concat(Array.from({ length: 5 }, () => large));
  for (let round = 0; round < 3; round++) {
    await assert.rejects(readMesh(new Uint8Array(huge), 'a.obj'), isRefused);
    for (const bytes of [large, small]) assert.ok((await readMesh(bytes, 'a.obj')).indices.length > 0);
  }
});

test('too many indices leave the welded mesh unchanged', async () => {
  const welded = await weld(mesh);
  assert.throws(() => welded.split(new Uint32Array(2e7)), isRefused);
  assert.equal(welded.split(welded.indices).length, mesh.indices.length);
  welded.free();
});

test('only errors about memory have the code of memory', async () => {
  await assert.rejects(generate('out of memory'), { code: 'invalid-option' });
  await assert.rejects(readMesh(new Uint8Array(4), 'out of memory.txt'), { code: 'unknown-format' });
});
