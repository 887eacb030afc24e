// Tests the arrays that a mesh may have: interleaved and quantized positions, indices and lists of every integer type.
// A result has indices of the type that came in. Hints say what a developer may have missed.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import * as here from 'edgeflip';
import { change, generate, measures, readMesh, writeMesh } from 'edgeflip/files';
import * as away from 'edgeflip/worker';

const { FlipSession, makeDelaunay } = here;

const options = { backend: 'cpu' };
const surface = await generate('uvsphere 12');
const plain = await makeDelaunay(surface, options);
assert.ok(plain.flips > 0);

/** The positions with other numbers between and before them. */
function interleaved({ positions, dimension }, stride, offset, Type = positions.constructor) {
  const vertices = positions.length / dimension;
  const numbers = Type.from({ length: offset + vertices * stride }, (_, i) => 7 * i + 0.5);
  for (let i = 0; i < positions.length; i++) {
    numbers[offset + stride * Math.floor(i / dimension) + (i % dimension)] = positions[i];
  }
  return numbers;
}

test('interleaved positions give the same triangles', async () => {
  for (const [stride, offset, Type] of [
    [8, 0, Float32Array],
    [8, 5, Float32Array],
    [3, 4, Float32Array],
    [5, 2, Float64Array],
  ]) {
    const moving = await FlipSession.create(surface, options);
    await moving.run();
    await moving.setPositions(surface.positions);
    const moved = await moving.run();
    moving.free();
    const positions = interleaved(surface, stride, offset, Type);
    const result = await makeDelaunay({ ...surface, positions, stride, offset }, options);
    assert.deepEqual(result.indices, plain.indices);
    const session = await FlipSession.create({ ...surface, positions, stride, offset }, options);
    await session.run();
    const { clean, remaining } = await session.verify();
    assert.deepEqual([clean, remaining], [true, plain.remaining]);
    // The last vertex may end before the stride does.
    await session.setPositions(positions.subarray(0, positions.length - (stride - 3)));
    assert.deepEqual((await session.run()).indices, moved.indices);
    await assert.rejects(session.setPositions(positions.subarray(0, positions.length - (stride - 1))), {
      code: 'ragged-array',
      message: /positions: the last vertex has 1 of 3 coordinates/,
    });
    session.free();
  }
  const positions = interleaved(surface, 6, 1);
  const { area } = await measures({ ...surface, positions, stride: 6, offset: 1 });
  assert.equal(area, (await measures(surface)).area);
});

test('the plane of a mesh with three coordinates per vertex', async () => {
  const mesh = await generate('random 12');
  const positions = interleaved(mesh, 3, 0);
  const wanted = await makeDelaunay(mesh, options);
  const result = await makeDelaunay({ ...mesh, positions, stride: 3 }, options);
  assert.deepEqual(result.indices, wanted.indices);
  assert.equal(result.hint, undefined);
});

test('quantized positions are exact numbers', async () => {
  for (const [Type, scale] of [
    [Int8Array, 127],
    [Uint8Array, 127],
    [Uint8ClampedArray, 127],
    [Int16Array, 32767],
    [Uint16Array, 32767],
    [Int32Array, 2 ** 31 - 1],
    [Uint32Array, 2 ** 31 - 1],
  ]) {
    const shift = Type.name.startsWith('Int') ? 0 : scale;
    const positions = Type.from(surface.positions, (x) => Math.round(x * scale) + shift);
    const result = await makeDelaunay({ ...surface, positions }, options);
    const wanted = await makeDelaunay({ ...surface, positions: Float64Array.from(positions) }, options);
    assert.deepEqual(result.indices, wanted.indices, Type.name);
    assert.ok(result.flips > 0);
  }
});

test('positions may be a plain array of numbers', async () => {
  for (const list of [Array.from(surface.positions), Object.freeze(Array.from(surface.positions))]) {
    assert.deepEqual((await makeDelaunay({ ...surface, positions: list }, options)).indices, plain.indices);
    assert.deepEqual((await away.makeDelaunay({ ...surface, positions: list }, options)).indices, plain.indices);
    assert.equal((await measures({ ...surface, positions: list })).area, (await measures(surface)).area);
  }
  const spread = Array.from(interleaved(surface, 5, 2));
  const wide = await makeDelaunay({ ...surface, positions: spread, stride: 5, offset: 2 }, options);
  assert.deepEqual(wide.indices, plain.indices);
  // Four points on a circle, and one step of a 64-bit float beside it.
  const flips = async (x) => {
    const positions = [7, -24, 25, 0, 7, 24, x, 0];
    return (await makeDelaunay({ positions, indices: [0, 1, 2, 0, 2, 3], dimension: 2 }, options)).flips;
  };
  assert.deepEqual([await flips(-25), await flips(-25 + 2 ** -48), await flips(-25 - 2 ** -48)], [0, 1, 0]);
  for (const { FlipSession } of [here, away]) {
    const session = await FlipSession.create(surface, options);
    await session.setPositions(Array.from(surface.positions));
    session.update({ positions: Array.from(surface.positions), iterations: 64 });
    assert.equal((await session.counters()).nonFinite, 0);
    assert.equal((await session.run()).status, 'done');
    assert.throws(() => session.update({ positions: [0, undefined] }), {
      code: 'invalid-input',
      message: /number 1 is/,
    });
    session.free();
  }
});

test('a misspelt name is refused, and other names are allowed', async () => {
  for (const [more, message] of [
    [{ strid: 3 }, /^mesh: strid is not known; did you mean stride\?$/],
    [{ Stride: 3 }, /did you mean stride\?$/],
    [{ offsett: 0 }, /did you mean offset\?$/],
    [{ dimension: undefined, dimensions: 3 }, /did you mean dimension\?$/],
    [{ positions: undefined, position: surface.positions }, /did you mean positions\?$/],
    [{ indices: undefined, indizes: surface.indices }, /did you mean indices\?$/],
  ]) {
    for (const { makeDelaunay, FlipSession } of [here, away]) {
      const refused = { name: 'EdgeflipError', code: 'invalid-input', message };
      await assert.rejects(makeDelaunay({ ...surface, ...more }, options), refused);
      await assert.rejects(FlipSession.create({ ...surface, ...more }, options), refused);
    }
    await assert.rejects(measures({ ...surface, ...more }), { message });
  }
  const more = { name: 'ball', position: [1, 2, 3], strip: true, side: undefined, strid: undefined, uvs: [], size: 3 };
  assert.deepEqual((await makeDelaunay({ ...surface, ...more }, options)).indices, plain.indices);
  const read = await readMesh(await writeMesh(surface, 'a.ply'), 'a.ply');
  assert.equal((await makeDelaunay(read, options)).flips, plain.flips);
});

test('a result has indices of the type that came in', async () => {
  for (const Type of [
    Int8Array,
    Uint8Array,
    Uint8ClampedArray,
    Int16Array,
    Uint16Array,
    Int32Array,
    Uint32Array,
    Array,
  ]) {
    const mesh = await generate('uvsphere 8');
    const wanted = await makeDelaunay(mesh, options);
    const indices = Type.from(mesh.indices);
    const given = { ...mesh, indices };
    const before = indices.slice();
    const result = await makeDelaunay(given, options);
    assert.deepEqual(result.indices, Type.from(wanted.indices));
    const welded = await makeDelaunay(given, { ...options, weld: true });
    assert.equal(welded.indices.constructor, Type);
    const session = await FlipSession.create(given, options);
    await session.step();
    assert.equal((await session.triangles()).constructor, Type);
    session.free();
    assert.ok((await change(given, result.indices)).moved.length > 0);
    assert.deepEqual(indices, before);
  }
});

test('lists may have any integer type', async () => {
  const triangles = surface.indices.length / 3;
  const wanted = await makeDelaunay(surface, { ...options, lockedEdges: [surface.indices[0], surface.indices[1]] });
  for (const Type of [Uint8Array, Int16Array, Uint16Array, Int32Array, Uint32Array, Array]) {
    const lockedEdges = Type.from(surface.indices.subarray(0, 2));
    assert.deepEqual((await makeDelaunay(surface, { ...options, lockedEdges })).indices, wanted.indices);
    const groups = Type.from({ length: triangles }, (_, t) => t % 120);
    assert.equal((await makeDelaunay(surface, { ...options, groups })).flips, 0);
    const lockedTriangles = Type.from({ length: 100 }, (_, t) => t);
    assert.ok((await makeDelaunay(surface, { ...options, lockedTriangles })).remaining.locked > 0);
  }
});

test('wrong arrays are refused with a message that names them', async () => {
  const refused = (mesh, code, message) =>
    assert.rejects(makeDelaunay({ ...surface, ...mesh }, options), { name: 'EdgeflipError', code, message });
  await refused({ stride: 2 }, 'invalid-input', /^stride: 2 is not a whole number of at least 3$/);
  await refused({ stride: '8' }, 'invalid-input', /^stride: '8' is not/);
  await refused({ offset: -1 }, 'invalid-input', /^offset: -1 is not/);
  await refused({ positions: '0, 0' }, 'invalid-input', /^positions: '0, 0' is neither a typed array nor an array/);
  await refused({ positions: [0, 0, '0'] }, 'invalid-input', /^positions: .* number 2 is '0'$/);
  await refused({ positions: [0, 0] }, 'ragged-array', /./);
  await refused({ positions: [0, 0, 0] }, 'index-out-of-range', /./);
  await refused({ positions: [NaN, 0, 0] }, 'non-finite', /vertex 0/);
  await refused({ indices: [0, 1, 1.5] }, 'invalid-input', /^indices: .* number 2 is 1.5$/);
  await refused(
    { indices: new Float32Array(3) },
    'invalid-input',
    /^indices: a Float32Array is neither an integer array/,
  );
  await refused({ indices: Int8Array.of(0, 1, -1) }, 'index-out-of-range', /4294967295/);
  await refused({ stride: 3, offset: 2 ** 32 - 1 }, 'index-out-of-range', /./);
  await refused({ stride: 2 ** 32 - 1 }, 'index-out-of-range', /./);
});

test('hints say what a developer may have missed', async () => {
  const soup = {
    positions: Float32Array.from(surface.indices, (v) => v).fill(0),
    indices: surface.indices.map((_, i) => i),
    dimension: 3,
  };
  soup.positions = new Float32Array(
    Array.from(surface.indices, (v) => [...surface.positions.slice(3 * v, 3 * v + 3)]).flat(),
  );
  assert.match((await makeDelaunay(soup, options)).hint, /^No two triangles share an edge.*pass the option weld\.$/);
  assert.equal((await makeDelaunay(soup, { ...options, weld: true })).hint, undefined);
  // The vertices that stay after welding are the first quarter.
  const joined = {
    ...soup,
    positions: Float32Array.from([...surface.positions, ...soup.positions, ...soup.positions]),
  };
  joined.indices = surface.indices.map((v, i) => (i < 3000 ? v : surface.positions.length / 3 + i));
  assert.equal((await makeDelaunay(joined, { ...options, weld: true })).hint, undefined);
  // Flat shading: each triangle has its own normal.
  const normals = Float32Array.from({ length: soup.positions.length }, (_, i) => Math.floor(i / 9));
  assert.match((await makeDelaunay(soup, { ...options, weld: [normals] })).hint, /^Every inner edge is a seam/);
  const flat = await generate('random 12');
  const triples = interleaved(flat, 3, 0);
  const silent = await makeDelaunay({ ...flat, positions: triples }, { ...options, maxIterations: 0 });
  assert.match(silent.hint, /dimension: 3, or for a terrain plane/);
  for (const { makeDelaunay } of [here, away]) {
    // Edges flip, although every number stands for something else.
    const flipping = await makeDelaunay({ ...flat, positions: triples }, options);
    assert.ok(flipping.flips > 0);
    assert.match(flipping.hint, /dimension: 3, or for a terrain plane/);
    const spread = interleaved(surface, 6, 0);
    assert.match((await makeDelaunay({ ...surface, positions: spread }, options)).hint, /3\/6 .*pass stride: 6\.$/);
    const named = { ...surface, positions: spread, stride: 3 };
    assert.equal((await makeDelaunay(named, options)).hint, undefined);
  }
  assert.equal(plain.hint, undefined);
});

test('a result says how many threads ran', async () => {
  assert.equal(plain.threads, 1);
  const large = await generate('random 190');
  assert.equal((await makeDelaunay(large, { ...options, threads: 2 })).threads, 2);
  assert.equal((await makeDelaunay(large, { ...options, threads: 1 })).threads, 1);
});
