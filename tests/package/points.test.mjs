// Tests the entry `edgeflip/points` in Node: an oracle of integers of any size, every form of input, hints and errors.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { test } from 'node:test';
import { runInNewContext } from 'node:vm';
import Delaunator from 'delaunator';
import { makeDelaunay } from 'edgeflip';
import { init, triangulate, triangulateSync } from 'edgeflip/points';
import { checkTriangulation, KINDS, randomOf, refused } from './points.mjs';

await init();
const NONE = 0xffffffff;

test('before `init`, the error says what to do; `triangulate` loads the module itself', () => {
  const program = `import { triangulate, triangulateSync } from 'edgeflip/points';
    try { triangulateSync([0, 0, 1, 0, 0, 1]); } catch ({ code, message }) { console.log(code, message); }
    const points = Float64Array.of(0, 0, 1, 0, 0, 1);
    const asked = triangulate(points);
    points.fill(NaN);
    console.log((await asked).triangles.join(), triangulateSync([0, 0, 0, 1, 1, 0]).triangles.join());`;
  const { stdout } = spawnSync(process.execPath, ['--input-type=module', '-e', program], { encoding: 'utf8' });
  assert.equal(
    stdout,
    'load-failed the module of the points is not loaded; call `await init()` before triangulateSync\n0,1,2 0,2,1\n',
  );
});

for (const [name, kind] of Object.entries(KINDS)) {
  test(`every triangle is the one that integers define: ${name}`, async () => {
    const random = randomOf(name.length);
    let [triangles, ties, flat, duplicates] = [0, 0, 0, 0];
    for (let i = 0; i < 60; i++) {
      const points = kind(1 + random(13), random);
      const result = triangulateSync(points);
      ties += checkTriangulation(points, result);
      triangles += result.triangles.length / 3;
      flat += Number(result.hint !== undefined);
      duplicates += result.duplicates.length / 2;
      const { triangles: singles } = triangulateSync(Float32Array.from(points.flat()));
      if (points.flat().every((x) => Math.fround(x) === x)) assert.deepEqual(singles, result.triangles);
    }
    const seen = { triangles: triangles > 0, ties: ties > 0, flat: flat > 0, duplicates: duplicates > 0 };
    assert.ok(seen[kind.has], `${triangles} triangles, ${ties} ties, ${flat} flat, ${duplicates} duplicates`);
  });
}

test('the triangles are those of delaunator, up to ties and to the order, and no edge of them can flip', async () => {
  const random = randomOf(7);
  for (const count of [3, 10, 1000, 30_000]) {
    const positions = Float64Array.from({ length: 2 * count }, () => random(2 ** 30) / 2 ** 30);
    const { triangles, twins, hull, duplicates, hint } = await triangulate(positions);
    const other = new Delaunator(positions);
    const sorted = (all) => {
      const rows = Array.from({ length: all.length / 3 }, (_, t) => {
        const row = [...all.subarray(3 * t, 3 * t + 3)];
        const least = row.indexOf(Math.min(...row));
        return [...row.slice(least), ...row.slice(0, least)];
      });
      return rows.sort(([a, b], [c, d]) => a - c || b - d).flat();
    };
    // Its triangles are clockwise where y is up.
    const turned = other.triangles.map((_, i, all) => all[i % 3 === 1 ? i + 1 : i % 3 === 2 ? i - 1 : i]);
    assert.deepEqual([...triangles], sorted(turned));
    assert.deepEqual(new Set(hull), new Set(other.hull));
    assert.deepEqual([duplicates.length, hint], [0, undefined]);
    assert.ok(twins.every((g, h) => g === NONE || twins[g] === h));
    const { flips, status, boundaryEdges } = await makeDelaunay({ positions, indices: triangles, dimension: 2 });
    assert.deepEqual([flips, status, boundaryEdges], [0, 'done', hull.length]);
  }
});

test('of four points on one circle, the least decides, whatever the order', () => {
  const square = [
    [0, 0],
    [1, 0],
    [1, 1],
    [0, 1],
  ];
  for (let turn = 0; turn < 4; turn++) {
    const points = [...square.slice(turn), ...square.slice(0, turn)];
    const { triangles, twins } = triangulateSync(points);
    const least = (4 - turn) % 4;
    assert.equal(triangles.filter((v) => v === least).length, 2);
    assert.equal(twins.filter((h) => h !== NONE).length, 2);
  }
});

test('each form of the same points gives the same triangles', async () => {
  const random = randomOf(3);
  const count = 200;
  // Bytes, so that every array can hold them.
  const numbers = Array.from({ length: 2 * count }, () => random(100));
  const pairs = Array.from({ length: count }, (_, i) => numbers.slice(2 * i, 2 * i + 2));
  const expected = triangulateSync(Float64Array.from(numbers));
  assert.ok(expected.triangles.length > 3 * count);
  /** Numbers between the coordinates, and before them. */
  const spaced = (Kind, stride, offset) => {
    const array = new Kind(offset + stride * count).fill(77);
    pairs.forEach((pair, i) => array.set(pair, offset + i * stride));
    return array;
  };
  const [x, y] = [(point) => point.at.x, (point) => point.at.y];
  const objects = pairs.map(([x, y]) => ({ at: { x, y } }));
  const shared = new Float64Array(new SharedArrayBuffer(16 * count));
  shared.set(numbers);
  const resizable = new Float64Array(new ArrayBuffer(16 * count, { maxByteLength: 32 * count }));
  resizable.set(numbers);
  const part = new Float32Array(2 * count + 3);
  part.set(numbers, 1);
  const ids = Uint16Array.from({ length: count }, (_, i) => i);
  const byId = { x: (id) => numbers[2 * id], y: (id) => numbers[2 * id + 1] };
  const forms = [
    ...[Float32Array, Float64Array, Int8Array, Uint8Array, Uint8ClampedArray].map((Kind) => [Kind.from(numbers)]),
    ...[Int16Array, Uint16Array, Int32Array, Uint32Array].map((Kind) => [Kind.from(numbers)]),
    [numbers],
    [Object.freeze(numbers.slice())],
    [pairs],
    [pairs.map((pair) => Float32Array.from(pair))],
    [pairs.map(([x, y], i) => Object.freeze([x, y, i]))],
    [part.subarray(1, 1 + 2 * count)],
    [shared],
    [resizable],
    [runInNewContext('Float32Array.from(numbers)', { numbers })],
    [runInNewContext('Array.from(numbers)', { numbers })],
    [runInNewContext('pairs.map(([x, y]) => [x, y])', { pairs })],
    [spaced(Float32Array, 3, 0), { stride: 3 }],
    [spaced(Float64Array, 3, 0), { stride: 3 }],
    [spaced(Int16Array, 5, 2), { stride: 5, offset: 2 }],
    [spaced(Float32Array, 2, 7), { offset: 7 }],
    [Array.from(spaced(Float64Array, 4, 1)), { stride: 4, offset: 1 }],
    // The last point ends the array.
    [spaced(Float32Array, 6, 4).subarray(0, -4), { stride: 6, offset: 4 }],
    [objects, { x, y }],
    [ids, byId],
    [[...ids], byId],
    [Array(count).fill(), { x: (_, i) => numbers[2 * i], y: (_, i) => numbers[2 * i + 1] }],
    [numbers, { stride: undefined, x: undefined, y: null }],
  ];
  for (const [i, form] of forms.entries()) {
    assert.deepEqual(triangulateSync(...form), expected, `form ${i}`);
    assert.deepEqual(await triangulate(...form), expected, `form ${i}`);
  }
});

test('64-bit floats are not rounded', () => {
  const far = 2 ** 40;
  const points = Float64Array.of(far, far, far + 1, far, far, far + 1);
  assert.deepEqual([...triangulateSync(points).triangles], [0, 1, 2]);
  assert.equal(triangulateSync(Float32Array.from(points)).triangles.length, 0);
  // The third point is next to the line y = x, by less than rounded products show.
  for (const [y, triangles] of [
    [1 + 2 ** -52, [0, 1, 2]],
    [1, []],
    [1 - 2 ** -53, [0, 2, 1]],
  ]) {
    const thin = Float64Array.of(-1e300, -1e300, 2e-300, 2e-300, 1, y);
    assert.deepEqual([...triangulateSync(thin).triangles], triangles, `${y}`);
  }
});

test('without a triangle, `hint` says why, and the hull has the distinct points', async () => {
  const few = /^There are fewer than three distinct points, so there is no triangle\.$/;
  const line = /^All points are on one line, so there is no triangle\.$/;
  for (const [points, hint, hull, duplicates] of [
    [[], few, [], []],
    [[[0, 0]], few, [0], []],
    [
      [
        [1, 0],
        [0, 0],
        [1, -0],
      ],
      few,
      [1, 0],
      [2, 0],
    ],
    [
      [
        [5, 5],
        [0, 0],
        [3, 3],
        [3, 3],
        [-1, -1],
      ],
      line,
      [4, 1, 2, 0],
      [3, 2],
    ],
    [
      [
        [0, 3],
        [0, 1],
        [0, 2],
      ],
      line,
      [1, 2, 0],
      [],
    ],
  ]) {
    const result = await triangulate(points);
    assert.match(result.hint, hint);
    assert.deepEqual([...result.hull], hull);
    assert.deepEqual([...result.duplicates], duplicates);
    assert.deepEqual([result.triangles.length, result.twins.length], [0, 0]);
  }
  for (const empty of [[], new Float32Array(), new Float64Array(), new Int8Array()]) {
    assert.match(triangulateSync(empty).hint, few);
  }
});

test('errors name the point and what is wrong with it', async () => {
  const triangle = [
    [0, 0],
    [1, 0],
    [0, 1],
  ];
  const detached = Float64Array.of(0, 0, 1, 0, 0, 1);
  structuredClone(detached, { transfer: [detached.buffer] });
  const buffer = new ArrayBuffer(48, { maxByteLength: 96 });
  const shrunk = new Float64Array(buffer, 0, 6);
  buffer.resize(8);
  const mine = new Error('mine');
  const throwing = Object.defineProperty([0, 0, 1, 0, 0, 1], 3, {
    get: () => {
      throw mine;
    },
  });
  const holes = [0, 0, 1, 0, 0, 1];
  delete holes[3];
  const { proxy, revoke } = Proxy.revocable([], {});
  revoke();
  const [x, y] = [([x]) => x, ([, y]) => y];
  for (const [points, options, code, message] of [
    ...[NaN, Infinity, -Infinity].flatMap((wrong) => {
      const message = new RegExp(`^point 2: coordinate y is ${wrong}, not a finite number$`);
      const numbers = [0, 0, 1, 0, 0, wrong];
      const all = [
        numbers,
        Float32Array.from(numbers),
        Float64Array.from(numbers),
        [
          [0, 0],
          [1, 0],
          [0, wrong],
        ],
      ];
      return all.map((points) => [points, {}, 'non-finite', message]);
    }),
    [[0, 0, 1], {}, 'ragged-array', /^points: the last point has 1 of 2 coordinates \(stride 2, offset 0\)$/],
    [new Float32Array(7), {}, 'ragged-array', /1 of 2 coordinates/],
    [new Float64Array(7), { stride: 3 }, 'ragged-array', /1 of 2 coordinates \(stride 3, offset 0\)/],
    [new Int8Array(8), { stride: 3, offset: 1 }, 'ragged-array', /stride 3, offset 1/],
    [undefined, {}, 'invalid-input', /^points: undefined is neither a typed array of numbers nor a list$/],
    [null, {}, 'invalid-input', /^points: null is neither/],
    ['0,0,1,0', {}, 'invalid-input', /^points: '0,0,1,0' is neither/],
    [{ length: 6 }, {}, 'invalid-input', /^points: an object is neither/],
    [new BigInt64Array(6), {}, 'invalid-input', /^points: a BigInt64Array is neither/],
    [new DataView(new ArrayBuffer(8)), {}, 'invalid-input', /is neither/],
    [proxy, {}, 'invalid-input', /^points cannot be read: /],
    [Array(2 ** 24 + 1), {}, 'invalid-input', /^points: a list has at most 16777216 items; pass a typed array$/],
    [holes, {}, 'invalid-input', /^points: y of point 1 is undefined, not a number$/],
    [throwing, {}, 'invalid-input', /^points cannot be read: mine$/],
    [['0', '0'], {}, 'invalid-input', /^points: x of point 0 is '0', not a number$/],
    [[0n, 0n], {}, 'invalid-input', /^points: x of point 0 is 0n/],
    [[[0, 0], null], {}, 'invalid-input', /^points: point 1 is null, not a pair of numbers$/],
    [[[0, 0], 1], {}, 'invalid-input', /^points: point 1 is 1, not a pair/],
    [[null], {}, 'invalid-input', /^points: point 0 is null, not a pair/],
    [[[0, 0], [1]], {}, 'invalid-input', /^points: y of point 1 is undefined, not a number; .* options x and y$/],
    [[{ x: 0, y: 0 }], {}, 'invalid-input', /^points: x of point 0 is undefined, .* pass the options x and y$/],
    [detached, {}, 'invalid-input', /^points: the buffer was transferred or has shrunk$/],
    [shrunk, {}, 'invalid-input', /^points cannot be read: /],
    [triangle, { x, y: () => '1' }, 'invalid-input', /^points: y of point 0 is '1', not a number$/],
    [triangle, { x, y: (_, i) => (i < 2 ? 0 : NaN) }, 'non-finite', /^point 2: coordinate y is NaN/],
    [{}, { x, y }, 'invalid-input', /^points: an object is neither/],
    [detached, { x, y }, 'invalid-input', /was transferred/],
    [triangle, { x }, 'invalid-option', /^option y is missing: x and y go together$/],
    [triangle, { y }, 'invalid-option', /^option x is missing/],
    [triangle, { x: 'lon', y }, 'invalid-input', /^x: 'lon' is not a function$/],
    [triangle, { x, y, stride: 3 }, 'invalid-option', /^option stride: it is for an array of numbers, not for a list/],
    [triangle, { offset: 1 }, 'invalid-option', /^option offset: it is for an array of numbers/],
    [new Float32Array(6), { stride: 1 }, 'invalid-input', /^stride: 1 is not a whole number of at least 2$/],
    [new Float32Array(6), { stride: '3' }, 'invalid-input', /^stride: '3' is not/],
    [new Float32Array(6), { offset: -1 }, 'invalid-input', /^offset: -1 is not a whole number of 32 bits$/],
    [new Float32Array(6), { strid: 3 }, 'invalid-option', /strid is not an option; did you mean stride\?/],
    [
      new Float32Array(6),
      { dimension: 3 },
      'invalid-option',
      /dimension is not an option; there are stride, offset, x, y/,
    ],
    [new Float32Array(6), null, 'invalid-input', /^options: null is not an object$/],
    [new Float32Array(6), [0, 1], 'invalid-input', /^options: a list is not an object/],
  ]) {
    assert.throws(() => triangulateSync(points, options), refused(code, message), `${message}`);
    await assert.rejects(triangulate(points, options), refused(code, message));
  }
  // Exceptions of the accessors pass through.
  const failing = () => {
    throw mine;
  };
  assert.throws(
    () => triangulateSync(triangle, { x, y: failing }),
    (error) => error === mine,
  );
  await assert.rejects(triangulate(triangle, { x: failing, y }), (error) => error === mine);
  assert.equal(triangulateSync(triangle).triangles.length, 3);
});

test('points that do not fit into the memory are refused, and the next call works', () => {
  for (const huge of [new Float32Array(2 ** 27), new Float64Array(2 ** 28), new Uint8Array(2 ** 29)]) {
    assert.throws(() => triangulateSync(huge), refused('too-large', /memory|bytes/));
  }
  assert.deepEqual([...triangulateSync([0, 0, 1, 0, 0, 1]).triangles], [0, 1, 2]);
});

test('the caller keeps its arrays, and gets arrays of its own', () => {
  const numbers = [0, 0, 4, 0, 4, 3, 0, 3, 4, 0, -0, 0];
  const points = Float64Array.from(numbers);
  const first = triangulateSync(points);
  assert.deepEqual([...points], numbers);
  for (const name of ['triangles', 'twins', 'hull', 'duplicates']) {
    assert.equal(first[name].buffer.byteLength, first[name].byteLength, name);
    assert.ok(first[name] instanceof Uint32Array, name);
  }
  const copy = structuredClone(first);
  triangulateSync(Float32Array.from({ length: 2000 }, (_, i) => (i * i) % 997));
  assert.deepEqual(first, copy);
  assert.deepEqual([...first.duplicates], [4, 1, 5, 0]);
});

test('ten thousand calls leave nothing behind', async () => {
  const points = [0, 0, 4, 1, 5, 3, 1, 3, 2, 2];
  const { memory } = await (await import('../../dist/wasm/edgeflip_points.js')).default();
  for (let i = 0; i < 100; i++) triangulateSync(points);
  const bytes = memory.buffer.byteLength;
  for (let i = 0; i < 10_000; i++) assert.equal(triangulateSync(points).hull.length, 4);
  assert.equal(memory.buffer.byteLength, bytes);
});
